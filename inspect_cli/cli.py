"""The command line: parse, call one command, print, and turn errors into exit codes.

This is the only place that catches InspectError. With ``--json`` exactly one JSON object goes to
stdout, an error too; everything for people goes to stderr. Imports inside the commands keep
``inspect --help`` from loading what it does not need.
"""

from __future__ import annotations

import json
import os
import shlex
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Annotated, Literal

import typer
from typer.exceptions import TyperException

from inspect_cli.errors import (
    EXIT_CHECK_FAILED,
    EXIT_FAULT,
    EXIT_GOOD,
    EXIT_INPUT_REFUSED,
    EXIT_INTERRUPTED,
    InspectError,
    Problem,
)

app = typer.Typer(
    name="inspect",
    help="Contact-based non-destructive testing by flying robots: plan, fly, report, regress.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)

Mission = Annotated[Path, typer.Argument(metavar="MISSION", help="The mission's YAML file.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
Out = Annotated[Path | None, typer.Option(metavar="DIR", help="Write here instead of in reports/.")]
ReportOut = Annotated[
    Path | None, typer.Option("--out", metavar="DIR", help="Write here instead of beside the log.")
]
Language = Annotated[Literal["en", "de"], typer.Option(help="Of the page.")]
Platform = Annotated[
    Path | None,
    typer.Option(metavar="NAME|FILE", help="A platform instead of the one the mission names."),
]


def main() -> None:
    """The program ``inspect``."""
    sys.exit(run(sys.argv[1:]))


def run(arguments: list[str]) -> int:
    """Run one command line and return its exit code."""
    as_json = "--json" in arguments
    try:
        code = app(arguments, prog_name="inspect", standalone_mode=False)
    except InspectError as error:
        return _fail(error.problems, error.exit_code, as_json)
    except TyperException as error:
        return _misused(error, as_json)
    except Exception as error:
        if os.environ.get("INSPECT_TRACEBACK"):
            raise
        what = f"a defect of inspect: {type(error).__name__}: {error}"
        hint = "set INSPECT_TRACEBACK=1 to see where, and report it with the files you used"
        return _fail((Problem(what, hint=hint),), EXIT_FAULT, as_json)
    if code == EXIT_INTERRUPTED:
        return _fail((Problem("interrupted"),), EXIT_INTERRUPTED, as_json)
    return int(code or EXIT_GOOD)


def _version(asked: bool) -> None:
    if asked:
        from importlib.metadata import version

        sys.stdout.write(f"inspect {version('inspect-cli')}\n")
        raise typer.Exit


@app.callback()
def _options(
    version: Annotated[
        bool,
        typer.Option("--version", help="Print the version.", callback=_version, is_eager=True),
    ] = False,
) -> None:
    """Options before the command."""


@app.command()
def init(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="New or empty.")],
    as_json: Json = False,
) -> int:
    """Make a campaign folder with the built-in missions and platforms."""
    from inspect_cli.commands.init import init as command

    with _stdout_kept_clean():
        made = command(folder)
    if as_json:
        _print_json({"folder": str(made.folder), "files": [str(file) for file in made.files]})
    else:
        from inspect_cli import terminal

        terminal.print_campaign(made)
    return EXIT_GOOD


@app.command()
def plan(
    mission: Mission, platform: Platform = None, out: Out = None, as_json: Json = False
) -> int:
    """Plan a mission and write plan.json."""
    from inspect_cli import terminal
    from inspect_cli.commands.plan import plan as command

    with _stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        outcome = command(mission, platform, out)
    if as_json:
        sys.stdout.write(outcome.plan.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_any_plan(outcome.plan, outcome.file)
    return EXIT_GOOD


@app.command()
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
    from inspect_cli.commands.flying import FlightInterrupted

    with _stdout_kept_clean():
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


@app.command()
def report(
    runs: Annotated[list[Path], typer.Argument(metavar="RUN|LOG...", help="Run folders or logs.")],
    out: ReportOut = None,
    language: Language = "en",
    pictures: Annotated[
        bool, typer.Option("--pictures/--no-pictures", help="Render a scene and a short film.")
    ] = True,
    as_json: Json = False,
) -> int:
    """Report flights: metrics, readings, an HTML page and pictures."""
    from inspect_cli import terminal
    from inspect_cli.commands.report import report as command

    with _stdout_kept_clean():
        outcomes = command(runs, out, language, pictures=pictures)
    if as_json:
        reports = [
            {"page": str(o.page), "result": o.result.model_dump(mode="json", by_alias=True)}
            for o in outcomes
        ]
        _print_json({"reports": reports})
    else:
        for outcome in outcomes:
            note = outcome.pictures.note if outcome.pictures else ""
            terminal.print_report(outcome.result, outcome.page, note)
    return EXIT_GOOD if all(o.result.passed for o in outcomes) else EXIT_CHECK_FAILED


@app.command()
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

    with _stdout_kept_clean():
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


@app.command()
def study(
    name: Annotated[str, typer.Argument(metavar="NAME", help="Which study: force, pitch.")],
    mission: Mission,
    gains: Annotated[
        str | None, typer.Option(metavar="K,K,…", help="force: observer gains K_I, 1/s.")
    ] = None,
    speeds: Annotated[
        str | None, typer.Option(metavar="V,V,…", help="force: speeds of the approach, m/s.")
    ] = None,
    pitch: Annotated[
        str | None, typer.Option(metavar="P,P,…", help="pitch: pitches of the grid, m.")
    ] = None,
    fly: Annotated[
        bool, typer.Option("--fly", help="pitch: fly each pitch once, beside the samples.")
    ] = False,
    out: Out = None,
    seed: Annotated[
        int | None, typer.Option(min=0, help="Of the noise; by default the mission's first.")
    ] = None,
    jobs: Annotated[int, typer.Option(min=1, help="Flights at a time.")] = 1,
    language: Language = "en",
    as_json: Json = False,
) -> int:
    """Fly or sample a mission with varied numbers; show what they do to its metrics."""
    from inspect_cli import terminal
    from inspect_cli.commands.study import study as command

    options = {"gains": gains, "speeds": speeds, "pitch": pitch}
    asked = {k: v for k, v in options.items() if v is not None}
    with _stdout_kept_clean():
        terminal.announce_compilation(shown=not as_json)
        with terminal.regression_progress(shown=not as_json) as progress:
            outcome = command(
                name,
                mission,
                asked=asked,
                out=out,
                seed=seed,
                jobs=jobs,
                language=language,
                fly_sampled=fly,
                progress=progress,
            )
    if as_json:
        sys.stdout.write(outcome.result.model_dump_json(by_alias=True) + "\n")
    else:
        terminal.print_study(outcome.result, outcome.page)
    return outcome.exit_code


@app.command()
def doctor(as_json: Json = False) -> int:
    """Check this installation and say how to mend what fails."""
    from inspect_cli.commands.doctor import doctor as command

    with _stdout_kept_clean():
        diagnosis = command()
    if as_json:
        _print_json(diagnosis.as_json())
    else:
        from inspect_cli import terminal

        terminal.print_diagnosis(diagnosis)
    return EXIT_GOOD if diagnosis.healthy else EXIT_CHECK_FAILED


@app.command()
def schema(
    kind: Annotated[Literal["mission", "platform"], typer.Argument(help="Which file.")],
    as_json: Annotated[bool, typer.Option("--json", help="The same: a schema is JSON.")] = False,
) -> int:
    """Print the JSON Schema of a file, for editors."""
    from inspect_cli.commands.schema import schema as command

    sys.stdout.write(command(kind))
    return EXIT_GOOD


class _Interrupted(InspectError):
    """The user stopped a flight."""

    exit_code = EXIT_INTERRUPTED


def _interrupted(folder: Path) -> _Interrupted:
    """Says what was kept of the flight."""
    report = f"inspect report {shlex.quote(str(folder))}"
    hint = f"the flown part of the log was kept; report it: {report}"
    return _Interrupted("interrupted", hint=hint)


@contextmanager
def _stdout_kept_clean() -> Iterator[None]:
    """Libraries that print do so on stderr; stdout belongs to the result."""
    with redirect_stdout(sys.stderr):
        yield


def _print_json(data: dict[str, object]) -> None:
    sys.stdout.write(json.dumps(data, ensure_ascii=False) + "\n")


def _misused(error: TyperException, as_json: bool) -> int:
    code = getattr(error, "exit_code", EXIT_INPUT_REFUSED)
    if not as_json and hasattr(error, "show"):
        error.show()
        return int(code)
    what = error.format_message() if hasattr(error, "format_message") else str(error)
    return _fail((Problem(what, hint="see inspect --help"),), int(code), as_json)


def _fail(problems: tuple[Problem, ...], code: int, as_json: bool) -> int:
    if as_json:
        _print_json({"error": {"exit_code": code, "problems": [_problem(p) for p in problems]}})
    else:
        from inspect_cli import terminal

        terminal.print_problems(problems)
    return code


def _problem(problem: Problem) -> dict[str, object]:
    where = vars(problem.where) if problem.where else None
    return {"what": problem.what, "where": where, "hint": problem.hint}
