"""What a mission's tasks ask for, one errand after the other, and how each becomes a visit.

An errand knows what shall be done; given where the vehicle comes from it answers with the visit
that does it, or with the reasons why that cannot be flown.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, replace
from typing import Protocol

import numpy as np

from inspect_cli.interfaces import (
    FREE,
    TOOL,
    Capabilities,
    Posture,
    Shortfall,
    least,
    pushed_along,
)
from inspect_cli.planning.clearance import Scene, gap_along
from inspect_cli.planning.contact_poses import Touch, touches
from inspect_cli.planning.feasibility import (
    Assessment,
    Limits,
    Reason,
    assess,
    cable_reasons,
    gap_reasons,
    margin_reasons,
)
from inspect_cli.planning.order import visiting_order
from inspect_cli.planning.path import Stop, Way, find_way
from inspect_cli.planning.point_cells import cells_of_tasks
from inspect_cli.planning.points import ContactPoint, in_words, points_of_task
from inspect_cli.planning.strokes import fault_of, points_along, sliding_s, slowed, stroke_model
from inspect_cli.planning.visits import (
    ContactVisit,
    FreePose,
    HoldVisit,
    ServoVisit,
    StrokeVisit,
    Visit,
)
from inspect_cli.schema import plan
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.tasks import (
    ContactGrid,
    ContactOptions,
    ContactPoints,
    Coverage,
    Hold,
    Servo,
    ServoStart,
    Trace,
)
from inspect_cli.spatial.arrays import Structured
from inspect_cli.spatial.rotations import quaternion_exp
from inspect_cli.structure.drawings import Stroke


@dataclass(frozen=True)
class Situation:
    """What is the same for every errand of a mission."""

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


class Errand(Protocol):
    """Something that the mission wants done."""

    @property
    def name(self) -> str:
        """What messages call it."""
        ...

    def visit(self, situation: Situation, before: Stop) -> Visit | list[Reason]:
        """The best way of doing it that can be flown, or what speaks against the best."""
        ...


def errands_of(
    mission: Mission,
    capabilities: Capabilities,
    prims: Mapping[str, Structured],
    drawings: Mapping[int, Sequence[Stroke]],
    hover: Posture,
) -> Iterator[Errand]:
    """All errands in the order of the visits, tasks one after the other.

    ``prims`` are the believed surfaces by name, ``drawings`` the strokes by the task's place.
    """
    tip_W = capabilities.frame_pose(hover, TOOL)[0]
    cells = cells_of_tasks(mission.tasks, prims)
    number = 1
    for place, task in enumerate(mission.tasks):
        work = task.work
        assert not isinstance(work, Coverage)  # that is what planning.coverage is for
        impedance = task.impedance or mission.impedance
        errands: list[Errand]
        if isinstance(work, ContactGrid | ContactPoints):
            points = points_of_task(task, prims[work.on], number, impedance, cells[place])
            ordered = [points[k] for k in visiting_order(work, points, tip_W)]
            errands = [TouchErrand(point, work) for point in ordered]
            tip_W = ordered[-1].in_front(work.standoff_m)
        elif isinstance(work, Trace):
            errands = _traces(work, prims[work.on], drawings[place], place, number, impedance)
        elif isinstance(work, Hold):
            errands = [HoldErrand(str(number), work, impedance)]
        else:
            errands = [ServoErrand(str(number), work, impedance)]
        yield from errands
        number += len(errands)


def _traces(
    trace: Trace,
    prim: Structured,
    strokes: Sequence[Stroke],
    drawing: int,
    number: int,
    impedance: str,
) -> list[Errand]:
    """The strokes of a drawing, as often as it is traced."""
    errands: list[Errand] = []
    for trial in range(trace.repeat):
        for part, pieces in enumerate(strokes):
            label = str(number + len(errands))
            stroke = stroke_model(pieces, trace.speed_mps, drawing, trial, part)
            errands.append(TraceErrand(label, trace, prim, stroke, impedance))
    return errands


@dataclass(frozen=True)
class TouchErrand:
    """Touch a point."""

    point: ContactPoint
    options: ContactOptions

    @property
    def name(self) -> str:
        """The point and its surface."""
        return f"point {self.point.label} on '{self.point.surface}'"

    def visit(self, situation: Situation, before: Stop) -> Visit | list[Reason]:
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
                return ContactVisit(point, self.options, touch, way, assessment)
            reasons = reasons or found
        return reasons


@dataclass(frozen=True)
class TraceErrand:
    """Draw a stroke."""

    label: str
    trace: Trace
    prim: Structured
    stroke: plan.Stroke
    impedance: str

    @property
    def name(self) -> str:
        """The stroke and its surface."""
        return f"stroke {self.label} on '{self.trace.on}'"

    def visit(self, situation: Situation, before: Stop) -> Visit | list[Reason]:
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
    ) -> Visit | list[Reason]:
        line = _line(situation, points, first)
        if isinstance(line, Reason):
            return [line]
        worst = _worst(situation, points, line)
        if worst.reasons:
            return list(worst.reasons)
        way = situation.way(before, Stop(first.standoff, points[0].n_W))
        if isinstance(way, list):
            return way
        return self._visit(situation, points, line, way, worst)

    def _visit(
        self,
        situation: Situation,
        points: Sequence[ContactPoint],
        line: Sequence[Touch],
        way: Way,
        assessment: Assessment,
    ) -> StrokeVisit:
        acceleration = situation.capabilities.max_acceleration_mps2
        stroke = slowed(self.stroke, points, line, situation.capabilities)
        return StrokeVisit(
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


@dataclass(frozen=True)
class HoldErrand:
    """Hold a pose in free air."""

    label: str
    hold: Hold
    impedance: str

    @property
    def name(self) -> str:
        """The pose."""
        return f"pose {self.label}"

    def visit(self, situation: Situation, before: Stop) -> Visit | list[Reason]:
        """Go there, if the vehicle has room and can hold it."""
        start = ServoStart(position_m=self.hold.position_m, heading_deg=self.hold.heading_deg)
        found = _free_pose(situation, start, before)
        if isinstance(found, list):
            return found
        return HoldVisit(self.label, self.hold, found, situation.capabilities, self.impedance)


@dataclass(frozen=True)
class ServoErrand:
    """Find a surface and follow it."""

    label: str
    servo: Servo
    impedance: str

    @property
    def name(self) -> str:
        """The start pose."""
        return f"servo {self.label}"

    def visit(self, situation: Situation, before: Stop) -> Visit | list[Reason]:
        """Go to the start pose; beyond it only the camera knows."""
        found = _free_pose(situation, self.servo.start, before)
        if isinstance(found, list):
            return found
        capabilities = situation.capabilities
        law = capabilities.contact_law(self.servo, self.impedance)
        force_n = law.expected_force_n
        _, R_WT = capabilities.frame_pose(found.posture, TOOL)
        margins = capabilities.margins(found.posture, pushed_along(-R_WT[:, 2], force_n))
        loaded = margin_reasons(margins, f"pressing with {force_n:.2f} N")
        if loaded:
            return loaded
        return ServoVisit(self.label, self.servo, found, capabilities, self.impedance, law)


def _free_pose(situation: Situation, start: ServoStart, before: Stop) -> FreePose | list[Reason]:
    """A level pose in free air, or why it cannot be."""
    capabilities = situation.capabilities
    q_WB = quaternion_exp(np.array([0.0, 0.0, np.radians(start.heading_deg)]))
    posture = Posture(np.array(start.position_m), q_WB, before.posture.joint_angle)
    margins = capabilities.margins(posture, FREE)
    gap = gap_along(capabilities, situation.scene, [posture, posture])
    reasons = [
        *margin_reasons(margins, "holding still there"),
        *gap_reasons(gap, situation.limits.clearance_m),
    ]
    if reasons:
        return reasons
    way = situation.way(before, Stop(posture, np.zeros(3)))
    if isinstance(way, list):
        return way
    return FreePose(posture, way, margins, gap.structure_m)


def _reached(
    situation: Situation, point: ContactPoint, touch: Touch, before: Stop
) -> tuple[Assessment, Way] | list[Reason]:
    """What a touch comes to and the way to it, or what speaks against it."""
    found = assess(situation.capabilities, situation.scene, point, touch, situation.limits)
    if found.reasons:
        return list(found.reasons)
    way = situation.way(before, Stop(touch.standoff, point.n_W))
    return way if isinstance(way, list) else (found, way)


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


def unreachable(point: ContactPoint, short: Shortfall) -> Reason:
    """That no posture brings the tool there, with what the vehicle says of it."""
    what = f"no posture brings the tool to {in_words(point.p_WC)} along {in_words(-point.n_W)}"
    if short.reason:
        what = f"{what}: {short.reason}"
    return Reason(what, short.hint or "use a tool at another angle, or touch another surface")
