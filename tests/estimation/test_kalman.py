"""The filter's kernels against finite differences, textbook matrix algebra and closed forms."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation

from inspect_cli.estimation.kalman import (
    correct_pose,
    frame_drifts,
    pose_innovation,
    propagate,
)

Array = NDArray[np.float64]
H = np.zeros((6, 15))
H[:3, :3] = H[3:, 6:9] = np.eye(3)


class Belief:
    """Arguments of the kernels, and x ⊞ δx, x ⊟ y written with scipy's rotations."""

    def __init__(self, p: Array, v: Array, R: Rotation, bias: Array) -> None:
        self.p, self.v, self.bias = p.copy(), v.copy(), bias.copy()
        self.q = R.as_quat(canonical=True, scalar_first=True)

    @classmethod
    def random(cls, rng: np.random.Generator) -> Belief:
        R = Rotation.from_rotvec(rng.uniform(-2.0, 2.0, 3))
        return cls(rng.normal(size=3), rng.normal(size=3), R, 0.1 * rng.normal(size=6))

    @property
    def R(self) -> Rotation:
        return Rotation.from_quat(self.q, scalar_first=True)

    def plus(self, d: Array) -> Belief:
        R = self.R * Rotation.from_rotvec(d[6:9])
        return Belief(self.p + d[:3], self.v + d[3:6], R, self.bias + d[9:])

    def minus(self, other: Belief) -> Array:
        turn = (other.R.inv() * self.R).as_rotvec()
        return np.r_[self.p - other.p, self.v - other.v, turn, self.bias - other.bias]

    def propagated(self, sample: Array, dt: float) -> Belief:
        moved = self.plus(np.zeros(15))
        P = np.zeros((15, 15))
        propagate(moved.p, moved.v, moved.q, moved.bias, P, sample, dt, np.zeros(4))
        return moved

    def covariance_after(
        self, P: Array, sample: Array, dt: float, noise: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0)
    ) -> Array:
        moved, P = self.plus(np.zeros(15)), P.copy()
        propagate(moved.p, moved.v, moved.q, moved.bias, P, sample, dt, np.array(noise))
        return P


def random_covariance(rng: np.random.Generator) -> Array:
    scale = np.repeat([0.01, 0.05, 0.02, 0.1, 0.01], 3)
    root = rng.normal(size=(15, 20)) * scale[:, None]
    return root @ root.T / 20.0


@pytest.mark.parametrize("dt", [0.001, 0.004])
@pytest.mark.parametrize("seed", range(5))
def test_transition_is_the_derivative_of_the_motion(seed: int, dt: float) -> None:
    rng = np.random.default_rng(seed)
    belief = Belief.random(rng)
    sample = np.r_[rng.uniform(-10.0, 10.0, 3), rng.uniform(-3.0, 3.0, 3)]
    nominal = belief.propagated(sample, dt)
    for j in range(15):
        step = np.zeros(15)
        step[j] = 1e-5
        ahead = belief.plus(step).propagated(sample, dt).minus(nominal)
        behind = belief.plus(-step).propagated(sample, dt).minus(nominal)
        # F e_j e_jᵀ Fᵀ is the outer product of F's column, whose diagonal entry is positive.
        outer = belief.covariance_after(np.outer(step, step) / 1e-10, sample, dt)
        column = outer[:, j] / np.sqrt(outer[j, j])
        # F leaves out terms of order Δt² times the specific force, at most 17 m/s² here.
        assert np.abs((ahead - behind) / 2e-5 - column).max() < 20.0 * dt**2


def test_covariance_stays_symmetric_and_positive() -> None:
    rng = np.random.default_rng(3)
    belief, P = Belief.random(rng), random_covariance(rng)
    variance = np.repeat([1e-6, 4e-6], 3)
    for k in range(2000):
        sample = np.r_[0.0, 0.0, 9.81, 0.0, 0.0, 0.0] + rng.normal(size=6)
        P = belief.covariance_after(P, sample, 0.004, (1e-6, 1e-8, 1e-10, 1e-12))
        if k % 3 == 0:
            innovation = 1e-3 * rng.normal(size=6)
            correct_pose(belief.p, belief.v, belief.q, belief.bias, P, innovation, variance, np.inf)
    assert (np.abs(P - P.T) <= 1e-12 * np.abs(P).max()).all()
    assert np.linalg.eigvalsh(P).min() > 0.0


def test_noise_grows_as_its_densities_say() -> None:
    """Without gravity or motion the double integrals of white noise have closed forms."""
    belief = Belief(np.zeros(3), np.zeros(3), Rotation.identity(), np.zeros(6))
    accel, gyro, accel_walk, gyro_walk = 2e-3, 3e-4, 5e-4, 2e-5
    noise = (accel**2, gyro**2, accel_walk**2, gyro_walk**2)
    P, dt, n = np.zeros((15, 15)), 0.004, 500
    for _ in range(n):
        P = belief.covariance_after(P, np.zeros(6), dt, noise)
    t = n * dt
    sd = np.sqrt(np.diagonal(P))
    # The sums differ from the integrals by a share of about 1.5 / n.
    close = {"rel": 2.0 / n}
    assert sd[0] ** 2 == pytest.approx(accel**2 * t**3 / 3.0 + accel_walk**2 * t**5 / 20.0, **close)
    assert sd[3] ** 2 == pytest.approx(accel**2 * t + accel_walk**2 * t**3 / 3.0, **close)
    assert sd[6] ** 2 == pytest.approx(gyro**2 * t + gyro_walk**2 * t**3 / 3.0, **close)
    assert sd[9] == pytest.approx(accel_walk * np.sqrt(t))
    assert sd[12] == pytest.approx(gyro_walk * np.sqrt(t))


