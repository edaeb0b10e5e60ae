"""Commands that plan and fly missions."""

from __future__ import annotations

import shlex
import sys
from pathlib import Path
from typing import Annotated

import typer

from inspect_cli.cli.program import (
    Json,
    Mission,
    Out,
    Platform,
    stdout_kept_clean,
)
from inspect_cli.errors import (
    EXIT_CHECK_FAILED,
    EXIT_GOOD,
    EXIT_INTERRUPTED,
    InspectError,
)


def plan(
    mission: Mission, platform: Platform = None, out: Out = None, as_json: Json = False
) -> int:
    """Plan a mission and write plan.json."""
    from inspect_cli import terminal
    from inspect_cli.commands.plan import plan as command

    with stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        outcome = command(mission, platform, out)
    if as_json:
        sys.stdout.write(outcome.plan.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_any_plan(outcome.plan, outcome.file)
    return EXIT_GOOD


def fly(
    mission: Annotated[
        Path, typer.Argument(metavar="MISSION|PLAN", help="A mission, or a plan.json made of one.")
    ],
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the noise; by default the mission's first.")
    ] = None,
    platform: Platform = None,
    out: Out = None,
    as_json: Json = False,
) -> int:
    """Fly a mission or a plan in simulation; write the log and the metrics."""
    from inspect_cli import terminal
    from inspect_cli.commands.fly import fly as command
    from inspect_cli.commands.single_flight import FlightInterrupted

    with stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        try:
            with terminal.flight_progress(shown=not as_json) as progress:
                outcome = command(mission, seed=seed, platform=platform, out=out, progress=progress)
        except FlightInterrupted as stopped:
            raise _interrupted(stopped.folder) from None
    if as_json:
        sys.stdout.write(outcome.result.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_flight(outcome.result, outcome.folder)
    return EXIT_GOOD if outcome.result.passed else EXIT_CHECK_FAILED


def regress(
    paths: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[PATH...]", help="Missions or folders; by default missions/."),
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Flights at a time.")] = 1,
    update: Annotated[bool, typer.Option("--update", help="Rewrite the references.")] = False,
    junit: Annotated[
        Path | None, typer.Option(metavar="FILE", help="Write JUnit XML here.")
    ] = None,
    out: Out = None,
    as_json: Json = False,
) -> int:
    """Fly missions with all their seeds; compare with acceptance and references."""
    from inspect_cli import terminal
    from inspect_cli.commands.regress import regress as command

    with stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        with terminal.regression_progress(shown=not as_json) as progress:
            outcome = command(
                paths or (), jobs=jobs, update=update, junit=junit, out=out, progress=progress
            )
        terminal.print_lines(outcome.annotations)
    if as_json:
        sys.stdout.write(outcome.report.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_regression(outcome.report, outcome.updated)
    return outcome.exit_code


class _Interrupted(InspectError):
    """The user stopped a flight."""

    exit_code = EXIT_INTERRUPTED


def _interrupted(folder: Path) -> _Interrupted:
    """Says what was kept of the flight."""
    report = f"inspect report {shlex.quote(str(folder))}"
    hint = f"the flown part of the log was kept; report it: {report}"
    return _Interrupted("interrupted", hint=hint)
