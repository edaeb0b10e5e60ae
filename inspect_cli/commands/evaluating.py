"""From readings to what a report shows of each surface: findings, and a map between the readings.

Maps take a moment and are for reports alone; ``metrics.json`` holds the findings without them.
"""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.kriging import krige
from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.assessed import assess_points
from inspect_cli.metrics.planned_cells import planned_cells
from inspect_cli.reporting.evaluated import Evaluated
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import PointResult


def evaluated_points(
    points: Sequence[PointResult], log: RunLog, plan: Plan | None = None
) -> list[Evaluated]:
    """The surfaces of a flight, or of the sorties of a survey, of which ``log`` is the first.

    ``plan`` is that of all sorties together; by default the log's own.
    """
    probe = log.platform().sensors.half_cell
    cells = planned_cells((plan or log.plan()).targets)
    return [mapped(assessed) for assessed in assess_points(points, log.mission(), probe, cells)]


def mapped(assessed: Assessed) -> Evaluated:
    """The findings of a surface with a map of its potentials."""
    places = assessed.readings
    return Evaluated(assessed, krige(places.uv_m, places.potential_v, assessed.budget.total_v))
