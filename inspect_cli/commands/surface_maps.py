"""The maps of potentials that reports draw beside the findings of each surface.

Kriging takes a moment and is for reports alone; ``metrics.json`` holds the findings without maps.
"""

from __future__ import annotations

from collections.abc import Iterable

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.kriging import krige
from inspect_cli.assessment.surface_findings import SurfaceFindings


def with_maps(assessed: Iterable[Assessed]) -> list[SurfaceFindings]:
    """The findings of each surface with its map."""
    return [with_map(surface) for surface in assessed]


def with_map(assessed: Assessed) -> SurfaceFindings:
    """The findings of a surface with a map of its potentials."""
    places = assessed.readings
    found = krige(places.uv_m, places.potential_v, assessed.budget.total_v)
    return SurfaceFindings(assessed, found)
