"""What a report shows of one surface's readings: findings and map, both computed before."""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.kriging import KrigedMap, NoMap


@dataclass(frozen=True)
class Evaluated:
    """A surface's readings, evaluated; of a flight or from a file."""

    assessed: Assessed
    map: KrigedMap | NoMap

    @property
    def surface(self) -> str:
        """Its name."""
        return self.assessed.summary.surface
