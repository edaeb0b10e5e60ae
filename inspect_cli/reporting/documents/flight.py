"""``report.html`` of a flight."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Reference
from inspect_cli.reporting.chapters.experiments import experiment_sections
from inspect_cli.reporting.chapters.pictures import Rendered, pictures_sections
from inspect_cli.reporting.chapters.provenance import provenance
from inspect_cli.reporting.chapters.summary_text import told
from inspect_cli.reporting.content.blocks import (
    Block,
    Cover,
    Document,
    Heading,
    Paragraph,
    Section,
    drawn,
)
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.documents.checks_table import checks_table
from inspect_cli.reporting.documents.summary import (
    SIGNED,
    caveats,
    finding,
    findings,
    is_simulated,
    key_figures,
    method,
    warnings,
)
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.figures.timeline import Timeline, timeline_of
from inspect_cli.reporting.flight.events_table import events_table
from inspect_cli.reporting.flight.fits_table import fits_table
from inspect_cli.reporting.flight.forces import (
    actuator_figures,
    force_figures,
    surface_figures,
)
from inspect_cli.reporting.flight.mission_profile import Works, kicker, works_of
from inspect_cli.reporting.flight.modes import modes_figure
from inspect_cli.reporting.flight.scene import scene_figure
from inspect_cli.reporting.flight.tracking import tracking_figures
from inspect_cli.reporting.half_cell.evaluation import evaluation_blocks
from inspect_cli.reporting.half_cell.points import ReadPoint, read_points
from inspect_cli.reporting.half_cell.surface_findings import Evaluated
from inspect_cli.reporting.half_cell.truth_table import truth_table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Badge, Text, say
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def report_document(
    log: RunLog,
    result: Result,
    plan: Plan,
    evaluated: Sequence[Evaluated] = (),
    pictures: Rendered | None = None,
) -> Document:
    """What the report of a flight says, in no language yet."""
    points = read_points(result, plan)
    works = works_of(log, plan)
    timeline = timeline_of(rows_of(log, Reference), plan)
    title = log.mission().title or result.mission
    opening = summary(log, result, works, points, evaluated)
    sections = [Section("summary", say("Summary"), opening), *pictures_sections(pictures)]
    if points:
        content = survey_content(log, result, plan, points, evaluated)
        sections.append(Section("survey", say("Corrosion survey"), content))
    sections += experiment_sections(log, result, plan, works, timeline)
    flight = _flight(log, result, plan, works, points, timeline)
    sections.append(Section("flight", say("Flight"), flight, on_paper=False))
    if plan.surfaces:
        sections.append(Section("structure", say("Structure"), [fits_table(plan)]))
    sections.append(Section("provenance", say("Provenance"), provenance(log, result, plan)))
    whole = (
        say("{title} – inspection report", title=title)
        if points
        else say("{title} – flight report", title=title)
    )
    return Document(whole, cover(log, result, works, title), sections)


def cover(log: RunLog, result: Result, works: Works, title: str) -> Cover:
    """What was flown, with what, and how it ended."""
    mission, platform = log.mission(), log.platform()
    facts: list[tuple[Text, Text]] = [
        (say("Mission"), result.mission),
        (say("Platform"), platform.title or result.platform),
        (say("Seed"), NOTHING if result.seed is None else str(result.seed)),
        (say("Kind"), say("simulated flight") if is_simulated(log) else say("flight")),
        (say("Status"), Badge(recorded(result.status), result.status)),
    ]
    signed = () if is_simulated(log) else SIGNED
    return Cover(kicker(works), title, mission.description, facts, signed)


def summary(
    log: RunLog,
    result: Result,
    works: Works,
    points: Sequence[ReadPoint],
    evaluated: Sequence[Evaluated],
) -> list[Block]:
    """Warnings, finding, key figures, checks, caveats."""
    checks = (
        checks_table(result.checks)
        if result.checks
        else Paragraph(say("The mission states no acceptance."))
    )
    return [
        *warnings(result, log.mission().expect_status),
        *finding([*findings(points, evaluated), *told(works, result)]),
        key_figures(result, works, points),
        checks,
        Heading(say("What this report does not say")),
        caveats(log, result, points, evaluated),
    ]


def survey_content(
    log: RunLog,
    result: Result,
    plan: Plan,
    points: Sequence[ReadPoint],
    evaluated: Sequence[Evaluated],
) -> list[Block]:
    """The readings: what was found, what is true where that is known, how they were taken."""
    return [
        *evaluation_blocks(evaluated, points, result.scoring),
        *truth_table(points),
        Heading(say("How the readings were taken")),
        method(log, plan),
    ]


def _flight(
    log: RunLog,
    result: Result,
    plan: Plan,
    works: Works,
    points: Sequence[ReadPoint],
    timeline: Timeline,
) -> list[Block]:
    modes = modes_figure(log)
    errors = say("Errors of tracking and estimation.")
    return [
        Heading(say("Pose tracking")),
        *drawn(tracking_figures(log, timeline), side_by_side=True),
        *metrics_table(errors, result, ("tracking", "estimation")),
        *_forces(log, result, plan, works, timeline),
        Heading(say("Actuators")),
        *drawn(actuator_figures(log, timeline)),
        Heading(say("Path in space")),
        *drawn([scene_figure(log, plan, points)]),
        Heading(say("Modes and events")),
        *drawn([modes] if modes else []),
        *events_table(log),
        *metrics_table(say("Other metrics."), result, _other_groups(result, works)),
    ]


def _forces(
    log: RunLog, result: Result, plan: Plan, works: Works, timeline: Timeline
) -> list[Block]:
    """What it pressed with and what it saw; where nothing was touched, what it felt."""
    forces = list(force_figures(log, plan, timeline))
    if not works.touches:
        wrench = [figure for figure in forces if figure.name != "force"]
        return [Heading(say("External wrench")), *drawn(wrench, side_by_side=True)]
    caption = say("Contact and readings.") if works.readings else say("Contact.")
    return [
        Heading(say("Contact force and external wrench")),
        *drawn(forces[:1]),
        *drawn(forces[1:], side_by_side=True),
        *metrics_table(caption, result, _contact_groups(works)),
        Heading(say("Surface seen by the depth camera")),
        *drawn(surface_figures(log, timeline)),
    ]


CONTACT_GROUPS = ("contact", "half_cell")
SHOWN_GROUPS = (
    *("tracking", "estimation", "pull", "drawing", "slide", "force_sensor"),
    *CONTACT_GROUPS,
)


def _contact_groups(works: Works) -> list[str]:
    return [group for group in CONTACT_GROUPS if group not in works.foreign_groups]


def _other_groups(result: Result, works: Works) -> list[str]:
    """The groups of metrics that no other table shows and that concern this mission."""
    hidden = {*SHOWN_GROUPS, *works.foreign_groups}
    return [g for name in result.metrics if (g := name.split(".")[0]) not in hidden]
