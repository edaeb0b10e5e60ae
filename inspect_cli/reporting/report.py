"""``report.html`` and ``readings.csv`` of a flight."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from inspect_cli.files import write_whole
from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.corrosion import COMBINED_RULE
from inspect_cli.records import Reference
from inspect_cli.reporting.figure import Figure
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
from inspect_cli.reporting.readings_csv import readings_csv
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
    checks_table,
    classes_table,
    events_table,
    fits_table,
    metrics_table,
    points_table,
    truth_table,
    verdicts_table,
)
from inspect_cli.reporting.timeline import Timeline, timeline_of
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

REPORT_NAME = "report.html"
READINGS_NAME = "readings.csv"


def write_report(log: RunLog, result: Result, folder: Path) -> Path:
    """Write ``report.html`` and ``readings.csv`` into ``folder``; return the page's path.

    The page is one file that needs no network. It draws what ``result`` and ``log`` hold and
    computes no finding; the same log and result give the same bytes.

    Raises:
        LogError: the log lacks the attachments that the report stands on.
        EnvironmentFault: a file cannot be written.
    """
    plan = log.plan()
    write_whole(folder / READINGS_NAME, readings_csv(result, plan))
    path = folder / REPORT_NAME
    write_whole(path, report_html(log, result, plan))
    return path


def report_html(log: RunLog, result: Result, plan: Plan) -> str:
    """The page as text."""
    points = read_points(result, plan)
    timeline = timeline_of(rows_of(log, Reference), plan)
    title = log.mission().title or result.mission
    sections = [
        Section("summary", "Summary", summary(log, result, points)),
        Section("survey", "Corrosion survey", survey_content(log, plan, points)),
        Section("flight", "Flight", _flight(log, result, plan, points, timeline)),
        Section("structure", "Structure", fits_table(plan)),
        Section("provenance", "Provenance", provenance(log, result, plan)),
    ]
    return page(f"{title} – inspection report", header(log, result, title), sections)


def header(log: RunLog, result: Result, title: str) -> Markup:
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
        element("p", "Inspection report · half-cell potential by contact", class_="kicker"),
        element("h1", title),
        element("p", description, class_="description") if description else "",
        definitions(facts),
    )


def summary(log: RunLog, result: Result, points: Sequence[ReadPoint]) -> Markup:
    """Warnings, finding, key figures, checks, caveats."""
    checks = (
        checks_table(result.checks)
        if result.checks
        else element("p", "The mission states no acceptance.")
    )
    return joined(
        warnings_markup(warnings(result, log.mission().expect_status)),
        finding_markup(finding(points)),
        key_figures(result, points),
        checks,
        element("h3", "What this report does not say"),
        caveats(log, points),
    )


def survey_content(log: RunLog, plan: Plan, points: Sequence[ReadPoint]) -> Markup:
    """The readings: map, tables, diagrams, and how they were taken."""
    if not points:
        return element("p", "The plan asks for no reading.")
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
    points: Sequence[ReadPoint],
    timeline: Timeline,
) -> Markup:
    modes = modes_figure(log)
    forces = [*force_figures(log, plan, timeline)]
    return joined(
        element("h3", "Pose tracking"),
        drawn(tracking_figures(log, timeline), side_by_side=True),
        metrics_table("Errors of tracking and estimation.", result, ("tracking", "estimation")),
        element("h3", "Contact force and external wrench"),
        drawn(forces[:1]),
        drawn(forces[1:], side_by_side=True),
        metrics_table("Contact and readings.", result, CONTACT_GROUPS),
        element("h3", "Surface seen by the depth camera"),
        drawn(surface_figures(log, timeline)),
        element("h3", "Actuators"),
        drawn(actuator_figures(log, timeline)),
        element("h3", "Path in space"),
        drawn([scene_figure(log, plan, points)]),
        element("h3", "Modes and events"),
        drawn([modes] if modes else []),
        events_table(log),
        metrics_table("Other metrics.", result, _other_groups(result)),
    )


CONTACT_GROUPS = ("contact", "force_sensor", "half_cell")
SHOWN_GROUPS = ("tracking", "estimation", *CONTACT_GROUPS)


def _other_groups(result: Result) -> list[str]:
    return [g for name in result.metrics if (g := name.split(".")[0]) not in SHOWN_GROUPS]


def drawn(figures: Iterable[Figure], *, side_by_side: bool = False) -> Markup:
    """Figures one after the other, or two in a row where there is room."""
    shown = joined(*(figure.html() for figure in figures))
    if side_by_side and shown:
        return element("div", shown, class_="pair")
    return shown
