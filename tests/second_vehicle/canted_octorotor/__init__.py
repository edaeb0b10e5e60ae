"""A second kind of vehicle, which the project knows nothing of: 8 rotors, one arm joint."""

from __future__ import annotations

import mujoco

from canted_octorotor.abilities import CantedOctorotorCapabilities
from canted_octorotor.file_model import CantedOctorotorPlatform
from canted_octorotor.fixed_allocation import FixedAllocation
from canted_octorotor.mujoco_model import actuators_of, build_spec
from inspect_cli.interfaces import TOOL, FlightStack
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.vehicles.contacts import PointContact
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.fully_actuated.stack import FullyActuatedStack
from inspect_cli.vehicles.kinds import Bodies


class CantedOctorotor:
    """One vehicle, built from its platform file."""

    behaviour = BEHAVIOUR

    def __init__(self, platform: CantedOctorotorPlatform) -> None:
        self.platform = platform
        wrist = platform.wrist
        self.bodies = Bodies()
        self.frames = (TOOL,)
        self.contacts = (
            PointContact("tip", ("tip",), TOOL, wrist.tip_stiffness_npm, wrist.tip_damping_ratio),
        )
        self.actuators = actuators_of(platform)
        self.joints = self.posture_joints = ("wrist",)
        self._body = nominal_body(build_spec(platform))
        self.capabilities = CantedOctorotorCapabilities(platform, self._body)

    def nominal_spec(self) -> mujoco.MjSpec:
        return build_spec(self.platform)

    def flight_stack(self, plan: Plan, estimation: Estimation = "external") -> FlightStack:
        controller = self.flight_control(estimation)
        return FullyActuatedStack(self.platform, self.capabilities, controller, plan)

    def flight_control(self, estimation: Estimation = "external") -> ImpedanceControl:
        allocation = FixedAllocation(self.platform.rotors)
        return ImpedanceControl(
            self.platform, self.capabilities, self._body, allocation, estimation
        )
