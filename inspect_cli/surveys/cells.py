"""The cells of a table as its file holds them, each with its address."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from typing import TypeAlias

from inspect_cli.errors import InputError, Location, Problem


@dataclass(frozen=True, slots=True)
class Odd:
    """What stands in a workbook's cell and is neither text nor a plain number."""

    what: str


EXPECTED = "a grid of readings is expected, or a list with columns x, y and potential"
"""What an empty table is told."""

Value: TypeAlias = str | float | Odd
"""Text as it stands in the file, or a number that a workbook stores; "" for an empty cell."""


def column_letters(column: int) -> str:
    """The name of a spreadsheet's column, counted from 1: A … Z, AA …"""
    name = ""
    while column:
        column, rest = divmod(column - 1, 26)
        name = chr(ord("A") + rest) + name
    return name


@dataclass(frozen=True)
class Cells:
    """A rectangular table of cells and where each stands."""

    file: str
    rows: list[list[Value]]
    """All of one width, none of them empty."""
    row_numbers: list[int]
    """The number of each row in a spreadsheet, counted from 1."""
    first_column: int = 1
    """The spreadsheet's column of the first cell of each row."""
    sheet: str | None = None
    """The workbook's sheet; None for a text file."""
    line_numbers: list[int] = field(default_factory=list)
    """Of a text file: the line that each row begins in, counted from 1."""
    lines: list[str] = field(default_factory=list)
    """Of a text file: all of its lines."""
    delimiter: str | None = None
    """Of a text file; None for blanks."""
    warnings: tuple[str, ...] = ()

    @property
    def width(self) -> int:
        """How many cells a row has."""
        return len(self.rows[0])

    def where(self, i: int, j: int) -> Location:
        """The address of a cell: ``s.csv:5:12: cell C5``, or ``s.xlsx: Sheet1!C5``."""
        name = f"{column_letters(self.first_column + j)}{self.row_numbers[i]}"
        if self.sheet is not None:
            return Location(self.file, path=f"{self.sheet}!{name}")
        line = self.line_numbers[i]
        column = _start_of(self.lines[line - 1], self.delimiter, self.first_column - 1 + j)
        return Location(self.file, line, column, f"cell {name}")

    def refused(self, i: int, j: int, what: str, hint: str = "") -> InputError:
        """The error about one cell."""
        return InputError(Problem(what, self.where(i, j), hint))

    def text(self, i: int, j: int) -> str:
        """A cell as text, without blanks around it; a whole number without its decimal point."""
        value = self.rows[i][j]
        if isinstance(value, Odd):
            raise self.refused(i, j, f"{value.what} stands where a name is expected")
        if isinstance(value, float):
            return f"{value:.0f}" if value.is_integer() else repr(value)
        return value.strip()


def shown(value: Value) -> str:
    """A cell's content as a message quotes it."""
    if isinstance(value, Odd):
        return value.what
    text = repr(value.strip()) if isinstance(value, str) else f"{value:g}"
    return text if len(text) <= 40 else text[:37] + "…'"


def _start_of(line: str, delimiter: str | None, cell: int) -> int | None:
    """Where a cell begins in its line, counted from 1; None if it begins in a later line."""
    if delimiter is None:
        starts = [match.start() + 1 for match in re.finditer(r"\S+", line)]
        return starts[cell] if cell < len(starts) else None
    starts, quoted = [1], False
    for k, character in enumerate(line):
        if character == '"':
            quoted = not quoted
        elif character == delimiter and not quoted:
            starts.append(k + 2)
    return starts[cell] if cell < len(starts) else None
