"""What the vehicle does at one place of its flight, each kind with its stretches and its target.

A visit begins with a way there and ends at a stop from which the next way starts. The planner
makes visits and joins them; what a kind of work adds to the flight stands here alone.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import Protocol

import numpy as np

from inspect_cli.autonomy.timing import PAUSE_S
from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.feasibility import Assessment
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.points import ContactPoint
from inspect_cli.schema.base import Triple
from inspect_cli.schema.plan import Following, LegKind, PostureModel, Stroke, Target
from inspect_cli.schema.tasks import ContactOptions, Hold, Servo
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import matrix_to_quaternion

EXPECTED_DISTANCE_M = 1.0
"""How far a surface that nobody described is taken to be from the start pose, for the time: a third
of a depth camera's range, more than a start pose set by eye leaves."""


@dataclass(frozen=True)
class Stretch:
    """A leg before it has its times; ``postures`` are those after the leg before.

    ``dwell_s`` is spent at its end, ``moving_s`` on a way that its postures do not show.
    """

    kind: LegKind
    target: int | None
    postures: Way
    dwell_s: float = 0.0
    moving_s: float = 0.0
    speed_mps: float | None = None
    """Instead of the speed of its kind."""


class Visit(Protocol):
    """One piece of work with the way to it."""

    @property
    def way(self) -> Way:
        """The way-points from the stop before; empty when it begins where the last one ended."""
        ...

    @property
    def label(self) -> str:
        """What people call it."""
        ...

    @property
    def stop(self) -> Stop:
        """Where it ends, as far as can be known."""
        ...

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Where the tool's tip goes, for the reach of its cable."""
        ...

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Its legs after the way there, as the ``index``-th target of the plan."""
        ...

    def target(self, index: int) -> Target:
        """Its entry among the plan's targets."""
        ...


@dataclass(frozen=True)
class ContactVisit:
    """A point that is touched and perhaps read."""

    point: ContactPoint
    options: ContactOptions
    touch: Touch
    way: Way
    assessment: Assessment

    @property
    def label(self) -> str:
        """The point's."""
        return self.point.label

    @property
    def stop(self) -> Stop:
        """The standoff, where the visit begins and ends."""
        return Stop(self.touch.standoff, self.point.n_W)

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """The point."""
        return (self.point.p_WC,)

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Approach, press and dwell, retreat."""
        yield Stretch("approach", index, (self.touch.contact,))
        yield Stretch("press", index, (self.touch.setpoint,), self.options.dwell_s)
        yield Stretch("retreat", index, (self.touch.standoff,))

    def target(self, index: int) -> Target:
        """A contact."""
        options = self.options
        return touching_target(
            index, "contact", self.point, self.touch, self.assessment
        ).model_copy(
            update={
                "sensor": self.point.sensor,
                "dwell_s": options.dwell_s,
                "off_target_m": options.off_target_m,
            }
        )


@dataclass(frozen=True)
class StrokeVisit:
    """A stroke of a drawing: touched at its first point, left at its last."""

    first: ContactPoint
    last: ContactPoint
    touch: Touch
    leave: Touch
    way: Way
    along: Way
    """Set-points behind the surface along the stroke, after the first."""
    stroke: Stroke
    moving_s: float
    settle_s: float
    assessment: Assessment

    @property
    def label(self) -> str:
        """The number of the stroke."""
        return self.first.label

    @property
    def stop(self) -> Stop:
        """In front of the stroke's end."""
        return Stop(self.leave.standoff, self.last.n_W)

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Both ends of the stroke."""
        return (self.first.p_WC, self.last.p_WC)

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Approach, press and settle, slide, retreat."""
        speed = self.stroke.speed_mps
        yield Stretch("approach", index, (self.touch.contact,))
        yield Stretch("press", index, (self.touch.setpoint,), self.settle_s)
        yield Stretch("slide", index, self.along, PAUSE_S, self.moving_s, speed)
        yield Stretch("retreat", index, (self.leave.standoff,))

    def target(self, index: int) -> Target:
        """A stroke."""
        return touching_target(index, "stroke", self.first, self.touch, self.assessment).model_copy(
            update={"dwell_s": self.settle_s, "stroke": self.stroke}
        )


@dataclass(frozen=True)
class FreePose:
    """A pose in free air with the way there; ``clearance_m`` is infinite without a structure."""

    posture: Posture
    way: Way
    thrust_margin_n: float
    clearance_m: float


@dataclass(frozen=True)
class HoldVisit:
    """A pose in free air."""

    label: str
    hold: Hold
    pose: FreePose
    capabilities: Capabilities
    impedance: str

    @property
    def way(self) -> Way:
        """The way to the pose."""
        return self.pose.way

    @property
    def stop(self) -> Stop:
        """The pose."""
        return Stop(self.pose.posture, np.zeros(3))

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Nothing hangs on a cable there."""
        return ()

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Hold."""
        yield Stretch("hold", index, (self.pose.posture,), self.hold.duration_s)

    def target(self, index: int) -> Target:
        """A pose."""
        return _looking_target(
            index, "pose", self.label, self.impedance, self.capabilities, self.pose
        ).model_copy(update={"dwell_s": self.hold.duration_s})


