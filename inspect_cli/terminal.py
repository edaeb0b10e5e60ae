"""What people read: tables, progress and problems on stderr.

Colours go where the terminal has them and ``NO_COLOR`` is not set. User text is never read as
markup. Words are never broken: tables keep to short cells and are as wide as those, and what needs
a sentence stands below as a line of its own.
"""

from __future__ import annotations

import os
import shlex
from collections.abc import Callable, Iterable, Iterator, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn
from rich.table import Table
from rich.text import Text

from inspect_cli.reporting.published import number_of

if TYPE_CHECKING:
    from inspect_cli.commands.doctor import Diagnosis
    from inspect_cli.commands.init import Campaign
    from inspect_cli.errors import Problem
    from inspect_cli.regression.flights import FlightEnd
    from inspect_cli.regression.outcome import RegressReport
    from inspect_cli.schema.coverage import CoveragePlan
    from inspect_cli.schema.plan import Plan
    from inspect_cli.schema.result import Check, PointResult, Result
    from inspect_cli.schema.study import StudyResult, StudyVariant

GOOD, BAD, UNSURE = "green", "bold red", "yellow"
STYLES = {
    "pass": GOOD,
    "valid": GOOD,
    "ok": GOOD,
    "completed": GOOD,
    "fail": BAD,
    "failed": BAD,
    "invalid": BAD,
    "not_measured": BAD,
    "aborted": BAD,
    "diverged": BAD,
    "interrupted": BAD,
    "fail-known": UNSURE,
    "warning": UNSURE,
}
ANY_WIDTH = 10_000
WHOLE = 100.0
"""From here on three digits are a whole number."""
STILL_MPS = 0.2
"""A vehicle that has landed is slower than this."""


def console(width: int | None = ANY_WIDTH) -> Console:
    """The console on stderr; it breaks no line unless it is told the terminal's width."""
    return Console(stderr=True, markup=False, emoji=False, highlight=False, width=width)


def print_problems(problems: Sequence[Problem]) -> None:
    """What was wrong, each where it stands and with what to do about it."""
    out = console()
    for problem in problems:
        out.print(Text.assemble(("error: ", BAD), str(problem)), soft_wrap=True)


def print_lines(lines: Iterable[str]) -> None:
    """Lines for a machine that reads this output, such as annotations."""
    out = console()
    for line in lines:
        out.print(line, soft_wrap=True)


def announce_compilation(*, shown: bool) -> None:
    """Say why the first run of an installation takes longer."""
    if not shown or os.environ.get("NUMBA_DISABLE_JIT", "0") != "0":
        return
    places = [Path(__file__).parent, Path.home() / ".cache" / "numba"]
    if "NUMBA_CACHE_DIR" in os.environ:
        places = [Path(os.environ["NUMBA_CACHE_DIR"])]
    if not any(next(place.rglob("*.nbi"), None) for place in places):
        console().print("first run of this installation: compiling, once, some 15 s")


def print_campaign(made: Campaign) -> None:
    """A new campaign folder and the first thing to do in it."""
    out = console()
    out.print(f"made {made.folder} with {len(made.files)} files")
    if made.first_mission:
        out.print(f"next: cd {made.folder}; inspect fly {made.first_mission}", soft_wrap=True)


def print_any_plan(plan: Plan | CoveragePlan, file: Path) -> None:
    """The plan of a flight or of a survey."""
    from inspect_cli.schema.coverage import CoveragePlan

    if isinstance(plan, CoveragePlan):
        print_survey_plan(plan, file)
    else:
        print_plan(plan, file)


