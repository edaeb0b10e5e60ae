"""Statics and kinematics of a pitching crawler: what a planner may ask of it.

The rotors push along z_B alone. To carry a force F on the vehicle they must give m g ẑ − F, so the
vehicle leans until z_B is along that: with a horizontal load, m g tan θ = |F|. The arm's angle
follows from the balance about its sprung hinge; nobody commands it.
"""

from __future__ import annotations

from collections.abc import Collection

import numpy as np
from scipy.optimize import brentq

from inspect_cli.control.impedance import RigidBody
from inspect_cli.interfaces import (
    FREE,
    TOOL,
    ForceLaw,
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
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix
from pitching_crawler.file_model import FOOT, CoplanarRotors, CrawlerPlatform, rotor_geometry
from pitching_crawler.task_models import Push

AIR_DENSITY_KGPM3 = 1.225
LEVEL_RAD = 1e-3
"""The foot is held square to a level ceiling only."""
LEAST_RISE = 0.05
"""A tool's axis closer to the vertical than this gives no heading."""
HUB_SPHERE_M, ARM_SPHERE_M = 0.10, 0.05
ARM_SHARES = (0.3, 0.5, 0.7)
"""Where the spheres on the arm sit, as shares of its length; the rest is the tool's last part."""


class CrawlerAbilities:
    """Postures that carry loads, and the thrust that is left."""

    impedances: tuple[str, ...] = ()

    def __init__(self, platform: CrawlerPlatform, body: RigidBody, modes: Collection[str]) -> None:
        self._platform = platform
        self._body = body
        self._n_rotors = platform.rotors.count
        self.lengths = {
            "n_rotors": self._n_rotors, "n_joints": 2, "n_servos": 0, "n_drives": 1, "n_arm": 1,
        }  # fmt: skip
        self.allocation = allocation_matrix(platform.rotors)
        self._inverse = np.linalg.pinv(self.allocation)
        self.max_speed_mps = platform.limits.speed_mps
        self.max_acceleration_mps2 = platform.limits.acceleration_mps2
        self.max_angular_rate_radps = platform.limits.angular_rate_radps
        self.standing_height_m = platform.hub.gear_height_m
        self.frames = (TOOL, FOOT)
        self.tasks = tasks_with(modes)

    def frame_pose(self, posture: Posture, frame: str) -> tuple[Vector, Matrix]:
        """Place (3,) in W and axes (3, 3) of a frame."""
        R_WB = quaternion_to_matrix(posture.q_WB)
        if frame == FOOT:
            return posture.p_WB + R_WB @ [0.0, 0.0, self._platform.foot.height_m], R_WB
        p_BT, R_BT = self._tool(hinge_angle(posture))
        return posture.p_WB + R_WB @ p_BT, R_WB @ R_BT

    def solve(self, goals: Goals, loads: Loads, near: Posture) -> Posture | Shortfall:
        """The posture that puts a frame there and carries the loads (6,), which act on it in W.

        Of the tool, place and heading are met; its inclination follows from body and arm.
        """
        force = sum((load[:3] for load in loads.values()), np.zeros(3))
        thrust = np.array([0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]) - force
        limit = self._n_rotors * self._platform.rotors.max_thrust_n
        if np.linalg.norm(thrust) > limit:
            lack_n = np.linalg.norm(thrust) - limit
            return Shortfall(f"it needs {lack_n:.2f} N more thrust", "push less")
        [(frame, goal)] = goals.items()
        ahead = goal.R[:, 2] if frame == TOOL else goal.R[:, 0]
        if np.hypot(ahead[0], ahead[1]) < LEAST_RISE:
            return Shortfall(f"the {frame} has no heading")
        R_WB = axes_along(thrust, np.arctan2(ahead[1], ahead[0]))
        if frame == FOOT and np.arccos(min(R_WB[2] @ goal.R[:, 2], 1.0)) > LEVEL_RAD:
            return Shortfall("the foot is square to the surface only without a horizontal load")
        angle = self._balanced_angle(R_WB, loads.get(TOOL, np.zeros(6)))
        at_origin = Posture(np.zeros(3), matrix_to_quaternion(R_WB), np.array([angle]))
        offset, _ = self.frame_pose(at_origin, frame)
        return Posture(goal.p - offset, at_origin.q_WB, at_origin.joint_angle)

    def margins(self, posture: Posture, loads: Loads) -> Margins:
        """Thrust left in the busiest rotor."""
        left_n = float(self._platform.rotors.max_thrust_n - self._thrusts(posture, loads).max())
        lack = f"asks for {-left_n:.2f} N more than a rotor can give"
        return {"thrust": Margin(left_n, "N", lack, "push less")}

    def collision_spheres(self, posture: Posture) -> Points:
        """Hub, rotor discs and the inner part of the arm, (n, 4)."""
        rotors, arm = self._platform.rotors, self._platform.arm
        _, R_BT = self._tool(hinge_angle(posture))
        along = [arm.hinge_B_m + share * arm.length_m * R_BT[:, 2] for share in ARM_SHARES]
        centers = np.vstack([np.zeros(3), rotor_geometry(rotors)[0], *along])
        radii = [HUB_SPHERE_M, *[rotors.radius_m] * rotors.count, *[ARM_SPHERE_M] * len(along)]
        R_WB = quaternion_to_matrix(posture.q_WB)
        return np.column_stack([posture.p_WB + centers @ R_WB.T, radii])

    def contact_law(self, pressing: Pressing | Push, profile: str) -> ForceLaw:
        """The force that the task states: a depth means nothing to it."""
        if not isinstance(pressing, Push):
            raise ValueError("a pitching crawler presses with a stated force")
        return ForceLaw(pressing.force_n)

    def power_w(self, posture: Posture, loads: Loads) -> float:
        """Induced power over figure of merit, and avionics."""
        thrusts = np.maximum(self._thrusts(posture, loads), 0.0)
        area = np.pi * self._platform.rotors.radius_m**2
        induced = float(np.sum(thrusts**1.5)) / np.sqrt(2.0 * AIR_DENSITY_KGPM3 * area)
        battery = self._platform.battery
        return float(induced / battery.figure_of_merit + battery.avionics_w)

    def com_B(self, angle: float) -> Vector:
        """Centre of mass (3,) of the whole vehicle with the arm at an angle."""
        lever_m = self._platform.arm_moment_kgm / self._body.mass_kg
        com: Vector = self._body.com_B + lever_m * np.array(
            [np.cos(angle) - 1.0, 0.0, -np.sin(angle)]
        )
        return com

    def _thrusts(self, posture: Posture, loads: Loads = FREE) -> Vector:
        """What each rotor gives at rest under the loads, (n_rotors,) N."""
        R_WB = quaternion_to_matrix(posture.q_WB)
        up_B = R_WB.T @ [0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]
        needed = np.concatenate([up_B, np.cross(self.com_B(hinge_angle(posture)), up_B)])
        for frame, load in loads.items():
            arm_B = R_WB.T @ (self.frame_pose(posture, frame)[0] - posture.p_WB)
            force_B, torque_B = R_WB.T @ load[:3], R_WB.T @ load[3:]
            needed -= np.concatenate([force_B, torque_B + np.cross(arm_B, force_B)])
        thrusts: Vector = self._inverse @ needed[2:]
        return thrusts

    def _tool(self, angle: float) -> tuple[Vector, Matrix]:
        z = np.array([np.cos(angle), 0.0, -np.sin(angle)])
        y = np.array([0.0, 1.0, 0.0])
        p_BT = np.array(self._platform.arm.hinge_B_m) + self._platform.tip_length_m * z
        return p_BT, np.column_stack([np.cross(y, z), y, z])

    def _balanced_angle(self, R_WB: Matrix, load: Vector) -> float:
        """k q = torque of weight and load about the hinge − torque of the level arm's weight."""
        platform = self._platform
        at_rest = platform.arm_moment_kgm * GRAVITY_MPS2
        weight_B = R_WB.T @ [0.0, 0.0, -at_rest]
        load_B = platform.tip_length_m * (R_WB.T @ load[:3])

        def imbalance(angle: float) -> float:
            _, R_BT = self._tool(angle)
            about_y = np.cross(R_BT[:, 2], weight_B + load_B)[1]
            return float(about_y - at_rest - platform.arm.hinge_stiffness_nmprad * angle)

        return float(brentq(imbalance, -1.0, 1.0))


def hinge_angle(posture: Posture) -> float:
    """The arm's angle; at rest where the posture states none."""
    return float(posture.joint_angle[0]) if posture.joint_angle.size else 0.0


def axes_along(thrust_W: Vector, heading: float) -> Matrix:
    """R_WB with z_B along a force and x_B as near to a heading as that allows."""
    z = thrust_W / np.linalg.norm(thrust_W)
    y = np.cross(z, [np.cos(heading), np.sin(heading), 0.0])
    y /= np.linalg.norm(y)
    return np.ascontiguousarray(np.column_stack([np.cross(y, z), y, z]))


def allocation_matrix(rotors: CoplanarRotors) -> Matrix:
    """A (4, n): thrust along z_B and torque (3,) about O_b, per newton of each rotor."""
    positions, spins = rotor_geometry(rotors)
    up = np.tile([0.0, 0.0, 1.0], (rotors.count, 1))
    torques = np.cross(positions, up) - spins[:, None] * rotors.moment_constant_m * up
    return np.vstack([np.ones(rotors.count), torques.T])
