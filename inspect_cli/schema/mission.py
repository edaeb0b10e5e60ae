"""``mission.yaml``: what is known of a structure, where to touch it, and what must come out."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import AfterValidator, Field, model_validator

from inspect_cli.schema.base import (
    Name,
    NonNegative,
    Positive,
    Strict,
    Triple,
)
from inspect_cli.schema.geometry import Displacement, Shape
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.start import Start
from inspect_cli.schema.tasks import TASK_KINDS, Task
from inspect_cli.schema.tasks.coverage import Coverage
from inspect_cli.schema.truth import TruthModel

Fit = Literal["plane", "sphere", "cylinder", "auto"]


def _without_repetition(seeds: tuple[int, ...]) -> tuple[int, ...]:
    again = sorted({seed for seed in seeds if seeds.count(seed) > 1})
    if again:
        raise ValueError(f"the same seed a second time: {', '.join(map(str, again))}")
    return seeds


Seeds = Annotated[
    tuple[Annotated[int, Field(ge=0)], ...],
    Field(min_length=1, json_schema_extra={"uniqueItems": True}),
    AfterValidator(_without_repetition),
]


class CropBox(Strict):
    """Keep the points inside a box of world coordinates."""

    min_m: Triple
    max_m: Triple

    @model_validator(mode="after")
    def _ordered(self) -> CropBox:
        for axis, low, high in zip("xyz", self.min_m, self.max_m, strict=True):
            if low >= high:
                raise ValueError(f"min_m must be below max_m, but {axis} has {low} ≥ {high}")
        return self


class FitOptions(Strict):
    """How a primitive is fitted to points."""

    inlier_m: Positive = 0.02
    """Points within this distance of the surface support it."""
    voxel_m: NonNegative = 0.0
    """Down-sample to one point per voxel of this size; 0 keeps every point."""
    side: Literal["outside", "inside"] | None = None
    """From which side a sphere or cylinder is touched; by default the side of the start pose."""


class SurfaceSource(Strict):
    """A surface, given as a shape or fitted to a cloud or a mesh: exactly one of the three."""

    shape: Shape | None = None
    cloud: str | None = None
    """PLY, PCD, XYZ, CSV, LAS, LAZ or E57, in the campaign folder."""
    mesh: str | None = None
    """STL, OBJ or PLY, in the campaign folder."""
    fit: Fit = "auto"
    options: FitOptions = FitOptions()
    crop: CropBox | None = None
    placed: Displacement = Displacement()
    """Brings the file's coordinates into the world."""

    @model_validator(mode="after")
    def _one_source(self) -> SurfaceSource:
        given = [n for n in ("shape", "cloud", "mesh") if getattr(self, n) is not None]
        if len(given) != 1:
            found = " and ".join(given) if given else "none"
            raise ValueError(f"give exactly one of shape, cloud, mesh; found {found}")
        return self

    @model_validator(mode="after")
    def _nothing_to_fit(self) -> SurfaceSource:
        fitting = ("fit", "options", "crop")
        fields = type(self).model_fields
        idle = [n for n in fitting if getattr(self, n) != fields[n].default]
        if self.shape is not None and idle:
            named = " and ".join(idle)
            raise ValueError(f"a shape is taken as it is given; {named} would have no effect")
        return self


class StructureSurface(Strict):
    """One named surface of the structure as the planner may know it."""

    name: Name
    surface: SurfaceSource
    temperature_c: Annotated[float, Field(ge=0, le=49)] | None = None
    """Of its concrete and the electrode, within the range that ASTM C876 corrects; readings are
    evaluated at 22.2 °C. Without it they are taken to be within 22.2 ± 5.5 °C."""


class FlightOptions(Strict):
    """How the plan may fly; lowers the platform's limits, never raises them."""

    speed_mps: Positive = 0.5
    approach_speed_mps: Positive = 0.1
    clearance_m: NonNegative = 0.05
    """Least distance of the vehicle's body from the structure along the whole path."""


class Over(Strict):
    """Divide by another mission's metric at the same seed."""

    mission: Name
    metric: str


class Acceptance(Strict):
    """A bound on a metric; ``ref`` names the ledger row that it answers for."""

    metric: str
    min: float | None = None
    max: float | None = None
    ref: str | None = None
    over: Over | None = None
    known_failure: str | None = None
    """Why this check cannot hold: shown as ``fail-known`` and counted apart."""

    @model_validator(mode="after")
    def _bounded(self) -> Acceptance:
        if self.min is None and self.max is None:
            raise ValueError("give min, max or both")
        if self.min is not None and self.max is not None and self.min > self.max:
            raise ValueError(f"min {self.min} is above max {self.max}")
        return self


class Mission(Strict):
    """What the planner may know. ``truth`` is split off by the loader and is not part of it."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    name: Name
    title: str = ""
    description: str = ""
    platform: str
    """Name of a platform in ``platforms/``, or a path to its file in the campaign folder."""
    impedance: Name = "contact_ndt"
    """Which of the platform's impedance profiles to fly with, where a task names none."""
    estimation: Estimation = "external"
    """Where poses come from: the external tracker, or the odometry on board."""
    seeds: Seeds = (1, 2, 3)
    tags: tuple[Name, ...] = ()
    start: Start = Start()
    flight: FlightOptions = FlightOptions()
    structure: tuple[StructureSurface, ...] = ()
    """What is known beforehand; a vehicle that servoes or holds a pose needs none of it."""
    tasks: Annotated[tuple[Task, ...], Field(min_length=1)]
    expect_status: Literal["completed", "aborted"] = "completed"
    """How the flight has to end for the regression to pass."""
    acceptance: tuple[Acceptance, ...] = ()

    @model_validator(mode="after")
    def _names_resolve(self) -> Mission:
        names = [s.name for s in self.structure]
        for name in names:
            if names.count(name) > 1:
                raise ValueError(f"two surfaces are named '{name}'")
        for task in self.tasks:
            if task.on is not None and task.on not in names:
                known = ", ".join(names) if names else "none"
                raise ValueError(f"a task is on '{task.on}'; the surfaces are: {known}")
        return self

    @model_validator(mode="after")
    def _alone(self) -> Mission:
        why = (TASK_KINDS[task.kind].alone for task in self.tasks)
        if len(self.tasks) > 1 and (alone := next(filter(None, why), "")):
            raise ValueError(alone)
        return self

    @property
    def is_survey(self) -> bool:
        """Whether it covers a surface by sorties."""
        return isinstance(self.tasks[0].work, Coverage)


class MissionFile(Mission):
    """The whole file: the mission and the truth."""

    extends: str | None = None
    """Another mission in the campaign folder whose entries hold where this file has none."""
    truth: TruthModel = TruthModel()
