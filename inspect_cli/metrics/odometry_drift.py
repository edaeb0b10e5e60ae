"""What the stated model of the odometry expects of a flight, before any dice are thrown.

The drift of an odometry is a random walk: two flights along one path err by different amounts, and
a single RMSE scatters by a factor of three around the model's. A published RMSE is held against
the model's expectation along the path that was truly flown. With the distance D, the angle
turned Θ, and the increments q_j = σ_ψd² ΔD_j + σ_ψθ² ΔΘ_j of the yaw's variance (sensing.odometry),

    Var ψ(t) = Σ_j q_j
    Var x(t) = σ_w² + σ_p² D(t) + σ_s² (x(t) − x_0)² + Σ_j q_j (y(t) − y_j)²
    Var y(t) = σ_w² + σ_p² D(t) + σ_s² (y(t) − y_0)² + Σ_j q_j (x(t) − x_j)²
    Var z(t) = σ_w² + σ_p² D(t) + σ_s² (z(t) − z_0)²

for small yaw errors, j running over the steps up to t: an error of yaw at j turns all the way
that follows. The expected RMSE is the root of the mean of the variance over the flight. The
filter, which only smooths the white noise, is left out.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, mean
from inspect_cli.metrics.geometry import attitude_angle
from inspect_cli.schema.vehicle import OdometryModel
from inspect_cli.spatial.arrays import Mask, Points, Vector

STEP = 10
"""Rows of the log between two steps of the sums."""


def expected_position_rmse(flight: FlightData, axis: int) -> float:
    """Expected RMS error of the odometry along an axis of W, m, from take-off to landing."""
    model = _model(flight)
    p, distance, increments = _path(flight, model)
    variance = model.position_noise_m**2 + model.position_walk**2 * distance
    variance = variance + model.scale_error**2 * (p[:, axis] - p[0, axis]) ** 2
    if axis < 2:
        across = p[:, 1 - axis]
        turned = np.tril((across[:, None] - across[None, :]) ** 2)
        variance = variance + turned @ increments
    return float(np.sqrt(mean(variance[_airborne(flight)])))


def expected_yaw_rmse(flight: FlightData) -> float:
    """Expected RMS error of the odometry's yaw, rad, from take-off to landing."""
    model = _model(flight)
    _, _, increments = _path(flight, model)
    variance = model.attitude_noise_rad**2 + np.cumsum(increments)
    return float(np.sqrt(mean(variance[_airborne(flight)])))


def _model(flight: FlightData) -> OdometryModel:
    odometry = flight.platform.find(OdometryModel)
    if odometry is None or flight.log.mission().estimation != "onboard":
        raise NotMeasured("the flight was not flown on odometry")
    truth = flight.log.truth()
    if truth is not None and any(truth.platform.odometry_drift_mps):
        raise NotMeasured("the odometry truly drifted otherwise than its model says")
    return odometry


def _airborne(flight: FlightData) -> Mask:
    rows: Mask = flight.airborne[::STEP]
    return rows


def _path(flight: FlightData, model: OdometryModel) -> tuple[Points, Vector, Vector]:
    """Positions (n, 3), distance travelled (n,) m and increments q (n,) rad² of the steps."""
    state = flight.state[::STEP]
    p = state["p_WB"]
    way = np.concatenate([[0.0], np.linalg.norm(np.diff(p, axis=0), axis=1)])
    turn = np.concatenate([[0.0], attitude_angle(state["q_WB"][:-1], state["q_WB"][1:])])
    increments = model.yaw_walk_moved**2 * way + model.yaw_walk_turned**2 * turn
    return p, np.cumsum(way), increments
