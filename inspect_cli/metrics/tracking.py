"""How closely the vehicle followed its reference."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, largest, root_mean_square
from inspect_cli.metrics.geometry import attitude_angle
from inspect_cli.spatial.arrays import Points, Vector

CONTACT_MARGIN_S = 0.5
"""How long before and after a touch tracking is not asked for (ledger row A8.track)."""


def tool_errors(flight: FlightData) -> Points:
    """Logged reference p_WT less true p_WT, (n, 3) m in W, out of contact.

    From take-off to landing less every touch ± 0.5 s: while the tool presses, the set-point lies
    behind the surface on purpose (Bodie et al., section V-E, fig. 10).
    """
    free = flight.airborne & ~flight.near_touch(CONTACT_MARGIN_S)
    errors: Points = flight.reference["p_WT"][free] - flight.state["p_WT"][free]
    return errors


def position_rmse_x(flight: FlightData) -> float:
    """RMS of the tool's position error along x_W, m, out of contact."""
    return root_mean_square(tool_errors(flight)[:, 0])


def position_rmse_y(flight: FlightData) -> float:
    """RMS of the tool's position error along y_W, m, out of contact."""
    return root_mean_square(tool_errors(flight)[:, 1])


def position_rmse_z(flight: FlightData) -> float:
    """RMS of the tool's position error along z_W, m, out of contact."""
    return root_mean_square(tool_errors(flight)[:, 2])


def position_rmse_max_axis(flight: FlightData) -> float:
    """The largest of the three RMS errors, m."""
    errors = tool_errors(flight)
    return max(root_mean_square(errors[:, axis]) for axis in range(3))


def tool_error_p95(flight: FlightData) -> float:
    """95th percentile of the tool's distance from its reference, m, out of contact."""
    distances = np.linalg.norm(tool_errors(flight), axis=1)
    largest(distances)  # says why when there is none
    return float(np.percentile(distances, 95.0))


def attitude_errors(flight: FlightData) -> Vector:
    """Angle between the reference's and the true attitude, (n,) rad, contacts included."""
    flying = flight.airborne
    return attitude_angle(flight.reference["q_WB"][flying], flight.state["q_WB"][flying])


def attitude_rmse(flight: FlightData) -> float:
    """RMS of the attitude error, rad."""
    return root_mean_square(attitude_errors(flight))


def attitude_max(flight: FlightData) -> float:
    """Largest attitude error, rad."""
    return largest(attitude_errors(flight))
