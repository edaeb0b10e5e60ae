"""A section for each kind of experiment that a flight made besides taking readings."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.flight import Flight, NotMeasured
from inspect_cli.reporting.content.blocks import Block, Facts, Heading, Paragraph, Section, drawn
from inspect_cli.reporting.content.metrics_table import metrics_table
from inspect_cli.reporting.figures.timeline import Timeline
from inspect_cli.reporting.flight.drawing import course_figures, drawing_figures, drawings_of
from inspect_cli.reporting.flight.ground_truth import (
    force_figure,
    position_figure,
    rmse_table,
)
from inspect_cli.reporting.flight.mission_profile import Works
from inspect_cli.reporting.flight.pulls import pull_figures, pull_phases, pull_table
from inspect_cli.reporting.flight.servoing import servoing_figures, slides_of
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import number, say, together
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result

NOT_FLOWN = Paragraph(say("There is nothing to draw: the flight never got there."))


def experiment_sections(
    log: RunLog,
    result: Result,
    plan: Plan,
    works: Works,
    timeline: Timeline,
) -> Iterator[Section]:
    """Rope pulls, drawing, depth servoing, estimates against ground truth: those that were."""
    if works.pulls:
        yield Section("pulls", say("Rope pulls"), _pulls(log, result))
    if works.strokes:
        yield Section("drawing", say("Drawing"), _drawing(log, result, plan))
    if works.followings:
        yield Section("servoing", say("Depth servoing"), _servoing(log, result))
    if works.ground_truth:
        content = _ground_truth(log, result, timeline)
        yield Section("ground-truth", say("Estimates against ground truth"), content)


def _pulls(log: RunLog, result: Result) -> list[Block]:
    caption = say("Pulls at the cord; of several the least favourable.")
    return [
        *drawn(pull_figures(log, pull_phases(log)), side_by_side=True),
        *_or_reason(lambda: [pull_table(Flight(log))]),
        *metrics_table(caption, result, ("pull",)),
    ]


def _drawing(log: RunLog, result: Result, plan: Plan) -> list[Block]:
    def shown() -> Iterator[Block]:
        flight, drawings = Flight(log), drawings_of(plan)
        for k, drawing in enumerate(drawings, 1):
            if len(drawings) > 1:
                yield Heading(say("Drawing {n}", n=number(k, 0)))
            yield from drawn(drawing_figures(flight, drawing))
            yield from drawn(course_figures(flight, drawing), side_by_side=True)

    return [*_or_reason(shown), *metrics_table(say("Drawing."), result, ("drawing",))]


def _servoing(log: RunLog, result: Result) -> list[Block]:
    def shown() -> Iterator[Block]:
        flight = Flight(log)
        for k, slide in enumerate(slides_of(flight), 1):
            yield from drawn(servoing_figures(flight, k, slide))

    return [
        *_or_reason(shown),
        *_drift(result.value("estimation.drift_at_first_contact_m")),
        *metrics_table(say("Depth servoing."), result, ("slide",)),
    ]


def _drift(drift_m: float | None) -> list[Block]:
    if drift_m is None:
        return []
    name = say("Drift of the estimate at the first touch")
    return [Facts([(name, together(number(1e3 * drift_m, 1), " mm"))])]


def _ground_truth(log: RunLog, result: Result, timeline: Timeline) -> list[Block]:
    figures = list(position_figure(log, timeline))
    caption = say("Force against the sensor in the wall.")
    return [
        *drawn(figures[:1]),
        *drawn(figures[1:], side_by_side=True),
        *drawn(force_figure(Flight(log), timeline)),
        *rmse_table(result),
        *metrics_table(caption, result, ("force_sensor",)),
    ]


def _or_reason(build: Callable[[], Iterable[Block]]) -> list[Block]:
    """What is shown, or why there is nothing to see."""
    try:
        # The states of a diverged flight overflow; what is not finite leaves gaps.
        with np.errstate(all="ignore"):
            shown = list(build())
    except NotMeasured as reason:
        why = recorded(str(reason))
        return [Paragraph(say("There is nothing to draw: {reason}.", reason=why))]
    return shown or [NOT_FLOWN]
