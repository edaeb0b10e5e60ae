"""How well the vehicle knew its own motion and the forces on it."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, root_mean_square
from inspect_cli.metrics.geometry import attitude_angle
from inspect_cli.records import Estimate
from inspect_cli.spatial.arrays import Points


def position_rmse(flight: FlightData) -> float:
    """RMS distance between estimated and true position of O_b, m, from take-off to landing."""
    flying = flight.airborne
    estimate = flight.on_state_ticks(Estimate)
    errors = estimate["p_WB"][flying] - flight.state["p_WB"][flying]
    return root_mean_square(np.linalg.norm(errors, axis=1))


def attitude_rmse(flight: FlightData) -> float:
    """RMS angle between estimated and true attitude, rad, from take-off to landing."""
    flying = flight.airborne
    estimate = flight.on_state_ticks(Estimate)
    return root_mean_square(attitude_angle(estimate["q_WB"][flying], flight.state["q_WB"][flying]))


def wrench_errors(flight: FlightData) -> Points:
    """Observed less true external wrench about O_b, (n, 6) N and N·m in B.

    Between take-off and landing: the push of the ground on the landing gear, which ends within
    one tick, would drown what the observer is for.
    """
    free = flight.off_ground
    estimate = flight.on_state_ticks(Estimate)
    errors: Points = estimate["wrench_B"][free] - flight.state["wrench_ext_B"][free]
    return errors


def wrench_force_rmse(flight: FlightData) -> float:
    """RMS length of the observer's force error, N."""
    return root_mean_square(np.linalg.norm(wrench_errors(flight)[:, :3], axis=1))


def wrench_torque_rmse(flight: FlightData) -> float:
    """RMS length of the observer's torque error, N·m."""
    return root_mean_square(np.linalg.norm(wrench_errors(flight)[:, 3:], axis=1))
