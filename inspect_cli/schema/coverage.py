"""``plan.json`` of a mission that covers a surface: its sorties, and the points left out."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Name, NonNegative, Positive, Strict, Triple
from inspect_cli.schema.plan import Plan


class Skipped(Strict):
    """A point of the lattice that no sortie goes to."""

    label: str
    surface: Name
    uv_m: tuple[float, float]
    p_WC: Triple
    reason: str


class Sortie(Strict):
    """A flight from take-off to landing on one battery: an ordinary plan."""

    number: Annotated[int, Field(ge=1)]
    added: bool = False
    """Whether the refinement rule added it while the survey was flown."""
    plan: Plan

    @property
    def folder(self) -> str:
        """The name of its folder within the run's."""
        return f"sortie-{self.number}"


class CoveragePlan(Strict):
    """The whole survey of a surface."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    kind: Literal["coverage"] = "coverage"
    mission: Name
    platform: Name
    sorties: Annotated[tuple[Sortie, ...], Field(min_length=1)]
    skipped: tuple[Skipped, ...]
    tour_m: NonNegative
    """Length of the shortest path that was found through the standoffs of all points, from the
    tool's tip over the start to the last point, before it is split into sorties."""
    budget_wh: Positive
    """What a sortie may take: the battery's energy less the reserve."""

    points: Annotated[int, Field(ge=1)]
    """That are visited."""
    duration_s: Positive
    """In the air, all sorties."""
    energy_wh: Positive
    """Of all sorties, by the planner's model of power."""

    @classmethod
    def of(
        cls,
        sorties: Sequence[Sortie],
        skipped: Sequence[Skipped],
        tour_m: float,
        budget_wh: float,
    ) -> CoveragePlan:
        """The survey that consists of these sorties, one at least."""
        plans = [sortie.plan for sortie in sorties]
        return cls(
            mission=plans[0].mission,
            platform=plans[0].platform,
            sorties=tuple(sorties),
            skipped=tuple(skipped),
            tour_m=tour_m,
            budget_wh=budget_wh,
            points=sum(len(plan.targets) for plan in plans),
            duration_s=sum(plan.duration_s for plan in plans),
            energy_wh=sum(plan.energy_wh for plan in plans),
        )

    def with_sorties(self, plans: Sequence[Plan], skipped: Sequence[Skipped]) -> CoveragePlan:
        """This survey with further sorties that the refinement rule added, and points it skips."""
        first = len(self.sorties) + 1
        more = [Sortie(number=k, added=True, plan=plan) for k, plan in enumerate(plans, first)]
        return self.of(
            (*self.sorties, *more), (*self.skipped, *skipped), self.tour_m, self.budget_wh
        )

    def joined(self) -> Plan:
        """All sorties as one plan, one after the other, with targets numbered through."""
        first = self.sorties[0].plan
        targets, legs, before = [], [], 0
        for sortie in self.sorties:
            plan = sortie.plan
            targets += [
                target.model_copy(update={"index": target.index + before})
                for target in plan.targets
            ]
            legs += [
                leg
                if leg.target is None
                else leg.model_copy(update={"target": leg.target + before})
                for leg in plan.legs
            ]
            before += len(plan.targets)
        plans = [sortie.plan for sortie in self.sorties]
        update = {
            "targets": tuple(targets),
            "legs": tuple(legs),
            "duration_s": self.duration_s,
            "energy_wh": self.energy_wh,
            "path_m": sum(plan.path_m for plan in plans),
            "cable_m": max(plan.cable_m for plan in plans),
            "warnings": tuple(
                f"sortie {sortie.number}: {warning}"
                for sortie in self.sorties
                for warning in sortie.plan.warnings
            ),
        }
        return first.model_copy(update=update)


class CoveragePlanFile(CoveragePlan):
    """``plan.json`` as ``inspect plan`` writes it: it remembers what it was made from."""

    mission_file: str
    """Path of the mission, relative to the plan's folder."""
    inputs_sha256: str
    """Of the mission and the platform; a plan does not fly when either has changed."""

    def plan(self) -> CoveragePlan:
        """The plan alone."""
        fields = CoveragePlan.model_fields
        return CoveragePlan.model_construct(**{name: getattr(self, name) for name in fields})
