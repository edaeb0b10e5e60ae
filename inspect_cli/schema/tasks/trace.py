"""Task ``trace``: draw on a surface with the tool, without lifting it along a line."""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated

from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, NonNegative, Positive
from inspect_cli.schema.tasks.base import (
    CONTACT_MODES,
    MAX_POINTS,
    SHORTEST_M,
    Coordinate,
    Pressing,
    TaskKind,
)

Corner = tuple[Coordinate, Coordinate]
Path = Annotated[tuple[Corner, ...], Field(min_length=2, max_length=MAX_POINTS)]


class Trace(Pressing):
    """A drawing traced on a surface, with the set-point behind it: push and slide.

    Given as one polyline in metres, or as the paths of an SVG file scaled to ``width_m``.
    """

    on: Name
    polyline_m: Path | None = None
    """(u, v) of its corners, from ``at_m``; the tool stops at each."""
    svg: str | None = None
    """File in the campaign folder; every path in it is a stroke, between which the tool lifts."""
    width_m: Positive | None = None
    """Width of the SVG's drawing on the surface, along u; its height follows."""
    at_m: tuple[Coordinate, Coordinate] = (0.0, 0.0)
    """(u, v) of the polyline's origin, or of the middle of the SVG's drawing, on the surface."""
    speed_mps: Positive = 0.1
    repeat: Annotated[int, Field(ge=1, le=20)] = 1
    """How often the whole drawing is traced."""
    settle_s: NonNegative = 2.0
    """Time in contact at the beginning of a stroke before the tool moves."""

    @model_validator(mode="after")
    def _one_drawing(self) -> Trace:
        if (self.polyline_m is None) == (self.svg is None):
            raise ValueError("give exactly one of polyline_m, svg")
        if (self.svg is None) != (self.width_m is None):
            raise ValueError("width_m belongs to an svg, and an svg needs it")
        return self

    @model_validator(mode="after")
    def _leads_somewhere(self) -> Trace:
        corners = self.polyline_m or ()
        if corners and all(math.dist(a, b) <= SHORTEST_M for a, b in pairwise(corners)):
            raise ValueError(f"no edge of polyline_m is longer than {SHORTEST_M:g} m")
        return self


KIND = TaskKind(Trace, modes=CONTACT_MODES | {"slide"}, surface_key="on", file_keys=("svg",))
