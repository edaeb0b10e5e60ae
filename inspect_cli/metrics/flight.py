"""A logged flight as the metrics see it: channels on common ticks, phases and dwells."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property

import numpy as np
from numpy.typing import NDArray

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Record, Reference, State
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.modes import AT_SURFACE, IN_FLIGHT, OFF_GROUND, ModeTable, Phase
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.spatial.arrays import Mask, Structured, Vector

TOUCH_N = 0.1
"""The tool touches where the true normal force is above this (ledger row A8.track)."""
STEADY_S = 2.0
"""The end of a dwell over which its steady values are averaged (ledger row A8.force)."""
SAME_TICK_S = 0.020
"""Rows of two channels belong together when they are at most this far apart."""

Rows = NDArray[np.intp]

TOUCHED = ("contact", "stroke", "following")
"""Kinds of target that the tool presses on."""


class NotMeasured(Exception):
    """The log does not hold what a metric is computed from; the text says what is missing."""


@dataclass(frozen=True)
class Dwell:
    """The time for which a point was truly pressed.

    From the first to the last touch while the tool was pressed on that target at rest; rows
    without touch in between belong to it, so that a bouncing tool does not look better.
    """

    rows: Rows
    """Rows of ``FlightData.state``."""
    steady: Rows
    """Those of the last ``STEADY_S``."""


@dataclass(frozen=True)
class FlightData:
    """The log of a flight with what is derived from several of its channels, computed once."""

    log: RunLog

    @cached_property
    def plan(self) -> Plan:
        """The plan that was flown."""
        return self.log.plan()

    @cached_property
    def mission(self) -> Mission:
        """What the planner was told."""
        return self.log.mission()

    @cached_property
    def platform(self) -> PlatformBase:
        """The platform's nominal numbers."""
        return self.log.platform()

    def rows(self, record: type[Record]) -> Structured:
        """The channel of a record.

        Raises:
            NotMeasured: the log has no such channel, or nothing in it.
        """
        rows = self.log.rows(record)
        if rows is None or len(rows) == 0:
            raise NotMeasured(f"the log has nothing on {record.topic}")
        return rows

    @cached_property
    def state(self) -> Structured:
        """The true state; its ticks are the ones that all masks and row numbers refer to."""
        return self.rows(State)

    def on_state_ticks(self, record: type[Record]) -> Structured:
        """The rows of a channel that belong to the rows of ``state``, one for each.

        Raises:
            NotMeasured: a row of ``state`` has none within ``SAME_TICK_S``.
        """
        rows, wanted_s = self.rows(record), self.state["t_s"]
        if np.array_equal(rows["t_s"], wanted_s):
            return rows
        found = rows[nearest(rows["t_s"], wanted_s)]
        apart_s = float(np.max(np.abs(found["t_s"] - wanted_s)))
        if apart_s > SAME_TICK_S:
            raise NotMeasured(
                f"{record.topic} and {State.topic} are up to {apart_s:.3f} s apart; "
                f"they must share ticks within {SAME_TICK_S:g} s"
            )
        return found

    @cached_property
    def reference(self) -> Structured:
        """The reference on the ticks of ``state``."""
        return self.on_state_ticks(Reference)

    @cached_property
    def modes(self) -> ModeTable:
        """The vehicle's modes."""
        return self.log.modes()

    def during(self, *phases: Phase, slides: bool | None = None) -> Mask:
        """Where the executive was in a mode of one of these phases (``ModeTable.within``)."""
        return self.modes.within(self.reference["mode"], phases, slides=slides)

    @cached_property
    def airborne(self) -> Mask:
        """From take-off to landing, but for what follows a failsafe."""
        return self.during(*IN_FLIGHT)

    @cached_property
    def off_ground(self) -> Mask:
        """The same without take-off and landing: the landing gear touches nothing."""
        return self.during(*OFF_GROUND)

    @cached_property
    def touching(self) -> Mask:
        """Where the tool truly touches.

        Raises:
            NotMeasured: the true force is missing somewhere; without it a bounce would not show.
        """
        force = self.state["f_normal"]
        if not np.all(np.isfinite(force)):
            raise NotMeasured(f"f_normal on {State.topic} is not known throughout the flight")
        return np.asarray(force > TOUCH_N)

    def near_touch(self, margin_s: float) -> Mask:
        """Where a touch is at most ``margin_s`` away in time, before or after."""
        times = self.state["t_s"]
        touches_s = times[self.touching]
        if len(touches_s) == 0:
            return np.zeros(len(times), bool)
        apart_s = np.abs(touches_s[nearest(touches_s, times)] - times)
        return np.asarray(apart_s <= margin_s + 1e-9)

    @cached_property
    def contact_targets(self) -> tuple[Target, ...]:
        """The targets that the plan wants touched: points, strokes and surfaces to follow."""
        targets = tuple(t for t in self.plan.targets if t.kind in TOUCHED)
        if not targets:
            raise NotMeasured("the plan has nothing to touch")
        return targets

    @cached_property
    def read_targets(self) -> tuple[Target, ...]:
        """The targets at which an instrument shall be read."""
        targets = tuple(t for t in self.plan.targets if t.sensor is not None)
        if not targets:
            raise NotMeasured("the plan has no point to read")
        return targets

    def read_by(self, instrument: str) -> tuple[Target, ...]:
        """The targets at which one instrument shall be read.

        Raises:
            NotMeasured: the plan has none.
        """
        targets = tuple(t for t in self.read_targets if t.sensor == instrument)
        if not targets:
            raise NotMeasured(f"the plan has no point to read with {instrument}")
        return targets

    def contact_rows(self, target: int) -> Rows:
        """Rows of a target from its approach to the retreat from it, first touch to release."""
        busy = self.during(*AT_SURFACE)
        return self._first_to_last_touch(busy & (self.reference["target"] == target))

    @cached_property
    def dwells(self) -> dict[int, Dwell]:
        """The dwell on each target, by index; those that were never pressed are left out."""
        pressing = self.during(Phase.CONTACT, slides=False)
        dwells = {}
        for target in self.plan.targets:
            rows = self._first_to_last_touch(pressing & (self.reference["target"] == target.index))
            if len(rows):
                times = self.state["t_s"][rows]
                dwells[target.index] = Dwell(rows, rows[times > times[-1] - STEADY_S + 1e-9])
        return dwells

    def _first_to_last_touch(self, phase: Mask) -> Rows:
        touches = np.flatnonzero(phase & self.touching)
        if len(touches) == 0:
            return touches
        rows: Rows = np.flatnonzero(phase)
        held: Rows = rows[(rows >= touches[0]) & (rows <= touches[-1])]
        return held


def nearest(times: Vector, wanted: Vector) -> Rows:
    """For each of ``wanted`` (m,) the index of the nearest of the ascending ``times`` (n,)."""
    if len(times) == 1:
        return np.zeros(len(wanted), np.intp)
    right = np.clip(np.searchsorted(times, wanted), 1, len(times) - 1)
    left_is_nearer = wanted - times[right - 1] < times[right] - wanted
    rows: Rows = np.where(left_is_nearer, right - 1, right)
    return rows


def root_mean_square(values: Vector) -> float:
    """√(mean of squares).

    Raises:
        NotMeasured: there is nothing to average.
    """
    return float(np.sqrt(mean(np.square(values))))


def mean(values: Vector) -> float:
    """The arithmetic mean.

    Raises:
        NotMeasured: there is nothing to average.
    """
    if values.size == 0:
        raise NotMeasured("the flight never got to the phase that this is measured in")
    return float(np.mean(values))


def largest(values: Vector) -> float:
    """The maximum.

    Raises:
        NotMeasured: there is nothing to choose from.
    """
    if values.size == 0:
        raise NotMeasured("the flight never got to the phase that this is measured in")
    return float(np.max(values))
