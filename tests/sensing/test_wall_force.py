"""The force sensor in the wall: frame, lever, resolution, noise, blocks."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.records import WALL_SAMPLES, State
from inspect_cli.schema.truth import ForceSensorModel
from inspect_cli.sensing.wall_force import WallForceSensor
from inspect_cli.spatial.primitives import plane
from inspect_cli.truth.snapshot import Truth

NORMAL = np.array([-0.8, 0.6, 0.0])
ORIGIN = np.array([2.0, 0.5, 1.25])
IDEAL = ForceSensorModel(resolution_n=0.0, torque_resolution_nm=0.0)


def sensor_of(model: ForceSensorModel, seed: int = 0) -> WallForceSensor:
    surface = plane(ORIGIN, NORMAL, (2.0, 2.0))
    return WallForceSensor(model, surface, np.random.default_rng(seed))


def push(force_W: np.ndarray, at_W: np.ndarray) -> np.ndarray:
    """The wrench about O_W of a force at a point."""
    return np.r_[force_W, np.cross(at_W, force_W)]


def at(t_s: float, wrench_W: np.ndarray) -> Truth:
    state = State.create({"n_rotors": 0, "n_joints": 0})
    state.t_s = t_s
    return Truth(state, wall_wrench=lambda: wrench_W)


def test_a_press_is_negative_along_the_normal_and_turns_about_the_origin() -> None:
    sensor = sensor_of(IDEAL)
    block = sensor.measurement
    R_WS = Rotation.from_quat(block.q_WS, scalar_first=True).as_matrix()
    np.testing.assert_allclose(R_WS[:, 2], NORMAL, atol=1e-12)
    at_S = np.array([0.3, -0.2, 0.0])
    sensor.sample(at(0.0, push(-7.0 * NORMAL + 2.0 * R_WS[:, 0], ORIGIN + R_WS @ at_S)))
    np.testing.assert_allclose(block.f_S[0], [2.0, 0.0, -7.0], atol=1e-12)
    np.testing.assert_allclose(block.t_S[0], np.cross(at_S, [2.0, 0.0, -7.0]), atol=1e-12)
    np.testing.assert_allclose(block.p_WS, ORIGIN)
    assert block.period == pytest.approx(1.0 / 800.0)


def test_its_output_has_steps() -> None:
    sensor = sensor_of(ForceSensorModel(resolution_n=0.1, torque_resolution_nm=0.02))
    sensor.sample(at(0.0, push(-1.234 * NORMAL, ORIGIN)))
    np.testing.assert_allclose(sensor.measurement.f_S[0], [0.0, 0.0, -1.2], atol=1e-12)
    for k in range(1, 50):
        sensor.sample(at(k / 800, push(k * np.array([0.37, -0.11, 0.053]), ORIGIN - 0.3)))
    for values, step in ((sensor.measurement.f_S[:50], 0.1), (sensor.measurement.t_S[:50], 0.02)):
        np.testing.assert_allclose(values / step, np.round(values / step), atol=1e-9)


def test_its_noise_has_the_stated_size() -> None:
    sensor = sensor_of(
        ForceSensorModel(
            resolution_n=0.0, torque_resolution_nm=0.0, noise_n=0.5, torque_noise_nm=0.01
        )
    )
    samples = []
    for k in range(100 * WALL_SAMPLES):
        if sensor.sample(at(k / 800, np.zeros(6))):
            samples.append(np.hstack([sensor.measurement.f_S, sensor.measurement.t_S]))
    spread = np.concatenate(samples).std(axis=0)
    # Five standard errors of a standard deviation of 8000 samples.
    assert spread == pytest.approx(np.repeat([0.5, 0.01], 3), rel=5.0 / np.sqrt(16_000))


def test_blocks_follow_each_other_without_a_gap() -> None:
    sensor, ends, values = sensor_of(IDEAL), [], []
    for k in range(3 * WALL_SAMPLES + 7):
        if sensor.sample(at(k / 800, push(-float(k) * NORMAL, ORIGIN))):
            ends.append(sensor.measurement.t_s)
            values.append(-sensor.measurement.f_S[:, 2].copy())
    assert ends == [(WALL_SAMPLES * n - 1) / 800 for n in (1, 2, 3)]
    np.testing.assert_allclose(np.concatenate(values), np.arange(3 * WALL_SAMPLES), atol=1e-9)
