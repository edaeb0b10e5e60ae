"""What the chapters of a report are written from: one flight, or a survey of several."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import Protocol

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.log.reader import RunLog
from inspect_cli.records import Reference
from inspect_cli.reporting.content.read_points import ReadPoint, read_points
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.figures.scene_marks import SceneMarks
from inspect_cli.reporting.figures.timeline import Timeline, timeline_of
from inspect_cli.reporting.flight.mission_profile import MissionProfile, mission_profile
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


class Rendered(Protocol):
    """What was rendered of a flight, with captions in the package's own English."""

    @property
    def scene_png(self) -> bytes | None:
        """A still."""

    @property
    def scene_caption(self) -> str:
        """What it shows."""

    @property
    def film_mp4(self) -> bytes | None:
        """A film."""

    @property
    def film_caption(self) -> str:
        """What it shows."""

    @property
    def note(self) -> str:
        """Why one of them is missing; empty when there are both."""


@dataclass(frozen=True)
class Coverage:
    """The plan of a survey, and the results of those of its sorties that were flown."""

    plan: CoveragePlan
    flown: Sequence[Result]


@dataclass(frozen=True)
class Material:
    """Everything that a report is written from; of a survey, ``log`` is that of its first sortie.

    ``result`` and ``plan`` are those of the flight, or of all sorties joined.
    """

    log: RunLog
    result: Result
    plan: Plan
    surfaces: Sequence[SurfaceFindings] = ()
    """The readings of each surface: findings and map."""
    pictures: Rendered | None = None
    coverage: Coverage | None = None
    """None for a single flight."""
    shown_instruments: frozenset[str] = frozenset()
    """Instruments whose points a chapter shows: see ``Chapter.instruments``."""
    scene_marks: Sequence[SceneMarks] = ()
    """What chapters add to the view of the structure."""
    own_groups: frozenset[str] = frozenset()
    """Groups of metrics that chapters show in tables of their own."""
    hidden_groups: frozenset[str] = frozenset()
    """Groups of metrics that do not concern this mission: see ``Chapter.shared_groups``."""

    @cached_property
    def points(self) -> tuple[ReadPoint, ...]:
        """The points that stand for readings, in the order of their labels."""
        return read_points(self.result, self.plan)

    @property
    def other_points(self) -> tuple[ReadPoint, ...]:
        """The points of instruments that have no chapter of their own."""
        return tuple(p for p in self.points if p.instrument not in self.shown_instruments)

    def read_by(self, instrument: str) -> tuple[ReadPoint, ...]:
        """The points that an instrument was to read, in the order of their labels."""
        return tuple(p for p in self.points if p.instrument == instrument)

    @cached_property
    def profile(self) -> MissionProfile:
        """What the mission asks for, by kind."""
        return mission_profile(self.log, self.plan)

    @cached_property
    def timeline(self) -> Timeline:
        """The time axis of figures over the flight, with its contacts."""
        return timeline_of(rows_of(self.log, Reference), self.plan, self.log.modes())
