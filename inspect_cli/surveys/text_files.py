"""Text files of cells: CSV, TSV and columns between blanks, in the encodings that are met.

Encodings: UTF-8 with or without a byte order mark, UTF-16 likewise, otherwise Windows-1252,
which holds Latin-1's letters. Cells stand between tabs, semicolons, commas or blanks: the first
of these in this order that all of the first lines hold. Empty lines and lines that begin with #
are passed over. Quoted cells are those of RFC 4180.
"""

from __future__ import annotations

import csv
import re

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.surveys.cells import EXPECTED, Cells, Value

LOOKED_AT = 50
"""Lines that are asked for the delimiter."""
TEXT_EXPECTED = "CSV or an Excel workbook (.xlsx) is expected"
"""What a file is told that is neither."""
_CONTROL = re.compile("[\x00-\x08\x0b\x0e-\x1f\x7f]")


def text_cells(data: bytes, file: str) -> Cells:
    """The cells of a text file.

    Raises:
        InputError: it is no text, holds nothing, or a row is longer or shorter than the first;
            with the line.
    """
    lines = _decoded(data, file).replace("\r\n", "\n").replace("\r", "\n").split("\n")
    kept = [line for line in lines if line.strip() and not line.startswith("#")]
    if not kept:
        raise InputError(Problem("the file is empty", Location(file, 1, 1, "cell A1"), EXPECTED))
    delimiter = _delimiter(kept)
    numbers, starts, rows = _records(lines, delimiter, file)
    width = len(rows[0])
    for start, row in zip(starts, rows, strict=True):
        if len(row) != width:
            what = f"a row of {len(row)} cells where the first has {width}"
            hint = "write - or n/a where there is no reading; quote a text with a delimiter in it"
            raise InputError(Problem(what, Location(file, start), hint))
    top, bottom, left, right = _filled_part(rows, file)
    return Cells(
        file,
        [row[left:right] for row in rows[top:bottom]],
        numbers[top:bottom],
        left + 1,
        line_numbers=starts[top:bottom],
        lines=lines,
        delimiter=delimiter,
    )


def _filled_part(rows: list[list[Value]], file: str) -> tuple[int, int, int, int]:
    """First and one past the last row and column that hold something.

    Spreadsheets export empty rows and columns around a table as delimiters without cells.
    """
    filled = [k for k, row in enumerate(rows) if any(str(cell).strip() for cell in row)]
    if not filled:
        raise InputError(Problem("the file is empty", Location(file, 1, 1, "cell A1"), EXPECTED))
    left, right = 0, len(rows[0])
    while not any(str(row[right - 1]).strip() for row in rows):
        right -= 1
    while not any(str(row[left]).strip() for row in rows):
        left += 1
    return filled[0], filled[-1] + 1, left, right


def _decoded(data: bytes, file: str) -> str:
    try:
        text = data.decode(_encoding(data))
    except UnicodeDecodeError as error:
        byte = data[error.start : error.start + 1].hex().upper()
        what = f"this is no text: byte {error.start + 1} (0x{byte}) is no character"
        raise InputError(Problem(what, Location(file), TEXT_EXPECTED)) from error
    found = _CONTROL.search(text)
    if found is None:
        return text
    line = text.count("\n", 0, found.start()) + 1
    what = f"this is no text: it holds the control character U+{ord(found[0]):04X}"
    raise InputError(Problem(what, Location(file, line), TEXT_EXPECTED))


def _encoding(data: bytes) -> str:
    if data.startswith((b"\xff\xfe", b"\xfe\xff")):
        return "utf-16"
    head = data[:200]
    if head[1::2].count(0) > len(head) // 4:
        return "utf-16-le"
    if head[::2].count(0) > len(head) // 4:
        return "utf-16-be"
    try:
        data.decode("utf-8")
    except UnicodeDecodeError:
        return "cp1252"
    return "utf-8-sig"


def _delimiter(lines: list[str]) -> str | None:
    asked = lines[:LOOKED_AT]
    everywhere = (d for d in "\t;," if all(d in line for line in asked))
    first = (d for d in "\t;," if d in lines[0])
    return next(everywhere, next(first, None))


def _records(
    lines: list[str], delimiter: str | None, file: str
) -> tuple[list[int], list[int], list[list[Value]]]:
    """Of each row: its number in a spreadsheet, the line it begins in, its cells."""
    numbers: list[int] = []
    starts: list[int] = []
    rows: list[list[Value]] = []
    quoted = delimiter is not None and any('"' in line for line in lines)
    reader = csv.reader((f"{line}\n" for line in lines), delimiter=delimiter or ",", strict=True)
    records = reader if quoted else (line.split(delimiter) for line in lines)
    start = 1
    try:
        for number, record in enumerate(records, start=1):
            here, start = start, (reader.line_num if quoted else number) + 1
            blank = not any(cell.strip() for cell in record)
            is_blank_line = blank and not lines[here - 1].strip()
            if is_blank_line or (record and record[0].startswith("#")):
                continue
            numbers.append(number)
            starts.append(here)
            rows.append(list(record))
    except csv.Error as error:
        where = Location(file, start)
        raise InputError(Problem(f"is not CSV: {error}", where, "check the quotes")) from error
    return numbers, starts, rows
