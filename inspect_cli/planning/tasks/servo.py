"""Planner of the task ``servo``: a surface that the depth camera finds and follows."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace

import numpy as np

from inspect_cli.interfaces import TOOL, Capabilities, ContactLaw, Posture, pushed_along
from inspect_cli.planning.feasibility import Reason, margin_reasons
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.segments import Segment, Stretch
from inspect_cli.planning.tasks.free_pose import FreePose, free_pose, looking_target
from inspect_cli.planning.tasks.situation import Asked, Planners, Situation
from inspect_cli.schema.plan import Following, Target
from inspect_cli.schema.tasks.servo import Servo
from inspect_cli.spatial.arrays import Vector

EXPECTED_DISTANCE_M = 1.0
"""How far a surface that nobody described is taken to be from the start pose, for the time: a third
of a depth camera's range, more than a start pose set by eye leaves."""


@dataclass(frozen=True)
class ServoSegment:
    """A surface that is found, touched and followed by the depth camera."""

    label: str
    servo: Servo
    pose: FreePose
    capabilities: Capabilities
    impedance: str
    law: ContactLaw

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
        return looking_target(
            index, "following", self.label, self.impedance, self.capabilities, self.pose
        ).model_copy(
            update={
                "dwell_s": servo.settle_s,
                "law": self.law,
                "standoff_m": servo.standoff_m,
                "following": following,
            }
        )

    def _ahead(self, distance_m: float) -> Posture:
        """The start pose moved along the tool's axis."""
        here = self.pose.posture
        _, R_WT = self.capabilities.frame_pose(here, TOOL)
        return replace(here, p_WB=here.p_WB + distance_m * R_WT[:, 2])


@dataclass(frozen=True)
class ServoPlanner:
    """Find a surface and follow it."""

    label: str
    servo: Servo
    impedance: str

    @property
    def name(self) -> str:
        """The start pose."""
        return f"servo {self.label}"

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """Go to the start pose; beyond it only the camera knows."""
        start = self.servo.start
        found = free_pose(situation, start.position_m, start.heading_deg, before)
        if isinstance(found, list):
            return found
        capabilities = situation.capabilities
        law = capabilities.contact_law(self.servo, self.impedance)
        force_n = law.expected_force_n
        _, R_WT = capabilities.frame_pose(found.posture, TOOL)
        margins = capabilities.margins(found.posture, pushed_along(-R_WT[:, 2], force_n))
        loaded = margin_reasons(margins, f"pressing with {force_n:.2f} N")
        if loaded:
            return loaded
        return ServoSegment(self.label, self.servo, found, capabilities, self.impedance, law)


def planners_of(asked: Asked) -> Planners:
    """One planner."""
    servo = asked.task.work
    assert isinstance(servo, Servo)  # the registry has looked it up by its kind
    return Planners((ServoPlanner(str(asked.number), servo, asked.impedance),), asked.tip_W)
