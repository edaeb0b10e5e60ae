"""``tasks:`` of a mission: what the vehicle shall touch, trace, follow or hold, in order.

A task is one of the kinds below, with the instrument and the impedance profile it is done with.
A kind that touches a surface of the structure names it by ``on``.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Annotated, Literal

from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, NonNegative, Positive, Strict, Triple
from inspect_cli.schema.start import Start

MAX_POINTS = 10_000
SHORTEST_M = 1e-4
"""Lines that are shorter are marks of the pen, not lines."""

Instrument = Literal["half_cell"]

Coordinate = Annotated[float, Field(ge=-1000.0, le=1000.0)]
Place = tuple[Coordinate, Coordinate, Coordinate]
"""Somewhere to fly to: farther off than any battery lasts is a slip of the unit."""


class Pressing(Strict):
    """How the tool is brought to a surface and pressed on it."""

    press_m: Annotated[float, Field(gt=0, le=1.0)] = 0.10
    """Set-point behind the surface while pressing."""
    standoff_m: Annotated[float, Field(gt=0, le=1.5)] = 0.25
    """Distance of the tool's tip from the surface before approach and after retreat."""


class ContactOptions(Pressing):
    """How each point of a task is touched."""

    dwell_s: Annotated[float, Field(gt=0, le=3600)] = 3.0
    """Time with sufficient force before a reading may be accepted."""
    off_target_m: Positive = 0.03
    """A reading taken farther than this from its point, along the surface, does not count."""


class ContactGrid(ContactOptions):
    """A grid of points along the surface's level direction u and along v."""

    on: Name
    rows: Annotated[int, Field(ge=1, le=1000)]
    columns: Annotated[int, Field(ge=1, le=1000)]
    pitch_m: Positive
    offset_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) of the grid's middle from the middle of the surface."""
    order: Literal["boustrophedon", "rows", "shortest"] = "boustrophedon"

    @model_validator(mode="after")
    def _not_too_many(self) -> ContactGrid:
        count = self.rows * self.columns
        if count > MAX_POINTS:
            raise ValueError(
                f"{self.rows} rows of {self.columns} columns are {count} points; "
                f"at most {MAX_POINTS} in one task: split it into several missions"
            )
        return self


class ContactPoints(ContactOptions):
    """Points given one by one."""

    on: Name
    at_m: Annotated[tuple[Triple, ...], Field(min_length=1, max_length=MAX_POINTS)]
    """World positions on the surface, within ``tolerance_m`` of it."""
    tolerance_m: Positive = 0.05
    order: Literal["given", "shortest"] = "given"


class KeepOut(Strict):
    """A round part of a surface that is not touched."""

    at_m: tuple[float, float]
    """(u, v) of its middle."""
    radius_m: Positive
    """Along the surface."""


CLOSER_SPACING_MV = 150.0
"""Neighbouring readings that differ by more ask for a closer spacing (ASTM C876)."""


class Refinement(Strict):
    """The rule of ASTM C876 for a closer spacing: points between neighbours that differ much."""

    difference_mv: Positive = CLOSER_SPACING_MV
    """Neighbouring readings that differ by more get points between them."""
    pitch_m: Positive | None = None
    """At most this far apart; by default half the pitch of the coverage, one point between."""
    max_points: Annotated[int, Field(ge=1, le=MAX_POINTS)] = 20
    """In the whole survey; the greatest differences come first."""


class Coverage(ContactOptions):
    """A whole surface, filled with contact points and flown in as many sorties as it takes."""

    on: Name
    pitch_m: Positive
    """Between neighbouring points along the surface."""
    edge_m: NonNegative | None = None
    """No point is nearer to the surface's edge; by default half the pitch."""
    offset_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) by which the points are shifted from where they lie evenly on the surface."""
    keep_out: tuple[KeepOut, ...] = ()
    reserve: Annotated[float, Field(ge=0, lt=1)] = 0.10
    """Share of the battery's energy that no sortie plans with."""
    starts: tuple[Start, ...] = ()
    """Where sorties may take off and land, each with the cable's clamp under it; by default the
    mission's start."""
    refine: Refinement | None = None
    """Without it, no points are added in flight."""

    @model_validator(mode="after")
    def _refined_is_closer(self) -> Coverage:
        closer_m = self.refine.pitch_m if self.refine else None
        if closer_m is not None and closer_m >= self.pitch_m:
            raise ValueError(
                f"refine.pitch_m {closer_m:g} must be below pitch_m {self.pitch_m:g}: "
                "no point would ever be added"
            )
        return self


class Hold(Strict):
    """A pose in free air, held for a time."""

    position_m: Place
    """Of O_b in W."""
    heading_deg: float = 0.0
    duration_s: Annotated[float, Field(gt=0, le=3600)]


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


class ServoStart(Strict):
    """Where the vehicle is brought by hand: level, the tool about towards the surface."""

    position_m: Place
    """Of O_b in W, as the vehicle believes to be there."""
    heading_deg: float = 0.0


class Servo(Pressing):
    """Depth servoing: find, touch and follow a surface that nobody has described.

    From the start pose the tool goes to what the depth camera sees along its axis, presses,
    slides ``slide_m`` along the surface in a direction of its own frame, and backs off.
    """

    start: ServoStart
    direction: Literal["x", "-x", "y", "-y"] = "-x"
    """Of the tool's frame T, along the surface."""
    slide_m: NonNegative = 0.5
    speed_mps: Positive = 0.17
    settle_s: NonNegative = 2.0
    """Time in contact before and after the slide."""


Work = ContactGrid | ContactPoints | Coverage | Hold | Trace | Servo


class Task(Strict):
    """Something to do, and the instrument and the impedance profile to do it with."""

    contact_grid: ContactGrid | None = None
    contact_points: ContactPoints | None = None
    coverage: Coverage | None = None
    hold: Hold | None = None
    trace: Trace | None = None
    servo: Servo | None = None
    sensor: Literal["half_cell", "none"] | None = None
    """What is read at each point; by default the half-cell at contacts, nothing elsewhere."""
    impedance: Name | None = None
    """One of the platform's profiles; without it, the mission's."""

    @model_validator(mode="after")
    def _one_kind(self) -> Task:
        given = [name for name in KINDS if getattr(self, name) is not None]
        if len(given) != 1:
            raise ValueError(f"give exactly one of {', '.join(KINDS)}")
        if self.sensor == "half_cell" and given[0] not in CONTACTS:
            raise ValueError(f"the half-cell reads at contacts; a {given[0]} has none to read at")
        if self.coverage and self.coverage.refine and self.instrument is None:
            raise ValueError("refine compares readings; sensor: none takes none")
        return self

    @property
    def work(self) -> Work:
        """The one that is given."""
        given: Work = next(w for name in KINDS if (w := getattr(self, name)) is not None)
        return given

    @property
    def on(self) -> str | None:
        """The surface of the structure that it is done on."""
        return getattr(self.work, "on", None)

    @property
    def instrument(self) -> Instrument | None:
        """What reads at its points."""
        if self.sensor is None:
            is_contact = any(getattr(self, name) is not None for name in CONTACTS)
            return "half_cell" if is_contact else None
        return None if self.sensor == "none" else self.sensor


CONTACTS = ("contact_grid", "contact_points", "coverage")
KINDS = (*CONTACTS, "hold", "trace", "servo")
