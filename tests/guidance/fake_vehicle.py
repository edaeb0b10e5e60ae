"""A rigid vehicle with a tool and no opinion about actuators, for guidance alone."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from inspect_cli.interfaces import TOOL, DepthLaw, FramePose, Margin, Posture, Shortfall
from inspect_cli.schema.plan import MarginModel, PostureModel, Target
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix

R_BT_AHEAD = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
"""A tool along x_B: z_T = x_B, y_T = y_B."""


@dataclass
class FakeVehicle:
    """Reaches every pose of its tool at once, or none when ``reach`` is switched off."""

    p_BT: np.ndarray = field(default_factory=lambda: np.array([0.55, 0.0, 0.02]))
    R_BT: np.ndarray = field(default_factory=lambda: R_BT_AHEAD.copy())
    max_speed_mps: float = 1.0
    max_acceleration_mps2: float = 1.0
    max_angular_rate_radps: float = 0.7
    impedances: tuple[str, ...] = ("contact_ndt",)
    standing_height_m: float = 0.2
    reach: bool = True
    frames: tuple[str, ...] = (TOOL,)
    tasks: frozenset[str] = frozenset()

    @property
    def lengths(self):
        return {"n_rotors": 4, "n_joints": 0}

    def frame_pose(self, posture, frame):
        R_WB = quaternion_to_matrix(posture.q_WB)
        return posture.p_WB + R_WB @ self.p_BT, R_WB @ self.R_BT

    def solve(self, goals, loads, near):
        if not self.reach:
            return Shortfall("it reaches nothing")
        p_WT, R_WT = goals[TOOL].p, goals[TOOL].R
        R_WB = np.ascontiguousarray(R_WT @ self.R_BT.T)
        return Posture(p_WT - R_WB @ self.p_BT, matrix_to_quaternion(R_WB), near.joint_angle)

    def collision_spheres(self, posture):
        return np.array([[*posture.p_WB, 0.4]])

    def margins(self, posture, loads):
        return {"thrust": Margin(1.0, "N")}

    def contact_law(self, pressing, profile):
        return DepthLaw(pressing.press_m, profile, 18.0 * pressing.press_m)

    def power_w(self, posture, loads):
        return 500.0


class FakeArm(FakeVehicle):
    """A telescope of two joints: the tip moves out along x_B with the sum of their angles."""

    @property
    def lengths(self):
        return {"n_rotors": 4, "n_joints": 2, "n_servos": 2, "n_arm": 2}

    def frame_pose(self, posture, frame):
        R_WB = quaternion_to_matrix(posture.q_WB)
        p_BT = self.p_BT + np.array([0.1 * posture.joint_angle.sum(), 0.0, 0.0])
        return posture.p_WB + R_WB @ p_BT, R_WB @ self.R_BT


def target_at(vehicle, p_WC, n_W, R_WT, standoff_m=0.25, press_m=0.1) -> Target:
    """A contact target whose postures are the vehicle's own."""
    here = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))

    def model(depth):
        posture = vehicle.solve({TOOL: FramePose(p_WC - depth * n_W, R_WT)}, {}, here)
        return PostureModel(p_WB=tuple(posture.p_WB.tolist()), q_WB=tuple(posture.q_WB.tolist()))

    return Target(
        index=0,
        label="A1",
        kind="contact",
        impedance="contact_ndt",
        surface="wall",
        uv_m=(0.0, 0.0),
        p_WC=tuple(p_WC.tolist()),
        n_W=tuple(n_W.tolist()),
        q_WT=tuple(matrix_to_quaternion(np.ascontiguousarray(R_WT)).tolist()),
        sensor="half_cell",
        law=DepthLaw(press_m, "contact_ndt", 1.8),
        dwell_s=3.0,
        standoff_m=standoff_m,
        standoff=model(-standoff_m),
        contact=model(0.0),
        margins={"thrust": MarginModel(value=5.0, unit="N")},
        clearance_m=0.2,
    )
