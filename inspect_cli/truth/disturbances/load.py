"""What a disturbance is built from, what it sees of the vehicle and what it does to it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import NamedTuple, Protocol

import numpy as np

from inspect_cli.records import TrueDisturbance
from inspect_cli.schema.disturbances import DisturbanceModel
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class Circumstances:
    """What a disturbance is built from besides its own entry."""

    entries: tuple[DisturbanceModel, ...]
    """All of the mission's disturbances."""
    rng: np.random.Generator
    step_s: float
    """Between two calls of ``act``."""


class Motion(NamedTuple):
    """Where the vehicle truly is and how it moves; views into the plant's memory."""

    p_WB: Vector
    q_WB: Vector
    v_WB_W: Vector
    p_WT: Vector


class Load:
    """The sum of what acts at one moment, and what the log says of it."""

    def __init__(self) -> None:
        self.force_W: Vector = np.zeros(3)
        """At O_b, N."""
        self.torque_B: Vector = np.zeros(3)
        """N·m."""
        self.force_tip_W: Vector = np.zeros(3)
        """At the tool's tip, N."""
        self.record = TrueDisturbance.create()
        numbers = self.record.array.view(np.float64)
        self._all = (self.force_W, self.torque_B, self.force_tip_W, numbers)

    def clear(self) -> None:
        """Nothing acts."""
        for numbers in self._all:
            numbers.fill(0.0)


class Model(Protocol):
    """One disturbance. It is asked once per control tick, in order of time."""

    def act(self, t_s: float, motion: Motion, load: Load) -> None:
        """Add what acts on the vehicle from now on to ``load``."""
        ...


def ramp(elapsed_s: float, ramp_s: float) -> float:
    """0 before the start, 1 after ``ramp_s``, linear between."""
    if elapsed_s < 0.0:
        return 0.0
    return 1.0 if elapsed_s >= ramp_s else elapsed_s / ramp_s
