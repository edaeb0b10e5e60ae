"""``plan.json``: what the planner decided, complete enough to fly from."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, Annotated, Literal, Self

import numpy as np
from pydantic import AfterValidator, Field, model_validator

from inspect_cli.interfaces import ContactLaw, Posture
from inspect_cli.schema.base import Name, NonNegative, Positive, Strict, Triple
from inspect_cli.schema.geometry import Shape
from inspect_cli.schema.registry import choice_of
from inspect_cli.schema.vehicle.sensors import INSTRUMENTS


def _unit(value: tuple[float, float, float, float]) -> tuple[float, float, float, float]:
    if abs(math.hypot(*value) - 1.0) > 1e-6:
        raise ValueError("an attitude is a unit quaternion")
    return value


Quaternion = Annotated[tuple[float, float, float, float], AfterValidator(_unit)]
LegKind = Name
"""``takeoff``, ``transit``, ``land``, or as a task's planner calls it: as a rule like a mode."""
GOING = ("takeoff", "transit", "land")
"""Kinds of leg that lead somewhere without having to be about a target."""
ToolDirection = Literal["x", "-x", "y", "-y"]


Piece = Annotated[tuple[tuple[float, float], ...], Field(min_length=2)]


class PostureModel(Strict):
    """A vehicle at rest: body pose and the angles of its arm."""

    p_WB: Triple
    q_WB: Quaternion
    arm_angle_rad: tuple[float, ...] = ()

    @property
    def posture(self) -> Posture:
        """The posture that is spelled out."""
        return Posture(np.array(self.p_WB), np.array(self.q_WB), np.array(self.arm_angle_rad))


class MarginModel(Strict):
    """What is left of one of the vehicle's limits."""

    value: float
    unit: str


class FitReport(Strict):
    """How well a primitive explains its points."""

    method: str
    points: int
    inliers: int
    inlier_share: float
    rms_m: float
    parameter_sd: dict[str, float]
    """Standard deviation of each fitted parameter, named with its unit."""


class PlannedSurface(Strict):
    """A surface as the planner believes it, with how it came to believe so."""

    name: Name
    shape: Shape
    source: str
    fit: FitReport | None = None


class Stroke(Strict):
    """A line on a believed surface that the tool follows without lifting."""

    pieces_m: Annotated[tuple[Piece, ...], Field(min_length=1)]
    """(u, v) of the points of each smooth piece; the tool rests between pieces."""
    speed_mps: Positive
    drawing: Annotated[int, Field(ge=0)] = 0
    """Place in the mission of the task that draws it."""
    trial: Annotated[int, Field(ge=0)] = 0
    """Repetition index of the drawing, from 0."""
    part: Annotated[int, Field(ge=0)] = 0
    """Index of the stroke within the drawing, from 0."""


class Following(Strict):
    """A way along a surface that is known by the depth camera alone."""

    direction: ToolDirection
    """Of the tool's frame T."""
    distance_m: NonNegative
    speed_mps: Positive


if TYPE_CHECKING:
    Instrument = str
else:
    Instrument = choice_of(INSTRUMENTS)


