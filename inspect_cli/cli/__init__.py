"""The command line: parse, call one command, print, and turn errors into exit codes.

This is the only place that catches InspectError. With ``--json`` exactly one JSON object goes to
stdout, an error too; everything for people goes to stderr. Imports inside the commands keep
``inspect --help`` from loading what it does not need.
"""

from __future__ import annotations

import gc
import os
import sys

from typer.exceptions import TyperException

from inspect_cli.cli import installation, missions, reports, studies
from inspect_cli.cli.program import app, print_json
from inspect_cli.errors import (
    EXIT_FAULT,
    EXIT_GOOD,
    EXIT_INPUT_REFUSED,
    EXIT_INTERRUPTED,
    InspectError,
    Problem,
)

COMMANDS = (
    installation.init,
    missions.plan,
    missions.fly,
    reports.report,
    missions.regress,
    studies.study,
    installation.doctor,
    installation.schema,
)
"""In the order of ``inspect --help``."""

SEARCHED_EVERY = (200_000, 50, 100)
"""How rarely Python looks for cycles of dead objects: a report holds a hundred thousand living
points, and looking through them again and again took a fifth of its time."""

for _command in COMMANDS:
    app.command(cls=studies.StudyCommand if _command is studies.study else None)(_command)


def main() -> None:
    """The program ``inspect``."""
    gc.set_threshold(*SEARCHED_EVERY)
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


def _misused(error: TyperException, as_json: bool) -> int:
    code = getattr(error, "exit_code", EXIT_INPUT_REFUSED)
    if not as_json and hasattr(error, "show"):
        error.show()
        return int(code)
    what = error.format_message() if hasattr(error, "format_message") else str(error)
    return _fail((Problem(what, hint="see inspect --help"),), int(code), as_json)


def _fail(problems: tuple[Problem, ...], code: int, as_json: bool) -> int:
    if as_json:
        print_json({"error": {"exit_code": code, "problems": [_problem(p) for p in problems]}})
    else:
        from inspect_cli import terminal

        terminal.print_problems(problems)
    return code


def _problem(problem: Problem) -> dict[str, object]:
    where = vars(problem.where) if problem.where else None
    return {"what": problem.what, "where": where, "hint": problem.hint}
