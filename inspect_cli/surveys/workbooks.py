"""Excel workbooks: the values of one sheet, never its formulas.

A formula counts with the value that was stored when the workbook was saved; one without is
refused, as are merged cells within the table. What is no plain number (truth values, dates,
percentages, errors) is kept as ``Odd`` and refused where a number is needed.
"""

from __future__ import annotations

import io
import re
import warnings
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.surveys.cells import EXPECTED, Cells, Odd, Value, column_letters

MAX_BYTES = 500_000_000
"""Unpacked; a workbook of a hundred thousand readings has about 10 MB."""
MAX_CELLS = 5_000_000

Place = tuple[int, int]
"""Row and column, counted from 1."""
_FORMULA = re.compile(rb"<(?:\w+:)?f[ >/]")
_PECULIAR = re.compile(rb'<(?:\w+:)?mergeCell |hidden="(?:1|true)"')
_BROKEN = (
    zipfile.BadZipFile, zlib.error, OSError, EOFError, SyntaxError, RuntimeError, ArithmeticError,
    KeyError, IndexError, ValueError, TypeError, AttributeError,
)  # fmt: skip
"""What a damaged workbook makes the libraries raise; parsers of XML raise SyntaxErrors."""


def workbook_cells(data: bytes, file: str, sheet: str | None) -> Cells:
    """The cells of one sheet, by default the only visible one that is not empty.

    Raises:
        InputError: it is no workbook, has no such sheet or several to choose from, or a cell
            cannot be trusted; with ``Sheet!C5``.
    """
    with _refusing_damage(file):
        xml = _sheets_xml(data, file)
        book = _opened(data, read_only=True, data_only=True)
        name, found = _chosen(book, file, sheet)
        if any(_FORMULA.search(part) for part in xml):
            _refuse_unsaved_formulas(data, file, name, found)
        rows, numbers, left = _table(file, name, found)
        notes: tuple[str, ...] = ()
        if any(_PECULIAR.search(part) for part in xml):
            notes = _peculiarities(data, file, name, numbers, left, len(rows[0]))
    return Cells(file, rows, numbers, left, name, warnings=notes)


@contextmanager
def _refusing_damage(file: str) -> Iterator[None]:
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # extensions of Excel that openpyxl passes over
            yield
    except _BROKEN as error:
        what = f"cannot be read as a workbook: {error or type(error).__name__}"
        hint = "open it in a spreadsheet program and save it as .xlsx, without a password"
        raise InputError(Problem(what, Location(file), hint)) from error


def _opened(data: bytes, *, read_only: bool, data_only: bool) -> Any:
    import openpyxl

    return openpyxl.load_workbook(io.BytesIO(data), read_only=read_only, data_only=data_only)


def _sheets_xml(data: bytes, file: str) -> list[bytes]:
    with zipfile.ZipFile(io.BytesIO(data)) as archive:
        if sum(info.file_size for info in archive.infolist()) > MAX_BYTES:
            what = f"holds more than {MAX_BYTES // 1_000_000} MB when it is unpacked"
            raise InputError(Problem(what, Location(file)))
        parts = [n for n in archive.namelist() if re.fullmatch(r"xl/worksheets/[^/]+\.xml", n)]
        return [archive.read(part) for part in parts]


def _chosen(book: Any, file: str, sheet: str | None) -> tuple[str, dict[Place, Value]]:
    names = [s.title for s in book.worksheets]
    if sheet is not None:
        if sheet not in names:
            hint = f"choices: {', '.join(names)}"
            raise InputError(Problem(f"has no sheet '{sheet}'", Location(file), hint))
        return sheet, _filled(book[sheet])
    shown = [s for s in book.worksheets if s.sheet_state == "visible"]
    filled = {s.title: cells for s in shown if (cells := _filled(s))}
    if len(filled) == 1:
        return next(iter(filled.items()))
    if filled:
        hint = f"choose one with sheet: {', '.join(filled)}"
        raise InputError(Problem("several sheets hold something", Location(file), hint))
    if len(names) == len(shown) == 1:
        raise _empty(file, names[0])
    hint = f"{EXPECTED}, on one of the sheets {', '.join(names)}"
    raise InputError(Problem("no visible sheet holds anything", Location(file), hint))


