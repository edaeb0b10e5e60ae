"""``report.html`` of a survey that took several sorties."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.chapters.pictures import Rendered, pictures_sections
from inspect_cli.reporting.chapters.provenance import provenance
from inspect_cli.reporting.content.blocks import (
    REPORT_NAME,
    Block,
    Column,
    Document,
    Paragraph,
    Section,
    Table,
    drawn,
)
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.documents.flight import (
    cover,
    summary,
    survey_content,
)
from inspect_cli.reporting.flight.fits_table import fits_table
from inspect_cli.reporting.flight.mission_profile import works_of
from inspect_cli.reporting.flight.sorties import energy_figure, tour_figures
from inspect_cli.reporting.half_cell.points import read_points
from inspect_cli.reporting.half_cell.surface_findings import Evaluated
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Chip,
    Link,
    Text,
    count,
    number,
    say,
    sentences,
    separated,
)
from inspect_cli.schema.coverage import CoveragePlan, Skipped, Sortie
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def survey_document(
    log: RunLog,
    result: Result,
    flown: Sequence[Result],
    survey: CoveragePlan,
    plan: Plan,
    evaluated: Sequence[Evaluated] = (),
    pictures: Rendered | None = None,
) -> Document:
    """What the report of a survey says, in no language yet."""
    points = read_points(result, plan)
    title = log.mission().title or result.mission
    works = works_of(log, plan)
    whole = [Paragraph(_extent(survey)), *summary(log, result, works, points, evaluated)]
    read = []
    if points:
        content = survey_content(log, result, plan, points, evaluated)
        read = [Section("survey", say("Corrosion survey"), content)]
    sections = [
        Section("summary", say("Summary"), whole),
        *pictures_sections(pictures),
        *read,
        Section("coverage", say("Coverage"), _coverage(survey, plan)),
        Section("sorties", say("Sorties"), _sorties(survey, result, flown)),
        Section("structure", say("Structure"), [fits_table(plan)]),
        Section("provenance", say("Provenance"), _provenance(log, result, plan)),
    ]
    page_title = say("{title} – inspection report", title=title)
    return Document(page_title, cover(log, result, works, title), sections)


def _coverage(survey: CoveragePlan, plan: Plan) -> list[Block]:
    added = [t.label for s in survey.sorties if s.added for t in s.plan.targets]
    told: list[Text] = [
        _extent(survey),
        say(
            "The shortest way that was found through the standoffs of all points is {length} m, "
            "before it was split.",
            length=number(survey.tour_m, 1),
        ),
    ]
    if added:
        told.append(
            count(
                len(added),
                "{labels} was added by the refinement rule of ASTM C876, between neighbours whose "
                "readings differ by more than the mission allows; a label names those neighbours.",
                "{labels} were added by the refinement rule of ASTM C876, between neighbours whose "
                "readings differ by more than the mission allows; a label names those neighbours.",
                labels=", ".join(added),
            )
        )
    return [
        Paragraph(sentences(told)),
        *drawn(tour_figures(survey, plan)),
        *_skipped_table(survey.skipped),
    ]


def _extent(survey: CoveragePlan) -> Text:
    """How much of the surface was asked for and how much was left out."""
    points = number(survey.points, 0)
    sorties = count(len(survey.sorties), "{n} sortie", "{n} sorties")
    if not survey.skipped:
        return say(
            "{points} points were planned in {sorties}; none was left out.",
            points=points,
            sorties=sorties,
        )
    return count(
        len(survey.skipped),
        "{points} points were planned in {sorties}; {n} was left out.",
        "{points} points were planned in {sorties}; {n} were left out.",
        points=points,
        sorties=sorties,
    )


def _skipped_table(skipped: Sequence[Skipped]) -> list[Block]:
    if not skipped:
        return []
    rows: list[list[Text]] = [
        [point.label, point.surface, *(number(x, 3) for x in point.uv_m), point.reason]
        for point in skipped
    ]
    columns = [
        Column(say("Point")),
        Column(say("Surface")),
        Column("u", "m", numeric=True),
        Column("v", "m", numeric=True),
        Column(say("Reason"), prose=True),
    ]
    return [Table(say("Points that were left out, and why."), columns, rows)]


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
    shown = ("tracking", "estimation", "guidance", "contact", "half_cell", "flight", "actuators")
    return [
        Table(caption, columns, rows, wide=True),
        *drawn([energy_figure(survey, flown)]),
        *metrics_table(together, result, shown),
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


def _provenance(log: RunLog, result: Result, plan: Plan) -> list[Block]:
    note = say("Attachments and versions are those of the first sortie; all fly with the same.")
    return [Paragraph(note), *provenance(log, result, plan)]
