"""What the rooms ask of each other: a vehicle's Capabilities, its FlightStack, a Judge of readings.

Planning, guidance and autonomy know a vehicle through these alone, so that a rigid tilt-rotor,
an articulated arm and a perching manipulator are planned and flown by the same code.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import Any, Literal, Protocol

import numpy as np

from inspect_cli.records import (
    Command,
    DepthImage,
    Estimate,
    Imu,
    Lengths,
    PointReading,
    Pose,
    Record,
    Reference,
)
from inspect_cli.spatial.arrays import Matrix, Points, Vector

TOOL = "tool"
"""The frame T of the tool; every vehicle has it."""


@dataclass(frozen=True)
class Support:
    """What carries a vehicle that does not fly: a frame of it that a surface holds."""

    frame: str
    surface: str


@dataclass(frozen=True)
class Posture:
    """A whole vehicle at rest: the body's pose and the angles of its arm.

    ``p_WB`` (3,) m in W; ``q_WB`` (4,) wxyz; ``joint_angle`` (n_arm,) rad, empty for a rigid arm;
    ``support`` is None in flight. Capabilities take an articulated arm without angles as one at
    rest, at zero.
    """

    p_WB: Vector
    q_WB: Vector
    joint_angle: Vector = field(default_factory=lambda: np.empty(0))
    support: Support | None = None


def at_origin(joint_angle: Vector) -> Posture:
    """The posture whose body frame is W: what is asked of it in W is answered in B."""
    return Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), joint_angle)


@dataclass(frozen=True)
class FramePose:
    """Where a frame of the vehicle shall be: its origin p (3,) m and its axes R (3, 3) in W."""

    p: Vector
    R: Matrix


@dataclass(frozen=True)
class Margin:
    """What is left of one of a vehicle's limits; negative when too much is asked of it.

    ``lack`` says what is then asked, as the end of a sentence that begins with what the vehicle
    does ("asks for 1.23 N more than a rotor can give"), and ``hint`` what may help.
    """

    value: float
    unit: str
    lack: str = ""
    hint: str = ""

    @property
    def holds(self) -> bool:
        """Whether the limit is kept; written so that NaN violates it."""
        return self.value >= 0.0


Margins = Mapping[str, Margin]
"""By the vehicle's own names, the one first that decides between two postures that both hold."""


def least(each: Iterable[Margins]) -> Margins:
    """Of several postures the smallest margin under each name."""
    found: dict[str, Margin] = {}
    for margins in each:
        for name, margin in margins.items():
            if name not in found or margin.value < found[name].value:
                found[name] = margin
    return found


@dataclass(frozen=True)
class Shortfall:
    """Why no posture does what is asked, and what may help. It is falsy."""

    reason: str = ""
    hint: str = ""

    def __bool__(self) -> Literal[False]:
        return False


Goals = Mapping[str, FramePose]
"""Where frames shall be, by their names."""
Loads = Mapping[str, Vector]
"""Wrenches (6,) N, N·m, that act on frames in W while they are held there, by the frames' names."""
FREE: Loads = {}
"""Nothing acts on the vehicle but its weight."""


def pushed_along(direction_W: Vector, force_n: float) -> Loads:
    """The load of a contact: the surface pushes the tool's tip with a force along a direction."""
    return {TOOL: np.concatenate([force_n * direction_W, np.zeros(3)])}


class Pressing(Protocol):
    """What a task says of how its tool is pressed on a surface."""

    @property
    def press_m(self) -> float:
        """How far the set-point lies behind the surface."""
        ...


@dataclass(frozen=True)
class DepthLaw:
    """Contact by a set-point behind the surface: an impedance makes a force of the depth.

    ``profile`` names the impedance, ``expected_force_n`` is the steady normal force that follows.
    Raises ValueError for a depth or a force below zero.
    """

    depth_m: float
    profile: str
    expected_force_n: float
    kind: Literal["depth"] = "depth"

    def __post_init__(self) -> None:
        if not (self.depth_m >= 0.0 and self.expected_force_n >= 0.0):
            raise ValueError(f"depth {self.depth_m} m and force {self.expected_force_n} N are ≥ 0")


