"""Whether the contact force comes to rest: no oscillation that grows (ledger row A9.stable)."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.contact import SETTLE_S
from inspect_cli.metrics.flight import TOUCH_N, Dwell, FlightData, NotMeasured
from inspect_cli.spatial.arrays import Vector

TREND_S = 1.0
"""What is slower than this is the press and not an oscillation."""
STILL_N = TOUCH_N
"""Amplitudes below that are not told from rest."""


def oscillation_growth(flight: FlightData) -> float:
    """Largest ratio of the force's oscillation in the second half of a dwell to the first half.

    The true normal force of each dwell, from 1 s after its first touch, less its moving mean over
    1 s; of that the amplitude √2 · RMS in either half. The ratio is a₂ / max(a₁, 0.1 N): a force
    at rest and an oscillation that dies out have a ratio below 1, a steady one 1, a growing one
    more.

    Raises:
        NotMeasured: a planned contact was never pressed, or no dwell was long enough.
    """
    ratios = [_growth(flight, dwell) for dwell in _planned_dwells(flight)]
    known = [ratio for ratio in ratios if ratio is not None]
    if not known:
        raise NotMeasured(f"no dwell lasted longer than {SETTLE_S + 2.0 * TREND_S:g} s")
    return max(known)


def residual_variation(flight: FlightData) -> float:
    """Worst coefficient of variation (σ / mean) of the true normal force in a dwell's last 2 s.

    Raises:
        NotMeasured: a planned contact was never pressed.
    """
    force = flight.state["f_normal"]
    dwells = _planned_dwells(flight)
    return float(max(np.std(force[d.steady]) / np.mean(force[d.steady]) for d in dwells))


def _planned_dwells(flight: FlightData) -> list[Dwell]:
    """The dwell of every contact; a contact that failed must not leave the word to the others."""
    missed = [t.label for t in flight.contact_targets if t.index not in flight.dwells]
    if missed:
        raise NotMeasured(f"never pressed: {', '.join(missed)}")
    return [flight.dwells[target.index] for target in flight.contact_targets]


def _growth(flight: FlightData, dwell: Dwell) -> float | None:
    times = flight.state["t_s"][dwell.rows]
    settled = times > times[0] + SETTLE_S
    wobble = _fast_part(times[settled], flight.state["f_normal"][dwell.rows][settled])
    if len(wobble) < 4:
        return None
    middle = len(wobble) // 2
    before, after = (np.sqrt(2.0 * np.mean(half**2)) for half in np.split(wobble, [middle]))
    return float(after / max(before, STILL_N))


def _fast_part(times: Vector, force: Vector) -> Vector:
    """The force less its centred moving mean over 1 s, where the whole window is there."""
    if len(times) < 2 or times[-1] - times[0] <= 2.0 * TREND_S:
        return np.empty(0)
    reach = max(1, round(0.5 * TREND_S / float(np.median(np.diff(times)))))
    width = 2 * reach + 1
    mean = np.convolve(force, np.full(width, 1.0 / width), mode="valid")
    fast: Vector = force[reach : len(force) - reach] - mean
    return fast
