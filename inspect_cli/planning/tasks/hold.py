"""Planner of the task ``hold``: a pose in free air."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import Capabilities
from inspect_cli.planning.feasibility import Reason
from inspect_cli.planning.path import Stop, Way
from inspect_cli.planning.segments import Segment, Stretch
from inspect_cli.planning.tasks.free_pose import FreePose, free_pose, looking_target
from inspect_cli.planning.tasks.situation import Asked, Planners, Situation
from inspect_cli.schema.plan import Target
from inspect_cli.schema.tasks.hold import Hold
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class HoldSegment:
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
        return looking_target(
            index, "pose", self.label, self.impedance, self.capabilities, self.pose
        ).model_copy(update={"dwell_s": self.hold.duration_s})


@dataclass(frozen=True)
class HoldPlanner:
    """Hold a pose in free air."""

    label: str
    hold: Hold
    impedance: str

    @property
    def name(self) -> str:
        """The pose."""
        return f"pose {self.label}"

    def plan(self, situation: Situation, before: Stop) -> Segment | list[Reason]:
        """Go there, if the vehicle has room and can hold it."""
        hold = self.hold
        found = free_pose(situation, hold.position_m, hold.heading_deg, before)
        if isinstance(found, list):
            return found
        return HoldSegment(self.label, self.hold, found, situation.capabilities, self.impedance)


def planners_of(asked: Asked) -> Planners:
    """One planner."""
    hold = asked.task.work
    assert isinstance(hold, Hold)  # the registry has looked it up by its kind
    return Planners((HoldPlanner(str(asked.number), hold, asked.impedance),), asked.tip_W)
