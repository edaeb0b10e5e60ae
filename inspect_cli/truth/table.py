"""Tables of numbers as measuring software writes them: CSV with names, or plain columns."""

from __future__ import annotations

import csv
import math
from pathlib import Path

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.spatial.arrays import Matrix

Line = tuple[int, list[str]]
"""Number of a line in its file, counted from 1, and its cells."""


def read_table(path: Path) -> Matrix:
    """Read a table (rows, columns) of finite numbers.

    Cells are separated by tabs, commas, semicolons or blanks. Empty lines and lines that begin
    with # are passed over. A first line without any number names the columns. When the first
    name is ``row`` or empty, the first cell of every line is its row's label, and then the
    other names may be numbers.

    Raises InputError that names file, line and cell.
    """
    lines = _lines(path)
    named, labelled = _header(lines[0][1])
    body = lines[1:] if named else lines
    if labelled:
        body = [(number, cells[1:]) for number, cells in body]
    if not body:
        raise InputError(f"{path} holds no rows of numbers")
    width = len(lines[0][1]) - labelled
    for number, cells in body:
        if len(cells) != width:
            what = f"a row of {len(cells)} values where the first line has {width}"
            raise InputError(Problem(what, Location(str(path), number)))
    return np.array([[_number(path, line, k) for k in range(width)] for line in body])


def _lines(path: Path) -> list[Line]:
    try:
        text = path.read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise InputError(f"{path} cannot be read as a table: {error}") from error
    numbered = [(n, line.rstrip()) for n, line in enumerate(text.splitlines(), start=1)]
    kept = [(n, line) for n, line in numbered if line.strip() and not line.startswith("#")]
    if not kept:
        raise InputError(f"{path} is empty")
    delimiter = next((d for d in "\t,;" if d in kept[0][1]), None)
    if delimiter is None:
        return [(n, line.split()) for n, line in kept]
    return [(n, next(csv.reader([line], delimiter=delimiter))) for n, line in kept]


def _header(cells: list[str]) -> tuple[bool, bool]:
    """Whether the first line names the columns, and whether rows carry labels."""
    labelled = cells[0].strip().lower() in ("row", "")
    return labelled or not any(map(_is_number, cells)), labelled


def _is_number(cell: str) -> bool:
    try:
        float(cell)
    except ValueError:
        return False
    return True


def _number(path: Path, line: Line, k: int) -> float:
    number, cells = line
    value = float(cells[k]) if _is_number(cells[k]) else math.nan
    if math.isfinite(value):
        return value
    what = f"value {k + 1} of the row, {cells[k]!r}, is not a finite number"
    hint = "write plain numbers with a decimal point"
    raise InputError(Problem(what, Location(str(path), number), hint))
