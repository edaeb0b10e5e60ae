"""When samples of the half-cell make a reading that counts; measured values alone decide.

Force.      The load cell's moving mean over 0.2 s must be at least ``min_force_n``: noise on a
            light contact does not make it sufficient, and a lift shorter than that passes if the
            mean passes. Sufficient time runs while this holds, and from zero again after
            the mean fell below or no sample came for more than 0.1 s.
Time.       Sufficient time without a break ≥ ``min_contact_s`` (and ≥ ``stable_s``), and
            sufficient time in all since ``begin`` ≥ the dwell.
Potential.  The last ``stable_s`` are cut into five equal parts. The medians of the parts must lie
            in a band of ``stable_v``; sample noise has little part in a median.
Resistance. Its median over the last ``stable_s`` must be below 10 MΩ, the least input resistance of
            the voltmeter (ASTM C876, section 6): above it, the potential is not the specimen's.

The accepted values are medians over the last ``stable_s``. The first moment at which all holds
makes the reading; what comes later does not change it.
"""

from __future__ import annotations

import math
from collections import deque
from functools import partial
from statistics import fmean, median
from typing import Final, NamedTuple

from inspect_cli.interfaces import Judging
from inspect_cli.records import InvalidReason, Probe, Reading
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.spatial.arrays import Vector

FORCE_MEAN_S: Final = 0.2
"""Length of the load cell's moving mean."""
MAX_GAP_S: Final = 0.1
"""Longest time between samples that counts as uninterrupted."""
STABLE_PARTS: Final = 5
"""Parts of ``stable_s`` whose medians are compared."""
MAX_RESISTANCE_OHM: Final = 1e7
"""Above it the circuit is open."""
NO_CONTACT_SHARE: Final = 0.2
"""Share of ``min_force_n`` that the mean force must have reached for contact to be claimed."""
TICK_S: Final = 1e-6
"""Times that differ by less are the same; sums of floating-point time steps are not exact."""


class Sample(NamedTuple):
    """One fed sample; t in s, potential in V, resistance in Ω, force in N, tip in W."""

    t: float
    potential: float
    resistance: float
    force: float
    tip: tuple[float, float, float]


class ReadingJudge:
    """Collects the samples of one visit and decides: begin, feed …, finish; then again."""

    def __init__(self, model: HalfCellModel, dwell_s: float) -> None:
        self._model = model
        self._dwell_s = dwell_s
        self._unbroken_s = max(model.min_contact_s, model.stable_s)
        self._kept_s = max(model.stable_s, FORCE_MEAN_S)
        self._samples: deque[Sample] = deque()
        self.begin(-1, 0.0)

    def begin(self, target: int, t_s: float) -> None:
        """Start the visit of a target; the time-out runs from now."""
        self._target = target
        self._begun_s = t_s
        self._samples.clear()
        self._run_s = self._longest_s = self._total_s = 0.0
        self._largest_n = 0.0
        self._accepted = False

    def feed(self, probe: Probe, p_WT_est: Vector) -> None:
        """Take one sample and where the tool's tip is believed to be (3,) in W."""
        if self._accepted:
            return
        t = probe.t_s
        dt = t - self._samples[-1].t if self._samples else 0.0
        if dt > MAX_GAP_S:
            self._samples.clear()
        x, y, z = p_WT_est.tolist()
        self._samples.append(Sample(t, probe.potential, probe.resistance, probe.force, (x, y, z)))
        self._count_time(t, dt)
        while self._samples[0].t < t - self._kept_s - TICK_S:
            self._samples.popleft()
        if self._run_s < self._unbroken_s - TICK_S or self._total_s < self._dwell_s - TICK_S:
            return
        self._accepted = self._defect(self._last(self._model.stable_s)) is InvalidReason.NONE

    def done(self, t_s: float) -> bool:
        """Whether the reading is accepted, or the time of dwell and time-out is over."""
        return self._accepted or t_s >= self._begun_s + self._dwell_s + self._model.timeout_s

    def finish(self, t_s: float) -> Reading:
        """The verdict: the reading, or NaN values with the reason."""
        samples = self._last(self._model.stable_s)
        reading = Reading.create()
        reading.t_s = t_s
        reading.target = self._target
        reading.valid = float(self._accepted)
        reading.reason = float(self._reason(samples))
        reading.contact_s = self._longest_s
        reading.potential = reading.resistance = reading.force_mean = math.nan
        reading.p_WT = math.nan
        if samples:
            reading.force_mean = fmean(s.force for s in samples)
            reading.p_WT = [fmean(axis) for axis in zip(*(s.tip for s in samples), strict=True)]
        if self._accepted:
            reading.potential = median(s.potential for s in samples)
            reading.resistance = median(s.resistance for s in samples)
        return reading

    def _last(self, duration_s: float) -> list[Sample]:
        """The newest samples that cover ``duration_s``."""
        if not self._samples:
            return []
        after = self._samples[-1].t - duration_s + TICK_S
        return [s for s in self._samples if s.t > after]

    def _count_time(self, t: float, dt: float) -> None:
        """Let sufficient time run, or stop it."""
        covered = self._samples[0].t <= t - FORCE_MEAN_S + TICK_S
        force = fmean(s.force for s in self._last(FORCE_MEAN_S)) if covered else 0.0
        self._largest_n = max(self._largest_n, force)
        if not force >= self._model.min_force_n:
            self._run_s = 0.0
            return
        self._run_s += dt
        self._total_s += dt
        self._longest_s = max(self._longest_s, self._run_s)

    def _reason(self, samples: list[Sample]) -> InvalidReason:
        """Why the visit has no reading; the first cause in the chain of what it takes."""
        if self._accepted:
            return InvalidReason.NONE
        if not any(math.isfinite(s.force) for s in samples):
            return InvalidReason.NO_SIGNAL
        if self._largest_n < NO_CONTACT_SHARE * self._model.min_force_n:
            return InvalidReason.NO_CONTACT
        if self._run_s < self._unbroken_s - TICK_S or self._total_s < self._dwell_s - TICK_S:
            return InvalidReason.FORCE
        return self._defect(samples)

    def _defect(self, samples: list[Sample]) -> InvalidReason:
        """What is wrong with potential or resistance over the last ``stable_s``."""
        resistances = [s.resistance for s in samples]
        if not (all(map(math.isfinite, resistances)) and median(resistances) < MAX_RESISTANCE_OHM):
            return InvalidReason.OPEN_CIRCUIT
        if not all(math.isfinite(s.potential) for s in samples):
            return InvalidReason.UNSTABLE
        parts: list[list[float]] = [[] for _ in range(STABLE_PARTS)]
        newest = samples[-1].t
        for s in samples:
            age = (newest - s.t + TICK_S) / self._model.stable_s
            parts[min(int(age * STABLE_PARTS), STABLE_PARTS - 1)].append(s.potential)
        if not all(parts):
            return InvalidReason.UNSTABLE
        medians = [median(part) for part in parts]
        stable = max(medians) - min(medians) <= self._model.stable_v
        return InvalidReason.NONE if stable else InvalidReason.UNSTABLE


def half_cell_judging(model: HalfCellModel) -> Judging:
    """How samples of a half-cell become readings."""
    return Judging(Probe, Reading, partial(ReadingJudge, model))
