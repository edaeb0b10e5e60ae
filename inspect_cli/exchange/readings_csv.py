"""``readings.csv``: one line per point, with every digit that the Result holds."""

from __future__ import annotations

import csv
import io
from collections.abc import Sequence
from operator import attrgetter

from inspect_cli.schema.result import PointResult
from inspect_cli.surveys.defusing import defused

PLACE = ("index", "label", "surface", "u_m", "v_m", "x_m", "y_m", "z_m")
FIELDS = tuple(
    name
    for name in PointResult.model_fields
    if name not in ("index", "label", "surface", "p_W", "uv_m")
)
COLUMNS = (*PLACE, *FIELDS)
"""Place first, then the fields of a PointResult under their own names, which hold the unit."""


def readings_csv(points: Sequence[PointResult]) -> str:
    """The points as CSV (RFC 4180 with bare line feeds); a number that does not exist is empty.

    Numbers are written so that reading them back gives the same float; booleans as true, false.
    A text that a spreadsheet would run as a formula gets an apostrophe before it
    (``surveys.defusing``); carriage returns in it become line feeds.
    """
    text = io.StringIO()
    writer = csv.writer(text, lineterminator="\n")
    writer.writerow(COLUMNS)
    fields = attrgetter(*FIELDS)
    for point in points:
        place = (point.index, point.label, point.surface)
        row = (*place, *(point.uv_m or (None, None)), *point.p_W, *fields(point))
        writer.writerow([_cell(value) for value in row])
    return text.getvalue()


def _cell(value: object) -> object:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str):
        # The csv module leaves a lone carriage return unquoted, which would end the line.
        return defused(value).replace("\r\n", "\n").replace("\r", "\n")
    return value
