"""Grid or list: which of the two a table is, told by its first row and never by a guess.

A grid's columns have names that only count: letters, numbers, or one word before numbers. Other
words may be a list's whose names are not known here; its coordinates would become potentials.
"""

from __future__ import annotations

import re
from collections.abc import Sequence
from typing import Literal

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.surveys.cells import Cells, Value, shown
from inspect_cli.surveys.headings import Heading, headings
from inspect_cli.surveys.numbers import is_gap, is_number

Layout = Literal["grid", "list"]
Wanted = Literal["potential", "resistivity"]

_LETTERS = re.compile(r"[A-Z]{1,2}")
_READ_LETTERS = frozenset("ETUVXYZ")
"""Letters that name columns of a list, and columns of a spreadsheet as well."""
SHOWN = 6
"""So many names are quoted."""
_LETTER_NAME = re.compile(r"[A-Z]{1,2}|[a-z]")
_COUNTED_NAME = re.compile(r"([^\W\d][^\d]*?)[\s_.#\-]*[0-9]+")
"""``C1``, ``P 3``, ``Spalte 4``: the group is the word before the number."""
ROW_WORDS = frozenset({"", "row", "rows", "zeile", "zeilen", "reihe", "reihen", "row/column"})
"""What stands above the names of rows."""


def layout_of(cells: Cells, wanted: Wanted, asked: Layout | None) -> Layout:
    """What the table is.

    A list names a column of what is wanted and columns x and y (or u and v). Everything else is
    a grid, unless it could be a list whose names are missing.

    Raises:
        InputError: it could be either, or half of a list's names are there; with the choices.
    """
    if asked is not None:
        return asked
    first = cells.rows[0]
    if any(is_number(value) for value in first):
        _refuse_unnamed_coordinates(cells, cells.rows, wanted)
        return "grid"
    if not _is_row_of_letters(cells) and _names_a_list(cells, wanted):
        return "list"
    if cells.width > 1 and not any(map(is_gap, first[1:])):
        _refuse_words(cells, wanted)
    skip = int(has_row_word(cells))
    _refuse_unnamed_coordinates(cells, [row[skip:] for row in cells.rows[1:]], wanted)
    return "grid"


def has_row_word(cells: Cells) -> bool:
    """Whether the first cell says that row names stand below it."""
    corner = cells.rows[0][0]
    return cells.width > 1 and isinstance(corner, str) and corner.strip().casefold() in ROW_WORDS


def _names_a_list(cells: Cells, wanted: Wanted) -> bool:
    """Whether the names are those of a list; refuses half of them."""
    named = headings(cells)
    has_place = _has(named, "x", "y") or _has(named, "u", "v")
    has_quantity = _has(named, wanted)
    unknown = [j for j, heading in enumerate(named) if heading.role is None]
    others = f"; not understood: {_quoted(cells, unknown)}" if unknown else ""
    if has_place and has_quantity:
        if _letters(cells) == sorted(_letters(cells)) and len(_letters(cells)) == cells.width:
            raise _undecided(cells, "the first row may name a list's columns or a grid's")
        return True
    if has_place:
        raise _undecided(cells, f"columns of coordinates, but none of {_spoken(wanted)}{others}")
    if has_quantity and cells.width > 1:
        raise _undecided(cells, f"a column of {_spoken(wanted)}, but no x and y{others}")
    return False


def _has(named: list[Heading], *roles: str) -> bool:
    return set(roles) <= {heading.role for heading in named}


def _spoken(wanted: Wanted) -> str:
    return "potentials" if wanted == "potential" else "resistivities"


def _letters(cells: Cells) -> list[str]:
    return [v for v in cells.rows[0] if isinstance(v, str) and _LETTERS.fullmatch(v.strip())]


def _is_row_of_letters(cells: Cells) -> bool:
    """Whether the names are a spreadsheet's columns, such as B D F H; the first may be another."""
    letters = _letters(cells)
    rising = letters == sorted(letters, key=lambda name: (len(name), name))
    rest = [v for v in cells.rows[0][1:] if isinstance(v, str) and _LETTERS.fullmatch(v.strip())]
    full = bool(rest) and len(rest) == cells.width - 1
    return full and rising and not set(letters) <= _READ_LETTERS


def _refuse_words(cells: Cells, wanted: Wanted) -> None:
    """Names that do not merely count may be a list's; the first may stand above rows' names."""
    if _count_columns(cells.rows[0][1:]):
        return
    named = headings(cells)
    words = [j for j in range(int(has_row_word(cells)), cells.width) if named[j].role is None]
    what = f"names of columns that are not understood: {_quoted(cells, words)}"
    example = "potential_mv" if wanted == "potential" else "resistivity_kohm_cm"
    hint = (
        f"a list has columns x, y[, z] and {wanted}: name them, such as x_m,y_m,{example}. "
        "A grid's columns are A, B, C or C1, C2, C3 or numbers; "
        "state --layout grid (layout: grid) if it is a grid with such names"
    )
    raise cells.refused(0, words[0] if words else 0, what, hint)


def _quoted(cells: Cells, columns: list[int]) -> str:
    names = [shown(cells.rows[0][j]) for j in columns[:SHOWN]]
    return ", ".join([*names, "…"] if len(columns) > SHOWN else names)


def _count_columns(names: Sequence[Value]) -> bool:
    """Whether names are letters, or one and the same word with numbers."""
    texts = [name.strip() for name in names if isinstance(name, str)]
    if len(texts) < len(names):
        return False
    if all(map(_LETTER_NAME.fullmatch, texts)):
        return True
    counted = [match for text in texts if (match := _COUNTED_NAME.fullmatch(text))]
    return len(counted) == len(texts) and len({m[1].casefold() for m in counted}) == 1


def _refuse_unnamed_coordinates(cells: Cells, body: list[list[Value]], wanted: Wanted) -> None:
    """Three to five columns whose first ones look like coordinates, and whose last like readings.

    The last may have gaps.
    """
    if wanted != "potential" or len(body) < 2 or not 3 <= len(body[0]) <= 5:
        return
    if not all(all(map(is_number, row[:-1])) for row in body):
        return
    if not all(is_number(row[-1]) or is_gap(row[-1]) for row in body):
        return
    places = np.array([[_number(v) for v in row[:2]] for row in body])
    last = np.array([_number(row[-1]) for row in body if is_number(row[-1])])
    if len(last) and (places >= 0).all() and (last < 0).all():
        raise _undecided(cells, "the first columns look like coordinates and have no such names")


def _number(value: Value) -> float:
    return float(str(value).replace("−", "-").replace(",", "."))


def _undecided(cells: Cells, what: str) -> InputError:
    hint = (
        "a list names its columns, such as x_m,y_m,potential_mv; "
        "a grid holds readings alone. State layout: list or layout: grid (--layout)"
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
