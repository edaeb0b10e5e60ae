"""Tasks of a vehicle that pushes by leaning: ``lean`` on a wall, ``prop`` under a ceiling."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, NonNegative, Positive
from inspect_cli.schema.tasks.base import TaskKind, Work

RAMP_S = 1.0
"""In which a force, and the speed of a crawl, rise and fall."""


class Push(Work):
    """A place on a surface that a part of the vehicle is pressed on with a stated force."""

    on: Name
    at_m: tuple[float, float]
    """(u, v) on the surface."""
    force_n: Positive
    dwell_s: Annotated[float, Field(gt=0, le=3600)] = 3.0
    """Time at the full force."""
    standoff_m: Annotated[float, Field(gt=0, le=1.5)] = 0.15
    """Distance from the surface before and after."""


class Lean(Push):
    """The wheel on a wall: press, then perhaps crawl upwards along it."""

    crawl_m: NonNegative = 0.0
    crawl_mps: Positive = 0.2

    @model_validator(mode="after")
    def _gets_up_to_speed(self) -> Lean:
        if 0.0 < self.crawl_m < self.crawl_mps * RAMP_S:
            least = self.crawl_mps * RAMP_S
            raise ValueError(f"crawl_m {self.crawl_m:g} is less than the {least:g} m of its ramps")
        return self


class Prop(Push):
    """The foot under a ceiling."""


LEAN = TaskKind(
    Lean, modes=frozenset({"nearing", "leaning", "crawling", "leaving"}), surface_key="on"
)
PROP = TaskKind(Prop, modes=frozenset({"nearing", "propping", "leaving"}), surface_key="on")
