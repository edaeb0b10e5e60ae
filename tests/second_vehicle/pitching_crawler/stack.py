"""Estimation and control of a pitching crawler.

Position PID ─▶ acceleration a, force f = m (a + g ẑ) + what is pressed ─▶ attitude whose z_B is
along f ─▶ attitude PD ─▶ thrust along z_B and torque about O_b ─▶ allocation.

Where it presses along a normal, the position error along it and all integrals are left out: the
force fed forward is what the surface gives back, and a stuck wheel would wind an integral up.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import numpy as np

from inspect_cli.control.impedance import RigidBody
from inspect_cli.estimation.error_state import ErrorStateFilter
from inspect_cli.interfaces import TOOL, FramePose, Posture, Shortfall
from inspect_cli.records import Command, DepthImage, Estimate, Imu, Pose, Record, Reference
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle import ImuModel
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import (
    matrix_to_quaternion,
    quaternion_to_matrix,
    roll_pitch_yaw_matrix,
)
from pitching_crawler.abilities import CrawlerAbilities, axes_along
from pitching_crawler.file_model import FOOT, CrawlerPlatform
from pitching_crawler.motions import Motion, SetPoint, heading_of, stay
from pitching_crawler.sensors import Encoders

KP, KI, KD = 5.0, 1.5, 4.0
"""Position gains per unit of mass, 1/s², 1/s³, 1/s."""
ATTITUDE_RADPS, ATTITUDE_DAMPING = 12.0, 0.8
MAX_ERROR_M = 0.3


@dataclass(frozen=True)
class Law:
    """What a mode holds by force instead of by position: the frame that it presses."""

    presses: str
    rolls: bool = False


LAWS = {"leaning": Law(TOOL), "crawling": Law(TOOL, rolls=True), "propping": Law(FOOT)}
"""By mode; every other holds a position."""


class CrawlerStack:
    """Filter, position and attitude loops and allocation; it never sees a State."""

    loops: Mapping[str, int] = {}

    def __init__(
        self,
        platform: CrawlerPlatform,
        abilities: CrawlerAbilities,
        body: RigidBody,
        start: Posture,
        estimation: Estimation,
    ) -> None:
        self.estimate = Estimate.create()
        self.estimate.wrench_B = np.full(6, np.nan)  # nothing here estimates it
        self.reference = Reference.create(abilities.lengths)
        self.command = Command.create(abilities.lengths)
        self.armed = False
        self.point = SetPoint(start.p_WB.copy(), heading=heading_of(start))
        self.turn_radps = platform.limits.angular_rate_radps
        imu, poses = platform.sensor(ImuModel), platform.pose_source(estimation)
        self._filter = ErrorStateFilter(imu, poses, imu.rate_hz, poses.rate_hz)
        self._pose: Pose | None = None
        self._platform, self._abilities, self._body = platform, abilities, body
        self._thrusts = np.linalg.pinv(abilities.allocation)
        self._period_s = 1.0 / platform.rates.control_hz
        self._motion: Motion = stay
        self._begun_s = 0.0
        self._law: Law | None = None
        self._integral = np.zeros(3)
        self._hinge = np.zeros(1)
        self._force_W, self._R_WR = np.zeros(3), np.eye(3)

    def start(self, pose: Pose) -> None:
        """Begin at rest at a measured pose."""
        self._filter.start(pose, self.estimate)

    def propagation(self, imu: Imu) -> Callable[[], object]:
        """The propagation of the estimate by the inertial unit's samples."""
        return self._filter.bind_propagation(imu, self.estimate)

    def hear(self, sample: Record | DepthImage) -> Record | None:
        """Correct the estimate, or note the hinge's angle; the rest passes."""
        if isinstance(sample, DepthImage):
            return None
        if isinstance(sample, Encoders):
            self._hinge = sample.angle[:1].copy()
        elif isinstance(sample, Pose):
            if sample is not self._pose:
                self._pose = sample
                self._correct = self._filter.bind_correction(sample, self.estimate)
            return sample if self._correct() else None
        return sample

    def enter(self, t_s: float, mode: str, target: int | None) -> None:
        """Take up the law of a mode; what the integral has found is kept."""
        self._law = LAWS.get(mode)
        if self._law is None:
            self.point.force_n, self.point.into_W = 0.0, np.zeros(3)

    def begin(self, t_s: float, motion: Motion) -> None:
        """Move the set-point by another motion from now on."""
        self._motion, self._begun_s = motion, t_s
        self.point.roll_mps = 0.0

    def run(self, loop: str, t_s: float) -> None:
        """It has no loops of its own."""

    def refer(self, t_s: float) -> None:
        """Write the reference of the instant."""
        self._motion(t_s - self._begun_s, self.point)
        self.reference.p_WB, self.reference.v_WB_W = self.point.p_WB, self.point.v_WB_W
        self._force_W = self._force()
        self._R_WR = axes_along(self._force_W, self.point.heading)
        self.reference.q_WB = matrix_to_quaternion(self._R_WR)
        self.reference.arm_angle = self._hinge
        asked = Posture(self.point.p_WB, self.reference.q_WB, self._hinge)
        self.reference.p_WT = self._abilities.frame_pose(asked, TOOL)[0]

    def control(self, t_s: float) -> None:
        """Write the reference and the command of the instant."""
        self.refer(t_s)
        command = self.command
        if not self.armed:
            command.rotor_thrust[:], command.drive_speed[:] = 0.0, 0.0
            return
        # The wall is ahead: a wheel that turns about +y_B climbs.
        rolling = self.point.roll_mps if self._law and self._law.rolls else 0.0
        command.drive_speed[0] = rolling / self._platform.wheel.radius_m
        R_WB = quaternion_to_matrix(self.estimate.q_WB)
        if self._law is None:
            self._integral += KI * self._error() * self._period_s
        asked = np.array([self._force_W @ R_WB[:, 2], *self._torque(R_WB)])
        command.wrench_B[2:] = asked
        thrusts = np.clip(self._thrusts @ asked, 0.0, self._platform.rotors.max_thrust_n)
        command.rotor_thrust[:] = thrusts
        command.allocated_B[2:] = self._abilities.allocation @ thrusts

    def believed(self, frame: str) -> tuple[Vector, Matrix]:
        """(p, R) in W of a frame by the estimate and the hinge's encoder."""
        posture = Posture(self.estimate.p_WB, self.estimate.q_WB, self._hinge)
        return self._abilities.frame_pose(posture, frame)

    def trimmed(self, mode: str, into_W: Vector, force_n: float) -> Posture:
        """The posture that presses the frame of a mode's law where it is believed to be.

        Raises:
            ValueError: there is none.
        """
        frame = LAWS[mode].presses
        p_W, _ = self.believed(frame)
        level = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(1))
        _, R = self._abilities.frame_pose(level, frame)
        R_heading = roll_pitch_yaw_matrix(0.0, 0.0, self.point.heading)
        goal = FramePose(p_W, R_heading @ R)
        load = np.array([*(-force_n * into_W), 0.0, 0.0, 0.0])
        found = self._abilities.solve({frame: goal}, {frame: load}, level)
        if isinstance(found, Shortfall):
            raise ValueError(found.reason)
        return found

    def _error(self) -> Vector:
        error = self.point.p_WB - self.estimate.p_WB
        error *= min(1.0, MAX_ERROR_M / max(float(np.linalg.norm(error)), 1e-9))
        return self._held_by_position(error)

    def _held_by_position(self, x: Vector) -> Vector:
        into = self.point.into_W if self._law else np.zeros(3)
        return x - into * (into @ x)

    def _force(self) -> Vector:
        """What the rotors shall give, N in W."""
        point = self.point
        wanted = KP * self._error() + self._held_by_position(self._integral)
        wanted += KD * (point.v_WB_W - self.estimate.v_WB_W)
        wanted[2] += GRAVITY_MPS2
        force: Vector = self._body.mass_kg * wanted + point.force_n * point.into_W
        return force

    def _torque(self, R_WB: Matrix) -> Vector:
        """Attitude PD about O_b, and the torques of the weight and of what is pressed."""
        R_WR, point = self._R_WR, self.point
        skewed = R_WR.T @ R_WB - R_WB.T @ R_WR
        error = 0.5 * np.array([skewed[2, 1], skewed[0, 2], skewed[1, 0]])
        w, inertia = self.estimate.w_WB_B, self._body.inertia_B
        rate = 2.0 * ATTITUDE_DAMPING * ATTITUDE_RADPS * w
        torque: Vector = -inertia @ (ATTITUDE_RADPS**2 * error + rate)
        torque += np.cross(w, inertia @ w)
        up_B = R_WB.T @ [0.0, 0.0, self._body.mass_kg * GRAVITY_MPS2]
        torque += np.cross(self._abilities.com_B(self._hinge[0]), up_B)
        if self._law is not None:
            arm_B = R_WB.T @ (self.believed(self._law.presses)[0] - self.estimate.p_WB)
            torque += np.cross(arm_B, R_WB.T @ (point.force_n * point.into_W))
        return torque
