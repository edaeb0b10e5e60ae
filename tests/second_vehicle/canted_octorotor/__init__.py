"""A second kind of vehicle, which the project knows nothing of: 8 rotors, one arm joint."""

from __future__ import annotations

import mujoco
import numpy as np

from canted_octorotor.abilities import CantedOctorotorCapabilities
from canted_octorotor.file_model import N_ROTORS, CantedOctorotorPlatform
from canted_octorotor.fixed_allocation import FixedAllocation
from canted_octorotor.mujoco_model import build_spec
from inspect_cli.interfaces import FlightStack
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.fully_actuated.stack import FullyActuatedStack
from inspect_cli.vehicles.kinds import Actuators, Tip


class CantedOctorotor:
    """One vehicle, built from its platform file."""

    behaviour = BEHAVIOUR

    def __init__(self, platform: CantedOctorotorPlatform) -> None:
        self.platform = platform
        rotors, wrist = platform.rotors, platform.wrist
        self.actuators = Actuators(
            time_up_s=np.full(N_ROTORS, rotors.time_up_s),
            time_down_s=np.full(N_ROTORS, rotors.time_down_s),
            joint_rate_radps=np.array([wrist.servo_rate_radps]),
            rotor_radius_m=rotors.radius_m,
        )
        self.tip = Tip(wrist.tip_radius_m, wrist.tip_stiffness_npm, wrist.tip_damping_ratio)
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
