"""Results of flights and reports."""

from __future__ import annotations

import shlex
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.table import Table
from rich.text import Text

from inspect_cli.reporting.words.published import number_of

if TYPE_CHECKING:
    from inspect_cli.schema.readings import ReadingsResult
    from inspect_cli.schema.result import Check, PointResult, Result
from inspect_cli.terminal.printing import (
    BAD,
    UNSURE,
    console,
    counted,
    grouped,
    near,
    number,
    print_warnings,
    styled,
    table_of,
)

STILL_MPS = 0.2
"""A vehicle that has landed is slower than this."""


def print_flight(result: Result, folder: Path) -> None:
    """A flight's points and checks, and where its files are."""
    _print_result(result)
    out = console()
    out.print(f"run: {near(folder)}", soft_wrap=True)
    out.print(f"next: inspect report {shlex.quote(str(near(folder)))}", soft_wrap=True)


def print_report(result: Result, page: Path, note: str = "") -> None:
    """A reported run and its page, and what is to be said of its pictures."""
    _print_result(result)
    print_warnings([note] if note else [])
    console().print(f"report: {near(page)}", soft_wrap=True)


def _print_result(result: Result) -> None:
    out = console()
    seed = "" if result.seed is None else f", seed {result.seed}"
    why = f": {result.status_reason}" if result.status_reason else ""
    title = f"{result.mission} on {result.platform}{seed}: "
    out.print(Text.assemble(title, styled(result.status), why), soft_wrap=True)
    for instrument in dict.fromkeys(point.instrument for point in result.points):
        points = [point for point in result.points if point.instrument == instrument]
        out.print(_values_table(instrument, points) if instrument else _points_table(points))
    for reason, labels in grouped((p.reason, p.label) for p in result.points).items():
        many = "s" if len(labels) > 1 else ""
        text = Text.assemble((f"point{many} {', '.join(labels)}: ", BAD), reason)
        out.print(text, soft_wrap=True)
    if result.checks:
        out.print(_checks_table(result.checks))
    for reason, metrics in grouped((c.reason, c.metric) for c in result.checks).items():
        out.print(Text.assemble((f"{', '.join(metrics)}: ", UNSURE), reason), soft_wrap=True)
    valid = sum(point.valid for point in result.points)
    passed = sum(check.verdict == "pass" for check in result.checks)
    readings = f"{valid} of {len(result.points)} readings valid, " if result.points else ""
    out.print(f"{readings}{passed} of {len(result.checks)} checks passed")
    print_warnings(_warnings(result))


def _warnings(result: Result) -> Iterator[str]:
    """What nobody asked for and everybody wants to know."""
    invalid = sum(not point.valid for point in result.points)
    if invalid:
        yield f"{invalid} of {len(result.points)} points have no valid reading"
    force_n = _measured(result, "contact.body_force_max_n")
    if force_n > 0.0:
        yield f"the vehicle's body touched something: {force_n:.3g} N"
    speed_mps = _measured(result, "flight.end_speed_mps")
    if speed_mps > STILL_MPS:
        yield f"the vehicle was still moving at the end: {speed_mps:.1f} m/s"


def _measured(result: Result, metric: str) -> float:
    """A metric's value, 0 where there is none."""
    found = result.metrics.get(metric)
    return (found.value or 0.0) if found else 0.0


def _points_table(points: Sequence[PointResult]) -> Table:
    table = table_of(
        *("points", "point", "reading", "potential\n/mV", "resistivity\n/Ω·m"),
        *("force\n/N", "corrosion"),
    )
    for point in points:
        table.add_row(
            point.label,
            styled("valid" if point.valid else "invalid"),
            number(point.potential_mv, ".0f"),
            number(point.resistivity_ohm_m, ".0f"),
            number(point.probe_force_n, ".2f"),
            point.corrosion or "",
        )
    return table


def _values_table(instrument: str, points: Sequence[PointResult]) -> Table:
    """The readings of another instrument than a half-cell, under the names of its values."""
    units = {name: unit for point in points for name, unit in point.units.items()}
    heads = (f"{name}\n/{unit}" if unit != "1" else name for name, unit in units.items())
    table = table_of(f"points of {instrument}", "point", "reading", *heads, "force\n/N")
    for point in points:
        table.add_row(
            point.label,
            styled("valid" if point.valid else "invalid"),
            *(number(point.values.get(name), ".6g") for name in units),
            number(point.probe_force_n, ".2f"),
        )
    return table


def _checks_table(checks: Sequence[Check]) -> Table:
    published = any(number_of(check.ref, check.metric) for check in checks)
    answers = "answers,\npublished" if published else "answers"
    table = table_of("checks", "metric", "value", "asked for", answers, "verdict")
    for check in checks:
        unit = "" if check.unit == "1" or check.value is None else f" {check.unit}"
        table.add_row(
            f"{check.metric}\nover {check.over}" if check.over else check.metric,
            number(check.value, ".4g") + unit,
            _bounds(check),
            _answers(check),
            styled(check.verdict),
        )
    return table


def _answers(check: Check) -> str:
    """The row of the ledger, and below it the published number where there is one."""
    number = number_of(check.ref, check.metric)
    return "\n".join(part for part in (check.ref or "", number) if part)


def _bounds(check: Check) -> str:
    if check.min is not None and check.min == check.max:
        return f"= {check.min:g}"
    low = "" if check.min is None else f"≥ {check.min:g}"
    high = "" if check.max is None else f"≤ {check.max:g}"
    return "\n".join(bound for bound in (low, high) if bound)


def print_readings(result: ReadingsResult, page: Path) -> None:
    """What the readings of a file come to, what was assumed, and where the page is."""
    out = console()
    out.print(f"{result.survey}: half-cell potentials against CSE", soft_wrap=True)
    for surface in result.assessment:
        table = table_of("classes of ASTM C876", "class", "points", "share", "area\n/m²")
        for share in surface.astm:
            area = number(share.area_m2, ".3g")
            table.add_row(share.name, str(share.count), f"{share.share:.1%}", area)
        out.print(table)
        potential = surface.potential
        if potential is not None:
            out.print(
                f"{counted(surface.valid, 'point')} from {potential.min_mv:.0f} to "
                f"{potential.max_mv:.0f} mV, median {potential.median_mv:.0f} mV; "
                f"{surface.invalid} without a reading",
                soft_wrap=True,
            )
    if result.assumed:
        out.print(f"assumed: {', '.join(result.assumed)} (see the report)", soft_wrap=True)
    print_warnings(result.warnings)
    out.print(f"report: {near(page)}", soft_wrap=True)
