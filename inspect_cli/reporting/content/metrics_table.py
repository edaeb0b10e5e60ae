"""Tables of metrics: what each is, its value, its unit, and why it is missing."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.reporting.content.blocks import Block, Column, Table
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Said, Text, code, say, significant
from inspect_cli.schema.result import Result


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
