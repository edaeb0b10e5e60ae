"""The mission executive: walks the plan's legs, mode by mode, and aborts by the failsafe table.

It decides where the vehicle shall go next and when a point is done; how to get there is
Guidance's, how to hold it is the controller's, which never learns of modes.

    IDLE ─▶ TAKEOFF ─▶ TRANSIT ─▶ APPROACH ─▶ PRESS ─▶ RETREAT ─▶ TRANSIT … ─▶ LAND ─▶ LANDED
                          ╰─▶ HOLD ─▶ …           ╰─▶ SLIDE ─▶╯
    any of them while flying, by the failsafe table ─▶ HOVER, and the run ends aborted
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from typing import Literal

import numpy as np

from inspect_cli.autonomy.failsafe import Action, FlightInputs, Watch
from inspect_cli.autonomy.roles import Guidance, Judge
from inspect_cli.interfaces import Posture
from inspect_cli.records import (
    Estimate,
    InvalidReason,
    Mode,
    Probe,
    Reading,
    SurfaceEstimate,
)
from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.schema.plan import Leg, LegKind, Plan, PostureModel, Target
from inspect_cli.schema.result import Status
from inspect_cli.spatial.arrays import Vector

SETTLE_S = 1.0
"""On the ground before take-off, for the filter to find its biases."""
STAND_S = 1.5
"""On the ground after the motors have stopped."""
SAFE_HOVER_S = 3.0
"""Hover at rest after an abort before the run ends."""
NEAREST_SHARE = 0.4
"""Of the standoff: a surface that is nearer on the way to it is not where it was planned."""
TOUCHDOWN_M = 0.15
"""How far below standing height the vehicle leans on the ground before its motors stop."""
BEFORE_CONTACT_M = 0.01
"""The approach ends this far from the surface; the press goes through it."""

MODES: dict[LegKind, Mode] = {
    "takeoff": Mode.TAKEOFF,
    "transit": Mode.TRANSIT,
    "hold": Mode.HOLD,
    "approach": Mode.APPROACH,
    "press": Mode.PRESS,
    "slide": Mode.SLIDE,
    "retreat": Mode.RETREAT,
    "land": Mode.LAND,
}
TOUCHING = frozenset({Mode.PRESS, Mode.SLIDE, Mode.RETREAT})
"""Modes in which the reference may lie behind the surface."""
NEAR = frozenset({Mode.APPROACH, *TOUCHING})
"""Modes from which a retreat leads along the surface's normal."""


@dataclass(frozen=True)
class Event:
    """Something worth a line in the log."""

    t_s: float
    level: Literal["info", "warning", "error"]
    text: str