def test_rest_and_free_fall() -> None:
    level = Belief(np.zeros(3), np.zeros(3), Rotation.identity(), np.zeros(6))
    tilted = Belief(np.zeros(3), np.zeros(3), Rotation.from_rotvec([0.4, 0.2, -1.0]), np.zeros(6))
    support = np.r_[tilted.R.inv().apply([0.0, 0.0, 9.81]), 0.0, 0.0, 0.0]
    for _ in range(250):
        level = level.propagated(np.zeros(6), 0.004)
        tilted = tilted.propagated(support, 0.004)
    assert level.v[2] == pytest.approx(-9.81)
    assert level.p[2] == pytest.approx(-9.81 / 2.0)
    assert np.abs(np.r_[tilted.p, tilted.v]).max() < 1e-12


@pytest.mark.parametrize("seed", range(5))
def test_correction_is_the_textbook_update(seed: int) -> None:
    rng = np.random.default_rng(seed)
    belief, P = Belief.random(rng), random_covariance(rng)
    variance = np.repeat([1e-4, 4e-4], 3)
    measured_p = belief.p + 0.01 * rng.normal(size=3)
    measured_R = belief.R * Rotation.from_rotvec(0.02 * rng.normal(size=3))
    measured_q = -3.0 * measured_R.as_quat(scalar_first=True)  # neither unit nor of w ≥ 0
    innovation = pose_innovation(belief.p, belief.q, measured_p, measured_q)
    turn = (belief.R.inv() * measured_R).as_rotvec()
    assert innovation == pytest.approx(np.r_[measured_p - belief.p, turn])

    S = H @ P @ H.T + np.diag(variance)
    K = P @ H.T @ np.linalg.inv(S)
    delta = K @ innovation
    keep = np.eye(15) - K @ H
    expected_P = keep @ P @ keep.T + K @ np.diag(variance) @ K.T
    G = np.eye(15)
    a, b, c = 0.5 * delta[6:9]
    G[6:9, 6:9] -= np.array([[0.0, -c, b], [c, 0.0, -a], [-b, a, 0.0]])
    expected_P = G @ expected_P @ G.T
    expected = belief.plus(delta)

    new_P = P.copy()
    chi2 = correct_pose(
        belief.p, belief.v, belief.q, belief.bias, new_P, innovation, variance, np.inf
    )
    assert chi2 == pytest.approx(innovation @ np.linalg.inv(S) @ innovation)
    assert np.abs(belief.minus(expected)).max() < 1e-12
    assert np.abs(new_P - expected_P).max() < 1e-12 * np.abs(P).max()
    assert belief.q[0] >= 0.0
    assert np.linalg.norm(belief.q) == pytest.approx(1.0)


@pytest.mark.parametrize("innovation", [np.full(6, 0.5), np.r_[np.zeros(5), np.nan]])
def test_nothing_changes_beyond_the_gate(innovation: Array) -> None:
    rng = np.random.default_rng(0)
    belief, P = Belief.random(rng), random_covariance(rng)
    before, P_before = belief.plus(np.zeros(15)), P.copy()
    variance = np.full(6, 1e-4)
    chi2 = correct_pose(belief.p, belief.v, belief.q, belief.bias, P, innovation, variance, 38.0)
    assert not chi2 <= 38.0
    assert (belief.minus(before)[:6] == 0.0).all()
    assert np.array_equal(belief.q, before.q)
    assert np.array_equal(P, P_before)


def test_a_drifting_frame_adds_what_its_random_walks_say() -> None:
    """The yaw of the world in the attitude error's frame: R_true = R_z(ψ) R = R Exp(Rᵀ z ψ)."""
    rng = np.random.default_rng(5)
    belief, P = Belief.random(rng), random_covariance(rng)
    rate, walks, dt = np.array([0.3, -0.2, 0.4]), np.array([0.02, 0.03, 0.05]), 0.04
    distance, angle = dt * np.linalg.norm(belief.v), dt * np.linalg.norm(rate)
    axis = belief.R.as_matrix().T @ [0.0, 0.0, 1.0]
    expected = P.copy()
    expected[:3, :3] += walks[0] ** 2 * distance * np.eye(3)
    expected[6:9, 6:9] += (walks[1] ** 2 * distance + walks[2] ** 2 * angle) * np.outer(axis, axis)
    frame_drifts(P, belief.q, belief.v, rate, walks, dt)
    np.testing.assert_allclose(P, expected, atol=1e-15)
