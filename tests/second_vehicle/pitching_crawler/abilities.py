"""Statics and kinematics of a pitching crawler: what a planner may ask of it.

The rotors push along z_B alone. To carry a force F on the vehicle they must give m g ẑ − F, so the
vehicle leans until z_B is along that: with a horizontal load, m g tan θ = |F|. The arm's angle
follows from the balance about its sprung hinge; nobody commands it.
"""

from __future__ import annotations

import numpy as np
from scipy.optimize import brentq

from inspect_cli.control.impedance import RigidBody
from inspect_cli.interfaces import TOOL, Goals, Loads, Posture, Shortfall
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix
from pitching_crawler.mujoco_model import FOOT
from pitching_crawler.numbers import N_ROTORS, CrawlerNumbers, rotor_geometry

LEVEL_RAD = 1e-3
"""The foot is held square to a level ceiling only."""
LEAST_RISE = 0.05
"""A tool's axis closer to the vertical than this gives no heading."""


class CrawlerAbilities:
    """Postures that carry loads, and the thrust that is left."""

    def __init__(self, numbers: CrawlerNumbers, body: RigidBody) -> None:
        self._numbers = numbers
        self._body = body
        self.lengths = {
            "n_rotors": N_ROTORS, "n_joints": 2, "n_servos": 0, "n_drives": 1, "n_arm": 1,
        }  # fmt: skip
        self.allocation = allocation_matrix(numbers)
        self._thrusts = np.linalg.pinv(self.allocation)
        self.standing_height_m = numbers.gear_height_m
        self.frames = (TOOL, FOOT)

    def frame_pose(self, posture: Posture, frame: str) -> tuple[Vector, Matrix]:
        """Place (3,) in W and axes (3, 3) of a frame."""
        R_WB = quaternion_to_matrix(posture.q_WB)
        if frame == FOOT:
            return posture.p_WB + R_WB @ [0.0, 0.0, self._numbers.foot_height_m], R_WB
        p_BT, R_BT = self._tool(posture.joint_angle[0])
        return posture.p_WB + R_WB @ p_BT, R_WB @ R_BT

    def solve(
        self,
        goals: Goals,
        loads: Loads,
        near: Posture,
    ) -> Posture | Shortfall:
        """The posture that puts a frame there and carries the loads (6,), which act on it in W.

        Of the tool, place and heading are met; its inclination follows from body and arm.
        """
        force = sum((load[:3] for load in loads.values()), np.zeros(3))
        thrust = np.array([0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]) - force
        limit = N_ROTORS * self._numbers.max_thrust_n
        if np.linalg.norm(thrust) > limit:
            return Shortfall(f"it needs {np.linalg.norm(thrust) - limit:.2f} N more thrust")
        [(frame, goal)] = goals.items()
        p, R = goal.p, goal.R
        ahead = R[:, 2] if frame == TOOL else R[:, 0]
        if np.hypot(ahead[0], ahead[1]) < LEAST_RISE:
            return Shortfall(f"the {frame} has no heading")
        R_WB = axes_along(thrust, np.arctan2(ahead[1], ahead[0]))
        if frame == FOOT and np.arccos(min(R_WB[2] @ R[:, 2], 1.0)) > LEVEL_RAD:
            return Shortfall("the foot is square to the surface only without a horizontal load")
        angle = self._hinge_angle(R_WB, loads.get(TOOL, np.zeros(6)))
        at_origin = Posture(np.zeros(3), matrix_to_quaternion(R_WB), np.array([angle]))
        offset, _ = self.frame_pose(at_origin, frame)
        return Posture(p - offset, at_origin.q_WB, at_origin.joint_angle)

    def thrust_margin_n(self, posture: Posture, loads: Loads) -> float:
        """Thrust left in the busiest rotor."""
        R_WB = quaternion_to_matrix(posture.q_WB)
        up_B = R_WB.T @ [0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]
        needed = np.concatenate([up_B, np.cross(self.com_B(posture.joint_angle[0]), up_B)])
        for frame, load in loads.items():
            arm_B = R_WB.T @ (self.frame_pose(posture, frame)[0] - posture.p_WB)
            force_B, torque_B = R_WB.T @ load[:3], R_WB.T @ load[3:]
            needed -= np.concatenate([force_B, torque_B + np.cross(arm_B, force_B)])
        return float(self._numbers.max_thrust_n - (self._thrusts @ needed[2:]).max())

    def com_B(self, angle: float) -> Vector:
        """Centre of mass (3,) of the whole vehicle with the arm at an angle."""
        lever_m = self._numbers.arm_moment_kgm / self._body.mass_kg
        com: Vector = self._body.com_B + lever_m * np.array(
            [np.cos(angle) - 1.0, 0.0, -np.sin(angle)]
        )
        return com

    def _tool(self, angle: float) -> tuple[Vector, Matrix]:
        z = np.array([np.cos(angle), 0.0, -np.sin(angle)])
        y = np.array([0.0, 1.0, 0.0])
        p_BT = np.array(self._numbers.hinge_B_m) + self._numbers.tip_length_m * z
        return p_BT, np.column_stack([np.cross(y, z), y, z])

    def _hinge_angle(self, R_WB: Matrix, load: Vector) -> float:
        """k q = torque of weight and load about the hinge − torque of the level arm's weight."""
        numbers = self._numbers
        weight_B = R_WB.T @ [0.0, 0.0, -numbers.arm_moment_kgm * GRAVITY_MPS2]
        load_B = numbers.tip_length_m * (R_WB.T @ load[:3])
        at_rest = numbers.arm_moment_kgm * GRAVITY_MPS2

        def imbalance(angle: float) -> float:
            _, R_BT = self._tool(angle)
            about_y = np.cross(R_BT[:, 2], weight_B + load_B)[1]
            return float(about_y - at_rest - numbers.hinge_stiffness_nmprad * angle)

        return float(brentq(imbalance, -1.0, 1.0))


def axes_along(thrust_W: Vector, heading: float) -> Matrix:
    """R_WB with z_B along a force and x_B as near to a heading as that allows."""
    z = thrust_W / np.linalg.norm(thrust_W)
    y = np.cross(z, [np.cos(heading), np.sin(heading), 0.0])
    y /= np.linalg.norm(y)
    return np.ascontiguousarray(np.column_stack([np.cross(y, z), y, z]))


def allocation_matrix(numbers: CrawlerNumbers) -> Matrix:
    """A (4, 6): thrust along z_B and torque (3,) about O_b, per newton of each rotor."""
    positions, spins = rotor_geometry(numbers)
    up = np.tile([0.0, 0.0, 1.0], (N_ROTORS, 1))
    torques = np.cross(positions, up) - spins[:, None] * numbers.moment_constant_m * up
    return np.vstack([np.ones(N_ROTORS), torques.T])