def print_survey_plan(plan: CoveragePlan, file: Path) -> None:
    """The sorties with their points, times and energies, and the points that are left out."""
    out = console()
    _print_surfaces(plan.sorties[0].plan)
    table = _table(
        f"{plan.mission}: sorties",
        *("sortie", "points", "start x, y\n/m", "time\n/s", "energy\n/Wh", "way\n/m"),
        *("cable\n/m", "least\nthrust\nmargin /N", "least\nclearance\n/m"),
    )
    for sortie in plan.sorties:
        flight = sortie.plan
        table.add_row(
            str(sortie.number),
            str(len(flight.targets)),
            ", ".join(f"{x:.1f}" for x in flight.start.p_WB[:2]),
            f"{flight.duration_s:.0f}",
            f"{flight.energy_wh:.1f}",
            f"{flight.path_m:.1f}",
            f"{flight.cable_m:.1f}",
            f"{min(t.thrust_margin_n for t in flight.targets):.1f}",
            _number(min(_clearances(flight), default=None), ".2f"),
        )
    out.print(table)
    for reason, labels in _grouped((p.reason, p.label) for p in plan.skipped).items():
        many = "s" if len(labels) > 1 else ""
        text = Text.assemble((f"left out, point{many} {', '.join(labels)}: ", UNSURE), reason)
        out.print(text, soft_wrap=True)
    out.print(
        f"{_counted(plan.points, 'point')} in {_counted(len(plan.sorties), 'sortie')}, "
        f"{len(plan.skipped)} left out, "
        f"{plan.tour_m:.1f} m through all standoffs"
    )
    out.print(
        f"{plan.duration_s:.0f} s and {plan.energy_wh:.1f} Wh in all, "
        f"at most {plan.budget_wh:.1f} Wh in each sortie"
    )
    for sortie in plan.sorties:
        _print_warnings(f"sortie {sortie.number}: {w}" for w in sortie.plan.warnings)
    out.print(f"plan: {_near(file)}", soft_wrap=True)


def print_plan(plan: Plan, file: Path) -> None:
    """The surfaces, the points in the order of the flight, and what the flight takes."""
    out = console()
    _print_surfaces(plan)
    points = _table(
        f"{plan.mission}: targets",
        *("target", "kind", "surface", "x, y, z /m", "press\n/m", "force\n/N"),
        *("thrust\nmargin\n/N", "clear-\nance\n/m"),
    )
    for target in plan.targets:
        points.add_row(
            target.label,
            target.kind,
            target.surface or "",
            ", ".join(f"{x:.3f}" for x in target.p_WC),
            _number(None if target.kind == "pose" else target.press_m, ".2f"),
            _number(None if target.kind == "pose" else target.expected_force_n, ".2f"),
            f"{target.thrust_margin_n:.1f}",
            _number(target.clearance_m, ".2f"),
        )
    out.print(points)
    out.print(
        f"{plan.duration_s:.0f} s, {plan.path_m:.1f} m, {plan.energy_wh:.1f} Wh, "
        f"cable {plan.cable_m:.1f} m"
    )
    _print_warnings(plan.warnings)
    out.print(f"plan: {_near(file)}", soft_wrap=True)


def _clearances(plan: Plan) -> list[float]:
    return [t.clearance_m for t in plan.targets if t.clearance_m is not None]


def _counted(count: int, what: str) -> str:
    return f"{count} {what}" if count == 1 else f"{count} {what}s"


def _print_surfaces(plan: Plan) -> None:
    surfaces = _table(f"{plan.mission}: surfaces", "surface", "shape", "from", "fit")
    for surface in plan.surfaces:
        fit = surface.fit
        quality = f"{fit.inlier_share:.0%} within, rms {1000 * fit.rms_m:.1f} mm" if fit else ""
        surfaces.add_row(surface.name, surface.shape.kind, surface.source, quality)
    if plan.surfaces:
        console().print(surfaces)


def print_flight(result: Result, folder: Path) -> None:
    """A flight's points and checks, and where its files are."""
    _print_result(result)
    out = console()
    out.print(f"run: {_near(folder)}", soft_wrap=True)
    out.print(f"next: inspect report {shlex.quote(str(_near(folder)))}", soft_wrap=True)


def print_report(result: Result, page: Path, note: str = "") -> None:
    """A reported run and its page, and what is to be said of its pictures."""
    _print_result(result)
    _print_warnings([note] if note else [])
    console().print(f"report: {_near(page)}", soft_wrap=True)


