"""``kind: wind``: a mean wind with gusts."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from inspect_cli.schema.base import NonNegative, Positive, PositiveTriple, Strict, Triple
from inspect_cli.schema.disturbances.base import DisturbanceModel

LEAST_CARRYING_WIND_MPS = 0.5


class Gust(Strict):
    """Dryden turbulence at low altitude (MIL-F-8785C), carried along by the mean wind."""

    w20_mps: Positive
    """The standard's measure of turbulence: the wind's speed 20 ft (6 m) over the ground."""
    altitude_m: Annotated[float, Field(ge=3.048, le=304.8)] = 3.048
    """The height that sets scale and strength; the standard gives none below 10 ft."""


class Wind(DisturbanceModel):
    """A mean wind with gusts that drags at the body."""

    kind: Literal["wind"]
    mean_mps: Triple
    gust: Gust | None = None
    start_s: NonNegative = 0.0
    ramp_s: NonNegative = 1.0
    """Mean and gusts rise linearly over this time."""
    drag_area_m2: PositiveTriple
    """C_d A of the vehicle along x, y and z of B."""

    @model_validator(mode="after")
    def _carries_its_gusts(self) -> Wind:
        speed = math.hypot(*self.mean_mps[:2])
        if self.gust is not None and speed < LEAST_CARRYING_WIND_MPS:
            raise ValueError(
                f"gusts are carried past the vehicle by a horizontal mean wind of at least "
                f"{LEAST_CARRYING_WIND_MPS:g} m/s; mean_mps has {speed:g} m/s"
            )
        return self

    @classmethod
    def refuse_together(cls, entries: Sequence[Self]) -> None:
        """Raise ValueError for a second wind."""
        if len(entries) > 1:
            raise ValueError("there is one air: give one wind")
