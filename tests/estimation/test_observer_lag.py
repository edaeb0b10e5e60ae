"""The closed forms of the observer's lag against the differential equation and the observer."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.integrate import solve_ivp

from inspect_cli.estimation.observer_lag import (
    first_order_response,
    press_rmse,
    press_sweep,
    ramp_error,
)
from inspect_cli.estimation.wrench_observer import WrenchObserver
from inspect_cli.records import Estimate

FORCE_N, RISE_S, HOLD_S = 7.2, 0.8, 4.0


def press(t: float) -> float:
    return FORCE_N * min(t / RISE_S, 1.0)


def integrated(gain: float, times: np.ndarray) -> np.ndarray:
    """f̂ by an integrator that knows nothing of closed forms."""
    return solve_ivp(
        lambda t, y: gain * (press(t) - y),
        (0.0, times[-1]),
        [0.0],
        t_eval=times,
        rtol=1e-10,
        atol=1e-12,
        max_step=0.05,
    ).y[0]


@pytest.mark.parametrize("gain", [0.3, 1.0, 5.0])
def test_the_closed_forms_solve_the_differential_equation(gain: float) -> None:
    times = np.linspace(0.0, RISE_S + HOLD_S, 4801)
    force = np.array([press(t) for t in times])
    observed = integrated(gain, times)
    np.testing.assert_allclose(
        first_order_response(force, times[1], gain), observed, atol=1e-6 * FORCE_N
    )
    half = np.searchsorted(times, 0.5 * RISE_S)
    expected = force[half] - observed[half]
    assert ramp_error(FORCE_N / RISE_S, times[half], gain) == pytest.approx(expected, rel=1e-6)
    error = np.sqrt(np.trapezoid((force - observed) ** 2, times) / times[-1])
    assert press_rmse(FORCE_N, RISE_S, HOLD_S, gain) == pytest.approx(error, rel=1e-4)


def test_a_fast_rise_is_a_step() -> None:
    """√((1 − e^(−2Kh)) / 2Kh) of the force."""
    step = np.sqrt(-np.expm1(-2.0 * HOLD_S) / (2.0 * HOLD_S))
    assert press_rmse(1.0, 1e-4, HOLD_S, 1.0) == pytest.approx(step, rel=1e-3)


def test_the_sweep_falls_with_the_gain_and_rises_with_the_speed() -> None:
    table = press_sweep(7.2, 0.1, 4.0, (0.5, 1.0, 2.0, 4.0), (0.02, 0.05, 0.1, 0.5))
    assert table.shape == (4, 4)
    assert (np.diff(table, axis=0) < 0.0).all()
    assert (np.diff(table, axis=1) > 0.0).all()
    assert table[1, 2] == press_rmse(7.2, 1.0, 4.0, 1.0)


@pytest.mark.parametrize("gain", [1.0, 3.0])
def test_the_observer_of_the_flight_has_this_lag(gain: float) -> None:
    """A body at 5 kg that is pushed, and knows its velocity and nothing of the push."""
    mass, dt = 5.0, 0.004
    observer = WrenchObserver(mass, np.eye(3), np.zeros(3), np.full(6, gain), dt)
    estimate = Estimate.create()
    estimate.q_WB[0] = 1.0
    observer.reset(estimate)
    hover = np.array([0.0, 0.0, 9.81 * mass, 0.0, 0.0, 0.0])
    times = dt * np.arange(round((RISE_S + HOLD_S) / dt) + 1)
    force = np.array([press(t) for t in times])
    momentum = np.concatenate([[0.0], np.cumsum(0.5 * dt * (force[1:] + force[:-1]))])
    observed = [0.0]
    observe = observer.bind(estimate, hover)
    for p in momentum[1:]:
        estimate.v_WB_W[0] = p / mass
        observe()
        observed.append(float(estimate.wrench_B[0]))
    # Within a step the observer takes the force as constant: half a step's rise at the most.
    allowed = 0.5 * dt * FORCE_N / RISE_S * gain * dt + 1e-3 * FORCE_N
    np.testing.assert_allclose(observed, first_order_response(force, dt, gain), atol=allowed)
