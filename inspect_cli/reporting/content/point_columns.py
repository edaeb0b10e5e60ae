"""Columns that tables of points share, whatever the instrument: place, contact, validity."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.words.text import NOTHING, Chip, Text, number, say

MOST_POINTS = 1000
"""Rows of a table of points; ``readings.csv`` has all of them."""

Filled = tuple[Column, Sequence[Text]]
"""A column and its cells."""


def named_columns(points: Sequence[ReadPoint]) -> list[Filled]:
    """Labels and surfaces."""
    return [
        (Column(say("Point")), [p.point.label for p in points]),
        (Column(say("Surface")), [p.surface or NOTHING for p in points]),
    ]


def place_columns(points: Sequence[ReadPoint]) -> list[Filled]:
    """Coordinates on the surface, m."""
    uv = [p.point.uv_m or (None, None) for p in points]
    return [
        (Column(name, "m", numeric=True), [number(place[axis], 3) for place in uv])
        for axis, name in enumerate("uv")
    ]


def contact_columns(points: Sequence[ReadPoint]) -> list[Filled]:
    """Force and time of the contact."""
    found = [p.point for p in points]
    return [
        (
            Column(say("Probe force"), "N", numeric=True),
            [number(point.probe_force_n, 2) for point in found],
        ),
        (
            Column(say("Contact"), "s", numeric=True),
            [number(point.contact_s, 1) for point in found],
        ),
    ]


def validity_column(points: Sequence[ReadPoint]) -> Filled:
    """Whether each reading counts, and why not."""
    return Column(say("Validity"), prose=True), [_validity(p) for p in points]


def _validity(p: ReadPoint) -> Text:
    return (
        say("valid") if p.point.valid else Chip(say("invalid: {reason}", reason=p.reason), "fail")
    )


def filled_table(caption: Text, columns: Iterable[Filled]) -> Table:
    """A table without the columns that no point fills."""
    kept = [(column, cells) for column, cells in columns if any(map(_says_something, cells))]
    rows = list(zip(*(cells for _, cells in kept), strict=True))
    return Table(caption, [column for column, _ in kept], rows, wide=True)


def _says_something(cell: Text) -> bool:
    return bool(getattr(cell, "value", cell) not in (None, NOTHING))


def rows_left_out(points: int) -> Text:
    """A sentence on the points that the table leaves out; empty if it has all."""
    if points <= MOST_POINTS:
        return ""
    return say(
        "The first {shown} of {n} points; readings.csv beside this report has all of them.",
        shown=number(MOST_POINTS, 0),
        n=number(points, 0),
    )
