"""``readings.csv``: one line per point, with every digit that the Result holds."""

from __future__ import annotations

import csv
import io
from collections.abc import Iterable, Iterator, Sequence

from inspect_cli.schema.result import PointResult
from inspect_cli.surveys.defusing import defused

PLACE = ("index", "label", "surface", "u_m", "v_m", "x_m", "y_m", "z_m")
FIELDS = tuple(
    name
    for name in PointResult.model_fields
    if name not in ("index", "label", "surface", "p_W", "uv_m", "instrument", "values", "units")
)
NUMBERS = ("_mv", "_n", "_s", "_m", "_ohm")
"""How the names of fields end that hold nothing but numbers."""
COLUMNS = (*PLACE, *FIELDS)
"""Place first, then the fields of a PointResult under their own names, which hold the unit. What
another instrument than a half-cell read follows in columns of its own names, each with its unit in
the next one, behind a column ``instrument``."""


def readings_csv(points: Sequence[PointResult]) -> str:
    """The points as CSV (RFC 4180 with bare line feeds); a number that does not exist is empty.

    Numbers are written so that reading them back gives the same float; booleans as true, false.
    A text that a spreadsheet would run as a formula gets an apostrophe before it
    (``surveys.defusing``); carriage returns in it become line feeds.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    values = value_columns(points)
    writer.writerow((*COLUMNS, *map(_cell, values)))
    more = [list(map(_cell, column)) for column in values.values()]
    writer.writerows(zip(*_columns(points), *more, strict=True))
    return text.getvalue()


def value_columns(points: Sequence[PointResult]) -> dict[str, list[str | float | None]]:
    """What other instruments than a half-cell read, as columns with one entry for each point.

    The kind of the instrument, then each value by its name and its unit; None where a point has
    none. There are no columns where no other instrument was read.
    """
    columns: dict[str, list[str | float | None]] = {}
    if any(point.instrument for point in points):
        columns["instrument"] = [point.instrument or None for point in points]
    for name in value_names(points):
        columns[name] = [point.values.get(name) for point in points]
        if any(name in point.units for point in points):
            columns[f"{name}_unit"] = [point.units.get(name) for point in points]
    return columns


def value_names(points: Iterable[PointResult]) -> tuple[str, ...]:
    """The names of all that other instruments than a half-cell were to read at the points."""
    return tuple(dict.fromkeys(name for p in points for name in (*p.units, *p.values)))


def _columns(points: Sequence[PointResult]) -> Iterator[Iterable[object]]:
    """Column by column, because numbers need no look at each and there may be a lot of them."""
    yield [point.index for point in points]
    yield map(_cell, [point.label for point in points])
    yield map(_cell, [point.surface for point in points])
    for axis in (0, 1):
        yield [None if point.uv_m is None else point.uv_m[axis] for point in points]
    for axis in (0, 1, 2):
        yield [point.p_W[axis] for point in points]
    for name in FIELDS:
        column = [getattr(point, name) for point in points]
        yield column if name.endswith(NUMBERS) else map(_cell, column)


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # The csv module leaves a lone carriage return unquoted, which would end the line.
        return defused(value).replace("\r\n", "\n").replace("\r", "\n")
    return value
