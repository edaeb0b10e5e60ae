"""Task ``hold``: hold a pose in free air."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field

from inspect_cli.schema.tasks.base import Place, TaskKind, Work


class Hold(Work):
    """A pose in free air, held for a time."""

    position_m: Place
    """Of O_b in W."""
    heading_deg: float = 0.0
    duration_s: Annotated[float, Field(gt=0, le=3600)]


KIND = TaskKind(Hold, modes=frozenset({"hold"}))
