"""Names of a grid's rows and columns that look like distances, whose unit nobody states."""

from __future__ import annotations

import re
from dataclasses import dataclass

import numpy as np

from inspect_cli.surveys.grids import Grid
from inspect_cli.surveys.numbers import is_number

COUNTED = (1.0, 2.0)
"""Steps of whole numbers that only count: 1, 2, 3, or every second row of a raster."""


@dataclass(frozen=True)
class _Axis:
    """Names that are numbers, all rising or all falling."""

    step: float | None
    """Between neighbours; None where it is not one and the same."""
    are_whole: bool

    @property
    def counts(self) -> bool:
        return self.are_whole and self.step in COUNTED


def require_spacing(grid: Grid) -> None:
    """Refuses a grid without a stated spacing whose names look like distances.

    Whole numbers at steps of 1 or 2 count rows and columns. Numbers with decimals or a minus are
    distances, and so are whole numbers at other equal steps, if the other side has numbers, too.
    Were they taken for mere names, the area could be wrong by any factor.

    Raises:
        InputError: with the distances that the names would mean.
    """
    along, down = _axis(grid.column_names), _axis(grid.row_names)
    found = [axis for axis in (along, down) if axis is not None]
    has_decimals = any(not axis.are_whole for axis in found)
    has_steps = any(axis.step is not None and not axis.counts for axis in found)
    if not has_decimals and not (len(found) == 2 and has_steps):
        return
    is_column = along is not None and (not along.are_whole or not along.counts)
    which = "columns and rows" if len(found) == 2 else "columns" if is_column else "rows"
    i, j = grid.first
    place = (0, j) if is_column else (i, 0)
    what = f"the names of the {which} look like distances, and their unit is not known"
    raise grid.cells.refused(*place, what, _hint(along, down))


def _hint(along: _Axis | None, down: _Axis | None) -> str:
    if any(axis is not None and axis.step is None for axis in (along, down)):
        return "their steps differ: give a list with x, y and potential, or state --spacing-m DUxDV"
    du = "DU" if along is None else f"{along.step:g}"
    dv = "DV" if down is None else f"{down.step:g}"
    return (
        f"state the spacing of columns and of rows in metres: --spacing-m {du}x{dv} "
        "if the names are in metres; they remain the names"
    )


def _axis(names: tuple[str, ...] | None) -> _Axis | None:
    if names is None or len(names) < 2 or not all(map(is_number, names)):
        return None
    values = np.array([float(name.replace("−", "-").replace(",", ".")) for name in names])
    steps = np.diff(values)
    if not ((steps > 0).all() or (steps < 0).all()):
        return None
    is_even = np.allclose(steps, steps[0], rtol=1e-6, atol=0.0)
    are_whole = all(re.fullmatch(r"\+?[0-9]+", name) for name in names)
    return _Axis(round(abs(float(steps[0])), 9) if is_even else None, are_whole)
