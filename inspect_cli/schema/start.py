"""Where a flight begins and ends."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from inspect_cli.schema.base import Strict


class Start(Strict):
    """Where the vehicle stands before take-off and lands again."""

    position_m: tuple[float, float] = (0.0, 0.0)
    heading_deg: float = 0.0
    takeoff_height_m: Annotated[float, Field(gt=0, le=120)] = 1.0
