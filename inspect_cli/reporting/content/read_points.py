"""The points of a Result, each with the target of the plan that it belongs to."""

from __future__ import annotations

import re
from dataclasses import dataclass

from inspect_cli.reporting.figures.figure import words
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, together
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.result import PointResult, Result


@dataclass(frozen=True)
class ReadPoint:
    """The result of a point, and its target in the plan."""

    point: PointResult
    target: Target | None

    @property
    def surface(self) -> str:
        """Name of the surface that the point lies on; empty where none was known."""
        return self.point.surface

    @property
    def reason(self) -> Text:
        """Why the point is invalid; empty when valid."""
        return recorded(self.point.reason)

    @property
    def instrument(self) -> str:
        """Kind of the instrument that was to be read there; empty where the plan names none."""
        return (self.target.sensor if self.target else None) or ""

    @property
    def is_reading(self) -> bool:
        """Whether the plan wanted an instrument read there."""
        return self.target is None or self.target.sensor is not None


def read_points(result: Result, plan: Plan) -> tuple[ReadPoint, ...]:
    """Every point of the result that stands for a reading, in the order of the labels.

    The plan visits points in the order of the shortest path; a reader looks for point 7 between
    6 and 8.
    """
    targets = {target.index: target for target in plan.targets}
    points = [ReadPoint(point, targets.get(point.index)) for point in result.points]
    readings = (point for point in points if point.is_reading)
    return tuple(sorted(readings, key=lambda p: _label_order(p.point.label)))


def reason_text(p: ReadPoint) -> Text:
    """The text that a figure shows for an invalid reading under the pointer."""
    return together(words(p.point.label), ": ", words(p.reason))


def _label_order(label: str) -> list[tuple[int, int, str]]:
    """A key that sorts the digits within a label as the numbers that they are."""
    parts = re.findall(r"[0-9]+|[^0-9]+", label)
    return [(0, int(part), "") if part.isdecimal() else (1, 0, part) for part in parts]
