"""``kind: cable``: the instrument's cable from a clamp on the ground to the vehicle."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Positive
from inspect_cli.schema.disturbances.base import DisturbanceModel


class Cable(DisturbanceModel):
    """The instrument's cable from a clamp on the ground to the vehicle."""

    kind: Literal["cable"]
    length_m: Positive
    mass_kgpm: Positive
    clamp_m: tuple[float, float] | None = None
    """(x, y) on the ground; without it, under the place where the vehicle starts."""
    attached: Literal["tool", "body"] = "tool"
    """To the tool's tip, or to O_b."""
    stiffness_npm: Annotated[float, Field(gt=0, le=500)] = 500.0
    """How fast the pull grows when the cable is stretched out; softer than a real one."""
