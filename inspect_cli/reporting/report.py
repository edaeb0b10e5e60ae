"""``report.html`` of a flight."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

from inspect_cli.assessment.classes import COMBINED_RULE
from inspect_cli.files import write_whole
from inspect_cli.log.reader import RunLog
from inspect_cli.records import Reference
from inspect_cli.reporting.checks_table import checks_table
from inspect_cli.reporting.experiments import experiment_sections
from inspect_cli.reporting.figure import drawn
from inspect_cli.reporting.figures_corrosion import cumulative_figure, resistivity_figure
from inspect_cli.reporting.figures_forces import (
    actuator_figures,
    force_figures,
    surface_figures,
)
from inspect_cli.reporting.figures_map import map_figures
from inspect_cli.reporting.figures_modes import modes_figure
from inspect_cli.reporting.figures_scene import scene_figure
from inspect_cli.reporting.figures_tracking import tracking_figures
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.page import Section, page
from inspect_cli.reporting.points import ReadPoint, read_points
from inspect_cli.reporting.provenance import provenance
from inspect_cli.reporting.rows import rows_of
from inspect_cli.reporting.summary import (
    caveats,
    finding,
    finding_markup,
    is_simulated,
    key_figures,
    method,
    warnings,
    warnings_markup,
)
from inspect_cli.reporting.table import NOTHING, definitions
from inspect_cli.reporting.tables import (
    classes_table,
    events_table,
    fits_table,
    metrics_table,
    points_table,
    truth_table,
    verdicts_table,
)
from inspect_cli.reporting.timeline import Timeline, timeline_of
from inspect_cli.reporting.works import Works, kicker, told, works_of
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

REPORT_NAME = "report.html"


def write_report(log: RunLog, result: Result, folder: Path) -> Path:
    """Write ``report.html`` into ``folder``; return the page's path.

    The page is one file that needs no network. It draws what ``result`` and ``log`` hold and
    computes no finding; the same log and result give the same bytes.

    Raises:
        LogError: the log lacks the attachments that the report stands on.
        EnvironmentFault: the file cannot be written.
    """
    plan = log.plan()
    path = folder / REPORT_NAME
    write_whole(path, report_html(log, result, plan))
    return path


def report_html(log: RunLog, result: Result, plan: Plan) -> str:
    """The page as text."""
    points = read_points(result, plan)
    works = works_of(log, plan)
    timeline = timeline_of(rows_of(log, Reference), plan)
    title = log.mission().title or result.mission
    sections = [Section("summary", "Summary", summary(log, result, works, points))]
    if points:
        sections.append(Section("survey", "Corrosion survey", survey_content(log, plan, points)))
    sections += experiment_sections(log, result, plan, works, timeline)
    flight = _flight(log, result, plan, works, points, timeline)
    sections.append(Section("flight", "Flight", flight))
    if plan.surfaces:
        sections.append(Section("structure", "Structure", fits_table(plan)))
    sections.append(Section("provenance", "Provenance", provenance(log, result, plan)))
    kind = "inspection report" if points else "flight report"
    return page(f"{title} – {kind}", header(log, result, works, title), sections)


def header(log: RunLog, result: Result, works: Works, title: str) -> Markup:
    """What was flown, with what, and how it ended."""
    mission, platform = log.mission(), log.platform()
    description = mission.description
    facts = [
        ("Mission", result.mission),
        ("Platform", platform.title or result.platform),
        ("Seed", NOTHING if result.seed is None else str(result.seed)),
        ("Kind", "simulated flight" if is_simulated(log) else "flight"),
        ("Status", element("span", result.status, class_=f"badge {result.status}")),
    ]
    return joined(
        element("p", kicker(works), class_="kicker"),
        element("h1", title),
        element("p", description, class_="description") if description else "",
        definitions(facts),
    )


def summary(log: RunLog, result: Result, works: Works, points: Sequence[ReadPoint]) -> Markup:
    """Warnings, finding, key figures, checks, caveats."""
    checks = (
        checks_table(result.checks)
        if result.checks
        else element("p", "The mission states no acceptance.")
    )
    return joined(
        warnings_markup(warnings(result, log.mission().expect_status)),
        finding_markup([*finding(points), *told(works, result)]),
        key_figures(result, works, points),
        checks,
        element("h3", "What this report does not say"),
        caveats(log, result, points),
    )


def survey_content(log: RunLog, plan: Plan, points: Sequence[ReadPoint]) -> Markup:
    """The readings: map, tables, diagrams, and how they were taken."""
    diagrams = [cumulative_figure(points), resistivity_figure(points)]
    return joined(
        drawn(map_figures(points, plan)),
        points_table(points),
        truth_table(points),
        classes_table(points),
        verdicts_table(points),
        element(
            "p", element("strong", "Rule of the combined verdict. "), COMBINED_RULE, class_="rule"
        ),
        drawn((d for d in diagrams if d is not None), side_by_side=True),
        element("h3", "How the readings were taken"),
        definitions(method(log, plan)),
    )


def _flight(
    log: RunLog,
    result: Result,
    plan: Plan,
    works: Works,
    points: Sequence[ReadPoint],
    timeline: Timeline,
) -> Markup:
    modes = modes_figure(log)
    return joined(
        element("h3", "Pose tracking"),
        drawn(tracking_figures(log, timeline), side_by_side=True),
        metrics_table("Errors of tracking and estimation.", result, ("tracking", "estimation")),
        _forces(log, result, plan, works, timeline),
        element("h3", "Actuators"),
        drawn(actuator_figures(log, timeline)),
        element("h3", "Path in space"),
        drawn([scene_figure(log, plan, points)]),
        element("h3", "Modes and events"),
        drawn([modes] if modes else []),
        events_table(log),
        metrics_table("Other metrics.", result, _other_groups(result, works)),
    )


def _forces(log: RunLog, result: Result, plan: Plan, works: Works, timeline: Timeline) -> Markup:
    """What it pressed with and what it saw; where nothing was touched, what it felt."""
    forces = list(force_figures(log, plan, timeline))
    if not works.touches:
        wrench = [figure for figure in forces if figure.name != "force"]
        return joined(element("h3", "External wrench"), drawn(wrench, side_by_side=True))
    caption = "Contact and readings." if works.readings else "Contact."
    return joined(
        element("h3", "Contact force and external wrench"),
        drawn(forces[:1]),
        drawn(forces[1:], side_by_side=True),
        metrics_table(caption, result, _contact_groups(works)),
        element("h3", "Surface seen by the depth camera"),
        drawn(surface_figures(log, timeline)),
    )


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
