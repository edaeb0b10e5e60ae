"""A file of cells, whichever its kind, with what it hashes to."""

from __future__ import annotations

import hashlib
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.surveys.cells import Cells
from inspect_cli.surveys.text_files import text_cells
from inspect_cli.surveys.workbooks import workbook_cells

WORKBOOKS = (".xlsx", ".xlsm")
UNREAD = (".xls", ".xlsb", ".ods", ".numbers", ".pdf")


@dataclass(frozen=True)
class SourceFile:
    """A file that was read, so that it can be told again."""

    name: str
    sha256: str


def read_cells(path: Path, sheet: str | None = None) -> tuple[Cells, SourceFile]:
    """The cells of a text file or of a workbook's sheet.

    Raises:
        InputError: the file cannot be read, or not be trusted as it is; with the place.
    """
    file = str(path)
    suffix = path.suffix.lower()
    if suffix in UNREAD:
        hint = "save it as .xlsx or as CSV"
        raise InputError(Problem(f"'{suffix}' files are not read", Location(file), hint))
    try:
        data = path.read_bytes()
    except (OSError, ValueError) as error:
        what = f"cannot be read as a table: {getattr(error, 'strerror', None) or error}"
        raise InputError(Problem(what, Location(file))) from error
    source = SourceFile(path.name, hashlib.sha256(data).hexdigest())
    if suffix in WORKBOOKS:
        return workbook_cells(data, file, sheet), source
    if sheet is not None:
        what = f"a text file has no sheet '{sheet}'"
        raise InputError(Problem(what, Location(file), "remove the setting 'sheet'"))
    return text_cells(data, file), source
