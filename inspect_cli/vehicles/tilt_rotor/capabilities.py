"""What planning and guidance may know of a tilt-rotor vehicle with a rigid arm."""

from __future__ import annotations

import numpy as np

from inspect_cli.control.impedance import RigidBody, steady_press_force
from inspect_cli.control.tilt_allocation import TiltAllocation
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
from inspect_cli.records import Lengths
from inspect_cli.schema.tasks import tasks_with
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.constants import AIR_DENSITY_KGPM3, GRAVITY_MPS2
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR
from inspect_cli.vehicles.tilt_rotor.model import tool_transform

ARM_SPHERE_M = 0.03
BODY = "body"
"""The frame B."""
BARE_TIP_SHARE = 0.35
"""The last part of the tool that may come close to what it touches."""


class TiltRotorCapabilities:
    """Kinematics and margins of a rigid tilt-rotor vehicle, from its nominal numbers."""

    def __init__(
        self,
        platform: TiltRotorPlatform,
        body: RigidBody,
        allocation: TiltAllocation,
    ) -> None:
        self._platform = platform
        self._body = body
        self._allocation = allocation
        self._p_BT, self._R_BT = tool_transform(platform)
        self._frames_B = {BODY: (np.zeros(3), np.eye(3)), TOOL: (self._p_BT, self._R_BT)}
        self.frames = tuple(self._frames_B)
        self.tasks = tasks_with(BEHAVIOUR.modes)
        self._spheres_B = _collision_spheres_B(platform)
        n = len(platform.groups)
        self.lengths: Lengths = {"n_rotors": 2 * n, "n_joints": n, "n_servos": n}
        self.max_speed_mps = platform.limits.speed_mps
        self.max_acceleration_mps2 = platform.limits.acceleration_mps2
        self.max_angular_rate_radps = platform.limits.angular_rate_radps
        self.standing_height_m = platform.core.gear_height_m
        self.impedances = tuple(platform.control.profiles)

    def frame_pose(self, posture: Posture, frame: str) -> tuple[Vector, Matrix]:
        """(p_WF, R_WF) of a frame in a posture."""
        p_BF, R_BF = self._in_body(frame)
        R_WB = quaternion_to_matrix(posture.q_WB)
        return posture.p_WB + R_WB @ p_BF, R_WB @ R_BF

    def solve(self, goals: Goals, loads: Loads, near: Posture) -> Posture | Shortfall:
        """The one posture of a rigid vehicle that puts a frame there; it can push anywhere."""
        if len(goals) != 1:
            return Shortfall("a rigid vehicle brings one frame to one place")
        ((frame, goal),) = goals.items()
        p_BF, R_BF = self._in_body(frame)
        R_WB = goal.R @ R_BF.T
        return Posture(goal.p - R_WB @ p_BF, matrix_to_quaternion(R_WB))

    def collision_spheres(self, posture: Posture) -> Points:
        """Spheres (n, 4) = (p_W, radius) that cover the vehicle but the tool's last part."""
        spheres = self._spheres_B.copy()
        R_WB = quaternion_to_matrix(posture.q_WB)
        spheres[:, :3] = posture.p_WB + spheres[:, :3] @ R_WB.T
        return spheres

    def margins(self, posture: Posture, loads: Loads) -> Margins:
        """Thrust left in the busiest group, and tilt left where it is limited."""
        needed = self._needed_B(posture, loads)
        unit = self._platform.unit
        thrust = unit.max_thrust_n - float(self._allocation.group_thrusts(needed).max())
        margins = {"thrust": thrust_margin(thrust)}
        if unit.range_deg is not None:
            tilt = float(np.abs(self._allocation.group_tilts(needed)).max())
            margins["tilt"] = tilt_margin(float(np.radians(unit.range_deg)) - tilt)
        return margins

    def contact_law(self, pressing: Pressing, profile: str) -> ContactLaw:
        """The set-point behind the surface, and the force that the profile makes of it."""
        control, depth_m = self._platform.control, pressing.press_m
        force_n = steady_press_force(control, control.profiles[profile], self._R_BT, depth_m)
        return DepthLaw(depth_m, profile, force_n)

    def power_w(self, posture: Posture, loads: Loads) -> float:
        """Electrical power at rest: ideal induced power over figure of merit, plus avionics.

        P = Σ T^1.5 / √(2 ρ A) / FM + avionics, one actuator disc per rotor (Leishman,
        Principles of Helicopter Aerodynamics, §2.2).
        """
        thrust = 0.5 * self._allocation.group_thrusts(self._needed_B(posture, loads))
        area = np.pi * self._platform.rotor.radius_m**2
        induced = 2.0 * float(np.sum(thrust**1.5)) / np.sqrt(2.0 * AIR_DENSITY_KGPM3 * area)
        battery = self._platform.battery
        return float(induced / battery.figure_of_merit + battery.avionics_w)

    def _needed_B(self, posture: Posture, loads: Loads) -> Vector:
        """The wrench (6,) about O_b in B that the rotors give at rest under the loads."""
        R_WB = quaternion_to_matrix(posture.q_WB)
        up_B = self._body.mass_kg * GRAVITY_MPS2 * R_WB[2]
        force_B, torque_B = up_B, np.cross(self._body.com_B, up_B)
        for frame, wrench_W in loads.items():
            pushed_B = R_WB.T @ wrench_W[:3]
            force_B = force_B - pushed_B
            p_BF, _ = self._in_body(frame)
            torque_B = torque_B - (R_WB.T @ wrench_W[3:] + np.cross(p_BF, pushed_B))
        return np.concatenate([force_B, torque_B])

    def _in_body(self, frame: str) -> tuple[Vector, Matrix]:
        """(p_BF, R_BF) of a frame."""
        if frame not in self._frames_B:
            raise ValueError(f"no frame is named '{frame}'; there are: {', '.join(self.frames)}")
        return self._frames_B[frame]


def thrust_margin(left_n: float) -> Margin:
    """What is left of the thrust of a rotor group, N."""
    lack = f"asks for {-left_n:.2f} N more than a rotor group can give"
    return Margin(left_n, "N", lack, "press less deep, or touch a surface that needs less tilt")


def tilt_margin(left_rad: float) -> Margin:
    """What is left of a joint's range, rad."""
    lack = f"asks a joint to turn {np.degrees(-left_rad):.1f}° beyond its limit"
    return Margin(left_rad, "rad", lack, "use a tool at another angle")


def _collision_spheres_B(platform: TiltRotorPlatform) -> Points:
    """Core, rotor discs and the inner part of the arm, in B."""
    core, unit, tool = platform.core, platform.unit, platform.tool
    spheres = [(0.0, 0.0, 0.0, core.radius_m)]
    for group in platform.groups:
        psi = np.radians(group.azimuth_deg)
        x, y = unit.distance_m * np.cos(psi), unit.distance_m * np.sin(psi)
        spheres.append((x, y, 0.0, platform.rotor.radius_m))
    p_BT, _ = tool_transform(platform)
    reach = (1.0 - BARE_TIP_SHARE) * tool.length_m
    for distance in np.arange(core.radius_m, reach, ARM_SPHERE_M):
        x, y, z = distance * p_BT / tool.length_m
        spheres.append((float(x), float(y), float(z), ARM_SPHERE_M))
    return np.array(spheres)
