"""What the planner of a task is given, and what it gives."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import NamedTuple, Protocol

from inspect_cli.interfaces import Capabilities, Posture, Shortfall
from inspect_cli.planning.clearance import Scene
from inspect_cli.planning.contact_poses import Touch, touches
from inspect_cli.planning.feasibility import Limits, Reason
from inspect_cli.planning.path import Stop, Way, find_way
from inspect_cli.planning.points import ContactPoint, in_words
from inspect_cli.planning.segments import Segment
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.tasks import Task
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.structure.drawings import Stroke


@dataclass(frozen=True)
class Situation:
    """What is the same for every task of a mission."""

    capabilities: Capabilities
    scene: Scene
    limits: Limits

    def touches(self, point: ContactPoint, previous: Posture) -> list[Touch] | Shortfall:
        """The ways to touch a point from a posture, best first; or why it is out of reach."""
        law = self.capabilities.contact_law(point.options, point.impedance)
        return touches(self.capabilities, point, law, previous)

    def way(self, before: Stop, after: Stop) -> Way | list[Reason]:
        """The way from one stop to the next, or why there is none."""
        clearance_m = self.limits.clearance_m
        way = find_way(self.capabilities, self.scene, before, after, clearance_m)
        if way is not None:
            return way
        origin = in_words(before.posture.p_WB)
        what = f"no way from {origin} keeps {clearance_m:.3f} m from the structure"
        return [Reason(what, "start elsewhere, or allow less clearance")]


class Planner(Protocol):
    """Plans one place of a task: a point to touch, a stroke, a pose."""

    @property
    def name(self) -> str:
        """What messages call the place."""
        ...

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """The best way of doing it that can be flown, or what speaks against the best."""
        ...


class Planners(NamedTuple):
    """The places of a task in the order of the flight.

    ``tip_W`` (3,) m in W is where the tool's tip is taken to be when they are done.
    """

    each: tuple[Planner, ...]
    tip_W: Vector


@dataclass(frozen=True)
class Asked:
    """A task of a mission, with what its planners may need.

    ``place`` is the task's in the mission, ``prims`` are the believed surfaces by name,
    ``drawings`` the strokes by a task's place, ``number`` is that of its first target, and
    ``tip_W`` (3,) m in W is where the tool's tip comes from.
    """

    mission: Mission
    place: int
    prims: Mapping[str, Structured]
    drawings: Mapping[int, Sequence[Stroke]]
    number: int
    tip_W: Vector

    @property
    def task(self) -> Task:
        """The task."""
        return self.mission.tasks[self.place]

    @property
    def impedance(self) -> str:
        """The profile that it is flown with."""
        return self.task.impedance or self.mission.impedance


def unreachable(point: ContactPoint, short: Shortfall) -> Reason:
    """That no posture brings the tool there, with what the vehicle says of it."""
    what = f"no posture brings the tool to {in_words(point.p_WC)} along {in_words(-point.n_W)}"
    if short.reason:
        what = f"{what}: {short.reason}"
    return Reason(what, short.hint or "use a tool at another angle, or touch another surface")
