"""Cells to numbers: exactly what the file says, a known gap, or a refusal with the address.

A number has a decimal point or a decimal comma, the same in the whole table, and no separators
of thousands. It may carry its unit if that is the one its column has anyway. The minus may be
the typographic one.
"""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from functools import partial

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.spatial.arrays import Vector
from inspect_cli.surveys.cells import Odd, Value, shown
from inspect_cli.surveys.units import Unit, unit_named

Where = Callable[[int], Location]
"""The address of the k-th of some cells."""
GAPS = frozenset({"", "-", "–", "—", "n/a", "nan"})
"""What stands for "no reading", in any case."""
_NUMBER = re.compile(r"[+-]?(?:[0-9]+(?:[.,][0-9]*)?|[.,][0-9]+)(?:[eE][+-]?[0-9]+)?")
_WITH_UNIT = re.compile(rf"({_NUMBER.pattern})\s*([^\W\d_].*|[°%].*)", re.DOTALL)


@dataclass(frozen=True)
class Numbers:
    """Some cells as numbers, NaN where there is none, and why there is none."""

    values: Vector
    gaps: dict[int, str]
    with_unit: frozenset[int] = frozenset()
    """Which of the cells carry their unit."""


def is_number(value: Value) -> bool:
    """Whether a cell holds a plain number."""
    if isinstance(value, float):
        return True
    return isinstance(value, str) and _NUMBER.fullmatch(_trimmed(value)) is not None


def is_gap(value: Value) -> bool:
    """Whether a cell says that there is no reading."""
    return isinstance(value, str) and _trimmed(value).casefold() in GAPS


@dataclass
class NumberReader:
    """Reads all the numbers of one table, whose decimal mark has to be one and the same."""

    _commas: list[Location] = field(default_factory=list)
    _points: list[Location] = field(default_factory=list)

    def read(
        self, cells: Sequence[Value], where: Where, unit: Unit | None, *, may_lack: bool
    ) -> Numbers:
        """Numbers of ``cells``.

        Args:
            cells: what the file holds.
            where: the address of the k-th of them.
            unit: that of the column; None when cells must not carry one.
            may_lack: whether there may be gaps.

        Raises:
            InputError: for the first cell that is neither a finite number nor a gap.
        """
        values = np.empty(len(cells))
        gaps: dict[int, str] = {}
        with_unit: set[int] = set()
        plain = not any(isinstance(cell, str) and "_" in cell for cell in cells)
        for k, cell in enumerate(cells):
            try:
                number = float(cell) if plain else math.nan  # type: ignore[arg-type]
            except (ValueError, TypeError):
                number = math.nan
            if not math.isfinite(number):
                number = self._carefully(cell, partial(where, k), unit)
                if math.isnan(number):
                    gaps[k] = _why(cell)
                elif not is_number(cell):
                    with_unit.add(k)
            values[k] = number
        if gaps and not may_lack:
            what = f"{shown(cells[min(gaps)])} stands where a number is needed"
            raise InputError(Problem(what, where(min(gaps))))
        self._watch_points(cells, where)
        return Numbers(values, gaps, frozenset(with_unit))

    def finish(self) -> None:
        """Refuses a table that has decimal points and decimal commas."""
        if self._commas and self._points:
            what = f"a decimal comma in a table with a decimal point ({self._points[0]})"
            raise InputError(Problem(what, self._commas[0], "write all numbers with one of them"))

    def _carefully(self, cell: Value, here: Callable[[], Location], unit: Unit | None) -> float:
        if isinstance(cell, Odd):
            raise _refused(f"{cell.what} is not a plain number", here())
        if isinstance(cell, float):
            raise _refused("the number is not finite", here())
        text = _trimmed(cell)
        if not _NUMBER.fullmatch(text):
            if is_gap(cell):
                return math.nan
            match = _WITH_UNIT.fullmatch(text)
            if not match:
                raise _refused(f"{shown(cell)} is not a number", here())
            _require_unit(match[2], unit, cell, here)
            text = match[1]
        if "," in text and not self._commas:
            self._commas.append(here())
        number = float(text.replace(",", "."))
        if not math.isfinite(number):
            raise _refused(f"{shown(cell)} is not a finite number", here())
        return number

    def _watch_points(self, cells: Sequence[Value], where: Where) -> None:
        """Remember the first decimal point that a text has."""
        if self._points:
            return
        for k, cell in enumerate(cells):
            if isinstance(cell, str) and "." in cell:
                self._points.append(where(k))
                return


def _trimmed(text: str) -> str:
    return text.strip().replace("−", "-")


def _why(cell: Value) -> str:
    text = str(cell).strip()
    return f"the file says {text!r}" if text else "the cell is empty"


def _refused(what: str, where: Location) -> InputError:
    hint = "write a plain number, or - where there is no reading"
    return InputError(Problem(what, where, hint))


def _require_unit(
    text: str, wanted: Unit | None, cell: Value, here: Callable[[], Location]
) -> None:
    found = unit_named(text)
    if found is None:
        raise _refused(f"{shown(cell)} is not a number", here())
    if wanted is None or found != wanted:
        of = f"the column is in {wanted.name}" if wanted else "no unit is expected"
        raise _refused(f"{shown(cell)} is in {found.name} where {of}", here())
