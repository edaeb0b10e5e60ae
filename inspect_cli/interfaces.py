"""What the rooms ask of each other: a vehicle's Capabilities, its FlightStack, a Sensor.

Planning, guidance and autonomy know a vehicle through these alone, so that a rigid tilt-rotor,
an articulated arm and a perching manipulator are planned and flown by the same code.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from inspect_cli.records import Command, Estimate, Lengths, Pose, Record, Reference, State
from inspect_cli.spatial.arrays import Matrix, Points, Vector


@dataclass(frozen=True)
class Posture:
    """A whole vehicle at rest: the body's pose and the angles of its arm.

    ``p_WB`` (3,) m in W; ``q_WB`` (4,) wxyz; ``arm_angle`` (n_arm,) rad, empty for a rigid arm.
    Capabilities take an articulated arm without angles as one at rest, at zero.
    """

    p_WB: Vector
    q_WB: Vector
    arm_angle: Vector = field(default_factory=lambda: np.empty(0))


def at_origin(arm_angle: Vector) -> Posture:
    """The posture whose body frame is W: what is asked of it in W is answered in B."""
    return Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), arm_angle)


@dataclass(frozen=True)
class Margins:
    """What is left of the actuators at a posture that also carries a contact wrench."""

    thrust_n: float
    """Smallest thrust still available in any rotor group, N; negative when it is too much."""
    tilt_rad: float
    """Smallest way to a joint's limit, rad; infinite where joints turn freely."""

    @property
    def feasible(self) -> bool:
        """Whether the posture can be held."""
        return self.thrust_n >= 0.0 and self.tilt_rad >= 0.0


class Capabilities(Protocol):
    """What planning and guidance may know of a vehicle; computed on its nominal model."""

    @property
    def lengths(self) -> Lengths:
        """The numbers that shapes in records refer to (``n_rotors``, ``n_joints``, ``n_arm``)."""
        ...

    @property
    def max_speed_mps(self) -> float:
        """The fastest translation that a plan may ask for."""
        ...

    @property
    def max_acceleration_mps2(self) -> float:
        """The largest acceleration that a plan may ask for."""
        ...

    @property
    def max_angular_rate_radps(self) -> float:
        """The fastest turn that a plan may ask for."""
        ...

    @property
    def standing_height_m(self) -> float:
        """Height of O_b over the ground when the vehicle stands on its landing gear."""
        ...

    def tool_pose(self, posture: Posture) -> tuple[Vector, Matrix]:
        """(p_WT, R_WT) of a posture."""
        ...

    def posture_for_tool(self, p_WT: Vector, R_WT: Matrix, near: Posture) -> Posture | None:
        """The posture that puts the tool there, the closest to ``near``; None if there is none."""
        ...

    def collision_spheres(self, posture: Posture) -> Points:
        """Spheres (n, 4) = (p_W, radius) that cover the vehicle but the tool's last part."""
        ...

    def margins(self, posture: Posture, wrench_tool_W: Vector) -> Margins:
        """Actuator margins at rest with the contact wrench (6,) acting on the tool's tip in W."""
        ...

    @property
    def impedances(self) -> tuple[str, ...]:
        """The names of the impedance profiles, in the order that ``Reference.impedance`` counts."""
        ...

    def press_force(self, press_m: float, impedance: str) -> float:
        """Steady normal contact force, N, with the set-point ``press_m`` behind the surface."""
        ...

    def hover_power_w(self, posture: Posture) -> float:
        """Electrical power at rest, W, by the platform's stated model."""
        ...


@dataclass(frozen=True)
class DepthImage:
    """A sample of a depth camera.

    ``points_D`` (rows · columns, 3) m, in the camera's frame D, NaN for pixels without a return;
    the camera overwrites them with its next image.
    """

    t_s: float
    points_D: Points


class FlightStack(Protocol):
    """Estimation, guidance and control of one vehicle. It never sees a State."""

    estimate: Estimate
    reference: Reference
    """Where the vehicle shall be, of the last ``refer`` or ``control``."""
    command: Command
    armed: bool
    """Whether the rotors may turn; the executive decides."""

    @property
    def loops(self) -> Mapping[str, int]:
        """Names and rates, Hz, of its loops beside ``control``; the flight loop calls ``run``."""
        ...

    def start(self, pose: Pose) -> None:
        """Begin at rest at a measured pose."""
        ...

    def hear(self, sample: Record | DepthImage) -> Record | None:
        """Take a sensor's sample.

        Returns what the mission may count on because of it: the pose that corrected the estimate,
        the surface that a depth image shows, the sample itself where the stack makes nothing of
        it. None where it was refused.
        """
        ...

    def enter(self, t_s: float, mode: str, target: int | None) -> None:
        """Take up the estimator and the controller of a mode, without a jump of the command."""
        ...

    def run(self, loop: str, t_s: float) -> None:
        """One period of one of its ``loops``."""
        ...

    def refer(self, t_s: float) -> None:
        """Write the ``reference`` of the instant."""
        ...

    def control(self, t_s: float) -> None:
        """Write the ``command`` that follows the reference of the instant."""
        ...

    def believed(self, frame: str) -> tuple[Vector, Matrix]:
        """(p, R) in W of a frame of the vehicle by the estimate: ``tool``, or a camera's name."""
        ...


class Sensor(Protocol):
    """A simulated instrument. It reads the truth and writes its own measurement."""

    @property
    def measurement(self) -> Record:
        """The record that ``sample`` fills."""
        ...

    def sample(self, state: State) -> None:
        """Measure now."""
        ...
