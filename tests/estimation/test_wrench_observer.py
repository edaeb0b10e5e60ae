"""The observer's response against its first-order solution on a body that scipy integrates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.integrate import solve_ivp
from scipy.spatial.transform import Rotation

from inspect_cli.estimation.wrench_observer import WrenchObserver
from inspect_cli.records import Estimate

Array = NDArray[np.float64]
MASS = 4.75
COM = np.array([0.03, -0.02, 0.05])
INERTIA_COM = np.array([[0.107, 0.004, -0.002], [0.004, 0.111, 0.003], [-0.002, 0.003, 0.207]])
INERTIA = INERTIA_COM + MASS * (COM @ COM * np.eye(3) - np.outer(COM, COM))
WEIGHT_W = np.array([0.0, 0.0, -9.81 * MASS])
GAIN = np.array([5.0, 8.0, 12.0, 6.0, 10.0, 15.0])
Load = Callable[[float, Rotation], tuple[Array, Array]]
"""(force in W, torque about the centre of mass in B) at a time and attitude."""


def flown(t: Array, applied_B: Array, load: Load, w0: Array) -> tuple[Array, Array, Array]:
    """q (n, 4) wxyz, v_WB_W (n, 3), w (n, 3) of the body under applied wrench and load.

    Newton and Euler about the centre of mass, with momenta as the integrated variables.
    """

    def derivative(now: float, y: Array) -> Array:
        q, L = y[:4], y[7:]
        R = Rotation.from_quat(q, scalar_first=True)
        w = np.linalg.solve(INERTIA_COM, L)
        force_W, torque_B = load(now, R)
        total = R.apply(applied_B[:3]) + force_W + WEIGHT_W
        torque = applied_B[3:] - np.cross(COM, applied_B[:3]) + torque_B
        q_dot = 0.5 * np.r_[-q[1:] @ w, q[0] * w + np.cross(q[1:], w)]
        return np.r_[q_dot, total / MASS, torque - np.cross(w, L)]

    q0 = Rotation.from_rotvec([0.5, -0.3, 0.8]).as_quat(scalar_first=True)
    start = np.r_[q0, np.array([0.3, -0.2, 0.1]), INERTIA_COM @ w0]
    y = solve_ivp(derivative, (t[0], t[-1]), start, t_eval=t, rtol=1e-10, atol=1e-12).y.T
    q = y[:, :4] / np.linalg.norm(y[:, :4], axis=1)[:, None]
    w = np.linalg.solve(INERTIA_COM, y[:, 7:].T).T
    v = y[:, 4:7] - Rotation.from_quat(q, scalar_first=True).apply(np.cross(w, COM))
    return q, v, w


def observed(t: Array, motion: tuple[Array, Array, Array], applied_B: Array) -> Array:
    """The observer's wrench about O_b in B at every time (n, 6)."""
    observer = WrenchObserver(MASS, INERTIA, COM, GAIN, t[1] - t[0])
    estimate = Estimate.create()
    observe = observer.bind(estimate, applied_B)
    out = np.zeros((len(t), 6))
    for k in range(len(t)):
        estimate.q_WB, estimate.v_WB_W, estimate.w_WB_B = (x[k] for x in motion)
        if k == 0:
            observer.reset(estimate)
        else:
            observe()
        out[k] = estimate.wrench_B
    return out


def first_order(t: Array, q: Array, force_W: Array, torque_B: Array) -> Array:
    """The solution of dτ̂/dt = K_I (τ − τ̂) for a constant load, as a wrench about O_b in B."""
    rise = 1.0 - np.exp(-np.outer(t, GAIN))
    force_B = Rotation.from_quat(q, scalar_first=True).inv().apply(rise[:, :3] * force_W)
    return np.hstack([force_B, rise[:, 3:] * torque_B + np.cross(COM, force_B)])


@pytest.mark.parametrize("dt", [0.001, 0.004, 0.02])
@pytest.mark.parametrize("spin", [0.0, 1.5])
def test_response_to_a_step_is_first_order_at_any_step_size(dt: float, spin: float) -> None:
    force, torque = np.array([4.0, -7.0, 3.0]), np.array([0.05, 0.08, -0.1])
    thrust = np.array([1.0, 2.0, 45.0])
    applied = np.r_[thrust, np.cross(COM, thrust) + np.array([0.02, -0.03, 0.01])]
    t = np.arange(0.0, 0.8 + 0.5 * dt, dt)
    motion = flown(t, applied, lambda _t, _R: (force, torque), spin * np.array([1.0, -1.0, 0.5]))
    expected = first_order(t, motion[0], force, torque)
    # Between the ends of a step R f_a is taken as a chord, which errs by 45 N (w Δt)² / 12.
    speed = np.linalg.norm(motion[2], axis=1).max()
    assert speed < 4.0
    tolerance = 1e-6 + 45.0 * (4.0 * dt) ** 2 / 12.0
    assert np.abs(observed(t, motion, applied) - expected).max() < tolerance


