"""A grid of numbers: rows run down the file, columns to the right, as seen from outside.

The first row names the columns if it holds no number, or if its first cell is empty or a word
for row. In the latter case, and where the first column is all text, the first column names the
rows; then the names of the columns may be numbers.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.surveys.cells import Cells
from inspect_cli.surveys.files import read_cells
from inspect_cli.surveys.layout import has_row_word, labelled_by_text, require_rows
from inspect_cli.surveys.numbers import NumberReader, is_gap, is_number
from inspect_cli.surveys.units import Unit

FEW = 3
"""So many numbers at equal steps, where readings should be, look like names."""


@dataclass(frozen=True)
class Grid:
    """The numbers of a grid as they stand in the file."""

    values: Matrix
    """(rows, columns), NaN where there is no reading."""
    gaps: dict[int, str]
    """Why there is none, by the index into the flattened values."""
    row_names: tuple[str, ...] | None
    column_names: tuple[str, ...] | None
    cells: Cells
    first: tuple[int, int]
    """Where in ``cells`` the first number stands."""
    with_unit: frozenset[int]
    """Which of the flattened values carry their unit."""

    def where(self, k: int) -> Location:
        """The address of the k-th value, row by row."""
        row, column = divmod(k, self.values.shape[1])
        return self.cells.where(self.first[0] + row, self.first[1] + column)

    @property
    def labels(self) -> tuple[str, ...]:
        """Of each value, row by row: ``2/B``, or ``R1C1`` where the file names neither."""
        rows, columns = self.values.shape
        if self.row_names is None and self.column_names is None:
            return tuple(f"R{i}C{j}" for i in range(1, rows + 1) for j in range(1, columns + 1))
        down = self.row_names or tuple(f"R{i}" for i in range(1, rows + 1))
        along = self.column_names or tuple(f"C{j}" for j in range(1, columns + 1))
        return tuple(f"{row}/{column}" for row in down for column in along)

    @property
    def size(self) -> str:
        """In words."""
        return f"{self.values.shape[0]} rows × {self.values.shape[1]} columns"


def read_numbers(path: Path) -> Grid:
    """A grid of finite numbers without gaps, from a text file or a workbook with one sheet.

    Raises:
        InputError: with the file, the line and the cell.
    """
    cells, _ = read_cells(path)
    grid = grid_of(cells, None)
    if grid.gaps:
        first = min(grid.gaps)
        what = f"{grid.gaps[first]}, where a finite number is needed"
        raise InputError(Problem(what, grid.where(first), "the table must have no gaps"))
    return grid


def grid_of(cells: Cells, unit: Unit | None) -> Grid:
    """The numbers of a table that is a grid; its cells may carry ``unit``.

    Raises:
        InputError: a cell is neither a number nor a gap, or names and readings cannot be told
            apart; with the address.
    """
    named, labelled = _names(cells)
    top, left = int(named), int(labelled)
    require_rows(cells, top)
    _refuse_empty_rows(cells, top)
    width = cells.width - left
    if width < 1:
        raise cells.refused(top, 0, "a column of names without a column of numbers")
    flat = [value for row in cells.rows[top:] for value in row[left:]]
    reader = NumberReader()
    numbers = reader.read(
        flat, lambda k: cells.where(top + k // width, left + k % width), unit, may_lack=True
    )
    reader.finish()
    values = numbers.values.reshape(-1, width)
    if not labelled:
        _refuse_names_among_readings(cells, values[:, 0], values[:, 1:], (top, 0), "rows")
    if not named:
        _refuse_names_among_readings(cells, values[0], values[1:], (0, left), "columns")
    _refuse_parts_of_numbers(cells, values, top)
    return Grid(
        values,
        numbers.gaps,
        _unique(cells, [(i, 0) for i in range(top, len(cells.rows))]) if labelled else None,
        _unique(cells, [(0, j) for j in range(left, cells.width)]) if named else None,
        cells,
        (top, left),
        numbers.with_unit,
    )


def _names(cells: Cells) -> tuple[bool, bool]:
    """Whether the first row names the columns, and whether the first column names the rows."""
    if has_row_word(cells):
        _refuse_readings_as_names(cells)
        return True, True
    named = not any(is_number(value) or is_gap(value) for value in cells.rows[0])
    require_rows(cells, int(named))
    return named, cells.width > 1 and labelled_by_text(cells, int(named))


def _refuse_readings_as_names(cells: Cells) -> None:
    """An empty first cell may be a reading that was not taken, beside others that were."""
    names = [*cells.rows[0], *(row[0] for row in cells.rows)]
    readings = (v for v in names if is_number(v) and str(v).strip().startswith(("-", "−")))
    if not str(cells.rows[0][0]).strip() and next(readings, None) is not None:
        what = "an empty cell beside negative numbers, which are no names"
        hint = "write - if there is no reading, or 'row' above the rows' names"
        raise cells.refused(0, 0, what, hint)


def _unique(cells: Cells, places: list[tuple[int, int]]) -> tuple[str, ...]:
    seen: dict[str, tuple[int, int]] = {}
    for place in places:
        name = cells.text(*place)
        if name in seen:
            first = cells.where(*seen[name])
            raise cells.refused(*place, f"the name {name!r} a second time (first at {first})")
        seen[name] = place
    return tuple(seen)


def _refuse_empty_rows(cells: Cells, top: int) -> None:
    """A row that a workbook leaves out between others would shift those below it."""
    if cells.sheet is None:
        return
    for i in range(top + 1, len(cells.rows)):
        if cells.row_numbers[i] - cells.row_numbers[i - 1] > 1:
            what = "empty rows above this one, within the grid"
            raise cells.refused(i, 0, what, "delete them, or write - where there is no reading")


def _refuse_names_among_readings(
    cells: Cells, suspect: Vector, others: Matrix, first: tuple[int, int], noun: str
) -> None:
    """Positive numbers at equal steps beside readings that are all negative are names."""
    if suspect.size < FEW or not others.size or not np.isfinite(suspect).all():
        return
    steps = np.diff(suspect)
    rest = others[np.isfinite(others)]
    even = steps[0] > 0 and np.allclose(steps, steps[0], rtol=1e-9, atol=0.0)
    if suspect[0] >= 0 and even and rest.size and (rest < 0).all():
        what = f"{cells.text(*first)} and what follows look like the {noun}' names"
        hint = "write 'row' into the first cell of the first line, above the rows' names"
        raise cells.refused(*first, what, hint)


def _refuse_parts_of_numbers(cells: Cells, values: Matrix, top: int) -> None:
    """Decimal commas between cells that are separated by commas: −350,5 is no pair."""
    if cells.delimiter != "," or values.shape[1] % 2 or values.shape[0] * values.shape[1] < 4:
        return
    whole, parts = values[:, ::2], values[:, 1::2]
    if (whole < 0).all() and ((parts >= 0) & (parts < 100) & (parts % 1 == 0)).all():
        what = "every second number looks like the decimals of the one before it"
        raise cells.refused(top, 1, what, "separate the cells by semicolons or tabs")
