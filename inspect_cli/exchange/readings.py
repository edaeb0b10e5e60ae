"""What every export takes: the points of a Result and what they belong to."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from inspect_cli.schema.result import PointResult


@dataclass(frozen=True)
class HandedReadings:
    """Readings of a flight or of a file, for other programs.

    Potentials are those of ``PointResult``, mV against CSE at the standard's temperature.
    """

    points: Sequence[PointResult]
    title: str
    """Of the survey; names the project in a model of a building."""
    structure: str | None = None
    """What was inspected; names the site."""
    date: str | None = None
    """When the readings were taken, such as 2025-03-31."""
    electrode: str = "CSE"
    """What was read against, before the potentials were converted to CSE."""

    @property
    def holds_potentials(self) -> bool:
        """Whether any of the points belongs to a half-cell; so it is of no points at all."""
        return not all(point.instrument for point in self.points) or not self.points
