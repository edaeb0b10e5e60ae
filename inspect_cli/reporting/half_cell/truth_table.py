"""The table of a simulation's true values beside what was read at each point."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import Block, Column, Table
from inspect_cli.reporting.content.point_columns import MOST_POINTS, rows_left_out
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.class_chips import class_chip
from inspect_cli.reporting.words.text import Text, number, say, sentences
from inspect_cli.schema.result import PointResult

TRUE_FIELDS = (
    "true_force_n",
    "true_force_peak_n",
    "position_error_m",
    "true_potential_mv",
    "true_corrosion",
)


def truth_table(points: Sequence[ReadPoint]) -> list[Block]:
    """What a simulation knows of each point beside what was read; nothing without truth."""
    if all(getattr(p.point, field) is None for p in points for field in TRUE_FIELDS):
        return []
    columns = [
        Column(say("Point")),
        Column(say("Potential read"), "mV CSE", numeric=True),
        Column(say("true"), "mV CSE", numeric=True),
        Column(say("Resistivity read"), "Ω·m", numeric=True),
        Column(say("true"), "Ω·m", numeric=True),
        Column(say("Corrosion read")),
        Column(say("true")),
        Column(say("Normal force"), say("N, mean of last 2 s"), numeric=True),
        Column(say("Peak"), "N", numeric=True),
        Column(say("Off target"), "mm", numeric=True),
    ]
    what = say(
        "Readings against the truth of the simulation, which no part of the vehicle could see."
    )
    shown = points[:MOST_POINTS]
    caption = sentences([what, rows_left_out(len(points))])
    return [Table(caption, columns, [_truth_row(p.point) for p in shown], wide=True)]


def _truth_row(point: PointResult) -> list[Text]:
    off_m = point.position_error_m
    return [
        point.label,
        number(point.potential_mv, 0),
        number(point.true_potential_mv, 0),
        number(point.resistivity_ohm_m, 0),
        number(point.true_resistivity_ohm_m, 0),
        class_chip(point.corrosion),
        class_chip(point.true_corrosion),
        number(point.true_force_n, 2),
        number(point.true_force_peak_n, 2),
        number(None if off_m is None else 1e3 * off_m, 1),
    ]
