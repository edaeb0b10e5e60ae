"""Rows of the log made ready for drawing: presence, alignment in time, attitudes as angles."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Record
from inspect_cli.spatial.arrays import Mask, Points, Structured, Vector


def rows_of(log: RunLog, record: type[Record]) -> Structured | None:
    """The record's rows, or None when the log has none (a real flight knows no truth)."""
    rows = log.rows(record)
    return None if rows is None or len(rows) == 0 else rows


def held_at(rows: Structured, t_s: Vector) -> Structured:
    """The latest row at or before each time (sample and hold); the first row before all."""
    index = np.searchsorted(rows["t_s"], t_s, side="right") - 1
    return rows[np.clip(index, 0, len(rows) - 1)]


def rotations(q: Points) -> tuple[Rotation, Mask]:
    """(rotations, whether each is one) of quaternions (n, 4) wxyz.

    A diverged flight may hold NaN or zeros; those become the identity and are marked False.
    """
    norm = np.linalg.norm(np.where(np.isfinite(q), q, 0.0), axis=1)
    good: Mask = np.isfinite(q).all(axis=1) & (norm > 1e-6) & (norm < 1e6)
    whole = np.where(good[:, None], q, [1.0, 0.0, 0.0, 0.0])
    return Rotation.from_quat(whole, scalar_first=True), good


def roll_pitch_yaw_deg(q: Points) -> Points:
    """Roll, pitch, yaw (n, 3) in degrees, R = R_z R_y R_x, without jumps of a whole turn."""
    turn, good = rotations(q)
    angles: Points = turn.as_euler("ZYX", suppress_warnings=True)[:, ::-1]
    result: Points = np.full(angles.shape, np.nan)
    result[good] = np.rad2deg(np.unwrap(angles[good], axis=0))
    return result


def attitude_difference_mrad(q_from: Points, q_to: Points) -> Points:
    """Log(R_fromᵀ R_to) (n, 3) in mrad: the right perturbation that leads from one to the other."""
    first, first_good = rotations(q_from)
    second, second_good = rotations(q_to)
    difference: Points = 1e3 * (first.inv() * second).as_rotvec()
    difference[~(first_good & second_good)] = np.nan
    return difference


def turned_to_body(q_WB: Points, x_W: Points) -> Points:
    """R_WBᵀ x_W for rows of quaternions and vectors; NaN where the attitude is none."""
    return turned_to_world(q_WB * np.array([1.0, -1.0, -1.0, -1.0]), x_W)


def turned_to_world(q_WB: Points, x_B: Points) -> Points:
    """R_WB x_B for rows of quaternions and vectors; NaN where the attitude is none."""
    turn, good = rotations(q_WB)
    x_W: Points = turn.apply(np.where(np.isfinite(x_B), x_B, 0.0))
    x_W[~(good & np.isfinite(x_B).all(axis=1))] = np.nan
    return x_W
