"""Estimation and impedance control of a fully actuated vehicle; allocation is the kind's own.

IMU ─▶ error-state filter ◀─ pose        (estimate; of the tracker or of the odometry)
          │
          ▼
momentum observer ─▶ selective impedance ─▶ allocation ─▶ command

The angles of an arm pass from the reference to its servos, which are believed to hold them.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Protocol

import numpy as np

from inspect_cli.compiled import Bound
from inspect_cli.control.impedance import ImpedanceController, RigidBody
from inspect_cli.estimation.error_state import ErrorStateFilter
from inspect_cli.estimation.wrench_observer import WrenchObserver
from inspect_cli.interfaces import TOOL, Capabilities, at_origin
from inspect_cli.records import Command, Estimate, Imu, Pose, Reference
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle import ImpedancePlatform, ImuModel
from inspect_cli.spatial.arrays import Vector


class Allocation(Protocol):
    """Turns the command's wrench into actuator set-points."""

    def bind(self, weight_B: Vector, command: Command) -> Callable[[], object]:
        """The call that writes thrusts, tilts, the granted wrench and whether it saturated."""
        ...


class ImpedanceControl:
    """Filter, observer, impedance law and allocation of one vehicle."""

    def __init__(
        self,
        platform: ImpedancePlatform,
        capabilities: Capabilities,
        body: RigidBody,
        allocation: Allocation,
        estimation: Estimation = "external",
    ) -> None:
        rates, control = platform.rates, platform.control
        self.estimate = Estimate.create()
        self.command = Command.create(capabilities.lengths)
        imu, pose = platform.sensor(ImuModel), platform.pose_source(estimation)
        self._filter = ErrorStateFilter(imu, pose, imu.rate_hz, pose.rate_hz)
        self._observer = WrenchObserver(
            body.mass_kg,
            body.inertia_B,
            body.com_B,
            np.array(control.observer_gain + control.observer_gain_torque),
            1.0 / rates.control_hz,
        )
        self._capabilities = capabilities
        angles, n_arm = self.command.joint_angle, capabilities.lengths.get("n_arm", 0)
        self._arm_angle = angles[len(angles) - n_arm :]
        _, R_BT = capabilities.frame_pose(at_origin(self._arm_angle), TOOL)
        self._impedance = ImpedanceController(body, control, R_BT, rates.control_hz)
        self._flying = False
        self._pose: Pose | None = None
        self._laws = (
            self._observer.bind(self.estimate, self.command.allocated_B),
            allocation.bind(self._impedance.weight_B, self.command),
        )

    def start(self, pose: Pose) -> None:
        """Begin at rest at a measured pose."""
        self._filter.start(pose, self.estimate)

    def propagation(self, imu: Imu) -> Bound:
        """The propagation of the estimate with an inertial sample."""
        return self._filter.bind_propagation(imu, self.estimate)

    def correct(self, pose: Pose) -> bool:
        """Correct the estimate with a pose measurement; False when it was refused."""
        if pose is not self._pose:
            self._pose, self._correct = pose, self._filter.bind_correction(pose, self.estimate)
        return self._correct()

    def bind(self, reference: Reference) -> Sequence[Callable[[], object]]:
        """The calls that turn a reference into the command, after ``prepare``."""
        observe, allocate = self._laws
        return observe, self._impedance.bind(self.estimate, reference, self.command), allocate

    def prepare(self, reference: Reference, armed: bool) -> bool:
        """Follow arm and profile of the reference; whether there is anything to control.

        Motors idle, and the observer rests, when not ``armed``.
        """
        if self._arm_angle.size:
            self._move_arm(reference.arm_angle)
        if not armed:
            self._idle()
            return False
        if not self._flying:
            self._observer.reset(self.estimate)
            self._flying = True
        self._impedance.follow(int(reference.views["impedance"][0]))
        return True

    def _move_arm(self, arm_angle: Vector) -> None:
        """Command the arm, and turn the impedance with the tool."""
        if np.array_equal(self._arm_angle, arm_angle):
            return
        self._arm_angle[:] = arm_angle
        _, R_BT = self._capabilities.frame_pose(at_origin(arm_angle), TOOL)
        self._impedance.turn_tool(R_BT)

    def _idle(self) -> None:
        self._flying = False
        for name in ("wrench_B", "allocated_B", "rotor_thrust", "saturated"):
            self.command.views[name][...] = 0.0
