"""Estimation and control of a pitching crawler.

Position PID ─▶ acceleration a, force f = m (a + g ẑ) + what is pressed ─▶ attitude whose z_B is
along f ─▶ attitude PD ─▶ thrust along z_B and torque about O_b ─▶ allocation.

Where it presses along a normal, the position error along it and all integrals are left out: the
force fed forward is what the surface gives back, and a stuck wheel would wind an integral up.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from inspect_cli.control.impedance import RigidBody
from inspect_cli.estimation.error_state import ErrorStateFilter
from inspect_cli.interfaces import Posture
from inspect_cli.records import Command, Estimate, Imu, Pose, Record
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import quaternion_to_matrix
from pitching_crawler.abilities import CrawlerAbilities, axes_along
from pitching_crawler.foot_sensor import Encoders
from pitching_crawler.modes import MODES, CrawlerMode
from pitching_crawler.numbers import CrawlerNumbers

KP, KI, KD = 5.0, 1.5, 4.0
"""Position gains per unit of mass, 1/s², 1/s³, 1/s."""
ATTITUDE_RADPS, ATTITUDE_DAMPING = 12.0, 0.8
MAX_ERROR_M = 0.3
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


@dataclass
class Order:
    """Where to be, and how hard to press along the direction ``into_W``."""

    p_WB: Vector
    v_WB_W: Vector = field(default_factory=lambda: np.zeros(3))
    heading: float = 0.0
    force_n: float = 0.0
    into_W: Vector = field(default_factory=lambda: np.array([1.0, 0.0, 0.0]))
    roll_mps: float = 0.0


class CrawlerStack:
    """Filter, position and attitude loops and allocation; it never sees a State."""

    def __init__(
        self, numbers: CrawlerNumbers, abilities: CrawlerAbilities, body: RigidBody
    ) -> None:
        self.estimate = Estimate.create()
        self.command = Command.create(abilities.lengths)
        self.mode = MODES["standing"]
        self._filter = ErrorStateFilter(
            numbers.imu, numbers.pose, numbers.control_hz, numbers.pose_hz
        )
        self._numbers, self._abilities, self._body = numbers, abilities, body
        self._thrusts = np.linalg.pinv(abilities.allocation)
        self._period_s = 1.0 / numbers.control_hz
        self._integral = np.zeros(3)
        self._hinge = 0.0

    def start(self, pose: Pose) -> None:
        """Begin at rest at a measured pose."""
        self._filter.start(pose, self.estimate)

    def hear(self, record: Record) -> bool:
        """Take a measurement; False when it was refused."""
        if isinstance(record, Imu):
            self._filter.propagate(record, self.estimate)
        elif isinstance(record, Encoders):
            self._hinge = float(record.angle[0])
        elif isinstance(record, Pose):
            return self._filter.correct(record, self.estimate)
        return True

    def enter(self, mode: CrawlerMode) -> None:
        """Change the mode; what the integral has found is kept."""
        self.mode = mode

    def control(self, order: Order) -> None:
        """Write the command."""
        command = self.command
        command.drive_speed[0] = 0.0
        if not self.mode.flies:
            command.rotor_thrust[:] = 0.0
            return
        if self.mode.rolls:
            # The wall is ahead: a wheel that turns about +y_B climbs.
            command.drive_speed[0] = order.roll_mps / self._numbers.wheel_radius_m
        R_WB = quaternion_to_matrix(self.estimate.q_WB)
        force_W = self._force(order)
        thrust = float(force_W @ R_WB[:, 2])
        torque_B = self._torque(R_WB, force_W, order)
        asked = np.concatenate([[thrust], torque_B])
        command.wrench_B[:] = [0.0, 0.0, *asked]
        thrusts = np.clip(self._thrusts @ asked, 0.0, self._numbers.max_thrust_n)
        command.rotor_thrust[:] = thrusts
        command.allocated_B[2:] = self._abilities.allocation @ thrusts

    def _force(self, order: Order) -> Vector:
        """What the rotors shall give, N in W."""
        error = order.p_WB - self.estimate.p_WB
        error *= min(1.0, MAX_ERROR_M / max(float(np.linalg.norm(error)), 1e-9))
        into = order.into_W if self.mode.presses else np.zeros(3)
        error -= into * (into @ error)
        if self.mode.presses is None:
            self._integral += KI * error * self._period_s
        held = self._integral - into * (into @ self._integral)
        wanted = KP * error + held + KD * (order.v_WB_W - self.estimate.v_WB_W)
        wanted[2] += GRAVITY_MPS2
        force: Vector = self._body.mass_kg * wanted + order.force_n * into
        return force

    def _torque(self, R_WB: np.ndarray, force_W: Vector, order: Order) -> Vector:
        """Attitude PD about O_b, and the torques of the weight and of what is pressed."""
        R_WR = axes_along(force_W, order.heading)
        skewed = R_WR.T @ R_WB - R_WB.T @ R_WR
        error = 0.5 * np.array([skewed[2, 1], skewed[0, 2], skewed[1, 0]])
        w, inertia = self.estimate.w_WB_B, self._body.inertia_B
        rate = 2.0 * ATTITUDE_DAMPING * ATTITUDE_RADPS * w
        torque = -inertia @ (ATTITUDE_RADPS**2 * error + rate) + np.cross(w, inertia @ w)
        up_B = R_WB.T @ [0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]
        torque += np.cross(self._abilities.com_B(self._hinge), up_B)
        if self.mode.presses:
            pushed_B = -order.force_n * (R_WB.T @ order.into_W)
            at_origin = Posture(np.zeros(3), LEVEL, np.array([self._hinge]))
            arm_B, _ = self._abilities.frame_pose(at_origin, self.mode.presses)
            torque -= np.cross(arm_B, pushed_B)
        return torque
