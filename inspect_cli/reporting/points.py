"""The points of a Result beside the targets that they answer, as the figures need them."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from inspect_cli.schema.plan import Plan, PlannedSurface, Target
from inspect_cli.schema.result import PointResult, Result


@dataclass(frozen=True)
class ReadPoint:
    """What became of a point, and what the plan wanted there."""

    point: PointResult
    target: Target | None

    @property
    def surface(self) -> str:
        """Name of the surface that the point lies on; empty for a point in free air."""
        return self.target.surface or "" if self.target else ""

    @property
    def is_reading(self) -> bool:
        """Whether the plan wanted an instrument read there."""
        return self.target is None or self.target.sensor is not None


def read_points(result: Result, plan: Plan) -> tuple[ReadPoint, ...]:
    """Every point of the result that stands for a reading, in the plan's order."""
    targets = {target.index: target for target in plan.targets}
    points = [ReadPoint(point, targets.get(point.index)) for point in result.points]
    return tuple(point for point in points if point.is_reading)


def by_surface(
    points: Sequence[ReadPoint], plan: Plan
) -> list[tuple[PlannedSurface, list[ReadPoint]]]:
    """The surfaces that carry points with coordinates, each with its points."""
    groups = []
    for surface in plan.surfaces:
        own = [p for p in points if p.surface == surface.name and p.point.uv_m is not None]
        if own:
            groups.append((surface, own))
    return groups
