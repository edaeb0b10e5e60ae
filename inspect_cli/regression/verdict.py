"""The verdict on one flight: its checks, its changes against the reference, and why it fails."""

from __future__ import annotations

from pathlib import Path

from inspect_cli.errors import InputError
from inspect_cli.metrics.acceptance import Resolve, answer_all
from inspect_cli.regression.compare import compare
from inspect_cli.regression.flights import FlightEnd
from inspect_cli.regression.outcome import Change, FlightReport, FlightVerdict
from inspect_cli.regression.reference import read_reference
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.result import Check, Result


def judge(end: FlightEnd, reference: Path, resolve: Resolve, *, updating: bool) -> FlightReport:
    """Compare a flight with its mission's acceptance and with its reference.

    It passes if it ended as the mission expects, every check passes, and no metric left its
    tolerance. Checks that are known failures do not fail it, but keep it from a plain ``pass``.

    Args:
        end: the flight with its mission, and how it ended.
        reference: the file of its reference metrics.
        resolve: finds the results of other missions at the same seed.
        updating: references are about to be rewritten, so that changes do not count.
    """
    loaded = end.task.loaded
    if end.result is None:
        return _report(end, "fail", (f"it could not be flown: {end.error}",), (), ())
    checks = answer_all(loaded.mission.acceptance, end.result.metrics, resolve)
    reasons = [*_status_reasons(loaded, end.result), *_check_reasons(checks)]
    changes, reference_reasons = _changes(end.result, reference, loaded.root)
    if not updating:
        reasons += reference_reasons
    known = any(check.verdict == "fail-known" for check in checks)
    verdict: FlightVerdict = "fail" if reasons else "fail-known" if known else "pass"
    return _report(end, verdict, tuple(reasons), checks, changes)


def describe(check: Check) -> str:
    """A check in words: what came out and what was asked for."""
    name = f"{check.metric} over {check.over}" if check.over else check.metric
    bounds = []
    if check.min is not None:
        bounds.append(f"at least {check.min:g}")
    if check.max is not None:
        bounds.append(f"at most {check.max:g}")
    asked = " and ".join(bounds)
    unit = "" if check.unit == "1" else f" {check.unit}"
    value = "not measured" if check.value is None else f"{check.value:.6g}{unit}"
    text = f"{name} is {value}, asked for {asked}{unit}"
    return f"{text}: {check.reason}" if check.reason else text


def _report(
    end: FlightEnd,
    verdict: FlightVerdict,
    reasons: tuple[str, ...],
    checks: tuple[Check, ...],
    changes: tuple[Change, ...],
) -> FlightReport:
    return FlightReport(
        mission=end.task.loaded.mission.name,
        platform=end.task.loaded.platform.name,
        seed=end.task.seed,
        verdict=verdict,
        status=None if end.result is None else end.result.status,
        reasons=reasons,
        checks=checks,
        changes=changes,
        wall_s=end.wall_s,
        folder=None if end.folder is None else str(end.folder),
        details=end.details,
    )


def _status_reasons(loaded: Loaded, result: Result) -> list[str]:
    expected = loaded.mission.expect_status
    if result.status == expected:
        return []
    why = f" ({result.status_reason})" if result.status_reason else ""
    return [f"the flight was {result.status}{why}, expected {expected}"]


def _check_reasons(checks: tuple[Check, ...]) -> list[str]:
    return [describe(check) for check in checks if check.verdict in ("fail", "not_measured")]


def _changes(result: Result, path: Path, root: Path) -> tuple[tuple[Change, ...], list[str]]:
    try:
        reference = read_reference(path)
    except InputError as error:
        return (), [str(error)]
    if reference is None:
        return (), [f"there is no {path.relative_to(root)}; `inspect regress --update` writes it"]
    changes = compare(result, reference)
    reasons = [f"{change.metric}: {change.what}" for change in changes]
    if result.status != reference.status:
        reasons.insert(0, f"the flight was {result.status}, in the reference {reference.status}")
    return changes, reasons
