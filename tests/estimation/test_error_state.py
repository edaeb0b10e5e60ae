"""The filter as a whole: consistency, timing, outliers, ideal sensors.

The truth is a trajectory in closed form; its measurements are made here, with scipy's rotations
and the noise model's definition, not by the simulated sensors.
"""

from __future__ import annotations

import numpy as np
import pytest
from numpy.typing import NDArray
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from inspect_cli.estimation.error_state import GATE, ErrorStateFilter
from inspect_cli.records import Estimate, Imu, Pose
from inspect_cli.schema.vehicle import ImuModel, PoseTrackerModel

Array = NDArray[np.float64]
IMU_HZ, POSE_HZ = 250, 100
IMU = ImuModel(
    kind="imu",
    rate_hz=250,
    accel_noise=2e-3,
    gyro_noise=2e-4,
    accel_bias_walk=3e-4,
    gyro_bias_walk=2e-5,
    accel_bias_initial_mps2=0.05,
    gyro_bias_initial_radps=0.005,
)
POSE = PoseTrackerModel(
    kind="pose_tracker", rate_hz=100, position_noise_m=0.001, attitude_noise_rad=0.003
)
QUIET_IMU = ImuModel(
    kind="imu",
    rate_hz=250,
    accel_noise=0.0,
    gyro_noise=0.0,
    accel_bias_walk=0.0,
    gyro_bias_walk=0.0,
    accel_bias_initial_mps2=0.0,
    gyro_bias_initial_radps=0.0,
)
QUIET_POSE = PoseTrackerModel(
    kind="pose_tracker", rate_hz=100, position_noise_m=0.0, attitude_noise_rad=0.0
)


class Wiggle:
    """Translation and roll, pitch, yaw as sums of sines; everything at times t (n,)."""

    def __init__(self, t: Array, drift: Array | None = None) -> None:
        self.t = t
        drift = np.zeros(3) if drift is None else drift
        size = np.array([[0.5, 0.4, 0.3], [0.05, 0.07, 0.04]])
        rate = np.array([[1.1, 0.8, 1.4], [5.0, 4.0, 6.0]])
        phase = rate[:, None, :] * t[:, None]
        # Cosines of zero slope at t = 0, so that the velocity at the start is the drift alone.
        self.p = (size[:, None] * (1.0 - np.cos(phase))).sum(0) + np.outer(t, drift)
        self.v = (size[:, None] * rate[:, None] * np.sin(phase)).sum(0) + drift
        self.a = (size[:, None] * rate[:, None] ** 2 * np.cos(phase)).sum(0)
        swing, speed = np.array([0.4, 0.3, 1.0]), np.array([1.9, 2.3, 0.7])
        angle = swing * np.sin(np.outer(t, speed))
        change = swing * speed * np.cos(np.outer(t, speed))
        self.R = Rotation.from_euler("ZYX", angle[:, ::-1])
        (roll, pitch, _), (d_roll, d_pitch, d_yaw) = angle.T, change.T
        self.w = np.column_stack(
            [
                d_roll - d_yaw * np.sin(pitch),
                d_pitch * np.cos(roll) + d_yaw * np.sin(roll) * np.cos(pitch),
                -d_pitch * np.sin(roll) + d_yaw * np.cos(roll) * np.cos(pitch),
            ]
        )
        self.f = self.R.inv().apply(self.a + np.array([0.0, 0.0, 9.81]))


def set_pose(pose: Pose, t: float, p: Array, R: Rotation) -> Pose:
    pose.t_s, pose.p_WB, pose.q_WB = t, p, R.as_quat(scalar_first=True)
    return pose