@dataclass(frozen=True)
class ForceLaw:
    """Contact by a normal force that is controlled itself; the set-point is on the surface.

    Raises ValueError for a force below zero.
    """

    force_n: float
    kind: Literal["force"] = "force"

    def __post_init__(self) -> None:
        if not self.force_n >= 0.0:
            raise ValueError(f"force {self.force_n} N is ≥ 0")

    @property
    def depth_m(self) -> float:
        """How far the set-point lies behind the surface."""
        return 0.0

    @property
    def expected_force_n(self) -> float:
        """The steady normal force."""
        return self.force_n


ContactLaw = DepthLaw | ForceLaw
"""How a vehicle presses its tool on a surface."""


class Capabilities(Protocol):
    """What planning and guidance may know of a vehicle; computed on its nominal model."""

    @property
    def tasks(self) -> frozenset[str]:
        """The kinds of tasks that its modes can do, by their names in the mission."""
        ...

    @property
    def lengths(self) -> Lengths:
        """The numbers that shapes in records refer to; see ``inspect_cli.records``."""
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

    @property
    def frames(self) -> tuple[str, ...]:
        """The names of the frames that goals and loads may name; ``TOOL`` is one of them."""
        ...

    def frame_pose(self, posture: Posture, frame: str) -> tuple[Vector, Matrix]:
        """(p_WF, R_WF) of a frame in a posture."""
        ...

    def solve(self, goals: Goals, loads: Loads, near: Posture) -> Posture | Shortfall:
        """The posture that puts frames there at rest under the loads, the closest to ``near``.

        A rigid vehicle that can push in every direction inverts its kinematics and ignores the
        loads; one whose thrusts are parallel pitches to carry them; an arm asks its inverse
        kinematics.
        """
        ...

    def collision_spheres(self, posture: Posture) -> Points:
        """Spheres (n, 4) = (p_W, radius) that cover the vehicle but the tool's last part."""
        ...

    def margins(self, posture: Posture, loads: Loads) -> Margins:
        """What is left of the vehicle's limits at rest under the loads."""
        ...

    @property
    def impedances(self) -> tuple[str, ...]:
        """Profiles that a mission may name, in the order that ``Reference.impedance`` counts."""
        ...

    def contact_law(self, pressing: Pressing, profile: str) -> ContactLaw:
        """What a task's way of pressing means for this vehicle, flown with a profile."""
        ...

    def power_w(self, posture: Posture, loads: Loads) -> float:
        """Electrical power, W, at rest under the loads, by the platform's stated model."""
        ...


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

    def propagation(self, imu: Imu) -> Callable[[], object]:
        """What an inertial unit is heard by: to be called whenever it has overwritten ``imu``."""
        ...

    def hear(self, sample: Record | DepthImage) -> Record | None:
        """Take the sample of any other sensor.

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


class Judge(Protocol):
    """Decides whether an instrument's samples at a point make a reading."""

    def begin(self, target: int, t_s: float) -> None:
        """A new point."""
        ...

    def feed(self, sample: Any, p_WT: Vector) -> None:
        """Another of the instrument's samples, with the believed position of the tip."""
        ...

    def done(self, t_s: float) -> bool:
        """Whether the point is decided."""
        ...

    def finish(self, t_s: float) -> PointReading:
        """The verdict."""
        ...


@dataclass(frozen=True)
class Judging:
    """How the samples of an instrument become readings."""

    sample: type[Record]
    """What the instrument sends."""
    reading: type[PointReading]
    """What is logged of each point."""
    judge: Callable[[float], Judge]
    """Makes the judge of one point, given its dwell, s."""
