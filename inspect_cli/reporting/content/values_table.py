"""The readings of any instrument by name and unit: a table, and marks in the view."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.content.point_columns import (
    MOST_POINTS,
    Filled,
    contact_columns,
    filled_table,
    named_columns,
    place_columns,
    rows_left_out,
    validity_column,
)
from inspect_cli.reporting.content.read_points import ReadPoint, reason_text
from inspect_cli.reporting.figures.figure import Json, words
from inspect_cli.reporting.figures.palette import MUTED
from inspect_cli.reporting.figures.scene_marks import SceneMarks, invalid_marks, point_marks
from inspect_cli.reporting.words.text import Text, say, sentences, separated, significant, together

DIGITS = 6
"""Significant digits of a value, whose size nothing is known of."""


def values_table(instrument: str, points: Sequence[ReadPoint]) -> Table:
    """Every point that an instrument read, with a column for each of its values."""
    shown = points[:MOST_POINTS]
    what = say("Readings of the instrument “{instrument}” by point.", instrument=instrument)
    return filled_table(
        sentences([what, rows_left_out(len(points))]),
        [
            *named_columns(shown),
            *place_columns(shown),
            *_value_columns(shown),
            *contact_columns(shown),
            validity_column(shown),
        ],
    )


def _value_columns(points: Sequence[ReadPoint]) -> list[Filled]:
    found = [p.point for p in points]
    units = {name: unit for point in found for name, unit in point.units.items()}
    names = dict.fromkeys([*units, *(name for point in found for name in point.values)])
    return [
        (
            Column(name, _shown_unit(units.get(name, "")), numeric=True),
            [significant(point.values.get(name), DIGITS) for point in found],
        )
        for name in names
    ]


def _shown_unit(unit: str) -> str:
    """The unit; nothing of a number without one."""
    return "" if unit == "1" else unit


def values_marks(instrument: str, points: Sequence[ReadPoint]) -> SceneMarks:
    """The points that an instrument read, with their values under the pointer."""
    valid = [p for p in points if p.point.valid]
    invalid = [p for p in points if not p.point.valid]
    traces: list[Json] = []
    if valid:
        name = say("valid readings of {instrument}", instrument=words(instrument))
        places_W, hover = [p.point.p_W for p in valid], [_hover_text(p) for p in valid]
        traces.append(point_marks(name, places_W, {"size": 6, "color": MUTED}, hover))
    name = say("invalid readings of {instrument}", instrument=words(instrument))
    places_W, reasons = [p.point.p_W for p in invalid], [reason_text(p) for p in invalid]
    return SceneMarks([*traces, *invalid_marks(name, places_W, reasons)])


def _hover_text(p: ReadPoint) -> Text:
    point = p.point
    values = [
        together(
            words(name),
            " ",
            significant(value, DIGITS),
            words(f" {_shown_unit(point.units.get(name, ''))}".rstrip()),
        )
        for name, value in point.values.items()
    ]
    return separated([words(point.label), *values], "<br>")
