"""A list of readings: one row each, in named columns, with the units that the names state."""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.schema.survey import MOST_M, SurveySettings
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.surveys.cells import Cells
from inspect_cli.surveys.defusing import undefused
from inspect_cli.surveys.headings import DIMENSIONS, Heading, headings
from inspect_cli.surveys.layout import Wanted, require_rows
from inspect_cli.surveys.numbers import NumberReader, Numbers
from inspect_cli.surveys.units import UNITS, Dimension, Unit

SETTINGS: dict[Dimension, str] = {
    "length": "coordinate_unit",
    "potential": "potential_unit",
    "resistivity": "resistivity_unit",
}
"""The setting that holds the unit of a dimension."""


@dataclass(frozen=True)
class ReadingList:
    """The columns of a list; lengths in m, the rest in the file's own units."""

    cells: Cells
    columns: dict[str, int]
    """Where the column of a role stands."""
    labels: tuple[str, ...]
    numbers: dict[str, Numbers]
    units: dict[str, Unit]
    electrode: str | None
    """What the heading of the potentials says they were read against."""
    stated: frozenset[str] = field(default=frozenset())
    """The settings that the headings answer."""
    ignored: tuple[str, ...] = ()
    """The names of columns that are not read."""

    def where(self, role: str, k: int) -> Location:
        """The address of the k-th reading's cell."""
        return self.cells.where(1 + k, self.columns[role])

    def coordinates(self, *roles: str) -> Points | None:
        """(n, len(roles)), m; None if one of the columns is not there."""
        if not all(role in self.numbers for role in roles):
            return None
        return np.column_stack([self.numbers[r].values * self.units[r].factor for r in roles])

    def column(self, role: str) -> Vector | None:
        """A column's numbers, NaN where there is none; None if there is no such column."""
        return self.numbers[role].values if role in self.numbers else None


def list_of(cells: Cells, wanted: Wanted, settings: SurveySettings) -> ReadingList:
    """The readings of a table that is a list.

    Raises:
        InputError: a column is missing or there twice, a cell is no number, or the names
            contradict the settings; with the address.
    """
    named = headings(cells)
    columns = _columns(cells, named)
    _require_columns(cells, columns, wanted)
    require_rows(cells, 1)
    units, stated = _units(cells, named, columns, settings)
    reader = NumberReader()
    numbers = {
        role: _numbers(reader, cells, column, units[role], role)
        for role, column in columns.items()
        if role in DIMENSIONS and not (role == "z" and _is_empty(cells, column))
    }
    reader.finish()
    for role, column in columns.items():
        if role in numbers and DIMENSIONS[role] == "length":
            _refuse_far(cells, column, numbers[role].values, units[role])
    _require_one_surface(cells, columns)
    return ReadingList(
        cells,
        columns,
        _labels(cells, columns.get("label")),
        numbers,
        units,
        _electrode(cells, named, columns, settings),
        frozenset(stated),
        tuple(cells.text(0, j) for j, h in enumerate(named) if h.role is None),
    )


def _columns(cells: Cells, named: list[Heading]) -> dict[str, int]:
    columns: dict[str, int] = {}
    for j, heading in enumerate(named):
        if heading.role is None:
            continue
        if heading.role == "label" and "label" in columns:
            continue  # a number and a name: the first one names the reading
        if heading.role in columns:
            first = cells.where(0, columns[heading.role])
            what = f"a second column of {heading.role} (first at {first})"
            raise cells.refused(0, j, what, "rename or remove one of the two")
        columns[heading.role] = j
    return columns


def _require_columns(cells: Cells, columns: dict[str, int], wanted: Wanted) -> None:
    placed = {"x", "y"} <= set(columns) or {"u", "v"} <= set(columns)
    if wanted in columns and placed:
        return
    missing = wanted if wanted not in columns else "x and y"
    what = f"the first row names no column {missing}"
    hint = "name the columns, such as x_m,y_m,potential_mv"
    raise InputError(Problem(what, cells.where(0, 0), hint))


def _units(
    cells: Cells, named: list[Heading], columns: dict[str, int], settings: SurveySettings
) -> tuple[dict[str, Unit], set[str]]:
    """The unit of each column, and the settings that all their headings answer."""
    units: dict[str, Unit] = {}
    silent: set[str] = set()
    for role, column in columns.items():
        if role not in DIMENSIONS:
            continue
        dimension, stated = DIMENSIONS[role], named[column].unit
        setting = SETTINGS.get(dimension)
        configured = UNITS[getattr(settings, setting)] if setting else UNITS["c"]
        units[role] = stated or configured
        if stated is None and setting:
            silent.add(setting)
        if stated and setting in settings.model_fields_set and stated != configured:
            what = f"the heading says {stated.name} where the settings say {configured.name}"
            raise cells.refused(0, column, what, f"remove {setting} from the settings")
    asked = {SETTINGS[DIMENSIONS[r]] for r in units if DIMENSIONS[r] in SETTINGS}
    return units, asked - silent


def _numbers(reader: NumberReader, cells: Cells, column: int, unit: Unit, role: str) -> Numbers:
    may_lack = role in ("potential", "resistivity", "temperature")
    values = [row[column] for row in cells.rows[1:]]
    return reader.read(values, lambda k: cells.where(1 + k, column), unit, may_lack=may_lack)


def _refuse_far(cells: Cells, column: int, values: Vector, unit: Unit) -> None:
    far = np.flatnonzero(np.abs(values) > MOST_M / unit.factor)
    if len(far):
        k = int(far[0])
        what = f"{values[k]:g} {unit.name} is no coordinate: beyond ±{MOST_M / 1000.0:,.0f} km"
        raise cells.refused(1 + k, column, what, "correct the cell, or its column's unit")


def _is_empty(cells: Cells, column: int) -> bool:
    return not any(str(row[column]).strip() for row in cells.rows[1:])


def _labels(cells: Cells, column: int | None) -> tuple[str, ...]:
    """The readings' names; their numbers, counted from 1, where they have none."""
    count = len(cells.rows) - 1
    if column is None:
        return tuple(map(str, range(1, count + 1)))
    names = (undefused(cells.text(1 + k, column)) for k in range(count))
    return tuple(name or str(k) for k, name in enumerate(names, start=1))


def _require_one_surface(cells: Cells, columns: dict[str, int]) -> None:
    column = columns.get("surface")
    if column is None:
        return
    first = cells.text(1, column)
    for k in range(2, len(cells.rows)):
        other = cells.text(k, column)
        if other != first:
            what = f"the surface {other!r} in a list of readings of {first!r}"
            raise cells.refused(k, column, what, "give each surface a file of its own")


def _electrode(
    cells: Cells, named: list[Heading], columns: dict[str, int], settings: SurveySettings
) -> str | None:
    column = columns.get("potential")
    stated = named[column].electrode if column is not None else None
    if column is None or stated is None:
        return None
    given = settings.electrode if "electrode" in settings.model_fields_set else None
    if stated == "silver chloride":
        if given is None or not given.startswith("Ag/AgCl"):
            what = "the heading says Ag/AgCl, whose potential depends on its filling"
            hint = "state electrode: 'Ag/AgCl sat. KCl', 'Ag/AgCl 1 M KCl' or 'Ag/AgCl 0.1 M KCl'"
            raise cells.refused(0, column, what, hint)
        return given
    if given not in (None, stated):
        what = f"the heading says {stated} where the settings say {given}"
        raise cells.refused(0, column, what, "remove electrode from the settings")
    return stated
