"""``report.html`` of a survey that took several sorties."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from inspect_cli.files import write_whole
from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.figure import drawn
from inspect_cli.reporting.figures_survey import energy_figure, tour_figures
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.page import Section, page
from inspect_cli.reporting.points import ReadPoint, read_points
from inspect_cli.reporting.provenance import provenance
from inspect_cli.reporting.report import (
    REPORT_NAME,
    header,
    summary,
    survey_content,
)
from inspect_cli.reporting.table import NOTHING, Column, chip, number, table
from inspect_cli.reporting.tables import fits_table, metrics_table
from inspect_cli.reporting.works import works_of
from inspect_cli.schema.coverage import CoveragePlan, Skipped, Sortie
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def write_survey_report(
    log: RunLog, result: Result, flown: Sequence[Result], survey: CoveragePlan, folder: Path
) -> Path:
    """Write ``report.html`` into ``folder``; return the page's path.

    Args:
        log: of the first sortie; mission, platform and versions are those of all.
        result: of the whole survey.
        flown: of the sorties that were flown, in their order.
        survey: as it was flown, with the sorties that were added on the way.
        folder: holds the sorties' own reports in folders of their own.
    """
    plan = survey.joined()
    path = folder / REPORT_NAME
    write_whole(path, survey_html(log, result, flown, survey, plan))
    return path


def survey_html(
    log: RunLog, result: Result, flown: Sequence[Result], survey: CoveragePlan, plan: Plan
) -> str:
    """The page as text."""
    points = read_points(result, plan)
    title = log.mission().title or result.mission
    works = works_of(log, plan)
    whole = summary(log, result, works, points)
    read = []
    if points:
        read = [Section("survey", "Corrosion survey", survey_content(log, plan, points))]
    sections = [
        Section("summary", "Summary", joined(element("p", _extent(survey)), whole)),
        *read,
        Section("coverage", "Coverage", _coverage(survey, plan, points)),
        Section("sorties", "Sorties", _sorties(survey, result, flown)),
        Section("structure", "Structure", fits_table(plan)),
        Section("provenance", "Provenance", _provenance(log, result, plan)),
    ]
    return page(f"{title} – inspection report", header(log, result, works, title), sections)


def _coverage(survey: CoveragePlan, plan: Plan, points: Sequence[ReadPoint]) -> Markup:
    added = [t.label for s in survey.sorties if s.added for t in s.plan.targets]
    sentences = [
        _extent(survey),
        "The shortest way that was found through the standoffs of all points is "
        f"{number(survey.tour_m, 1)} m, before it was split.",
    ]
    if added:
        verb = "was" if len(added) == 1 else "were"
        sentences.append(
            f"{', '.join(added)} {verb} added by the refinement rule of ASTM C876, between "
            "neighbours whose readings differ by more than the mission allows; a label names "
            "those neighbours."
        )
    return joined(
        element("p", " ".join(sentences)),
        drawn(tour_figures(survey, plan)),
        _skipped_table(survey.skipped),
    )


def _extent(survey: CoveragePlan) -> str:
    """How much of the surface was asked for and how much was left out."""
    left = len(survey.skipped)
    out = "none was left out" if not left else f"{left} {'was' if left == 1 else 'were'} left out"
    many = "sortie" if len(survey.sorties) == 1 else "sorties"
    return f"{survey.points} points were planned in {len(survey.sorties)} {many}; {out}."


def _skipped_table(skipped: Sequence[Skipped]) -> Markup:
    if not skipped:
        return Markup("")
    rows = [
        [point.label, point.surface, *(number(x, 3) for x in point.uv_m), point.reason]
        for point in skipped
    ]
    columns = [
        Column("Point"),
        Column("Surface"),
        Column("u", "m", numeric=True),
        Column("v", "m", numeric=True),
        Column("Reason", prose=True),
    ]
    return table("Points that were left out, and why.", columns, rows)


def _sorties(survey: CoveragePlan, result: Result, flown: Sequence[Result]) -> Markup:
    results = [*flown, *[None] * (len(survey.sorties) - len(flown))]
    rows = [_sortie_row(s, r) for s, r in zip(survey.sorties, results, strict=True)]
    columns = [
        Column("Sortie"),
        Column("Status"),
        Column("Points", numeric=True),
        Column("Valid", numeric=True),
        Column("Time planned", "s", numeric=True),
        Column("flown", "s", numeric=True),
        Column("Energy planned", "Wh", numeric=True),
        Column("flown", "Wh", numeric=True),
        Column("Planned / flown", numeric=True),
        Column("Remark", prose=True),
    ]
    caption = (
        "The sorties with their own reports. Planned energy is by the planner's momentum theory, "
        "flown energy by the true speeds of the rotors; a sortie may plan with "
        f"{number(survey.budget_wh, 1)} Wh, the battery less its reserve."
    )
    shown = ("tracking", "estimation", "guidance", "contact", "half_cell", "flight", "actuators")
    return joined(
        table(caption, columns, rows, wide=True),
        drawn([energy_figure(survey, flown)]),
        metrics_table("All sorties together: sums, worst cases and means.", result, shown),
    )


def _sortie_row(sortie: Sortie, result: Result | None) -> list[str]:
    remark = "added by the refinement rule" if sortie.added else ""
    planned = [number(sortie.plan.duration_s, 0), number(sortie.plan.energy_wh, 1)]
    total = str(len(sortie.plan.targets))
    if result is None:
        status = chip("not flown", "fail")
        name = str(sortie.number)
        cells = [NOTHING, planned[0], NOTHING, planned[1], NOTHING, NOTHING]
        return [name, status, total, *cells, remark]
    link = f"{sortie.folder}/{REPORT_NAME}"
    return [
        element("a", f"Sortie {sortie.number}", href=link),
        chip(result.status, "pass" if result.status == "completed" else "fail"),
        total,
        str(sum(point.valid for point in result.points)),
        planned[0],
        number(_value(result, "flight.duration_s"), 0),
        planned[1],
        number(_value(result, "flight.energy_wh_flown"), 1),
        number(_value(result, "flight.energy_planned_over_flown"), 3),
        "; ".join(part for part in (remark, result.status_reason) if part),
    ]


def _value(result: Result, name: str) -> float | None:
    metric = result.metrics.get(name)
    return metric.value if metric else None


def _provenance(log: RunLog, result: Result, plan: Plan) -> Markup:
    note = "Attachments and versions are those of the first sortie; all fly with the same."
    return joined(element("p", note), provenance(log, result, plan))