class Run:
    """One flight: the filter is fed tick by tick (500 per second, as the rates need)."""

    def __init__(
        self, imu: ImuModel, pose: PoseTrackerModel, seconds: float, rng: np.random.Generator
    ) -> None:
        self.ticks = int(seconds * 500) + 1
        t = np.arange(self.ticks) / 500.0
        self.truth = Wiggle(t, rng.normal(size=3))
        n, root = self.ticks, np.sqrt(IMU_HZ)
        start = np.repeat([imu.accel_bias_initial_mps2, imu.gyro_bias_initial_radps], 3)
        walk = np.repeat([imu.accel_bias_walk, imu.gyro_bias_walk], 3) / root
        white = np.repeat([imu.accel_noise, imu.gyro_noise], 3) * root
        steps = walk * rng.normal(size=(n // 2 + 1, 6))
        steps[0] = start * rng.normal(size=6)
        self.bias = np.repeat(np.cumsum(steps, axis=0), 2, axis=0)[:n]
        ideal = np.column_stack([self.truth.f, self.truth.w])
        self.samples = ideal + self.bias + white * rng.normal(size=(n, 6))
        self.seen_p = self.truth.p + pose.position_noise_m * rng.normal(size=(n, 3))
        turn = Rotation.from_rotvec(pose.attitude_noise_rad * rng.normal(size=(n, 3)))
        self.seen_R = self.truth.R * turn
        self.filter = ErrorStateFilter(imu, pose, IMU_HZ, POSE_HZ)
        self.estimate = Estimate.create()
        self._imu, self._pose = Imu.create(), Pose.create()
        self.propagate = self.filter.bind_propagation(self._imu, self.estimate)
        self.correct = self.filter.bind_correction(self._pose, self.estimate)

    def start(self) -> None:
        self.filter.start(set_pose(self._pose, 0.0, self.seen_p[0], self.seen_R[0]), self.estimate)

    def tick(self, k: int) -> bool:
        """Feed what is due at tick ``k``; False if a pose was rejected."""
        t = k / 500.0
        if k % 2 == 0:
            self._imu.t_s = t
            self._imu.f_B, self._imu.w_B = self.samples[k, :3], self.samples[k, 3:]
            self.propagate()
        if k % 5 == 0 and k > 0:
            set_pose(self._pose, t, self.seen_p[k], self.seen_R[k])
            return self.correct()
        return True

    def error(self, k: int) -> Array:
        e, truth = self.estimate, self.truth
        believed = Rotation.from_quat(e.q_WB, scalar_first=True)
        turn = (believed.inv() * truth.R[k]).as_rotvec()
        bias = self.bias[k] - np.r_[e.bias_f_B, e.bias_w_B]
        return np.r_[truth.p[k] - e.p_WB, truth.v[k] - e.v_WB_W, turn, bias]


def test_errors_are_as_large_as_the_filter_says() -> None:
    """Normalised estimation error squared, mean of 50 runs: draws from χ²(50 · dof) / 50 each.

    All have to lie in the 99.9 % band, nine in ten in the 95 % band, and so has the whole state
    at the end of the flight.
    """
    runs, instants = 50, range(250, 5001, 250)
    groups = {"p": slice(0, 3), "v": slice(3, 6), "θ": slice(6, 9), "all": slice(0, 15)}
    ratio = {name: np.zeros(len(instants)) for name in groups}
    for seed in range(runs):
        run = Run(IMU, POSE, 10.0, np.random.default_rng(seed))
        run.start()
        for k in range(run.ticks):
            run.tick(k)
            if k in instants:
                error = run.error(k)
                for name, part in groups.items():
                    P = run.filter.covariance[part, part]
                    value = error[part] @ np.linalg.solve(P, error[part])
                    ratio[name][instants.index(k)] += value / runs
    inside = []
    for name, part in groups.items():
        dof = runs * (part.stop - part.start)
        for share, strict in ((0.999, True), (0.95, False)):
            low, high = np.array(chi2.interval(share, dof)) / runs
            within = (ratio[name] > low) & (ratio[name] < high)
            if strict:
                assert within.all(), (name, ratio[name], low, high)
            else:
                inside.append(within)
    assert np.mean(inside) >= 0.9
    assert inside[-1][-1]


def test_published_sigma_is_the_diagonal_of_the_covariance() -> None:
    run = Run(IMU, POSE, 1.0, np.random.default_rng(0))
    run.start()
    for k in range(run.ticks):
        run.tick(k)
    e = run.estimate
    assert e.sigma == pytest.approx(np.sqrt(np.diagonal(run.filter.covariance)))
    assert e.w_WB_B == pytest.approx(run.samples[-1, 3:] - e.bias_w_B)
    assert e.q_WB[0] >= 0.0
    assert e.t_s == pytest.approx(1.0)


def test_ideal_sensors_are_followed_without_a_rejection() -> None:
    run = Run(QUIET_IMU, QUIET_POSE, 10.0, np.random.default_rng(1))
    run.start()
    for k in range(run.ticks):
        assert run.tick(k)
        if k > 500 and k % 10 == 0:  # both sensors are due
            error = run.error(k)
            assert np.abs(error[:3]).max() < 1e-4
            assert np.abs(error[3:6]).max() < 2e-3
            assert np.abs(error[6:9]).max() < 1e-4


def test_the_gate_is_its_quantile() -> None:
    assert pytest.approx(chi2.isf(1e-6, 6), abs=1e-3) == GATE


@pytest.mark.parametrize("what", ["outlier", "nan", "zero quaternion"])
def test_a_lone_bad_pose_leaves_no_trace(what: str) -> None:
    run, spoiled = (Run(IMU, POSE, 3.0, np.random.default_rng(2)) for _ in range(2))
    for r in (run, spoiled):
        r.start()
        for k in range(1005):
            assert r.tick(k)
    pose = set_pose(Pose.create(), 1004 / 500.0, spoiled.seen_p[1004], spoiled.seen_R[1004])
    if what == "outlier":
        pose.p_WB[0] += 0.3
    elif what == "nan":
        pose.q_WB[2] = np.nan
    else:
        pose.q_WB = np.zeros(4)
    with np.errstate(invalid="ignore"):  # only plain Python warns of 0/0
        assert not spoiled.filter.bind_correction(pose, spoiled.estimate)()
    assert spoiled.estimate.array == run.estimate.array


def test_a_tracker_that_moved_for_good_is_believed_in_the_end() -> None:
    run = Run(IMU, POSE, 6.0, np.random.default_rng(3))
    run.start()
    shift = np.array([0.5, -0.2, 0.1])
    accepted = []
    for k in range(run.ticks):
        if k == 1500:
            run.seen_p = run.seen_p + shift
            run.truth.p = run.truth.p + shift
        good = run.tick(k)
        if k >= 1500 and k % 5 == 0:
            accepted.append(good)
    assert run.filter.restart_after == 20  # 0.2 s at 100 Hz
    assert accepted.index(True) == 19
    assert all(accepted[20:])
    error = run.error(run.ticks - 1)
    assert (np.abs(error) < 4.5 * run.estimate.sigma).all()


def test_an_inertial_sample_that_is_not_finite_is_passed_over() -> None:
    run = Run(IMU, POSE, 4.0, np.random.default_rng(5))
    run.start()
    run.samples[1000:1010, 1] = np.nan
    for k in range(run.ticks):
        run.tick(k)
        assert np.isfinite(run.estimate.p_WB).all()
    assert (np.abs(run.error(run.ticks - 1)) < 4.5 * run.estimate.sigma).all()


def test_a_start_needs_a_finite_pose() -> None:
    run = Run(IMU, POSE, 0.1, np.random.default_rng(6))
    run.seen_p[0, 1] = np.nan
    with pytest.raises(ValueError, match="finite"):
        run.start()