def print_regression(report: RegressReport, updated: Sequence[Path]) -> None:
    """All flights, what is wrong with those that fail, and what changed by how much."""
    out = console()
    table = _table("regression", "mission", "platform", "seed", "status", "checks", "verdict")
    for flight in report.missions:
        passed = sum(check.verdict == "pass" for check in flight.checks)
        table.add_row(
            flight.mission,
            flight.platform,
            str(flight.seed),
            flight.status or "not flown",
            f"{passed}/{len(flight.checks)}",
            _styled(flight.verdict),
        )
    out.print(table)
    for flight in report.missions:
        for reason in flight.reasons:
            name = f"{flight.mission} seed {flight.seed}: "
            out.print(Text.assemble((name, BAD), reason), soft_wrap=True)
    for file in updated:
        out.print(f"rewrote {_near(file)}", soft_wrap=True)
    out.print(f"{report.passed} passed, {report.failed} failed, {report.known} known failures")


def print_study(study: StudyResult, page: Path) -> None:
    """Each variant's numbers, the published ones below them, and what went wrong."""
    out = console()
    quantities = (f"{q.symbol}\n/{q.unit}" for q in study.quantities)
    heads = (f"{c.heading}\n/{c.unit}".removesuffix("/1") for c in study.columns)
    table = _table(study.title, "variant", *quantities, *(h.replace(", ", "\n") for h in heads))
    for variant in study.variants:
        values = (f"{variant.values[q.name]:g}" for q in study.quantities)
        table.add_row(variant.name, *values, *(_mean(variant, c.metric) for c in study.columns))
    if any(c.published is not None for c in study.columns):
        blank = ("" for _ in study.quantities)
        table.add_row("published", *blank, *(_number(c.published, ".3g") for c in study.columns))
    out.print(table)
    for reason in study.shortfalls:
        out.print(Text.assemble(("not as expected: ", BAD), reason), soft_wrap=True)
    for finding in study.findings:
        out.print(finding, soft_wrap=True)
    out.print(f"study: {_near(page)}", soft_wrap=True)


def _mean(variant: StudyVariant, metric: str) -> str:
    """A number of a variant, with its standard error if it is a mean."""
    value, error = variant.value(metric), variant.standard_errors.get(metric)
    shown = _number(value, ".3g" if abs(value or 0.0) < WHOLE else ".0f")
    return shown if error is None else f"{shown}\n±{error:.2g}"


def print_diagnosis(diagnosis: Diagnosis) -> None:
    """What was examined, what was found, and how to mend what fails."""
    out = console()
    for finding in diagnosis.findings:
        verdict = Text(f"{finding.verdict:<8}", style=STYLES[finding.verdict])
        out.print(Text.assemble(verdict, f"{finding.what}: {finding.found}"), soft_wrap=True)
    for finding in diagnosis.findings:
        if finding.hint:
            out.print(Text.assemble((f"{finding.what}: ", UNSURE), finding.hint), soft_wrap=True)


@contextmanager
def flight_progress(*, shown: bool) -> Iterator[Callable[[float, float], None]]:
    """A bar of the time of flight; the function takes seconds flown and seconds planned."""
    bar = _bar(TextColumn("{task.fields[flown]:.0f} of {task.total:.0f} s"), shown=shown)
    with bar:
        task = bar.add_task("flying", total=1.0, flown=0.0)

        def advance(flown_s: float, planned_s: float) -> None:
            done = min(flown_s, planned_s)
            bar.update(task, total=planned_s, completed=done, flown=flown_s)

        yield advance


@contextmanager
def regression_progress(*, shown: bool) -> Iterator[Callable[[int, int, FlightEnd], None]]:
    """A bar of the flights, or a line for each where there is no terminal.

    The function takes flights done, flights in all and the last.
    """
    with _bar(MofNCompleteColumn(), shown=shown) as bar:
        task = bar.add_task("flights", total=None)

        def advance(done: int, total: int, end: FlightEnd) -> None:
            bar.update(task, total=total, completed=done)
            if shown and bar.disable:
                text = f"{done}/{total} {end.task.name}, {end.wall_s:.1f} s"
                bar.console.print(text, soft_wrap=True)

        yield advance