def _empty(file: str, sheet: str) -> InputError:
    where = Location(file, path=f"{sheet}!A1")
    hint = f"{EXPECTED}; a formula counts with the value that was stored with it"
    return InputError(Problem("the sheet is empty", where, hint))


def _filled(sheet: Any) -> dict[Place, Value]:
    """Every cell that holds something."""
    sheet.reset_dimensions()  # what the file says of its size is not always so
    return {
        (cell.row, cell.column): _value(cell)
        for row in sheet.rows
        for cell in row
        if cell.value is not None
    }


def _value(cell: Any) -> Value:
    value, kind = cell.value, cell.data_type
    if kind == "n":
        if cell.has_style and "%" in cell.number_format:
            return Odd(f"the percentage {100 * value:g} %")
        return float(value)
    if kind == "b":
        return Odd(f"the truth value {str(value).upper()}")
    if kind == "e":
        return Odd(f"the error {value}")
    return value if isinstance(value, str) else Odd(f"the date or time {value}")


def _refuse_unsaved_formulas(data: bytes, file: str, name: str, found: dict[Place, Value]) -> None:
    sheet = _opened(data, read_only=True, data_only=False)[name]
    sheet.reset_dimensions()
    for row in sheet.rows:
        for cell in row:
            if cell.value is not None and cell.data_type == "f":
                if (cell.row, cell.column) in found:
                    continue
                raise InputError(
                    Problem(
                        "a formula without a stored value",
                        Location(file, path=f"{name}!{cell.coordinate}"),
                        "open the workbook in a spreadsheet program and save it, or paste values",
                    )
                )


def _table(
    file: str, name: str, found: dict[Place, Value]
) -> tuple[list[list[Value]], list[int], int]:
    """Rows without empty ones around and between them, their numbers, the first column."""
    first = dict(sorted(found, reverse=True))  # the last entry of each row is its first column
    notes = {r for r, c in first.items() if str(found[r, c]).startswith("#")}
    kept = {place: value for place, value in found.items() if place[0] not in notes}
    if not kept:
        raise _empty(file, name)
    numbers = sorted({row for row, _ in kept})
    columns = [column for _, column in kept]
    left, right = min(columns), max(columns)
    if len(numbers) * (right - left + 1) > MAX_CELLS:
        what = f"the table spans {len(numbers)} rows × {right - left + 1} columns"
        where = Location(file, path=f"{name}!{column_letters(right)}{numbers[-1]}")
        raise InputError(Problem(what, where, "clear cells that lie far from the table"))
    span = range(left, right + 1)
    return [[kept.get((r, c), "") for c in span] for r in numbers], numbers, left


def _peculiarities(
    data: bytes, file: str, name: str, numbers: list[int], left: int, width: int
) -> tuple[str, ...]:
    """Refuses merged cells in the table; tells of hidden rows and columns that were read."""
    sheet = _opened(data, read_only=False, data_only=True)[name]
    right, within = left + width - 1, set(numbers)
    for area in sheet.merged_cells.ranges:
        rows = within.intersection(range(area.min_row, area.max_row + 1))
        if rows and area.min_col <= right and area.max_col >= left:
            where = Location(file, path=f"{name}!{area.coord}")
            raise InputError(Problem("merged cells within the table", where, "split them"))
    rows = sum(sheet.row_dimensions[n].hidden for n in numbers if n in sheet.row_dimensions)
    hidden = [d for d in sheet.column_dimensions.values() if d.hidden]
    columns = sum(any(d.min <= c <= d.max for d in hidden) for c in range(left, right + 1))
    if not rows and not columns:
        return ()
    return (f"{name}: {rows} hidden rows and {columns} hidden columns were read, too.",)
