"""The sorties of a survey one by one: status, points, time and energy."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.content.blocks import REPORT_NAME, Block, Column, Table, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.flight.sorties import energy_figure
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Chip, Link, Text, number, say, separated
from inspect_cli.schema.coverage import CoveragePlan, Sortie
from inspect_cli.schema.result import Result

SHOWN_GROUPS = (
    *("tracking", "estimation", "guidance", "contact", *INSTRUMENTS),
    *("flight", "actuators"),
)
"""Groups of metrics in the table on all sorties together."""


def _sorties(survey: CoveragePlan, result: Result, flown: Sequence[Result]) -> list[Block]:
    results = [*flown, *[None] * (len(survey.sorties) - len(flown))]
    rows = [_sortie_row(s, r) for s, r in zip(survey.sorties, results, strict=True)]
    columns = [
        Column(say("Sortie")),
        Column(say("Status")),
        Column(say("Points"), numeric=True),
        Column(say("Valid"), numeric=True),
        Column(say("Time planned"), "s", numeric=True),
        Column(say("flown"), "s", numeric=True),
        Column(say("Energy planned"), "Wh", numeric=True),
        Column(say("flown"), "Wh", numeric=True),
        Column(say("Planned / flown"), numeric=True),
        Column(say("Remark"), prose=True),
    ]
    caption = say(
        "The sorties with their own reports. Planned energy is by the planner's momentum theory, "
        "flown energy by the true speeds of the rotors; a sortie may plan with {budget} Wh, the "
        "battery less its reserve.",
        budget=number(survey.budget_wh, 1),
    )
    together = say("All sorties together: sums, worst cases and means.")
    return [
        Table(caption, columns, rows, wide=True),
        *drawn([energy_figure(survey, flown)]),
        *metrics_table(together, result, SHOWN_GROUPS),
    ]


def _sortie_row(sortie: Sortie, result: Result | None) -> list[Text]:
    remark = say("added by the refinement rule") if sortie.added else ""
    planned = [number(sortie.plan.duration_s, 0), number(sortie.plan.energy_wh, 1)]
    total = number(len(sortie.plan.targets), 0)
    if result is None:
        status = Chip(say("not flown"), "fail")
        cells: list[Text] = [NOTHING, planned[0], NOTHING, planned[1], NOTHING, NOTHING]
        return [str(sortie.number), status, total, *cells, remark]
    name = say("Sortie {n}", n=str(sortie.number))
    return [
        Link(name, f"{sortie.folder}/{REPORT_NAME}"),
        Chip(recorded(result.status), "pass" if result.status == "completed" else "fail"),
        total,
        number(sum(point.valid for point in result.points), 0),
        planned[0],
        number(result.value("flight.duration_s"), 0),
        planned[1],
        number(result.value("flight.energy_wh_flown"), 1),
        number(result.value("flight.energy_planned_over_flown"), 3),
        separated([remark, recorded(result.status_reason)], "; "),
    ]


CHAPTER = Chapter(
    heading=say("Sorties"),
    applies=lambda material: material.coverage is not None,
    blocks=lambda material: (
        _sorties(material.coverage.plan, material.result, material.coverage.flown)
        if material.coverage
        else ()
    ),
    spans_sorties=True,
)
