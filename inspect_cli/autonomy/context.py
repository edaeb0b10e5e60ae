"""What the functions of modes and failsafes may read and move during one flight.

A vehicle subclasses ``Context`` with what its own modes need: its guidance, its inputs.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np

from inspect_cli.autonomy.modes import Mode, Order
from inspect_cli.autonomy.protocols import Judge
from inspect_cli.interfaces import FlightStack
from inspect_cli.records import InvalidReason, Probe, Reading, Record
from inspect_cli.schema.plan import Plan, Target

Judges = Mapping[str, Callable[[Target], Judge]]
"""By the instrument of a target: makes the judge of its samples there."""


@dataclass(frozen=True)
class Event:
    """Something worth a line in the log."""

    t_s: float
    level: Literal["info", "warning", "error"]
    text: str


class Context:
    """The flight as its modes see it: time, order, target, readings. Never a true value."""

    inputs: Any
    """What the failsafes look at."""

    def __init__(self, plan: Plan, stack: FlightStack, judges: Judges, mode: Mode) -> None:
        self.plan = plan
        self.stack = stack
        self.t_s = 0.0
        self.mode = mode
        self.order = Order(mode.name)
        self.since_s = 0.0
        """When the mode was entered."""
        self.armed = False
        """Whether the rotors shall turn."""
        self.readings: list[Reading] = []
        """Verdicts that nobody has logged yet."""
        self.events: list[Event] = []
        """Events that nobody has logged yet."""
        self._judges = judges
        self._judge: Judge | None = None
        self._judging = False
        self._judged: set[int] = set()

    @property
    def target(self) -> Target | None:
        """The target of the order."""
        index = self.order.target
        return None if index is None else self.plan.targets[index]

    def is_fresh(self, need: str) -> bool:
        """Whether what a mode needs is there and recent; a vehicle says so for its own needs."""
        return True

    def refresh(self, t_s: float) -> None:
        """Bring the inputs up to date."""
        self.t_s = t_s

    def enter(self, t_s: float, mode: Mode, order: Order) -> None:
        """Note that a mode is entered; its ``begin`` comes next."""
        self.t_s = self.since_s = t_s
        self.mode, self.order = mode, order
        target = self.target
        point = "" if target is None else f", point {target.label}"
        self.note("info", f"{mode.name}{point}")

    def hear(self, record: Record) -> None:
        """Take what the stack made of a sensor's sample, or an instrument's sample."""
        if isinstance(record, Probe) and self._judge is not None and self._judging:
            p_WT, _ = self.stack.believed("tool")
            self._judge.feed(record, p_WT)

    def note(self, level: Literal["info", "warning", "error"], text: str) -> None:
        """Leave an event for the log."""
        self.events.append(Event(self.t_s, level, text))

    def prepare_reading(self, target: Target) -> None:
        """Have a judge ready if an instrument is read at the target."""
        self._judge = self._judges[target.sensor](target) if target.sensor else None
        self._judging = False

    def begin_reading(self) -> None:
        """Let the samples count from now on: the set-point is where it shall be."""
        if self._judge is not None and self.order.target is not None:
            self._judge.begin(self.order.target, self.t_s)
            self._judging = True

    @property
    def reads(self) -> bool:
        """Whether a judge waits for samples, or has them."""
        return self._judge is not None

    def decided(self) -> bool:
        """Whether the judge has decided."""
        return self._judge is not None and self._judge.done(self.t_s)

    def take_reading(self) -> None:
        """Take the judge's verdict, if there is a judge."""
        target = self.target
        if self._judge is None or target is None:
            return
        reading = self._judge.finish(self.t_s)
        check_place(reading, target)
        self._judge = None
        self._judged.add(int(reading.target))
        self.readings.append(reading)

    def give_up_readings(self) -> None:
        """Leave an invalid reading at every target that shall be read and was not."""
        self._judge = None
        for target in self.plan.targets:
            if target.sensor is not None and target.index not in self._judged:
                self._judged.add(target.index)
                self.readings.append(_no_reading(self.t_s, target))


def check_place(reading: Reading, target: Target) -> None:
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
