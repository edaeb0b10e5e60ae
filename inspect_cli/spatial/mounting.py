"""Pose of a frame D that is fixed to the body or to the tool.

    p_WD = p_WF + R_WF p_FD        R_WD = R_WA R_AD

F, to which the origin is fixed, and A, with which the axes turn, are each B or T. They differ for a
camera that sits where the last joint's axes meet: its origin stays put in B while it turns with T.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import quaternion_exp, quaternion_to_matrix, rotate


class Mount(Protocol):
    """Where a sensor is mounted; ``schema.vehicle.MountModel`` is one."""

    @property
    def frame(self) -> str:
        """F: ``body`` or ``tool``."""
        ...

    @property
    def position_m(self) -> tuple[float, float, float]:
        """p_FD."""
        ...

    @property
    def axes(self) -> str | None:
        """A: ``body`` or ``tool``; F without it."""
        ...

    @property
    def rotation_rad(self) -> tuple[float, float, float]:
        """The rotation vector of R_AD."""
        ...


class Mounting:
    """The frame D of one sensor."""

    def __init__(self, mount: Mount) -> None:
        self._on_tool = mount.frame == "tool"
        self._position = np.array(mount.position_m)
        self._turns_with_tool = (mount.axes or mount.frame) == "tool"
        self._R_AD: Matrix | None = None
        if any(mount.rotation_rad):
            self._R_AD = quaternion_to_matrix(quaternion_exp(np.array(mount.rotation_rad)))

    def pose(self, p_WB: Vector, q_WB: Vector, p_WT: Vector, R_WT: Matrix) -> tuple[Vector, Matrix]:
        """(p_WD, R_WD) with the body and the tool there; R_WD is ``R_WT`` itself if the axes are
        the tool's.
        """
        if self._on_tool:
            p_WD = p_WT + R_WT @ self._position
        else:
            p_WD = p_WB + rotate(q_WB, self._position)
        R_WA = R_WT if self._turns_with_tool else quaternion_to_matrix(q_WB)
        return p_WD, R_WA if self._R_AD is None else R_WA @ self._R_AD
