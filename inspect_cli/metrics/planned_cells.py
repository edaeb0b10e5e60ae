"""The cells that a plan states for its points: what each of them stands for."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

import numpy as np

from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult
from inspect_cli.spatial.arrays import Points

PlannedCells = Mapping[str, tuple[float, float] | None]
"""Widths along u and v, m, of the rectangle around each point, by the point's label. Labels are
numbered through a whole mission, all flights of a survey included."""


def planned_cells(targets: Iterable[Target]) -> PlannedCells:
    """The cells of a plan's targets."""
    return {target.label: target.cell_m for target in targets}


def widths_of(points: Sequence[PointResult], cells: PlannedCells) -> Points:
    """Widths (n, 2), m, of the points' cells; NaN where the plan states none."""
    unknown = (np.nan, np.nan)
    found = [cells.get(point.label) or unknown for point in points]
    return np.array(found, np.float64).reshape(-1, 2)
