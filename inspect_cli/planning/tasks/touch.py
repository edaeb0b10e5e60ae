"""Touching points: what ``contact_grid``, ``contact_points`` and coverages have in common."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

from inspect_cli.interfaces import Shortfall
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.feasibility import Assessment, Reason, assess, cable_reasons
from inspect_cli.planning.order import visiting_order
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.point_cells import cells_of_tasks
from inspect_cli.planning.points import ContactPoint, points_of_task
from inspect_cli.planning.segments import Segment, Stretch, touching_target
from inspect_cli.planning.tasks.situation import Asked, Planners, Situation, unreachable
from inspect_cli.schema.plan import Target
from inspect_cli.schema.tasks.base import ContactOptions
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.contact_points import ContactPoints
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class ContactSegment:
    """A point that is touched and perhaps read."""

    point: ContactPoint
    options: ContactOptions
    touch: Touch
    way: Way
    assessment: Assessment

    @property
    def label(self) -> str:
        """The point's."""
        return self.point.label

    @property
    def stop(self) -> Stop:
        """The standoff, where the segment begins and ends."""
        return Stop(self.touch.standoff, self.point.n_W)

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """The point."""
        return (self.point.p_WC,)

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Approach, press and dwell, retreat."""
        yield Stretch("approach", index, (self.touch.contact,))
        yield Stretch("press", index, (self.touch.setpoint,), self.options.dwell_s)
        yield Stretch("retreat", index, (self.touch.standoff,))

    def target(self, index: int) -> Target:
        """A contact."""
        options = self.options
        return touching_target(
            index, "contact", self.point, self.touch, self.assessment
        ).model_copy(
            update={
                "sensor": self.point.sensor,
                "cell_m": self.point.cell_m,
                "dwell_s": options.dwell_s,
                "off_target_m": options.off_target_m,
            }
        )


@dataclass(frozen=True)
class TouchPlanner:
    """Touch a point."""

    point: ContactPoint
    options: ContactOptions

    @property
    def name(self) -> str:
        """The point and its surface."""
        return f"point {self.point.label} on '{self.point.surface}'"

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """Of the ways to turn the tool, the first that can be flown."""
        point = self.point
        if point.fault:
            return [Reason(point.fault, "give points on the patch, or enlarge it")]
        ways = situation.touches(point, before.posture)
        if isinstance(ways, Shortfall):
            return [unreachable(point, ways), *cable_reasons(point, situation.limits)]
        reasons: list[Reason] = []
        for touch in ways:
            found = _reached(situation, point, touch, before)
            if not isinstance(found, list):
                assessment, way = found
                return ContactSegment(point, self.options, touch, way, assessment)
            reasons = reasons or found
        return reasons


def touching_points(asked: Asked, work: ContactGrid | ContactPoints) -> Planners:
    """A planner for each point of a task, in the order of the flight."""
    task, prim = asked.task, asked.prims[work.on]
    cell_m = cells_of_tasks(asked.mission.tasks, asked.prims)[asked.place]
    points = points_of_task(task, prim, asked.number, asked.impedance, cell_m)
    ordered = [points[k] for k in visiting_order(work, points, asked.tip_W)]
    planners = tuple(TouchPlanner(point, work) for point in ordered)
    return Planners(planners, ordered[-1].in_front(work.standoff_m))


def _reached(
    situation: Situation, point: ContactPoint, touch: Touch, before: Stop
) -> tuple[Assessment, Way] | list[Reason]:
    """What a touch comes to and the way to it, or what speaks against it."""
    found = assess(situation.capabilities, situation.scene, point, touch, situation.limits)
    if found.reasons:
        return list(found.reasons)
    way = situation.way(before, Stop(touch.standoff, point.n_W))
    return way if isinstance(way, list) else (found, way)