class Executive:
    """Walks one plan."""

    def __init__(
        self,
        plan: Plan,
        guidance: Guidance,
        judge: Callable[[Target], Judge],
        estimate: Estimate,
        time_limit_s: float,
    ) -> None:
        self._plan = plan
        self._guidance = guidance
        self._new_judge = judge
        self._judge: Judge | None = None
        self._dwelling_since_s: float | None = None
        self._seen: SurfaceEstimate | None = None
        self._watch = Watch()
        self._inputs = FlightInputs(0.0, estimate, guidance.reference)
        self._time_limit_s = time_limit_s
        self._leg = -1
        self._since_s = 0.0
        self._resting_since_s: float | None = None
        self._waiting_for_surface = False
        self._down = False
        self._judged: set[int] = set()
        self.mode = Mode.IDLE
        self.target = -1
        self.status: Status = "completed"
        self.reason = ""
        self.finished = False
        self.readings: list[Reading] = []
        """Verdicts that nobody has logged yet."""
        self.events: list[Event] = []
        """Events that nobody has logged yet."""

    @property
    def flying(self) -> bool:
        """Whether the motors shall run."""
        return self.mode != Mode.IDLE and not self._down

    @property
    def watches_surface(self) -> bool:
        """Whether surface estimates steer the vehicle now."""
        # A retreat keeps to the surface that it leaves: what it sees of it only gets noisier. A
        # stroke is drawn on the surface that was seen before it.
        if self.mode == Mode.SLIDE:
            return self._plan.targets[self.target].following is not None
        return self.mode in (Mode.APPROACH, Mode.PRESS) and not self._waiting_for_surface

    def heard_pose(self, t_s: float) -> None:
        """A pose measurement was accepted."""
        self._inputs.pose_heard_s = t_s

    def saw_surface(self, surface: SurfaceEstimate) -> None:
        """The depth camera produced an estimate; only a valid one counts."""
        if not surface.valid:
            return
        self._seen = surface
        inputs = self._inputs
        inputs.surface_seen_s, inputs.surface_distance_m = surface.t_s, surface.distance
        inputs.surface_n_W[:] = surface.n_W
        if self.target < 0:
            return
        target = self._plan.targets[self.target]
        if not self._guidance.contradicts(surface.t_s, target, surface):
            inputs.surface_agreed_s = surface.t_s

    def probe_sampled(self, probe: Probe, p_WT: Vector) -> None:
        """The probe produced a sample; it counts once the set-point is where it shall be."""
        if self._judge is not None and self._dwelling_since_s is not None:
            self._judge.feed(probe, p_WT)

    def update(self, t_s: float) -> None:
        """Decide what to do now; called at the mission rate."""
        self._inputs.refresh(t_s)
        action, reason = self._watch.check(self.mode, self._inputs)
        if self._overtime(t_s):
            action, reason = Action.HOVER, "flight took far longer than planned"
        if action != Action.CONTINUE:
            self._abort(t_s, action, reason)
        elif self._done(t_s):
            self._advance(t_s)
        self._mark_reference()

    def give_up(self, status: Status, reason: str) -> None:
        """End the run from outside: the physics diverged, or somebody interrupted it."""
        self.status, self.reason, self.finished = status, reason, True

    def _mark_reference(self) -> None:
        self._guidance.reference.mode = float(self.mode)
        self._guidance.reference.target = float(self.target)

    def _overtime(self, t_s: float) -> bool:
        return t_s > self._time_limit_s and self.mode not in (Mode.HOVER, Mode.LANDED)

    def _done(self, t_s: float) -> bool:
        """Whether the current mode has come to its end."""
        if self.mode == Mode.IDLE:
            return t_s - self._since_s >= SETTLE_S
        if self.mode == Mode.HOVER:
            return self._rested(t_s, SAFE_HOVER_S)
        if self.mode == Mode.LANDED:
            return self._settled_down(t_s)
        if self.mode == Mode.PRESS:
            return self._dwelt(t_s)
        if self.mode == Mode.HOLD:
            return t_s - self._since_s >= self._plan.targets[self.target].dwell_s
        if self.mode == Mode.SLIDE:
            return self._rested(t_s, self._settling_s())
        if self._waiting_for_surface:
            self._begin_approach_when_seen(t_s)
            return False
        return self._rested(t_s)

    def _dwelt(self, t_s: float) -> bool:
        """Press to the set-point, then dwell: until the judge has decided, if there is one."""
        if self._dwelling_since_s is None and self._guidance.arrived(t_s):
            self._dwelling_since_s = t_s
            if self._judge is not None:
                self._judge.begin(self.target, t_s)
        if self._dwelling_since_s is None:
            return False
        if self._judge is not None:
            return self._judge.done(t_s)
        return t_s - self._dwelling_since_s >= self._plan.targets[self.target].dwell_s

    def _settling_s(self) -> float:
        """How long the tool stays at the end of a slide."""
        target = self._plan.targets[self.target]
        return max(PAUSE_S, target.dwell_s) if target.following else PAUSE_S

    def _settled_down(self, t_s: float) -> bool:
        """Lean on the ground, stop the motors, wait."""
        if not self._down and self._rested(t_s):
            self._down, self._since_s = True, t_s
        return self._down and t_s - self._since_s >= STAND_S

    def _rested(self, t_s: float, for_s: float = PAUSE_S) -> bool:
        """Whether the reference has been at rest at its goal for so long."""
        if not self._guidance.arrived(t_s):
            self._resting_since_s = None
            return False
        if self._resting_since_s is None:
            self._resting_since_s = t_s
        return t_s - self._resting_since_s >= for_s

    def _advance(self, t_s: float) -> None:
        if self.mode in (Mode.HOVER, Mode.LANDED):
            self.finished = True
            return
        if self._judge is not None:
            self._take_reading(t_s)
        if self._leg + 1 == len(self._plan.legs):
            self._touch_down(t_s)
            return
        self._leg += 1
        self._begin(t_s, self._plan.legs[self._leg])

    def _touch_down(self, t_s: float) -> None:
        self._enter(t_s, Mode.LANDED, -1)
        leg = self._plan.legs[-1]
        below = _lower(posture_of(leg.postures[-1]), TOUCHDOWN_M)
        self._guidance.go_to(t_s, [below], leg.speed_mps)

    def _begin(self, t_s: float, leg: Leg) -> None:
        mode = MODES[leg.kind]
        self._enter(t_s, mode, -1 if leg.target is None else leg.target)
        if leg.target is None or mode in (Mode.TRANSIT, Mode.HOLD):
            postures = [posture_of(model) for model in leg.postures]
            self._guidance.go_to(t_s, postures, leg.speed_mps)
            return
        target = self._plan.targets[leg.target]
        if mode == Mode.APPROACH:
            self._waiting_for_surface = True
            self._inputs.surface_seen_s = self._inputs.surface_agreed_s = t_s
        elif mode == Mode.PRESS:
            self._judge = self._new_judge(target) if target.sensor else None
            self._dwelling_since_s = None
            self._guidance.approach(t_s, target, target.press_m, leg.speed_mps)
        elif mode == Mode.SLIDE:
            self._guidance.slide(t_s, target)
        else:
            self._guidance.approach(t_s, target, -target.standoff_m, leg.speed_mps)

    def _begin_approach_when_seen(self, t_s: float) -> None:
        if self._inputs.surface_agreed_s < self._since_s + PAUSE_S:
            return
        leg = self._plan.legs[self._leg]
        target = self._plan.targets[self.target]
        seen = self._seen
        if target.following is not None and (seen is None or not _is_good(seen, self._inputs)):
            return
        self._waiting_for_surface = False
        self._guidance.approach(t_s, target, -BEFORE_CONTACT_M, leg.speed_mps)
        if target.following is not None and seen is not None:
            # A surface that nobody described is aimed at by what is seen of it now.
            self._guidance.observe(t_s, seen)

    def _enter(self, t_s: float, mode: Mode, target: int) -> None:
        self.mode, self.target, self._since_s = mode, target, t_s
        self._resting_since_s = None
        self._waiting_for_surface = False
        aim = self._plan.targets[target] if target >= 0 else None
        self._inputs.press_m = aim.press_m if aim is not None and mode in TOUCHING else 0.0
        self._inputs.least_distance_m = NEAREST_SHARE * aim.standoff_m if aim else 0.0
        if mode != Mode.HOVER:  # after an abort, possibly in contact, nothing shall change
            self._guidance.take_impedance(aim.impedance if aim else self._plan.impedance)
        point = "" if target < 0 else f", point {self._plan.targets[target].label}"
        self.events.append(Event(t_s, "info", f"{mode.name.lower()}{point}"))

    def _take_reading(self, t_s: float) -> None:
        assert self._judge is not None  # the caller saw to it
        reading = self._judge.finish(t_s)
        _check_place(reading, self._plan.targets[self.target])
        self._judge = None
        self._judged.add(int(reading.target))
        self.readings.append(reading)

    def _has_something_to_leave(self) -> bool:
        """Whether the standoff leads away from the surface.

        A following begins anywhere: before its surface is found or near, the standoff would lead
        back into what nobody looked at, or forward.
        """
        if self.mode != Mode.APPROACH or self._plan.targets[self.target].following is None:
            return self.mode in NEAR
        near_m = self._plan.targets[self.target].standoff_m
        return not self._waiting_for_surface and self._inputs.surface_distance_m < near_m

    def _abort(self, t_s: float, action: Action, reason: str) -> None:
        self.status, self.reason = "aborted", reason
        self.events.append(Event(t_s, "error", f"aborted: {reason}"))
        if action == Action.RETREAT and self._has_something_to_leave():
            target = self._plan.targets[self.target]
            speed = self._plan.legs[self._leg].speed_mps
            self._guidance.approach(t_s, target, -target.standoff_m, speed)
        else:
            self._guidance.hold(t_s)
        self._judge = None
        for target in self._plan.targets:
            if target.sensor is not None and target.index not in self._judged:
                self.readings.append(_no_reading(t_s, target))
        self._enter(t_s, Mode.HOVER, -1)


