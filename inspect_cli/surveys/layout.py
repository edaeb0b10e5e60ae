"""Grid or list: which of the two a table is, told by its first row and never by a guess."""

from __future__ import annotations

import re
from typing import Literal

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.surveys.cells import Cells
from inspect_cli.surveys.headings import Heading, headings
from inspect_cli.surveys.numbers import is_gap, is_number

Layout = Literal["grid", "list"]
Wanted = Literal["potential", "resistivity"]

_LETTERS = re.compile(r"[A-Z]{1,2}")
_READ_LETTERS = frozenset("ETUVXYZ")
"""Letters that name columns of a list, and columns of a spreadsheet as well."""


def layout_of(cells: Cells, wanted: Wanted, asked: Layout | None) -> Layout:
    """What the table is.

    A list names a column of what is wanted and columns x and y (or u and v). Everything else is
    a grid, unless it could be a list whose names are missing.

    Raises:
        InputError: it could be either, or half of a list's names are there; with the choices.
    """
    if asked is not None:
        return asked
    if any(is_number(value) for value in cells.rows[0]):
        _refuse_list_without_names(cells, wanted)
        return "grid"
    if _is_row_of_letters(cells):
        return "grid"
    named = headings(cells)
    has_place = _has(named, "x", "y") or _has(named, "u", "v")
    has_quantity = _has(named, wanted)
    if has_place and has_quantity:
        if _letters(cells) == sorted(_letters(cells)) and len(_letters(cells)) == cells.width:
            raise _undecided(cells, "the first row may name a list's columns or a grid's")
        return "list"
    if has_place:
        raise _undecided(cells, f"columns of coordinates, but none of {_spoken(wanted)}")
    if has_quantity and cells.width > 1:
        raise _undecided(cells, f"a column of {_spoken(wanted)}, but no x and y")
    return "grid"


def _has(named: list[Heading], *roles: str) -> bool:
    return set(roles) <= {heading.role for heading in named}


def _spoken(wanted: Wanted) -> str:
    return "potentials" if wanted == "potential" else "resistivities"


def _letters(cells: Cells) -> list[str]:
    return [v for v in cells.rows[0] if isinstance(v, str) and _LETTERS.fullmatch(v.strip())]


def _is_row_of_letters(cells: Cells) -> bool:
    """Whether the names are a spreadsheet's columns, such as B D F H."""
    letters = _letters(cells)
    rising = letters == sorted(letters, key=lambda name: (len(name), name))
    return len(letters) >= cells.width - 1 and rising and not set(letters) <= _READ_LETTERS


def _refuse_list_without_names(cells: Cells, wanted: Wanted) -> None:
    """Three to five columns without names whose first ones look like coordinates."""
    if not 3 <= cells.width <= 5 or len(cells.rows) < 3:
        return
    body = [row for row in cells.rows if all(map(is_number, row))]
    if len(body) < len(cells.rows) or any("," in str(v) for row in body for v in row):
        return
    values = np.array([[float(str(v).replace("−", "-")) for v in row] for row in body])
    places, last = values[:, :2], values[:, -1]
    if wanted == "potential" and (places >= 0).all() and (last < 0).all():
        raise _undecided(cells, "the first columns look like coordinates and have no names")


def _undecided(cells: Cells, what: str) -> InputError:
    hint = (
        "a list names its columns, such as x_m,y_m,potential_mv; "
        "a grid holds readings alone. State layout: list or layout: grid"
    )
    return InputError(Problem(what, cells.where(0, 0), hint))


def require_rows(cells: Cells, first: int) -> None:
    """Refuses a table of nothing but names."""
    if len(cells.rows) <= first:
        what = "holds no rows of numbers"
        where = Location(cells.file, path=cells.sheet or "")
        raise InputError(Problem(what, where, "readings are expected below the names"))


def labelled_by_text(cells: Cells, first: int) -> bool:
    """Whether every cell below the names in the first column is a text that is no number."""
    column = [row[0] for row in cells.rows[first:]]
    return not any(is_number(value) or is_gap(value) for value in column)
