"""What the observer's gain and the speed of the reference do to the error of the force estimate.

The momentum observer is a first-order lag, df̂/dt = K (f − f̂) with K = K_I of the axis
(``inspect_cli.estimation.wrench_observer``). A step of force leaves the error e^(−K t); a force
that rises by r newtons per second leaves

    f − f̂ = (r / K) (1 − e^(−K t))

A set-point that enters the surface with the speed v, at the contact stiffness k = m* K̃, makes
r = k v: a slow press is estimated well even with a slow observer. Predictions are for the lag
alone; the noise of the estimate and forces that are no contact come on top.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector


def first_order_response(force_n: Vector, period_s: float, gain: float) -> Vector:
    """f̂ (n,) of an observer that starts at rest, for forces (n,) at equal times.

    Exact for a force that is linear between its samples. ``gain`` is K, 1/s.
    """
    from scipy.signal import lfilter  # slow to import, and only a study needs it

    decay = np.exp(-gain * period_s)
    rising = 1.0 - (1.0 - decay) / (gain * period_s)
    numerator = [rising, 1.0 - decay - rising]
    start = [-rising * force_n[0]]  # so that f̂ begins at zero
    response: Vector = lfilter(numerator, [1.0, -decay], force_n, zi=start)[0]
    return response


def ramp_error(rate_nps: float, t_s: float, gain: float) -> float:
    """f − f̂ at the time ``t_s`` into a force that rises by ``rate_nps`` from zero, N."""
    return float(rate_nps / gain * -np.expm1(-gain * t_s))


def press_rmse(force_n: float, rise_s: float, hold_s: float, gain: float) -> float:
    """RMS of f − f̂ over a press: a linear rise to ``force_n``, then a hold, N.

    With T the rise, h the hold, e_T the error at the end of the rise and a = e^(−K T):

        ∫ = (r / K)² (T − 2 (1 − a) / K + (1 − a²) / 2K)  +  e_T² (1 − e^(−2 K h)) / 2K
    """
    rate = force_n / rise_s
    decay = np.exp(-gain * rise_s)
    rise = rise_s - 2.0 * (1.0 - decay) / gain + (1.0 - decay**2) / (2.0 * gain)
    rise *= (rate / gain) ** 2
    last = ramp_error(rate, rise_s, gain)
    hold = last**2 * -np.expm1(-2.0 * gain * hold_s) / (2.0 * gain)
    return float(np.sqrt((rise + hold) / (rise_s + hold_s)))


def press_sweep(
    force_n: float,
    press_m: float,
    hold_s: float,
    gains: Sequence[float],
    speeds_mps: Sequence[float],
) -> Matrix:
    """``press_rmse`` for every gain (rows) and every speed of the set-point (columns), N.

    The set-point goes ``press_m`` behind the surface, where the force is ``force_n``.
    """
    return np.array(
        [
            [press_rmse(force_n, press_m / speed, hold_s, gain) for speed in speeds_mps]
            for gain in gains
        ]
    )
