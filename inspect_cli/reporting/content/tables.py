"""The tables of the report."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.log.foxglove import Event
from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.reporting.content.blocks import Block, Column, Folded, Table
from inspect_cli.reporting.half_cell.points import ReadPoint
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Chip,
    Said,
    Text,
    code,
    number,
    say,
    sentences,
    separated,
    significant,
    together,
)
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.result import PointResult, Result

QUIET_LEVELS = ("debug", "info")
MANY_EVENTS = 12
MOST_EVENTS = 1000
MOST_POINTS = 1000
"""Rows of a table of points; ``readings.csv`` has all of them."""
TRUE_FIELDS = (
    "true_force_n",
    "true_force_peak_n",
    "position_error_m",
    "true_potential_mv",
    "true_corrosion",
)


def truth_table(points: Sequence[ReadPoint]) -> list[Block]:
    """What a simulation knows of each point beside what was read; nothing without truth."""
    if all(getattr(p.point, field) is None for p in points for field in TRUE_FIELDS):
        return []
    columns = [
        Column(say("Point")),
        Column(say("Potential read"), "mV CSE", numeric=True),
        Column(say("true"), "mV CSE", numeric=True),
        Column(say("Resistivity read"), "Ω·m", numeric=True),
        Column(say("true"), "Ω·m", numeric=True),
        Column(say("Corrosion read")),
        Column(say("true")),
        Column(say("Normal force"), say("N, mean of last 2 s"), numeric=True),
        Column(say("Peak"), "N", numeric=True),
        Column(say("Off target"), "mm", numeric=True),
    ]
    told = say(
        "Readings against the truth of the simulation, which no part of the vehicle could see."
    )
    shown = points[:MOST_POINTS]
    caption = sentences([told, rows_left_out(len(points))])
    return [Table(caption, columns, [_truth_row(p.point) for p in shown], wide=True)]


def rows_left_out(points: int) -> Text:
    """Which points a table has no row for; nothing where it has all."""
    if points <= MOST_POINTS:
        return ""
    return say(
        "The first {shown} of {n} points; readings.csv beside this report has all of them.",
        shown=number(MOST_POINTS, 0),
        n=number(points, 0),
    )


def _truth_row(point: PointResult) -> list[Text]:
    off_m = point.position_error_m
    return [
        point.label,
        number(point.potential_mv, 0),
        number(point.true_potential_mv, 0),
        number(point.resistivity_ohm_m, 0),
        number(point.true_resistivity_ohm_m, 0),
        class_chip(point.corrosion),
        class_chip(point.true_corrosion),
        number(point.true_force_n, 2),
        number(point.true_force_peak_n, 2),
        number(None if off_m is None else 1e3 * off_m, 1),
    ]


def class_chip(name: str | None) -> Text:
    """The class in words with its colour; ``none`` corrosion has the passive class's."""
    if name is None:
        return NOTHING
    kind = {"none": "passive", "possible": "uncertain"}.get(name, name)
    return Chip(class_word(name), kind)


def class_word(name: str) -> Text:
    """The class in words; of a verdict ``none`` no more than that nothing indicates corrosion."""
    return say("not indicated") if name == "none" else recorded(name)


def metrics_table(caption: Text, result: Result, groups: Sequence[str]) -> list[Block]:
    """The result's metrics of some groups, the part of a name before its dot; nothing without."""
    rows = [
        [_meaning(name, metric.why), significant(metric.value), unit_shown(metric.unit), code(name)]
        for name, metric in result.metrics.items()
        if name.split(".")[0] in groups
    ]
    columns = [
        Column(say("Metric"), prose=True),
        Column(say("Value"), numeric=True),
        Column(say("Unit")),
        Column(say("Name")),
    ]
    return [Table(caption, columns, rows)] if rows else []


def _meaning(name: str, why: str) -> Text:
    if not why:
        return meaning(name)
    if name not in METRICS:
        return recorded(why)
    return say("{metric}; not measured: {why}", metric=meaning(name), why=recorded(why))


def unit_shown(unit: str) -> str:
    """The unit; nothing for a number without one."""
    return "" if unit == "1" else unit


def meaning(metric: str) -> Text:
    """What a metric is, by the catalogue; nothing for one that is not in it."""
    spec = METRICS.get(metric)
    return Said(spec.meaning) if spec else ""


def fits_table(plan: Plan) -> Table:
    """How well each fitted surface explains its points."""
    columns = [
        Column(say("Surface")),
        Column(say("Shape")),
        Column(say("Source and method"), prose=True),
        Column(say("Points"), numeric=True),
        Column(say("Inliers"), "%", numeric=True),
        Column("RMS", "mm", numeric=True),
        Column(say("Standard deviations of the parameters"), prose=True),
    ]
    rows = [_fit_row(surface) for surface in plan.surfaces]
    return Table(say("Surfaces as the planner believed them."), columns, rows)


def _fit_row(surface: PlannedSurface) -> list[Text]:
    fit, shape = surface.fit, recorded(surface.shape.kind)
    if fit is None:
        return [surface.name, shape, say("given"), *[NOTHING] * 4]
    deviations = [_deviation(name, sd) for name, sd in fit.parameter_sd.items()]
    return [
        surface.name,
        shape,
        f"{surface.source}; {fit.method}",
        number(fit.points, 0),
        number(100.0 * fit.inlier_share, 1),
        number(1e3 * fit.rms_m, 2),
        separated(deviations, ", ") if deviations else NOTHING,
    ]


def _deviation(parameter: str, sd: float) -> Text:
    """``offset_m`` and 1.8e-5 as "offset ± 0.018 mm"."""
    name, _, unit = parameter.rpartition("_")
    if unit not in ("m", "rad"):
        return together(parameter, " ± ", significant(sd, 2))
    return together(recorded(name.replace("_", " ")), " ± ", significant(1e3 * sd, 2), f" m{unit}")


def events_table(log: RunLog) -> list[Block]:
    """What the vehicle said during the flight; a long list is folded but for its warnings."""
    if not log.events:
        return []
    if len(log.events) <= MANY_EVENTS:
        return [_events(say("Events."), log.events)]
    warnings = [event for event in log.events if event.level not in QUIET_LEVELS]
    everything = _events(say("Events."), log.events[:MOST_EVENTS])
    folded = Folded(say("All {n} events", n=number(len(log.events), 0)), [everything])
    if not warnings:
        return [folded]
    return [_events(say("Warnings."), warnings[:MOST_EVENTS]), folded]


def _events(caption: Text, events: Sequence[Event]) -> Table:
    rows = [[number(event.t_s, 2), recorded(event.level), event.text] for event in events]
    columns = [
        Column(say("Time"), "s", numeric=True),
        Column(say("Level")),
        Column(say("Event"), prose=True),
    ]
    return Table(caption, columns, rows)
