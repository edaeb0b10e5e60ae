"""Odometry that drifts with motion: the stated statistics, and the filter that flies on it."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from inspect_cli.estimation.error_state import ErrorStateFilter
from inspect_cli.records import Estimate, Imu, Odometry, State
from inspect_cli.schema.vehicle import ImuModel, OdometryModel
from inspect_cli.sensing.odometry import OdometrySensor
from inspect_cli.truth.snapshot import Truth

QUIET = {
    "kind": "odometry",
    "rate_hz": 30,
    "position_noise_m": 0.0,
    "attitude_noise_rad": 0.0,
    "position_walk": 0.0,
    "scale_error": 0.0,
    "yaw_walk_moved": 0.0,
    "yaw_walk_turned": 0.0,
    "tilt_error_rad": 0.0,
}
FLOWN = {
    "kind": "odometry",
    "rate_hz": 30,
    "position_noise_m": 0.001,
    "attitude_noise_rad": 0.002,
    "position_walk": 0.004,
    "scale_error": 0.004,
    "yaw_walk_moved": 0.005,
    "yaw_walk_turned": 0.005,
    "tilt_error_rad": 0.002,
}
Path = Callable[[float], tuple[np.ndarray, Rotation]]
RUNS = 400


def along_x(speed: float) -> Path:
    return lambda t: (np.array([1.0 + speed * t, 2.0, 1.5]), Rotation.identity())


def turning(rate: float) -> Path:
    return lambda t: (np.array([1.0, 2.0, 1.5]), Rotation.from_rotvec([0.0, 0.0, rate * t]))


def errors(path: Path, seconds: float, seed: int, **numbers: float) -> np.ndarray:
    """(δp in W, rotation vector in W) of the last sample at 30 Hz."""
    sensor = OdometrySensor(OdometryModel(**{**QUIET, **numbers}), np.random.default_rng(seed))
    state = State.create({})
    for k in range(round(30 * seconds) + 1):
        p, R = path(k / 30.0)
        state.t_s, state.p_WB, state.q_WB = k / 30.0, p, R.as_quat(scalar_first=True)
        sensor.sample(Truth(state))
    found = Rotation.from_quat(sensor.measurement.q_WB, scalar_first=True)
    assert sensor.measurement.t_s == state.t_s
    return np.r_[sensor.measurement.p_WB - p, (found * R.inv()).as_rotvec()]


def spread(path: Path, seconds: float, **numbers: float) -> np.ndarray:
    runs = [errors(path, seconds, seed, **numbers) for seed in range(RUNS)]
    return np.sqrt(np.mean(np.square(runs), axis=0))


BAND = 4.0 / np.sqrt(2.0 * RUNS)
"""Relative; four standard deviations of a standard deviation found from that many runs."""


def test_without_noise_it_is_the_truth() -> None:
    path: Path = lambda t: (  # noqa: E731
        np.array([np.sin(t), np.cos(t), t]),
        Rotation.from_rotvec([0.3 * t, -0.2 * t, 0.7 * t]),
    )
    np.testing.assert_allclose(errors(path, 3.0, 1), 0.0, atol=1e-12)


def test_it_starts_at_the_true_pose_and_stays_there_at_rest() -> None:
    walks = dict.fromkeys(("position_walk", "yaw_walk_moved", "yaw_walk_turned"), 0.1)
    np.testing.assert_array_equal(errors(along_x(0.0), 0.0, 1, **walks)[:3], 0.0)
    np.testing.assert_allclose(
        errors(along_x(0.0), 20.0, 1, **walks, scale_error=0.1), 0, atol=1e-12
    )


@pytest.mark.parametrize(("speed", "seconds"), [(1.0, 4.0), (0.25, 4.0), (0.5, 8.0)])
def test_position_walks_with_the_root_of_the_distance(speed: float, seconds: float) -> None:
    found = spread(along_x(speed), seconds, position_walk=0.01)
    expected = 0.01 * np.sqrt(speed * seconds)
    assert found[:3] == pytest.approx(np.full(3, expected), rel=BAND)
    np.testing.assert_allclose(found[3:], 0.0, atol=1e-12)


def test_the_scale_is_wrong_by_the_same_share_all_along() -> None:
    short, long = (errors(along_x(1.0), s, 3, scale_error=0.01)[0] for s in (1.0, 5.0))
    assert long == pytest.approx(5.0 * short)
    found = spread(along_x(1.0), 2.0, scale_error=0.01)
    assert found[0] == pytest.approx(0.02, rel=BAND)
    np.testing.assert_allclose(found[1:], 0.0, atol=1e-12)


def test_yaw_walks_with_distance_and_bends_the_path() -> None:
    """ψ(x) is a Wiener process of variance σ² x; the place across the path is its integral,
    of variance σ² x³ / 3 (Ito's isometry)."""
    found = spread(along_x(1.0), 4.0, yaw_walk_moved=0.01)
    assert found[5] == pytest.approx(0.01 * 2.0, rel=BAND)
    assert found[1] == pytest.approx(0.01 * np.sqrt(4.0**3 / 3.0), rel=BAND)
    assert found[0] < 0.1 * found[1]
    np.testing.assert_allclose(found[[2, 3, 4]], 0.0, atol=1e-12)


def test_the_path_bends_to_the_side_that_the_attitude_is_off_to() -> None:
    """Of the same Wiener process, E[ψ(x) ∫ψ] = σ² x² / 2: with its integral ψ correlates by √3/2.

    The estimated correlation of 400 pairs has a standard deviation of (1 − 3/4) / 20 = 0.013.
    """
    runs = np.array([errors(along_x(1.0), 2.0, k, yaw_walk_moved=0.01) for k in range(RUNS)])
    correlation = np.corrcoef(runs[:, 5], runs[:, 1])[0, 1]
    assert correlation == pytest.approx(np.sqrt(0.75), abs=0.05)


def test_yaw_walks_with_the_angle_turned() -> None:
    found = spread(turning(0.5), 4.0, yaw_walk_turned=0.01)
    assert found[5] == pytest.approx(0.01 * np.sqrt(2.0), rel=BAND)
    np.testing.assert_allclose(found[:5], 0.0, atol=1e-12)


def test_roll_and_pitch_are_bounded() -> None:
    early, late = (errors(along_x(1.0), s, 5, tilt_error_rad=0.01) for s in (0.0, 20.0))
    np.testing.assert_allclose(early[3:], late[3:], atol=1e-12)
    found = spread(along_x(1.0), 0.2, tilt_error_rad=0.01)
    assert found[3:5] == pytest.approx(np.full(2, 0.01), rel=BAND)
    assert found[5] < 1e-4


def test_white_noise_in_all() -> None:
    found = spread(along_x(0.0), 0.1, position_noise_m=0.002, attitude_noise_rad=0.003)
    assert found == pytest.approx(np.repeat([0.002, 0.003], 3), rel=BAND)


def test_the_drift_depends_on_the_seed_alone() -> None:
    first, again, other = (errors(along_x(1.0), 1.0, seed, **FLOWN) for seed in (1, 1, 2))
    np.testing.assert_array_equal(first, again)
    assert (first != other).all()


IMU = ImuModel(
    kind="imu",
    rate_hz=250,
    accel_noise=2e-3,
    gyro_noise=2e-4,
    accel_bias_walk=3e-4,
    gyro_bias_walk=2e-5,
    accel_bias_initial_mps2=0.02,
    gyro_bias_initial_radps=0.001,
)


class Shuttle:
    """Back and forth along x for one run: the filter fed by inertial unit and odometry, by tick of
    750 Hz, at which 250 Hz and 30 Hz fall on ticks."""

    def __init__(self, seed: int) -> None:
        rng = np.random.default_rng(seed)
        model = OdometryModel(**FLOWN)
        self.sensor = OdometrySensor(model, rng)
        self.filter = ErrorStateFilter(IMU, model, 250, 30)
        self.estimate = Estimate.create()
        self.rejected = 0
        root = np.sqrt(250.0)
        bias = np.repeat([0.02, 0.001], 3) * rng.standard_normal(6)
        state, imu = State.create({}), Imu.create()
        state.q_WB[0] = 1.0
        for k in range(750 * 30 + 1):
            t = state.t_s = imu.t_s = k / 750.0
            state.p_WB = [1.0 - np.cos(0.8 * t), 0.0, 0.0]
            if k == 0:
                self.sensor.sample(Truth(state))
                self.filter.start(self.sensor.measurement, self.estimate)
                propagate = self.filter.bind_propagation(imu, self.estimate)
                correct = self.filter.bind_correction(self.sensor.measurement, self.estimate)
            if k % 3 == 0:
                noise = root * np.repeat([2e-3, 2e-4], 3) * rng.standard_normal(6)
                sample = noise + bias
                imu.f_B = sample[:3] + np.array([0.64 * np.cos(0.8 * t), 0.0, 9.81])
                imu.w_B = sample[3:]
                propagate()
            if k % 25 == 0 and k > 0:
                self.sensor.sample(Truth(state))
                self.rejected += not correct()
        self.true_p = state.p_WB.copy()
        self.odometry_p = self.sensor._believed[:3].copy()


def test_the_filter_takes_every_pose_and_is_consistent_with_the_drifting_frame() -> None:
    """Thirty seconds and fifteen metres: against the odometry's own frame its position is as
    good as it says (99.9 % band of 20 runs), against the world it is far worse."""
    runs = [Shuttle(seed) for seed in range(20)]
    assert sum(run.rejected for run in runs) == 0
    ratio, true = 0.0, 0.0
    for run in runs:
        P = run.filter.covariance[:3, :3]
        for origin in ("odometry_p", "true_p"):
            error = getattr(run, origin) - run.estimate.p_WB
            value = error @ np.linalg.solve(P, error)
            ratio += value if origin == "odometry_p" else 0.0
            true += value if origin == "true_p" else 0.0
    low, high = chi2.interval(0.999, 3 * len(runs))
    assert low < ratio < high
    assert true > 10.0 * high


def test_the_filter_knows_by_its_gyroscopes_that_the_frame_turns_away() -> None:
    """A pose that is no number corrects nothing, but the frame has drifted until then."""
    variances = []
    for walk in (0.0, 0.01):
        model = OdometryModel(**{**QUIET, "yaw_walk_turned": walk})
        filter_, estimate, pose, imu = ErrorStateFilter(IMU, model, 250, 30), *_first()
        filter_.start(pose, estimate)
        propagate = filter_.bind_propagation(imu, estimate)
        for k in range(26):
            imu.t_s = k / 250.0
            propagate()
        pose.t_s, pose.p_WB = 0.1, np.nan
        assert not filter_.bind_correction(pose, estimate)()
        variances.append(filter_.covariance[8, 8])
    assert variances[1] - variances[0] == pytest.approx(0.01**2 * 0.5 * 0.1, rel=1e-6)


def _first() -> tuple[Estimate, Odometry, Imu]:
    """Level at rest, then turning by 0.5 rad/s about the vertical."""
    pose, imu = Odometry.create(), Imu.create()
    pose.q_WB[0] = 1.0
    imu.f_B, imu.w_B = [0.0, 0.0, 9.81], [0.0, 0.0, 0.5]
    return Estimate.create(), pose, imu


def test_the_filter_gives_up_after_as_long_a_time_as_with_a_tracker() -> None:
    assert ErrorStateFilter(IMU, OdometryModel(**FLOWN), 250, 30).restart_after == 6


def test_a_steady_drift_moves_what_it_believes_at_rest_too() -> None:
    sensor = OdometrySensor(
        OdometryModel(**QUIET), np.random.Generator(np.random.SFC64(1)), (0.002, 0.0, -0.001)
    )
    state = State.create()
    state.q_WB[0] = 1.0
    for k in range(301):
        state.t_s = 1.0 + k / 30.0
        sensor.sample(Truth(state))
    np.testing.assert_allclose(sensor.measurement.p_WB, [0.02, 0.0, -0.01], atol=1e-12)
