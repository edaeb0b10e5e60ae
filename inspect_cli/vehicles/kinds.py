"""What the simulator and the commands ask of a kind of vehicle.

Everything that they need of the MuJoCo model of ``nominal_spec`` is stated by name: bodies,
frames, contacts, joints and actuators. The plant resolves the names when it is built and refuses
what does not fit (``simulation.addresses``). The model's first joint is the free joint of the base
body, whose frame is B.
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
from inspect_cli.vehicles.actuators import Actuator
from inspect_cli.vehicles.contacts import Contact


@dataclass(frozen=True)
class Bodies:
    """Bodies of the MuJoCo model by name."""

    base: str = "core"
    """Carries the free joint; its frame is B."""
    gear: tuple[str, ...] = ("gear",)
    """What stands on the ground."""
    protected: tuple[str, ...] = ("shell",)
    """What must never touch anything; the forces on it are ``State.f_body``."""


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
    def bodies(self) -> Bodies:
        """The bodies that the simulator and the pictures treat differently."""
        ...

    @property
    def frames(self) -> tuple[str, ...]:
        """Sites of the model by name; one of them is ``tool``."""
        ...

    @property
    def contacts(self) -> tuple[Contact, ...]:
        """What touches surfaces on purpose; one of them has the frame ``tool``."""
        ...

    @property
    def joints(self) -> tuple[str, ...]:
        """All joints but the free one, in the order of ``State.joint_angle``."""
        ...

    @property
    def posture_joints(self) -> tuple[str, ...]:
        """The joints whose angles a Posture states, in its order."""
        ...

    @property
    def actuators(self) -> tuple[Actuator, ...]:
        """Rotors, servos and drives; those of a kind in the order of the records' arrays."""
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
