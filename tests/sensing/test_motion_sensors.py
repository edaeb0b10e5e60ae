"""Inertial unit and tracker: ideal values, the stated noise, and the filter's trust in them."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from scipy.stats import chi2

from inspect_cli.estimation.error_state import ErrorStateFilter
from inspect_cli.records import Estimate, State
from inspect_cli.schema.vehicle import ImuModel, PoseTrackerModel
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.instrument import BLOCK, Noise
from inspect_cli.sensing.pose_tracker import PoseSensor
from inspect_cli.truth.snapshot import Truth

QUIET = dict.fromkeys(
    (
        "accel_noise",
        "gyro_noise",
        "accel_bias_walk",
        "gyro_bias_walk",
        "accel_bias_initial_mps2",
        "gyro_bias_initial_radps",
    ),
    0.0,
)


def imu_model(**numbers: float) -> ImuModel:
    return ImuModel(kind="imu", rate_hz=250, **{**QUIET, **numbers})


LENGTHS = {"n_rotors": 1, "n_joints": 0}


def moving_state() -> State:
    state = State.create(LENGTHS)
    state.t_s = 1.25
    state.p_WB = [1.0, -2.0, 3.0]
    state.q_WB = Rotation.from_rotvec([0.3, -1.1, 0.7]).as_quat(scalar_first=True)
    state.a_WB_W = [0.5, -1.5, 2.0]
    state.w_WB_B = [0.1, 0.2, -0.3]
    return state


def imu_samples(model: ImuModel, rate_hz: int, n: int, seed: int = 0) -> np.ndarray:
    """Samples (n, 6) of a body at rest, gravity taken off."""
    sensor = ImuSensor(model.model_copy(update={"rate_hz": rate_hz}), np.random.default_rng(seed))
    state = State.create(LENGTHS)
    state.q_WB[0] = 1.0
    out = np.empty((n, 6))
    for k in range(n):
        sensor.sample(Truth(state))
        out[k, :3], out[k, 3:] = sensor.measurement.f_B, sensor.measurement.w_B
    return out - np.array([0.0, 0.0, 9.81, 0.0, 0.0, 0.0])


def test_ideal_imu() -> None:
    state = moving_state()
    sensor = ImuSensor(imu_model(), np.random.default_rng(0))
    sensor.sample(Truth(state))
    R = Rotation.from_quat(state.q_WB, scalar_first=True).as_matrix()
    assert sensor.measurement.f_B == pytest.approx(R.T @ [0.5, -1.5, 2.0 + 9.81])
    assert sensor.measurement.w_B == pytest.approx([0.1, 0.2, -0.3])
    assert sensor.measurement.t_s == 1.25


@pytest.mark.parametrize("rate_hz", [250, 1000])
def test_white_noise_has_its_density(rate_hz: int) -> None:
    model = imu_model(accel_noise=2e-3, gyro_noise=3e-4)
    samples = imu_samples(model, rate_hz, 20_000)
    expected = np.repeat([2e-3, 3e-4], 3) * np.sqrt(rate_hz)
    # The sample's standard deviation errs by 1/√(2n) = 0.5 %; five times that.
    assert samples.std(axis=0) == pytest.approx(expected, rel=0.025)
    correlation = np.corrcoef(np.hstack([samples[1:], samples[:-1]]).T) - np.eye(12)
    assert np.abs(correlation).max() < 5.0 / np.sqrt(20_000)


def test_biases_walk_as_their_density_says() -> None:
    model = imu_model(accel_bias_walk=1e-3, gyro_bias_walk=1e-4)
    steps = np.diff(imu_samples(model, 250, 20_000), axis=0)
    assert steps.std(axis=0) * np.sqrt(250) == pytest.approx(np.repeat([1e-3, 1e-4], 3), rel=0.025)


def test_biases_start_where_the_model_says() -> None:
    model = imu_model(accel_bias_initial_mps2=0.1, gyro_bias_initial_radps=0.02)
    first = np.array([imu_samples(model, 250, 2, seed) for seed in range(2000)])
    assert (first[:, 0] == first[:, 1]).all()
    sd = first[:, 0].std(axis=0)
    assert sd == pytest.approx(np.repeat([0.1, 0.02], 3), rel=0.08)  # five times 1/√(2n)


def test_tracker_noise_is_on_the_right() -> None:
    state = moving_state()
    model = PoseTrackerModel(
        kind="pose_tracker", rate_hz=100, position_noise_m=0.002, attitude_noise_rad=0.01
    )
    sensor = PoseSensor(model, np.random.default_rng(2))
    truth = Rotation.from_quat(state.q_WB, scalar_first=True)
    n = 10_000
    errors = np.empty((n, 6))
    for k in range(n):
        sensor.sample(Truth(state))
        q = sensor.measurement.q_WB
        assert q[0] >= 0.0
        errors[k, :3] = sensor.measurement.p_WB - state.p_WB
        errors[k, 3:] = (truth.inv() * Rotation.from_quat(q, scalar_first=True)).as_rotvec()
    expected = np.repeat([0.002, 0.01], 3)
    assert errors.std(axis=0) == pytest.approx(expected, rel=0.036)  # five times 1/√(2n)
    assert (np.abs(errors.mean(axis=0)) < 5.0 * expected / np.sqrt(n)).all()
    assert sensor.measurement.t_s == 1.25


def test_ideal_tracker() -> None:
    state = moving_state()
    model = PoseTrackerModel(
        kind="pose_tracker", rate_hz=100, position_noise_m=0.0, attitude_noise_rad=0.0
    )
    sensor = PoseSensor(model, np.random.default_rng(0))
    sensor.sample(Truth(state))
    assert sensor.measurement.p_WB == pytest.approx([1.0, -2.0, 3.0])
    assert sensor.measurement.q_WB == pytest.approx(state.q_WB)


def test_noise_does_not_repeat_and_depends_on_its_generator_alone() -> None:
    def stream(seed: int) -> np.ndarray:
        noise = Noise(np.random.default_rng(seed), 3)
        return np.array([noise.draw().copy() for _ in range(2 * BLOCK + 5)])

    one = stream(1)
    assert len(np.unique(one)) == one.size
    assert np.array_equal(one, stream(1))
    assert not np.array_equal(one, stream(2))


def test_the_filter_trusts_these_sensors_as_much_as_they_deserve() -> None:
    """Normalised error squared of p, v, θ over 20 hovers with a steady turn, 99.9 % band."""
    imu_model = ImuModel(
        kind="imu",
        rate_hz=250,
        accel_noise=2e-3,
        gyro_noise=2e-4,
        accel_bias_walk=3e-4,
        gyro_bias_walk=2e-5,
        accel_bias_initial_mps2=0.05,
        gyro_bias_initial_radps=0.005,
    )
    pose_model = PoseTrackerModel(
        kind="pose_tracker", rate_hz=100, position_noise_m=0.001, attitude_noise_rad=0.003
    )
    runs, rate = 20, 0.8
    ratio = 0.0
    for seed in range(runs):
        rng = np.random.default_rng(seed)
        imu, pose = ImuSensor(imu_model, rng), PoseSensor(pose_model, rng)
        belief = ErrorStateFilter(imu_model, pose_model, 250, 100)
        estimate = Estimate.create()
        state = State.create(LENGTHS)
        state.w_WB_B = [0.0, 0.0, rate]
        for k in range(2001):
            t = k / 500.0
            state.t_s = t
            state.q_WB = [np.cos(0.5 * rate * t), 0.0, 0.0, np.sin(0.5 * rate * t)]
            if k % 5 == 0:
                pose.sample(Truth(state))
            if k == 0:
                belief.start(pose.measurement, estimate)
                propagate = belief.bind_propagation(imu.measurement, estimate)
                correct = belief.bind_correction(pose.measurement, estimate)
            if k % 2 == 0:
                imu.sample(Truth(state))
                propagate()
            if k % 5 == 0 and k > 0:
                assert correct()
        believed = Rotation.from_quat(estimate.q_WB, scalar_first=True)
        turn = believed.inv() * Rotation.from_quat(state.q_WB, scalar_first=True)
        error = np.r_[-estimate.p_WB, -estimate.v_WB_W, turn.as_rotvec()]
        ratio += error @ np.linalg.solve(belief.covariance[:9, :9], error)
    low, high = chi2.interval(0.999, 9 * runs)
    assert low < ratio < high
