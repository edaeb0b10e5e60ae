"""What a mission asks for, by kind of target, and what was done to the vehicle in flight."""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.flight.ground_truth import has_ground_truth
from inspect_cli.reporting.flight.pulls import pull_phases
from inspect_cli.schema.plan import Plan, Target


@dataclass(frozen=True)
class MissionProfile:
    """What a mission asks for, by kind."""

    readings: tuple[Target, ...]
    contacts: tuple[Target, ...]
    """Points that are touched and not read."""
    strokes: tuple[Target, ...]
    followings: tuple[Target, ...]
    poses: tuple[Target, ...]
    pulls: int
    """How often somebody pulled at a cord."""
    ground_truth: bool
    """Whether estimates can be held against a sensor in the wall or follow an odometry."""

    @property
    def touches(self) -> bool:
        """Whether anything is touched."""
        return bool(self.readings or self.contacts or self.strokes or self.followings)


def mission_profile(log: RunLog, plan: Plan) -> MissionProfile:
    """What the plan asks for, and what the log says was done to the vehicle."""

    def of(kind: str) -> tuple[Target, ...]:
        return tuple(t for t in plan.targets if t.kind == kind and t.sensor is None)

    return MissionProfile(
        readings=tuple(t for t in plan.targets if t.sensor is not None),
        contacts=of("contact"),
        strokes=of("stroke"),
        followings=of("following"),
        poses=of("pose"),
        pulls=len(pull_phases(log)),
        ground_truth=has_ground_truth(log),
    )
