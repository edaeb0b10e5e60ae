"""Two small vehicles for the planner's tests: a rigid arm, and an arm with one joint."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import TOOL, DepthLaw, Posture, Shortfall
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix
from inspect_cli.vehicles.tilt_rotor.capabilities import thrust_margin, tilt_margin

WEIGHT_N = 46.6
Y_B = np.array([0.0, 1.0, 0.0])


def tool_direction(pitch_rad):
    """z_T in B for a tool turned from −z_B towards x_B."""
    return np.array([np.sin(pitch_rad), 0.0, -np.cos(pitch_rad)])


def tool_axes(pitch_rad):
    """R_BT."""
    z = tool_direction(pitch_rad)
    return np.column_stack([np.cross(Y_B, z), Y_B, z])


@dataclass(frozen=True)
class RigidVehicle:
    """Tool along x_B (``pitch_deg`` 90) or 30° from z_B upwards (150); disc of radius 0.42 m."""

    pitch_deg: float = 90.0
    length_m: float = 0.55
    max_thrust_n: float = 120.0
    max_tilt_deg: float | None = None
    max_speed_mps: float = 1.0
    max_acceleration_mps2: float = 1.0
    max_angular_rate_radps: float = 1.0
    impedances: tuple[str, ...] = ("contact_ndt",)
    standing_height_m: float = 0.25
    frames: tuple[str, ...] = (TOOL,)
    tasks: frozenset[str] = frozenset()

    @property
    def lengths(self):
        return {"n_rotors": 12, "n_joints": 6, "n_servos": 6}

    def frame_pose(self, posture, frame):
        assert frame == TOOL
        R_WB = quaternion_to_matrix(posture.q_WB)
        pitch = np.radians(self.pitch_deg)
        return (
            posture.p_WB + R_WB @ (self.length_m * tool_direction(pitch)),
            R_WB @ tool_axes(pitch),
        )

    def solve(self, goals, loads, near):
        p_WT, R_WT = goals[TOOL].p, goals[TOOL].R
        pitch = np.radians(self.pitch_deg)
        R_WB = R_WT @ tool_axes(pitch).T
        p_WB = p_WT - R_WB @ (self.length_m * tool_direction(pitch))
        return Posture(p_WB, matrix_to_quaternion(R_WB))

    def collision_spheres(self, posture):
        angles = np.arange(6) * np.pi / 3.0
        rotors = np.column_stack([0.3 * np.cos(angles), 0.3 * np.sin(angles), np.zeros(6)])
        centers = np.vstack([np.zeros(3), rotors])
        radii = np.array([0.2, *[0.12] * 6])
        R_WB = quaternion_to_matrix(posture.q_WB)
        return np.column_stack([posture.p_WB + centers @ R_WB.T, radii])

    def margins(self, posture, loads):
        needed = np.array([0.0, 0.0, WEIGHT_N]) - loads.get(TOOL, np.zeros(6))[:3]
        thrust = (self.max_thrust_n - np.linalg.norm(needed)) / 6.0
        if self.max_tilt_deg is None:
            return {"thrust": thrust_margin(thrust)}
        z_B = quaternion_to_matrix(posture.q_WB)[:, 2]
        tilt = np.arccos(np.clip(z_B @ needed / np.linalg.norm(needed), -1.0, 1.0))
        left = np.radians(self.max_tilt_deg) - tilt
        return {"thrust": thrust_margin(thrust), "tilt": tilt_margin(left)}

    def contact_law(self, pressing, profile):
        return DepthLaw(pressing.press_m, profile, 18.0 * pressing.press_m)

    def power_w(self, posture, loads):
        return 500.0 + 100.0 * (1.0 - quaternion_to_matrix(posture.q_WB)[2, 2])


@dataclass(frozen=True)
class ArmVehicle:
    """Hovers level; its arm of 0.6 m turns about y_B between two angles from −z_B."""

    low_deg: float = 20.0
    high_deg: float = 160.0
    length_m: float = 0.6
    rest_deg: float = 90.0
    max_speed_mps: float = 1.0
    max_acceleration_mps2: float = 1.0
    max_angular_rate_radps: float = 1.0
    impedances: tuple[str, ...] = ("contact_ndt",)
    standing_height_m: float = 0.25
    frames: tuple[str, ...] = (TOOL,)
    tasks: frozenset[str] = frozenset()

    @property
    def lengths(self):
        return {"n_rotors": 4, "n_joints": 1, "n_servos": 1}

    def angle(self, posture):
        return posture.joint_angle[0] if posture.joint_angle.size else np.radians(self.rest_deg)

    def frame_pose(self, posture, frame):
        assert frame == TOOL
        R_WB = quaternion_to_matrix(posture.q_WB)
        angle = self.angle(posture)
        tip = posture.p_WB + R_WB @ (self.length_m * tool_direction(angle))
        return tip, R_WB @ tool_axes(angle)

    def solve(self, goals, loads, near):
        p_WT, R_WT = goals[TOOL].p, goals[TOOL].R
        y_B, z_B = R_WT[:, 1], np.array([0.0, 0.0, 1.0])
        if abs(y_B[2]) > 1e-9:
            return Shortfall()
        x_B = np.cross(y_B, z_B)
        angle = np.arctan2(R_WT[:, 2] @ x_B, -R_WT[2, 2])
        if not np.radians(self.low_deg) <= angle <= np.radians(self.high_deg):
            return Shortfall()
        p_WB = p_WT - self.length_m * R_WT[:, 2]
        q_WB = matrix_to_quaternion(np.column_stack([x_B, y_B, z_B]))
        return Posture(p_WB, q_WB, np.array([angle]))

    def collision_spheres(self, posture):
        R_WB = quaternion_to_matrix(posture.q_WB)
        arm = posture.p_WB + R_WB @ (0.4 * tool_direction(self.angle(posture)))
        return np.array([[*posture.p_WB, 0.2], [*arm, 0.05]])

    def margins(self, posture, loads):
        pushed = float(np.linalg.norm(loads.get(TOOL, np.zeros(6))))
        return {"thrust": thrust_margin(10.0 - 0.1 * pushed)}

    def contact_law(self, pressing, profile):
        return DepthLaw(pressing.press_m, profile, 10.0 * pressing.press_m)

    def power_w(self, posture, loads):
        return 300.0
