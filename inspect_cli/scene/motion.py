"""How the vehicle moved, from the log: the truth of a simulation, else its own estimate."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.log.reader import RunLog
from inspect_cli.records import Command, Estimate, State
from inspect_cli.spatial.arrays import Indices, Points, Vector
from inspect_cli.vehicles.actuators import Servo, of_kind
from inspect_cli.vehicles.kinds import Vehicle

FAR_M = 200.0
"""A flight that ends farther away than this from where it began has diverged."""
LEAST_ROWS = 2
MOST_ROWS = 6000
"""Largest number of rows: a film of 15 minutes of flight still has more than six rows a second."""


@dataclass(frozen=True, eq=False)
class Motion:
    """Rows of a flight in order of time, all of them finite."""

    t_s: Vector
    qpos: Points
    """(n, 7 + n_joints): p_WB, q_WB and the joints, as the vehicle's model takes them."""
    p_WT: Points
    """(n, 3) of the tool's tip, W, m."""
    source: Literal["truth", "estimate"]
    cut: bool
    """Whether the flight went on after the last row, but no longer in numbers that can be drawn."""

    def at(self, t_s: Vector) -> Indices:
        """The rows (m,) that are last at or before each time; the first one before all."""
        rows = np.searchsorted(self.t_s, t_s, side="right") - 1
        return np.clip(rows, 0, len(self.t_s) - 1).astype(np.int32)


def motion_of(log: RunLog, model: mujoco.MjModel, vehicle: Vehicle) -> Motion | None:
    """The motion of a vehicle with its nominal ``model``; None where no pose was logged."""
    state, estimate = log.rows(State), log.rows(Estimate)
    rows, source = (state, "truth") if state is not None else (estimate, "estimate")
    if rows is None or rows.size < LEAST_ROWS:
        return None
    joints = rows["joint_angle"] if state is not None else _commanded(log, rows["t_s"], vehicle)
    qpos = np.zeros((rows.size, model.nq))
    qpos[:, :3], qpos[:, 3:7] = rows["p_WB"], rows["q_WB"]
    if joints.shape[1] == len(vehicle.joints):
        places = [int(model.joint(name).qposadr[0]) for name in vehicle.joints]
        qpos[:, places] = np.nan_to_num(joints)
    whole = _leading_finite(rows["t_s"], qpos)
    if whole < LEAST_ROWS:
        return None
    stride = -(-whole // MOST_ROWS)
    t_s, kept = rows["t_s"][:whole:stride].copy(), qpos[:whole:stride].copy()
    kept[:, 3:7] /= np.linalg.norm(kept[:, 3:7], axis=1, keepdims=True)
    return Motion(
        t_s,
        kept,
        _tips(model, kept),
        "truth" if source == "truth" else "estimate",
        whole < rows.size,
    )


def _leading_finite(t_s: Vector, qpos: Points) -> int:
    """Number of rows before the first that cannot be drawn."""
    with np.errstate(invalid="ignore", over="ignore"):
        away = np.linalg.norm(qpos[:, :3] - qpos[0, :3], axis=1)
        turned = np.linalg.norm(qpos[:, 3:7], axis=1)
        good = np.isfinite(t_s) & np.all(np.isfinite(qpos), axis=1)
        good &= (away < FAR_M) & (np.abs(turned - 1.0) < 0.1)
    return len(good) if good.all() else int(np.argmin(good))


def _commanded(log: RunLog, t_s: Vector, vehicle: Vehicle) -> Points:
    """Joint angles (n, n_joints) as last commanded; a real vehicle may log no others.

    Joints without a servo stay at zero.
    """
    rows = log.rows(Command)
    angles: Points = np.zeros((len(t_s), len(vehicle.joints)))
    servos = of_kind(vehicle.actuators, Servo)
    if rows is None or rows.size == 0 or rows["joint_angle"].shape[1] != len(servos):
        return angles
    last = np.clip(np.searchsorted(rows["t_s"], t_s, side="right") - 1, 0, rows.size - 1)
    angles[:, [vehicle.joints.index(servo.joint) for servo in servos]] = rows["joint_angle"][last]
    return angles


def _tips(model: mujoco.MjModel, qpos: Points) -> Points:
    """Places (n, 3) of the tool's tip by the nominal model."""
    data = mujoco.MjData(model)
    site = model.site(TOOL).id
    tips = np.zeros((len(qpos), 3))
    for row, tip in zip(qpos, tips, strict=True):
        data.qpos[:] = row
        mujoco.mj_kinematics(model, data)
        tip[:] = data.site_xpos[site]
    return tips
