"""The table of all readings: where, what was read, how sure it is, and what it means."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.surface_findings import SurfaceFindings
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
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.class_chips import class_chip
from inspect_cli.reporting.half_cell.places import index_of_places, place_key, points_on
from inspect_cli.reporting.words.text import (
    NOTHING,
    Text,
    number,
    say,
    sentences,
    together,
)

CERTAIN = 0.999
"""Probability of a class above which it is not stated."""


@dataclass(frozen=True)
class Sureness:
    """Standard uncertainty of the potential at a reading's place, and probability of its class."""

    sd_mv: float
    own_class: float
    """Probability that the true potential is in the class of the reading."""
    doubtful: bool


def points_table(points: Sequence[ReadPoint], evaluated: Sequence[SurfaceFindings]) -> Table:
    """Every point, as far as a page has room; columns that no point fills are left out."""
    shown = points[:MOST_POINTS]
    sure = sureness_of(shown, evaluated)
    columns: list[Filled] = [
        *named_columns(shown),
        *place_columns(shown),
        *_read(shown),
        *_judged(shown, sure),
        *contact_columns(shown),
        validity_column(shown),
    ]
    caption = sentences(
        [
            say("Readings by point."),
            say(
                "u(E) is the standard uncertainty of the potential; certainty is the probability "
                "that the true potential at that place is in the class, with a question mark where "
                "it is below 95 %. It does not tell how sure it is that steel corrodes."
            )
            if sure
            else "",
            rows_left_out(len(points)),
        ]
    )
    return filled_table(caption, columns)


def sureness_of(
    points: Sequence[ReadPoint], evaluated: Sequence[SurfaceFindings]
) -> dict[int, Sureness]:
    """The uncertainty of each evaluated point by its index in ``points``."""
    by_name = {e.surface: e.assessed for e in evaluated}
    index = {name: index_of_places(assessed) for name, assessed in by_name.items()}
    on = {id(p): name for name, own in points_on(evaluated, points).items() for p in own}
    found = {}
    for k, p in enumerate(points):
        name = on.get(id(p))
        if name is None or p.point.potential_mv is None:
            continue
        sure = _at(by_name[name], index[name], p)
        if sure is not None:
            found[k] = sure
    return found


def _at(
    assessed: Assessed, index: Mapping[tuple[float, float], int], p: ReadPoint
) -> Sureness | None:
    place = None if p.point.uv_m is None else index.get(place_key(p.point.uv_m))
    if place is None or assessed.astm[place] < 0:
        return None
    return Sureness(
        1e3 * float(assessed.budget.total_v[place]),
        float(assessed.probabilities[place, assessed.astm[place]]),
        bool(assessed.doubtful[place]),
    )


def _read(points: Sequence[ReadPoint]) -> list[Filled]:
    found = [p.point for p in points]
    return [
        (
            Column(say("Potential"), "mV CSE", numeric=True),
            [number(point.potential_mv, 0) for point in found],
        ),
        (
            Column(say("Resistance"), "Ω", numeric=True),
            [number(point.resistance_ohm, 0) for point in found],
        ),
        (
            Column(say("Resistivity"), "Ω·m", numeric=True),
            [number(point.resistivity_ohm_m, 0) for point in found],
        ),
    ]


def _judged(points: Sequence[ReadPoint], sure: Mapping[int, Sureness]) -> list[Filled]:
    each = [sure.get(k) for k in range(len(points))]
    measured = any(p.point.resistivity_ohm_m is not None for p in points)
    return [
        (
            Column("u(E)", "mV", numeric=True),
            [number(None if s is None else s.sd_mv, 1) for s in each],
        ),
        (Column("ASTM C876"), [class_chip(p.point.astm_class) for p in points]),
        (Column(say("Certainty"), numeric=True), [_certainty(s) for s in each]),
        (
            Column(say("Corrosion"), say("combined")),
            [class_chip(p.point.corrosion if measured else None) for p in points],
        ),
    ]


def _certainty(sure: Sureness | None) -> Text:
    if sure is None:
        return NOTHING
    if sure.own_class > CERTAIN:
        # Nothing measured is wholly certain, though its probability may round to 1.
        return together("> ", number(100.0 * CERTAIN, 1), " %")
    percent = 100.0 * sure.own_class
    digits = 1 if percent > 99.0 else 0
    return together(number(percent, digits), " %", " ?" if sure.doubtful else "")
