"""A section for each kind of experiment that a flight made besides taking readings."""

from __future__ import annotations

from collections.abc import Callable, Iterator

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.flight import Flight, NotMeasured
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
from inspect_cli.reporting.table import definitions, number
from inspect_cli.reporting.tables import metrics_table
from inspect_cli.reporting.timeline import Timeline
from inspect_cli.reporting.works import Works
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

NOT_FLOWN = "There is nothing to draw: the flight never got there."


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
        _or_reason(lambda: pull_table(Flight(log))),
        metrics_table("Pulls at the cord; of several the least favourable.", result, ("pull",)),
    )


def _drawing(log: RunLog, result: Result, plan: Plan) -> Markup:
    def shown() -> Markup:
        flight, drawings = Flight(log), drawings_of(plan)
        return joined(
            *(
                joined(
                    element("h3", f"Drawing {k + 1}") if len(drawings) > 1 else "",
                    drawn(drawing_figures(flight, drawing)),
                    drawn(course_figures(flight, drawing), side_by_side=True),
                )
                for k, drawing in enumerate(drawings)
            )
        )

    return joined(_or_reason(shown), metrics_table("Drawing.", result, ("drawing",)))


def _servoing(log: RunLog, result: Result) -> Markup:
    def shown() -> Markup:
        flight = Flight(log)
        figures = (servoing_figures(flight, k + 1, s) for k, s in enumerate(slides_of(flight)))
        return joined(*(drawn(pair) for pair in figures))

    drift = result.metrics.get("estimation.drift_at_first_contact_m")
    off = None if drift is None or drift.value is None else 1e3 * drift.value
    return joined(
        _or_reason(shown),
        definitions([("Drift of the estimate at the first touch", f"{number(off, 1)} mm")])
        if off is not None
        else "",
        metrics_table("Depth servoing.", result, ("slide",)),
    )


def _ground_truth(log: RunLog, result: Result, timeline: Timeline) -> Markup:
    figures = list(position_figure(log, timeline))
    return joined(
        drawn(figures[:1]),
        drawn(figures[1:], side_by_side=True),
        drawn(force_figure(Flight(log), timeline)),
        rmse_table(result),
        metrics_table("Force against the sensor in the wall.", result, ("force_sensor",)),
    )


def _or_reason(build: Callable[[], Markup]) -> Markup:
    """What is shown, or why there is nothing to see."""
    try:
        # The states of a diverged flight overflow; what is not finite leaves gaps.
        with np.errstate(all="ignore"):
            shown = build()
    except NotMeasured as reason:
        return element("p", f"There is nothing to draw: {reason}.")
    return shown or element("p", NOT_FLOWN)
