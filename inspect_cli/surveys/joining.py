"""Resistivities from a second file, laid on the points of the first."""

from __future__ import annotations

from collections import Counter
from collections.abc import Hashable
from pathlib import Path

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.spatial.arrays import Vector
from inspect_cli.surveys.files import SourceFile, read_cells
from inspect_cli.surveys.grids import Grid, grid_of
from inspect_cli.surveys.layout import layout_of
from inspect_cli.surveys.lists import ReadingList, list_of
from inspect_cli.surveys.plausible import resistivities_ohm_m
from inspect_cli.surveys.units import UNITS, Unit

SAME_PLACE_DIGITS = 6
"""Coordinates are the same if they agree to a micrometre."""


def joined_resistivity(
    path: Path, settings: SurveySettings, potentials: Grid | ReadingList
) -> tuple[Vector, Unit, bool, SourceFile]:
    """Resistivities (n,) in Ω·m at the points of ``potentials``, NaN where there is none.

    Grids have to be of one size, and of the same names where both have names. Readings of lists
    are matched by their labels where both files have them, otherwise by their coordinates.

    Returns:
        the values, their unit in the file, whether it was stated, and the file.

    Raises:
        InputError: the files do not belong to the same points, or a resistivity is not
            positive; with the address.
    """
    cells, source = read_cells(path)
    layout = layout_of(cells, "resistivity", settings.layout)
    if isinstance(potentials, Grid):
        if layout != "grid":
            raise _of_two_kinds(path, "list", "grid")
        unit = UNITS[settings.resistivity_unit]
        grid = grid_of(cells, unit)
        _require_same_grid(grid, potentials)
        values = resistivities_ohm_m(grid.values.ravel(), unit, grid.where)
        return values, unit, "resistivity_unit" in settings.model_fields_set, source
    if layout != "list":
        raise _of_two_kinds(path, "grid", "list")
    # Only the unit of the resistivities is this file's own affair.
    rows = list_of(cells, "resistivity", settings)
    unit = rows.units["resistivity"]
    raw = rows.numbers["resistivity"].values
    values = resistivities_ohm_m(raw, unit, lambda k: rows.where("resistivity", k))
    stated = "resistivity_unit" in rows.stated or "resistivity_unit" in settings.model_fields_set
    return values[_matches(rows, potentials)], unit, stated, source


def _of_two_kinds(path: Path, this: str, that: str) -> InputError:
    what = f"a {this} of resistivities where the potentials are a {that}"
    return InputError(Problem(what, Location(str(path)), f"give both as a {that}"))


def _require_same_grid(grid: Grid, potentials: Grid) -> None:
    other = potentials.cells.file
    if grid.values.shape != potentials.values.shape:
        what = f"{grid.size} of resistivities where {other} has {potentials.size}"
        hint = "potential and resistivity have to be given at the same points"
        raise InputError(Problem(what, Location(grid.cells.file), hint))
    for noun, here, there in (
        ("row", grid.row_names, potentials.row_names),
        ("column", grid.column_names, potentials.column_names),
    ):
        if here is None or there is None or here == there:
            continue
        k = next(k for k, (a, b) in enumerate(zip(here, there, strict=True)) if a != b)
        what = f"the {noun} {here[k]!r} stands where {other} has {there[k]!r}"
        place = (grid.first[0] + k, 0) if noun == "row" else (0, grid.first[1] + k)
        raise grid.cells.refused(*place, what, "give both files the same names")


def _matches(rows: ReadingList, potentials: ReadingList) -> list[int]:
    """Of each potential, the row of its resistivity; repeated places are matched in order."""
    by_label = "label" in rows.columns and "label" in potentials.columns
    here, there = _keys(rows, by_label), _keys(potentials, by_label)
    if len(here) != len(there):
        what = f"{len(here)} resistivities where {potentials.cells.file} has {len(there)} readings"
        hint = "potential and resistivity have to be given at the same points"
        raise InputError(Problem(what, Location(rows.cells.file), hint))
    where = {key: k for k, key in enumerate(here)}
    missing = next((k for k, key in enumerate(there) if key not in where), None)
    if missing is not None:
        name = potentials.labels[missing]
        what = f"the reading {name!r} has no resistivity in {rows.cells.file}"
        role = "label" if by_label else next(r for r in ("x", "u") if r in potentials.columns)
        hint = "labels, or else coordinates, have to be the same in both files"
        raise InputError(Problem(what, potentials.where(role, missing), hint))
    return [where[key] for key in there]


def _keys(rows: ReadingList, by_label: bool) -> list[Hashable]:
    if by_label:
        names: list[Hashable] = list(rows.labels)
    else:
        found = (rows.coordinates(*roles) for roles in ("xyz", "xy", "uv"))
        places = next(p for p in found if p is not None)
        # Adding zero turns −0.0 into 0.0, which is another key.
        names = list(map(tuple, (np.round(places, SAME_PLACE_DIGITS) + 0.0).tolist()))
    seen: Counter[Hashable] = Counter()
    keys: list[Hashable] = []
    for name in names:
        keys.append((name, seen[name]))
        seen[name] += 1
    return keys