@dataclass(frozen=True)
class ServoVisit:
    """A surface that is found, touched and followed by the depth camera."""

    label: str
    servo: Servo
    pose: FreePose
    capabilities: Capabilities
    impedance: str
    expected_force_n: float

    @property
    def way(self) -> Way:
        """The way to the start pose."""
        return self.pose.way

    @property
    def stop(self) -> Stop:
        """The start pose: nobody knows where the surface will be left, so the way leads back."""
        return Stop(self.pose.posture, np.zeros(3))

    @property
    def tips_W(self) -> tuple[Vector, ...]:
        """Nothing hangs on a cable there."""
        return ()

    def stretches(self, index: int) -> Iterator[Stretch]:
        """Approach, press and settle, slide, settle, retreat, back to the start pose."""
        here, servo = (self.pose.posture,), self.servo
        way_s = servo.slide_m / servo.speed_mps
        yield Stretch("approach", index, (self._ahead(EXPECTED_DISTANCE_M),))
        yield Stretch("press", index, (self._ahead(EXPECTED_DISTANCE_M),), servo.settle_s)
        if servo.slide_m > 0.0:
            yield Stretch(
                "slide", index, (self._ahead(EXPECTED_DISTANCE_M),), servo.settle_s, way_s,
                servo.speed_mps,
            )  # fmt: skip
        yield Stretch("retreat", index, (self._ahead(EXPECTED_DISTANCE_M - servo.standoff_m),))
        yield Stretch("transit", None, here)

    def target(self, index: int) -> Target:
        """A following."""
        servo = self.servo
        following = Following(
            direction=servo.direction, distance_m=servo.slide_m, speed_mps=servo.speed_mps
        )
        return _looking_target(
            index, "following", self.label, self.impedance, self.capabilities, self.pose
        ).model_copy(
            update={
                "dwell_s": servo.settle_s,
                "press_m": servo.press_m,
                "standoff_m": servo.standoff_m,
                "following": following,
                "expected_force_n": self.expected_force_n,
            }
        )

    def _ahead(self, distance_m: float) -> Posture:
        """The start pose moved along the tool's axis."""
        here = self.pose.posture
        _, R_WT = self.capabilities.tool_pose(here)
        return Posture(here.p_WB + distance_m * R_WT[:, 2], here.q_WB, here.arm_angle)


def touching_target(
    index: int, kind: str, point: ContactPoint, touch: Touch, found: Assessment
) -> Target:
    """The part of a target that every touch of a believed surface has."""
    w, x, y, z = (float(value) for value in matrix_to_quaternion(touch.R_WT))
    tilt_rad = found.margins.tilt_rad
    options = point.options
    return Target.model_validate(
        {
            "index": index,
            "label": point.label,
            "kind": kind,
            "impedance": point.impedance,
            "surface": point.surface,
            "uv_m": point.uv_m,
            "p_WC": triple(point.p_WC),
            "n_W": triple(point.n_W),
            "q_WT": (w, x, y, z),
            "sensor": None,
            "press_m": options.press_m,
            "dwell_s": 0.0,
            "standoff_m": options.standoff_m,
            "standoff": posture_model(touch.standoff),
            "contact": posture_model(touch.contact),
            "expected_force_n": found.force_n,
            "thrust_margin_n": found.margins.thrust_n,
            "tilt_margin_rad": tilt_rad if np.isfinite(tilt_rad) else None,
            "clearance_m": found.gap.structure_m,
        }
    )


def _looking_target(
    index: int,
    kind: str,
    label: str,
    impedance: str,
    capabilities: Capabilities,
    pose: FreePose,
) -> Target:
    """The part of a target in free air: the tool's own place and axis stand for the surface's."""
    p_WT, R_WT = capabilities.tool_pose(pose.posture)
    w, x, y, z = (float(value) for value in matrix_to_quaternion(np.ascontiguousarray(R_WT)))
    here = posture_model(pose.posture)
    return Target.model_validate(
        {
            "index": index,
            "label": label,
            "kind": kind,
            "impedance": impedance,
            "surface": None,
            "uv_m": None,
            "p_WC": triple(p_WT),
            "n_W": triple(-R_WT[:, 2]),
            "q_WT": (w, x, y, z),
            "sensor": None,
            "press_m": 0.0,
            "dwell_s": 0.0,
            "standoff_m": 0.0,
            "standoff": here,
            "contact": here,
            "expected_force_n": 0.0,
            "thrust_margin_n": pose.thrust_margin_n,
            "tilt_margin_rad": None,
            "clearance_m": pose.clearance_m if np.isfinite(pose.clearance_m) else None,
        }
    )


def posture_model(posture: Posture) -> PostureModel:
    """A posture as it is written."""
    w, x, y, z = (float(value) for value in posture.q_WB)
    return PostureModel(
        p_WB=triple(posture.p_WB),
        q_WB=(w, x, y, z),
        arm_angle_rad=tuple(float(angle) for angle in posture.arm_angle),
    )


def triple(a: Vector) -> Triple:
    """Three numbers as a file keeps them."""
    return (float(a[0]), float(a[1]), float(a[2]))