def test_a_load_that_changes_is_filtered_and_not_delayed() -> None:
    """A ramp: the first-order solution is τ̂ = r (t − (1 − e^(−K t)) / K)."""
    slope, dt = np.array([6.0, 0.0, -4.0]), 0.004
    t = np.arange(0.0, 1.0, dt)
    applied = np.r_[0.0, 0.0, 46.0, 0.0, 0.0, 0.0]
    motion = flown(t, applied, lambda now, _R: (slope * now, np.zeros(3)), np.zeros(3))
    lag = (1.0 - np.exp(-np.outer(t, GAIN[:3]))) / GAIN[:3]
    force_W = slope * (t[:, None] - lag)
    force_B = Rotation.from_quat(motion[0], scalar_first=True).inv().apply(force_W)
    assert np.abs(observed(t, motion, applied)[:, :3] - force_B).max() < 0.01


@pytest.mark.parametrize("w0", [np.zeros(3), np.array([2.0, -1.0, 3.0])])
def test_nothing_is_seen_where_nothing_acts(w0: Array) -> None:
    """Free fall, tumbling: neither gravity nor the Coriolis terms look like a load."""
    t = np.arange(0.0, 1.0, 0.004)
    motion = flown(t, np.zeros(6), lambda _t, _R: (np.zeros(3), np.zeros(3)), w0)
    # The mean of w × L errs by Δt² / 12 of its second derivative, here below 20 N·m/s².
    assert np.abs(observed(t, motion, np.zeros(6))).max() < 1e-4


def test_hovering_off_centre_is_no_load() -> None:
    """Thrust through O_b with the centre of mass aside needs the torque c × (weight)."""
    hover = np.r_[-WEIGHT_W, np.cross(COM, -WEIGHT_W)]
    observer = WrenchObserver(MASS, INERTIA, COM, GAIN, 0.004)
    estimate = Estimate.create()
    estimate.q_WB[0] = 1.0
    observer.reset(estimate)
    observe = observer.bind(estimate, hover)
    for _ in range(500):
        observe()
    assert np.abs(estimate.wrench_B).max() < 1e-9


def test_a_push_at_the_tool_has_its_lever_about_the_origin() -> None:
    """At rest, held by the actuators: force f at p gives (f, p × f), whatever the mass centre."""
    tip, push = np.array([0.5, 0.0, -0.2]), np.array([-2.0, 0.3, 0.1])
    contact = np.r_[push, np.cross(tip, push)]
    hold = np.r_[-WEIGHT_W, np.cross(COM, -WEIGHT_W)] - contact
    observer = WrenchObserver(MASS, INERTIA, COM, GAIN, 0.004)
    estimate = Estimate.create()
    estimate.q_WB[0] = 1.0
    observer.reset(estimate)
    observe = observer.bind(estimate, hold)
    for _ in range(2000):  # 8 s: the slowest mode has decayed by e⁻⁴⁰
        observe()
    assert estimate.wrench_B == pytest.approx(contact, abs=1e-9)


def test_reset_forgets() -> None:
    observer = WrenchObserver(MASS, INERTIA, COM, GAIN, 0.004)
    estimate = Estimate.create()
    estimate.q_WB[0] = 1.0
    observer.reset(estimate)
    observer.bind(estimate, np.full(6, 9.0))()
    assert np.abs(estimate.wrench_B).max() > 0.01
    estimate.v_WB_W = [3.0, -1.0, 2.0]
    estimate.w_WB_B = [0.1, 0.0, 0.2]
    observer.reset(estimate)
    assert (estimate.wrench_B == 0.0).all()
    estimate.w_WB_B = np.zeros(3)
    observer.reset(estimate)
    R = Rotation.from_quat(estimate.q_WB, scalar_first=True)
    hover = R.inv().apply(-WEIGHT_W)
    observer.bind(estimate, np.r_[hover, np.cross(COM, hover)])()
    assert np.abs(estimate.wrench_B).max() < 1e-9
