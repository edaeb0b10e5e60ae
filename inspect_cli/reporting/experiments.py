"""A section for each kind of experiment that a flight made besides taking readings."""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.flight import Flight
from inspect_cli.records import Record, Reference, State, TrueContact
from inspect_cli.reporting.figure import drawn
from inspect_cli.reporting.figures_drawing import course_figures, drawing_figures, drawings_of
from inspect_cli.reporting.figures_ground_truth import (
    force_figure,
    position_figure,
    rmse_table,
)
from inspect_cli.reporting.figures_pulls import pull_figures, pull_phases, pull_table
from inspect_cli.reporting.figures_servoing import servoing_figures, slides_of
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.page import Section
from inspect_cli.reporting.rows import rows_of
from inspect_cli.reporting.tables import metrics_table
from inspect_cli.reporting.timeline import Timeline
from inspect_cli.reporting.works import Works
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

NOT_FLOWN = (
    "There is nothing to draw: the flight never got there, or its log does not hold the truth."
)


def experiment_sections(
    log: RunLog,
    result: Result,
    plan: Plan,
    works: Works,
    timeline: Timeline,
) -> Iterator[Section]:
    """Rope pulls, drawing, depth servoing, estimates against ground truth: those that were."""
    if works.pulls:
        yield Section("pulls", "Rope pulls", _pulls(log, result))
    if works.strokes:
        yield Section("drawing", "Drawing", _drawing(log, result, plan))
    if works.followings:
        yield Section("servoing", "Depth servoing", _servoing(log, result))
    if works.ground_truth:
        content = _ground_truth(log, result, timeline)
        yield Section("ground-truth", "Estimates against ground truth", content)


def _pulls(log: RunLog, result: Result) -> Markup:
    return joined(
        drawn(pull_figures(log, pull_phases(log)), side_by_side=True),
        pull_table(Flight(log)),
        metrics_table("Pulls at the cord; of several the least favourable.", result, ("pull",)),
    )


def _drawing(log: RunLog, result: Result, plan: Plan) -> Markup:
    numbers = drawings_of(plan) if _has(log, (State, Reference)) else []
    flight = Flight(log)
    shown = [
        joined(
            element("h3", f"Drawing {number + 1}") if len(numbers) > 1 else "",
            drawn(drawing_figures(flight, number)),
            drawn(course_figures(flight, number), side_by_side=True),
        )
        for number in numbers
    ]
    return joined(_or_reason(shown), metrics_table("Drawing.", result, ("drawing",)))


def _servoing(log: RunLog, result: Result) -> Markup:
    flight = Flight(log)
    found = slides_of(flight) if _has(log, (State, Reference, TrueContact)) else []
    shown = [drawn(servoing_figures(flight, k + 1, slide)) for k, slide in enumerate(found)]
    return joined(_or_reason(shown), metrics_table("Depth servoing.", result, ("slide",)))


def _ground_truth(log: RunLog, result: Result, timeline: Timeline) -> Markup:
    figures = list(position_figure(log, timeline))
    return joined(
        drawn(figures[:1]),
        drawn(figures[1:], side_by_side=True),
        drawn(force_figure(Flight(log), timeline)),
        rmse_table(result),
        metrics_table("Force against the sensor in the wall.", result, ("force_sensor",)),
    )


def _has(log: RunLog, records: Iterable[type[Record]]) -> bool:
    return all(rows_of(log, record) is not None for record in records)


def _or_reason(shown: Sequence[Markup]) -> Markup:
    """What is shown, or why there is nothing to see."""
    whole = joined(*shown)
    return whole or element("p", NOT_FLOWN)
