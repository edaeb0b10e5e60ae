"""The findings and the map of one surface, both computed before the report is written."""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.kriging import KrigedMap, NoMap


@dataclass(frozen=True)
class SurfaceFindings:
    """The findings from a surface's readings, of a flight or of a file, with their map."""

    assessed: Assessed
    map: KrigedMap | NoMap

    @property
    def surface(self) -> str:
        """Name of the surface."""
        return self.assessed.summary.surface