def _bar(column: TextColumn | MofNCompleteColumn, *, shown: bool) -> Progress:
    out = console(width=None)
    columns = (TextColumn("{task.description}"), BarColumn(), column, TimeElapsedColumn())
    return Progress(*columns, console=out, transient=True, disable=not (shown and out.is_terminal))


def _print_result(result: Result) -> None:
    out = console()
    seed = "" if result.seed is None else f", seed {result.seed}"
    why = f": {result.status_reason}" if result.status_reason else ""
    title = f"{result.mission} on {result.platform}{seed}: "
    out.print(Text.assemble(title, _styled(result.status), why), soft_wrap=True)
    if result.points:
        out.print(_points_table(result.points))
    for reason, labels in _grouped((p.reason, p.label) for p in result.points).items():
        many = "s" if len(labels) > 1 else ""
        text = Text.assemble((f"point{many} {', '.join(labels)}: ", BAD), reason)
        out.print(text, soft_wrap=True)
    if result.checks:
        out.print(_checks_table(result.checks))
    for reason, metrics in _grouped((c.reason, c.metric) for c in result.checks).items():
        out.print(Text.assemble((f"{', '.join(metrics)}: ", UNSURE), reason), soft_wrap=True)
    valid = sum(point.valid for point in result.points)
    passed = sum(check.verdict == "pass" for check in result.checks)
    readings = f"{valid} of {len(result.points)} readings valid, " if result.points else ""
    out.print(f"{readings}{passed} of {len(result.checks)} checks passed")
    _print_warnings(_warnings(result))


def _grouped(pairs: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """The names by the reason that they share; those without a reason are left out."""
    groups: dict[str, list[str]] = {}
    for reason, name in pairs:
        if reason:
            groups.setdefault(reason, []).append(name)
    return groups


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


def _print_warnings(warnings: Iterable[str]) -> None:
    out = console()
    for warning in warnings:
        out.print(Text.assemble(("warning: ", UNSURE), warning), soft_wrap=True)


def _points_table(points: Sequence[PointResult]) -> Table:
    table = _table(
        *("points", "point", "reading", "potential\n/mV", "resistivity\n/Ω·m"),
        *("force\n/N", "corrosion"),
    )
    for point in points:
        table.add_row(
            point.label,
            _styled("valid" if point.valid else "invalid"),
            _number(point.potential_mv, ".0f"),
            _number(point.resistivity_ohm_m, ".0f"),
            _number(point.probe_force_n, ".2f"),
            point.corrosion or "",
        )
    return table


def _checks_table(checks: Sequence[Check]) -> Table:
    published = any(number_of(check.ref, check.metric) for check in checks)
    answers = "answers,\npublished" if published else "answers"
    table = _table("checks", "metric", "value", "asked for", answers, "verdict")
    for check in checks:
        unit = "" if check.unit == "1" or check.value is None else f" {check.unit}"
        table.add_row(
            f"{check.metric}\nover {check.over}" if check.over else check.metric,
            _number(check.value, ".4g") + unit,
            _bounds(check),
            _answers(check),
            _styled(check.verdict),
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


def _table(title: str, *columns: str) -> Table:
    table = Table(
        title=title, title_justify="left", box=SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0)
    )
    for column in columns:
        table.add_column(column, no_wrap=True)
    return table


def _styled(word: str) -> Text:
    return Text(word, style=STYLES.get(word, ""))


def _number(value: float | None, form: str) -> str:
    return "—" if value is None else format(value, form)


def _near(path: Path) -> Path:
    """The path as it is written from here, where that is shorter."""
    here = Path.cwd()
    whole = path.resolve()
    return whole.relative_to(here) if whole.is_relative_to(here) else path
