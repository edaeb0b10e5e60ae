"""What the simulator and the commands ask of a kind of vehicle.

Contract of ``nominal_spec``: the first body is named ``core`` and has a free joint; fixed to it
are the bodies ``shell`` (what must never touch) and ``gear`` (what stands on the ground), and
fixed to it or at the end of the arm's joints is the body ``tool`` with the geom ``tip`` and the
site ``tool_tip``, whose axes are T's. Joints are those of the tilts, then those of the arm.
Actuators come in this order, each with one activation, which lags behind its control: one per
rotor (free-air thrust, N), one per joint (angle, rad).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Protocol

import mujoco

from inspect_cli.autonomy.modes import Behaviour
from inspect_cli.interfaces import Capabilities, FlightStack
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class Actuators:
    """Timing and geometry of the actuators that the plant moves."""

    time_up_s: Vector
    """Lag (n_rotors,) of rising thrust."""
    time_down_s: Vector
    """Lag (n_rotors,) of falling thrust."""
    joint_rate_radps: Vector
    """Fastest motion (n_joints,) of the joints' set-points."""
    rotor_radius_m: float


@dataclass(frozen=True)
class Tip:
    """The tool's end and how stiff its contact is."""

    radius_m: float
    stiffness_npm: float
    damping_ratio: float


class Vehicle(Protocol):
    """One vehicle, built from its platform file."""

    @property
    def platform(self) -> PlatformBase:
        """The numbers it was built from."""
        ...

    @property
    def capabilities(self) -> Capabilities:
        """What planning and guidance may know."""
        ...

    @property
    def actuators(self) -> Actuators:
        """What the plant needs beyond the nominal model."""
        ...

    @property
    def tip(self) -> Tip:
        """The tool's end."""
        ...

    def nominal_spec(self) -> mujoco.MjSpec:
        """The nominal MuJoCo model, in free space."""
        ...

    @property
    def behaviour(self) -> Behaviour:
        """Its modes and failsafes."""
        ...

    def flight_stack(self, plan: Plan, estimation: Estimation = "external") -> FlightStack:
        """A fresh stack of estimation, guidance and control, which gets its poses from there."""
        ...
