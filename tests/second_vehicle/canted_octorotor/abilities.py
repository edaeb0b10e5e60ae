"""What planning and guidance may know of a canted octorotor."""

from __future__ import annotations

import numpy as np

from canted_octorotor.file_model import (
    N_ROTORS,
    CantedOctorotorPlatform,
    rotor_geometry,
    tool_in_body,
)
from canted_octorotor.fixed_allocation import FixedAllocation
from inspect_cli.control.impedance import GRAVITY_MPS2, RigidBody, steady_press_force
from inspect_cli.interfaces import (
    TOOL,
    ContactLaw,
    DepthLaw,
    Goals,
    Loads,
    Margin,
    Margins,
    Posture,
    Pressing,
    Shortfall,
)
from inspect_cli.schema.tasks import tasks_with
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR

AIR_DENSITY_KGPM3 = 1.225
WRIST_SPHERE_M = 0.04
LEVEL = 1e-6


class CantedOctorotorCapabilities:
    """The body stays level: heading and position are the body's, the pitch is the wrist's."""

    def __init__(self, platform: CantedOctorotorPlatform, body: RigidBody) -> None:
        self._platform = platform
        self._body = body
        self._allocation = FixedAllocation(platform.rotors)
        self.lengths = {"n_rotors": N_ROTORS, "n_joints": 1, "n_servos": 1, "n_arm": 1}
        self.max_speed_mps = platform.limits.speed_mps
        self.max_acceleration_mps2 = platform.limits.acceleration_mps2
        self.max_angular_rate_radps = platform.limits.angular_rate_radps
        self.standing_height_m = platform.core.gear_height_m
        self.frames = (TOOL,)
        self.tasks = tasks_with(BEHAVIOUR.modes)
        self.impedances = tuple(platform.control.profiles)

    def frame_pose(self, posture: Posture, frame: str) -> tuple[Vector, Matrix]:
        if frame != TOOL:
            raise ValueError(f"no frame is named '{frame}'; there is: {TOOL}")
        R_WB = quaternion_to_matrix(posture.q_WB)
        p_BT, R_BT = tool_in_body(self._platform.wrist, _angle(posture))
        return posture.p_WB + R_WB @ p_BT, R_WB @ R_BT

    def solve(self, goals: Goals, loads: Loads, near: Posture) -> Posture | Shortfall:
        """y_B = y_T has to be level, and z_T within the wrist's range of x_B."""
        p_WT, R_WT = goals[TOOL].p, goals[TOOL].R
        y, z_T = R_WT[:, 1], R_WT[:, 2]
        if abs(y[2]) > LEVEL:
            return Shortfall()
        R_WB = np.column_stack([[y[1], -y[0], 0.0], [y[0], y[1], 0.0], [0.0, 0.0, 1.0]])
        angle = np.arctan2(-z_T[2], z_T @ R_WB[:, 0])
        if abs(angle) > np.radians(self._platform.wrist.range_deg):
            return Shortfall()
        p_BT, _ = tool_in_body(self._platform.wrist, angle)
        return Posture(p_WT - R_WB @ p_BT, matrix_to_quaternion(R_WB), np.array([angle]))

    def collision_spheres(self, posture: Posture) -> Points:
        core, rotors, wrist = self._platform.core, self._platform.rotors, self._platform.wrist
        centers = np.vstack(
            [
                np.zeros(3),
                rotor_geometry(rotors)[0],
                wrist.position_B_m,
                np.array(wrist.position_B_m) + 0.5 * wrist.length_m * self._axis_B(posture),
            ]
        )
        radii = [core.radius_m, *[rotors.radius_m] * N_ROTORS, WRIST_SPHERE_M, WRIST_SPHERE_M]
        R_WB = quaternion_to_matrix(posture.q_WB)
        return np.column_stack([posture.p_WB + centers @ R_WB.T, radii])

    def margins(self, posture: Posture, loads: Loads) -> Margins:
        """Thrust left above or below in the worst rotor, and the wrist's way to its limit."""
        thrusts = self._thrusts(posture, loads)
        left_n = float(np.minimum(thrusts, self._platform.rotors.max_thrust_n - thrusts).min())
        reach = np.radians(self._platform.wrist.range_deg)
        left_rad = float(reach - abs(_angle(posture)))
        lack_n = f"asks for {-left_n:.2f} N more than a rotor can give"
        lack_rad = f"asks the wrist to turn {np.degrees(-left_rad):.1f}° beyond its limit"
        return {
            "thrust": Margin(left_n, "N", lack_n, "press less deep"),
            "wrist": Margin(left_rad, "rad", lack_rad, "touch a surface that leans less"),
        }

    def contact_law(self, pressing: Pressing, profile: str) -> ContactLaw:
        _, R_BT = tool_in_body(self._platform.wrist, 0.0)
        control = self._platform.control
        force_n = steady_press_force(control, control.profiles[profile], R_BT, pressing.press_m)
        return DepthLaw(pressing.press_m, profile, force_n)

    def power_w(self, posture: Posture, loads: Loads) -> float:
        thrusts = np.maximum(self._thrusts(posture, loads), 0.0)
        area = np.pi * self._platform.rotors.radius_m**2
        induced = float(np.sum(thrusts**1.5)) / np.sqrt(2.0 * AIR_DENSITY_KGPM3 * area)
        battery = self._platform.battery
        return float(induced / battery.figure_of_merit + battery.avionics_w)

    def _thrusts(self, posture: Posture, loads: Loads) -> Vector:
        """What the rotors give at rest under a load on the tool."""
        wrench_W = loads.get(TOOL, np.zeros(6))
        R_WB = quaternion_to_matrix(posture.q_WB)
        p_BT, _ = tool_in_body(self._platform.wrist, _angle(posture))
        force_B, torque_B = R_WB.T @ wrench_W[:3], R_WB.T @ wrench_W[3:]
        pushed = np.concatenate([force_B, torque_B + np.cross(p_BT, force_B)])
        return self._allocation.thrusts(self._weight_B(R_WB) - pushed)

    def _weight_B(self, R_WB: Matrix) -> Vector:
        """The wrench (6,) that carries the weight."""
        up_B = self._body.mass_kg * GRAVITY_MPS2 * R_WB[2]
        return np.concatenate([up_B, np.cross(self._body.com_B, up_B)])

    def _axis_B(self, posture: Posture) -> Vector:
        return tool_in_body(self._platform.wrist, _angle(posture))[1][:, 2]


def _angle(posture: Posture) -> float:
    return float(posture.joint_angle[0]) if posture.joint_angle.size else 0.0
