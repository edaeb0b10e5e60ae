"""How far the estimated pose is from the true one, axis by axis, and when that error grows.

Position errors are in W. Attitude errors are the rotation vector Log(R_refᵀ R_est), whose
components about the body's axes are roll, pitch and yaw; it has no singular attitude.

The paper compares with the body of a motion capture system, whose frame M is not quite B:
R_WM = R_WB Exp(m) with m = ``body_misalignment_rad`` of the tracker. Errors against M are the ones
to hold against its Table IV; those against B are what the vehicle suffers from. The position of M
is that of B, and the noise of the motion capture, a millimetre, is left out.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured, root_mean_square
from inspect_cli.metrics.geometry import rotation_vectors
from inspect_cli.records import Estimate
from inspect_cli.schema.vehicle import PoseTrackerModel
from inspect_cli.spatial.arrays import Mask, Points, Vector
from inspect_cli.spatial.rotations import (
    quaternion_exp,
    rotate,
    rotate_back,
)

WINDOW_S = 1.0
"""Length of the windows over which the growth of the error is taken."""
MOVING_M = 0.1
"""A window is in motion when the body travels farther than this in it."""
HOVERING_M = 0.02
"""A window is quasi-static when it travels less than this."""


def position_rmse(flight: FlightData, axis: int) -> float:
    """RMS error of the estimated position along an axis of W, m, take-off to landing."""
    return root_mean_square(position_errors(flight)[flight.airborne, axis])


def attitude_rmse(flight: FlightData, axis: int, true_body: bool) -> float:
    """RMS error about an axis, rad, take-off to landing; against B, or against the tracker's M."""
    flying = flight.airborne
    estimate = flight.on_state_ticks(Estimate)["q_WB"][flying]
    reference = flight.state["q_WB"][flying]
    if not true_body:
        tracker = flight.platform.find(PoseTrackerModel)
        if tracker is None:
            raise NotMeasured("the platform has no tracker, whose frame this is held against")
        misalignment = np.array(tracker.body_misalignment_rad)
        reference = turned_frames(reference, misalignment)
    return root_mean_square(rotation_vectors(reference, estimate)[:, axis])


def turned_frames(q: Points, turn: Vector) -> Points:
    """R(q) Exp(turn), (n, 4): the frames q (n, 4) turned about their own axes by ``turn`` (3,)."""
    by = quaternion_exp(turn)
    return np.column_stack(
        [
            q @ (by * np.array([1.0, -1.0, -1.0, -1.0])),
            q @ np.array([by[1], by[0], by[3], -by[2]]),
            q @ np.array([by[2], -by[3], by[0], by[1]]),
            q @ np.array([by[3], by[2], -by[1], by[0]]),
        ]
    )


def position_errors(flight: FlightData) -> Points:
    """Estimated less true position of O_b in W, (n, 3) m, at every tick."""
    errors: Points = flight.on_state_ticks(Estimate)["p_WB"] - flight.state["p_WB"]
    return errors


def moving_over_hovering(flight: FlightData) -> float:
    """RMS growth of the position error in motion as a multiple of that at quasi-static hover.

    The growth is |e(t + 1 s) − e(t)| of the error vector e over windows that follow each other
    off the ground; a window is in motion with more than 0.1 m of true path, quasi-static with less
    than 0.02 m. An error that only adds up would be large in a late hover as well, so that the
    error itself would not tell the two apart.
    """
    times, errors = flight.state["t_s"], position_errors(flight)
    steps = np.linalg.norm(np.diff(flight.state["p_WB"], axis=0), axis=1)
    path = np.concatenate([np.zeros(1), np.cumsum(steps)])
    ends = _windows(times, flight.off_ground)
    travelled = path[ends[:, 1]] - path[ends[:, 0]]
    growth = np.linalg.norm(errors[ends[:, 1]] - errors[ends[:, 0]], axis=1)
    moving = root_mean_square(growth[travelled > MOVING_M])
    hovering = root_mean_square(growth[travelled < HOVERING_M])
    if hovering == 0.0:
        raise NotMeasured("the error does not change at all in hover")
    return moving / hovering


def drift_at_first_contact(flight: FlightData) -> float:
    """Distance between estimated and true position of the tool's tip at the first touch, m.

    p̂_WT = p̂_WB + R̂_WB p_BT with the true place p_BT of the tip on the body: what the arm's angles
    are believed to be is no part of it.
    """
    touches = np.flatnonzero(flight.touching)
    if len(touches) == 0:
        raise NotMeasured("the tool never touched anything")
    row, estimate = flight.state[touches[0]], flight.on_state_ticks(Estimate)[touches[0]]
    p_BT = rotate_back(row["q_WB"], row["p_WT"] - row["p_WB"])
    believed = estimate["p_WB"] + rotate(estimate["q_WB"], p_BT)
    return float(np.linalg.norm(believed - row["p_WT"]))


def _windows(times: Vector, inside: Mask) -> np.ndarray[tuple[int, int], np.dtype[np.intp]]:
    """First and last row (n, 2) of windows of 1 s that lie within ``inside`` as a whole."""
    rows: list[tuple[int, int]] = []
    for first in range(len(times)):
        if rows and times[first] < times[rows[-1][1]] - 1e-9:
            continue
        last = int(np.searchsorted(times, times[first] + WINDOW_S - 1e-9))
        if last < len(times) and inside[first : last + 1].all():
            rows.append((first, last))
    if not rows:
        raise NotMeasured("the flight never got to the phase that this is measured in")
    return np.array(rows, dtype=np.intp)
