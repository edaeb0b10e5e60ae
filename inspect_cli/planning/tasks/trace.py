"""Planner of the task ``trace``: strokes of a drawing, followed without lifting the tool."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, replace

from inspect_cli.interfaces import Shortfall, least
from inspect_cli.planning.clearance import gap_along
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.feasibility import Assessment, Reason, assess, gap_reasons
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.points import ContactPoint
from inspect_cli.planning.segments import Segment, Stretch, touching_target
from inspect_cli.planning.strokes import fault_of, points_along, sliding_s, slowed, stroke_model
from inspect_cli.planning.tasks.situation import Asked, Planners, Situation, unreachable
from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.schema.plan import Stroke, Target
from inspect_cli.schema.tasks.trace import Trace
from inspect_cli.spatial.arrays import Structured, Vector


@dataclass(frozen=True)
class StrokeSegment:
    """A stroke of a drawing: touched at its first point, left at its last."""

    first: ContactPoint
    last: ContactPoint
    touch: Touch
    leave: Touch
    way: Way
    along: Way
    """Set-points behind the surface along the stroke, after the first."""
    stroke: Stroke
    moving_s: float
    settle_s: float
    assessment: Assessment

    @property
    def label(self) -> str:
        """The number of the stroke."""
        return self.first.label

    @property
    def stop(self) -> Stop:
        """In front of the stroke's end."""
        return Stop(self.leave.standoff, self.last.n_W)

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Both ends of the stroke."""
        return (self.first.p_WC, self.last.p_WC)

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Approach, press and settle, slide, retreat."""
        speed = self.stroke.speed_mps
        yield Stretch("approach", index, (self.touch.contact,))
        yield Stretch("press", index, (self.touch.setpoint,), self.settle_s)
        yield Stretch("slide", index, self.along, PAUSE_S, self.moving_s, speed)
        yield Stretch("retreat", index, (self.leave.standoff,))

    def target(self, index: int) -> Target:
        """A stroke."""
        return touching_target(index, "stroke", self.first, self.touch, self.assessment).model_copy(
            update={"dwell_s": self.settle_s, "stroke": self.stroke}
        )


@dataclass(frozen=True)
class TracePlanner:
    """Draw a stroke."""

    label: str
    trace: Trace
    prim: Structured
    stroke: Stroke
    impedance: str

    @property
    def name(self) -> str:
        """The stroke and its surface."""
        return f"stroke {self.label} on '{self.trace.on}'"

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """Touch its first point, follow the line, leave at the last; every place is checked."""
        fault = fault_of(self.prim, self.stroke)
        if fault:
            return [Reason(fault, "draw smaller, or elsewhere")]
        points = points_along(self.prim, self.stroke, self.label, self.trace, self.impedance)
        ways = situation.touches(points[0], before.posture)
        if isinstance(ways, Shortfall):
            return [unreachable(points[0], ways)]
        reasons: list[Reason] = []
        for first in ways:
            found = self._attempt(situation, points, first, before)
            if not isinstance(found, list):
                return found
            reasons = reasons or found
        return reasons

    def _attempt(
        self, situation: Situation, points: Sequence[ContactPoint], first: Touch, before: Stop
    ) -> Segment | list[Reason]:
        line = _line(situation, points, first)
        if isinstance(line, Reason):
            return [line]
        worst = _worst(situation, points, line)
        if worst.reasons:
            return list(worst.reasons)
        way = situation.way(before, Stop(first.standoff, points[0].n_W))
        if isinstance(way, list):
            return way
        return self._segment(situation, points, line, way, worst)

    def _segment(
        self,
        situation: Situation,
        points: Sequence[ContactPoint],
        line: Sequence[Touch],
        way: Way,
        assessment: Assessment,
    ) -> StrokeSegment:
        acceleration = situation.capabilities.max_acceleration_mps2
        stroke = slowed(self.stroke, points, line, situation.capabilities)
        return StrokeSegment(
            first=points[0],
            last=points[-1],
            touch=line[0],
            leave=line[-1],
            way=way,
            along=tuple(touch.setpoint for touch in line[1:]),
            stroke=stroke,
            moving_s=sliding_s(stroke, acceleration),
            settle_s=self.trace.settle_s,
            assessment=assessment,
        )


def planners_of(asked: Asked) -> Planners:
    """A planner for each stroke of the drawing, as often as it is traced."""
    trace = asked.task.work
    assert isinstance(trace, Trace)  # the registry has looked it up by its kind
    planners: list[TracePlanner] = []
    for trial in range(trace.repeat):
        for part, pieces in enumerate(asked.drawings[asked.place]):
            label = str(asked.number + len(planners))
            stroke = stroke_model(pieces, trace.speed_mps, asked.place, trial, part)
            prim = asked.prims[trace.on]
            planners.append(TracePlanner(label, trace, prim, stroke, asked.impedance))
    return Planners(tuple(planners), asked.tip_W)


def _line(
    situation: Situation, points: Sequence[ContactPoint], first: Touch
) -> list[Touch] | Reason:
    """The touches along a stroke, each turned like the one before; or where there is none."""
    line = [first]
    for point in points[1:]:
        found = situation.touches(point, line[-1].contact)
        if isinstance(found, Shortfall):
            return unreachable(point, found)
        line.append(found[0])
    return line


def _worst(
    situation: Situation, points: Sequence[ContactPoint], line: Sequence[Touch]
) -> Assessment:
    """The assessment along a stroke: the least margins, the least gap, every reason once."""
    found = [
        assess(situation.capabilities, situation.scene, point, touch, situation.limits)
        for point, touch in zip(points, line, strict=True)
    ]
    between = gap_along(situation.capabilities, situation.scene, [touch.contact for touch in line])
    reasons = [reason for one in found for reason in one.reasons]
    reasons += gap_reasons(between, situation.limits.clearance_m)
    gap = min([between, *(one.gap for one in found)], key=lambda one: one.structure_m)
    margins = least(one.margins for one in found)
    return replace(found[0], margins=margins, gap=gap, reasons=tuple(dict.fromkeys(reasons)))
