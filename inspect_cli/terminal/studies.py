"""Regressions and studies: many flights at once."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.text import Text

if TYPE_CHECKING:
    from inspect_cli.regression.outcome import RegressReport
    from inspect_cli.schema.study import StudyResult, StudyVariant
from inspect_cli.terminal.printing import BAD, console, near, number, styled, table_of

WHOLE = 100.0
"""From here on three digits are a whole number."""


def print_regression(report: RegressReport, updated: Sequence[Path]) -> None:
    """All flights, what is wrong with those that fail, and what changed by how much."""
    out = console()
    table = table_of("regression", "mission", "platform", "seed", "status", "checks", "verdict")
    for flight in report.missions:
        passed = sum(check.verdict == "pass" for check in flight.checks)
        table.add_row(
            flight.mission,
            flight.platform,
            str(flight.seed),
            flight.status or "not flown",
            f"{passed}/{len(flight.checks)}",
            styled(flight.verdict),
        )
    out.print(table)
    for flight in report.missions:
        for reason in flight.reasons:
            name = f"{flight.mission} seed {flight.seed}: "
            out.print(Text.assemble((name, BAD), reason), soft_wrap=True)
    for file in updated:
        out.print(f"rewrote {near(file)}", soft_wrap=True)
    out.print(f"{report.passed} passed, {report.failed} failed, {report.known} known failures")


def print_study(study: StudyResult, page: Path) -> None:
    """Each variant's numbers, the published ones below them, and what went wrong."""
    out = console()
    quantities = (f"{q.symbol}\n/{q.unit}" for q in study.quantities)
    heads = (f"{c.heading}\n/{c.unit}".removesuffix("/1") for c in study.columns)
    table = table_of(study.title, "variant", *quantities, *(h.replace(", ", "\n") for h in heads))
    for variant in study.variants:
        values = (f"{variant.values[q.name]:g}" for q in study.quantities)
        table.add_row(variant.name, *values, *(_mean(variant, c.metric) for c in study.columns))
    if any(c.published is not None for c in study.columns):
        blank = ("" for _ in study.quantities)
        table.add_row("published", *blank, *(number(c.published, ".3g") for c in study.columns))
    out.print(table)
    for reason in study.shortfalls:
        out.print(Text.assemble(("not as expected: ", BAD), reason), soft_wrap=True)
    for finding in study.findings:
        out.print(finding, soft_wrap=True)
    out.print(f"study: {near(page)}", soft_wrap=True)


def _mean(variant: StudyVariant, metric: str) -> str:
    """A number of a variant, with its standard error if it is a mean."""
    value, error = variant.value(metric), variant.standard_errors.get(metric)
    shown = number(value, ".3g" if abs(value or 0.0) < WHOLE else ".0f")
    return shown if error is None else f"{shown}\n±{error:.2g}"
