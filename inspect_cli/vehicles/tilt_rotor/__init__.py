"""The tilt-rotor platform of paper A: n tilting groups of two coaxial rotors and a rigid arm."""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.control.tilt_allocation import TiltAllocation
from inspect_cli.interfaces import TOOL, FlightStack
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.vehicles.actuators import Servo, of_kind
from inspect_cli.vehicles.contacts import PointContact
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.fully_actuated.stack import FullyActuatedStack
from inspect_cli.vehicles.kinds import Bodies
from inspect_cli.vehicles.tilt_rotor.capabilities import TiltRotorCapabilities
from inspect_cli.vehicles.tilt_rotor.model import actuators_of, build_spec, group_kappa_m


class TiltRotor:
    """A tilt-rotor vehicle, built from its platform file."""

    behaviour = BEHAVIOUR

    def __init__(self, platform: TiltRotorPlatform) -> None:
        self.platform = platform
        tool = platform.tool
        self.bodies = Bodies()
        self.frames = (TOOL,)
        self.contacts = (
            PointContact("tip", ("tip",), TOOL, tool.tip_stiffness_npm, tool.tip_damping_ratio),
        )
        self.actuators = actuators_of(platform)
        self.joints = tuple(servo.joint for servo in of_kind(self.actuators, Servo))
        self.posture_joints: tuple[str, ...] = ()
        self._body = nominal_body(build_spec(platform))
        self.capabilities = TiltRotorCapabilities(platform, self._body, self._allocation())

    def nominal_spec(self) -> mujoco.MjSpec:
        """The nominal MuJoCo model, in free space."""
        return build_spec(self.platform)

    def flight_stack(self, plan: Plan, estimation: Estimation = "external") -> FlightStack:
        """Pursuit and impedance control."""
        controller = self.flight_control(estimation)
        return FullyActuatedStack(self.platform, self.capabilities, controller, plan)

    def flight_control(self, estimation: Estimation = "external") -> ImpedanceControl:
        """Error-state filter, momentum observer, selective impedance, static allocation."""
        return ImpedanceControl(
            self.platform, self.capabilities, self._body, self._allocation(), estimation
        )

    def _allocation(self) -> TiltAllocation:
        azimuth = np.radians([group.azimuth_deg for group in self.platform.groups])
        unit = self.platform.unit
        return TiltAllocation(
            azimuth, unit.distance_m, group_kappa_m(self.platform), unit.max_thrust_n
        )