def posture_of(model: PostureModel) -> Posture:
    """The posture that a plan spells out."""
    return Posture(np.array(model.p_WB), np.array(model.q_WB), np.array(model.arm_angle_rad))


def _lower(posture: Posture, by_m: float) -> Posture:
    down = np.array([0.0, 0.0, by_m])
    return replace(posture, p_WB=posture.p_WB - down)


def _is_good(seen: SurfaceEstimate, inputs: FlightInputs) -> bool:
    """Whether the estimate, overwritten with each depth image, is the last one that agreed."""
    return seen.valid == 1.0 and seen.t_s == inputs.surface_agreed_s


def _check_place(reading: Reading, target: Target) -> None:
    """Refuse a reading that was taken too far from its point, along the surface."""
    way = reading.p_WT - target.p_WC
    along = way - np.array(target.n_W) * float(way @ np.array(target.n_W))
    if reading.valid and not np.linalg.norm(along) <= target.off_target_m:
        reading.valid, reading.reason = 0.0, float(InvalidReason.OFF_TARGET)
        reading.potential = reading.resistance = float("nan")


def _no_reading(t_s: float, target: Target) -> Reading:
    reading = Reading.create()
    reading.t_s = t_s
    reading.target = float(target.index)
    reading.potential = reading.resistance = float("nan")
    reading.p_WT[:] = target.p_WC
    reading.reason = float(InvalidReason.ABORTED)
    return reading
