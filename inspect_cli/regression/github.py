"""Formats a regression's report for GitHub Actions: annotations and the step summary.

Formats: docs.github.com, "Workflow commands for GitHub Actions" (setting an error message,
adding a job summary).
"""

from __future__ import annotations

from inspect_cli.regression.outcome import FlightReport, RegressReport
from inspect_cli.regression.verdict import describe


def annotation_lines(report: RegressReport) -> tuple[str, ...]:
    """Lines to print: an error per failed flight, a notice per known failure."""
    lines = []
    for flight in report.missions:
        title = _property(f"{flight.mission}, {flight.platform}, seed {flight.seed}")
        if flight.verdict == "fail":
            lines.append(f"::error title={title}::{_message(chr(10).join(flight.reasons))}")
        elif flight.verdict == "fail-known":
            lines.append(f"::notice title={title}::{_message(chr(10).join(_known(flight)))}")
    return tuple(lines)


def step_summary(report: RegressReport) -> str:
    """A table of all flights in GitHub's Markdown, then the reasons of those that fail."""
    counts = f"{report.passed} passed, {report.failed} failed"
    if report.known:
        counts += f", {report.known} fail as declared"
    lines = [
        "## Missions",
        "",
        counts,
        "",
        "| mission | platform | seed | verdict | status | checks | changes |",
        "|---|---|---:|---|---|---:|---:|",
    ]
    lines += [_row(flight) for flight in report.missions]
    for flight in report.missions:
        found = [*flight.reasons, *_known(flight)]
        if found:
            lines += ["", f"**{_cell(flight.mission)}, seed {flight.seed}**", ""]
            lines += [f"- {_cell(text)}" for text in found]
    return "\n".join(lines) + "\n"


def _known(flight: FlightReport) -> list[str]:
    return [describe(check) for check in flight.checks if check.verdict == "fail-known"]


def _row(flight: FlightReport) -> str:
    passed = sum(check.verdict == "pass" for check in flight.checks)
    cells = [
        flight.mission,
        flight.platform,
        str(flight.seed),
        flight.verdict,
        flight.status or "not flown",
        f"{passed}/{len(flight.checks)}",
        str(len(flight.changes)),
    ]
    return "| " + " | ".join(_cell(cell) for cell in cells) + " |"


def _cell(text: str) -> str:
    """Text that stays in its cell or list item and is not read as markup."""
    flat = " ".join(text.split()).replace("&", "&amp;").replace("<", "&lt;")
    return flat.replace("|", "\\|")


def _message(text: str) -> str:
    return text.replace("%", "%25").replace("\r", "%0D").replace("\n", "%0A")


def _property(text: str) -> str:
    return _message(text).replace(":", "%3A").replace(",", "%2C")