class Target(Strict):
    """Something that the vehicle goes to.

    A contact is a point to touch, a stroke begins where the tool first touches, a following
    where the tool looks from, a pose hangs in free air. ``p_WC`` and ``n_W`` of a pose and of a
    following are those of the tool: its tip, and the direction against its axis.
    """

    index: Annotated[int, Field(ge=0)]
    label: str
    kind: Literal["contact", "stroke", "following", "pose", "perch"]
    impedance: Name | None = None
    """The profile of the platform that is flown with, from the way there on; None where it has
    none."""
    surface: Name | None
    uv_m: tuple[float, float] | None
    """Coordinates on the surface."""
    stroke: Stroke | None = None
    following: Following | None = None
    p_WC: Triple
    """The planned contact point."""
    n_W: Triple
    """Outward normal of the fitted surface there."""
    q_WT: Quaternion
    sensor: Instrument | None
    """The instrument that is read there, by its kind; None where none is."""
    law: Annotated[ContactLaw, Field(discriminator="kind")] | None = None
    """How the tool is pressed on the surface; None where nothing is touched."""
    dwell_s: NonNegative
    standoff_m: NonNegative
    cell_m: tuple[Positive, Positive] | None = None
    """Widths along u and v of the part of the surface that the point stands for; None where
    nothing is touched, and for a point that stands alone."""
    off_target_m: Positive = 0.03
    """A reading taken farther than this from its point, along the surface, does not count."""
    standoff: PostureModel
    """The vehicle with its tool ``standoff_m`` from the surface."""
    contact: PostureModel
    """The vehicle with its tip on the surface, held there by the law of contact."""
    margins: dict[str, MarginModel] = {}
    """The least of each on the way in and out, by the vehicle's own names."""
    clearance_m: float | None
    """Least distance of the body from the structure on the way in and out, or in a pose; None
    where no structure is known."""

    @property
    def press_m(self) -> float:
        """How far the set-point lies behind the surface."""
        return 0.0 if self.law is None else self.law.depth_m

    @property
    def expected_force_n(self) -> float:
        """The steady normal force while the tool presses."""
        return 0.0 if self.law is None else self.law.expected_force_n


class Leg(Strict):
    """A stretch of the flight. Postures are passed at rest, so each stretch can be cut short."""

    kind: LegKind
    target: int | None
    postures: Annotated[tuple[PostureModel, ...], Field(min_length=1)]
    """Where it leads: way-points in order; the last is its end. A press leads to the posture
    with the tip ``press_m`` behind the surface, which the surface itself prevents."""
    speed_mps: Positive
    """Peak speed of the smooth profile between way-points."""
    duration_s: Positive
    """As planned, with the time for the dwell."""


class Plan(Strict):
    """The whole flight."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    mission: Name
    platform: Name
    impedance: Name | None
    """The profile that is flown with where no target says otherwise; None where the platform has
    none."""
    surfaces: tuple[PlannedSurface, ...]
    start: PostureModel
    targets: Annotated[tuple[Target, ...], Field(min_length=1)]
    legs: tuple[Leg, ...]
    duration_s: Positive
    energy_wh: Positive
    path_m: Positive
    """Length of the body's planned path, presses behind the surface included."""
    cable_m: float
    """Longest straight distance from the start to a target that the cable has to span."""
    warnings: tuple[str, ...] = ()

    @property
    def instruments(self) -> tuple[str, ...]:
        """The instruments that are read, each once, in the order of the targets."""
        return tuple(dict.fromkeys(t.sensor for t in self.targets if t.sensor is not None))

    @model_validator(mode="after")
    def _legs_lead_to_targets(self) -> Self:
        for place, target in enumerate(self.targets):
            if target.index != place:
                raise ValueError(f"target {place} has the index {target.index}")
        for leg in self.legs:
            if leg.target is None and leg.kind not in GOING:
                raise ValueError(f"a leg of kind {leg.kind} has no target")
            if leg.target is not None and not 0 <= leg.target < len(self.targets):
                raise ValueError(f"a leg leads to target {leg.target}, which is not there")
        return self


class PlanFile(Plan):
    """``plan.json`` as ``inspect plan`` writes it: it remembers what it was made from."""

    mission_file: str
    """Path of the mission, relative to the plan's folder."""
    inputs_sha256: str
    """Of the mission and the platform; a plan does not fly when either has changed."""

    @model_validator(mode="after")
    def _leads_somewhere(self) -> Self:
        if not self.legs:
            raise ValueError("there are no legs to fly")
        return self

    def plan(self) -> Plan:
        """The plan alone, as a log carries it."""
        return Plan.model_construct(**{name: getattr(self, name) for name in Plan.model_fields})
