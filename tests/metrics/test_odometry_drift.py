"""The model's expectation of the drift against many runs of the simulated sensor on one path."""

from __future__ import annotations

from types import SimpleNamespace
from typing import Any

import numpy as np

from inspect_cli.metrics import odometry_drift
from inspect_cli.records import State
from inspect_cli.schema.vehicle import OdometryModel
from inspect_cli.sensing.odometry import OdometrySensor
from inspect_cli.truth.snapshot import Truth

MODEL = OdometryModel(
    kind="odometry",
    rate_hz=30,
    position_noise_m=0.001,
    attitude_noise_rad=0.002,
    position_walk=0.004,
    scale_error=0.004,
    yaw_walk_moved=0.02,
    yaw_walk_turned=0.02,
    tilt_error_rad=0.0,
)
RUNS = 400


def path() -> Any:
    """Out, across and back over 30 s with a turn about z, at 100 Hz."""
    t = np.arange(0.0, 30.0, 0.01)
    rows = np.zeros(len(t), State.dtype())
    rows["t_s"] = t
    rows["p_WB"][:, 0] = 2.0 * np.sin(2.0 * np.pi * t / 30.0)
    rows["p_WB"][:, 1] = 1.0 - np.cos(2.0 * np.pi * t / 15.0)
    rows["p_WB"][:, 2] = 0.5 * np.sin(2.0 * np.pi * t / 20.0)
    yaw = 0.4 * np.sin(2.0 * np.pi * t / 25.0)
    rows["q_WB"][:, 0], rows["q_WB"][:, 3] = np.cos(0.5 * yaw), np.sin(0.5 * yaw)
    return rows


def test_the_expected_rmse_is_that_of_many_runs() -> None:
    rows = path()
    squares = np.zeros(4)
    state = State.create()
    for seed in range(RUNS):
        sensor = OdometrySensor(MODEL, np.random.Generator(np.random.SFC64(seed)))
        errors = []
        for row in rows[::10]:
            state.array[0] = row
            sensor.sample(Truth(state))
            q, m = row["q_WB"], sensor.measurement.q_WB
            yaw = 2.0 * (np.arctan2(m[3], m[0]) - np.arctan2(q[3], q[0]))
            errors.append([*(sensor.measurement.p_WB - row["p_WB"]), yaw])
        squares += np.mean(np.square(errors), axis=0) / RUNS
    flight: Any = SimpleNamespace(
        state=rows,
        airborne=np.ones(len(rows), bool),
        platform=SimpleNamespace(find=lambda model: MODEL),
        log=SimpleNamespace(
            mission=lambda: SimpleNamespace(estimation="onboard"), truth=lambda: None
        ),
    )
    expected = [odometry_drift.expected_position_rmse(flight, axis) for axis in range(3)]
    expected.append(odometry_drift.expected_yaw_rmse(flight))
    # The mean square of one run scatters by about its own size: 1/√400 of it, 2.5 % of its root.
    np.testing.assert_allclose(np.sqrt(squares), expected, rtol=0.10)
