"""The command that reports."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from inspect_cli.cli.program import (
    Json,
    Language,
    ReportOut,
    print_json,
    stdout_kept_clean,
)
from inspect_cli.errors import (
    EXIT_CHECK_FAILED,
    EXIT_GOOD,
)


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

    with stdout_kept_clean():
        outcomes = command(runs, out, language, pictures=pictures)
    if as_json:
        reports = [
            {"page": str(o.page), "result": o.result.model_dump(mode="json", by_alias=True)}
            for o in outcomes
        ]
        print_json({"reports": reports})
    else:
        for outcome in outcomes:
            note = outcome.pictures.note if outcome.pictures else ""
            terminal.print_report(outcome.result, outcome.page, note)
    return EXIT_GOOD if all(o.result.passed for o in outcomes) else EXIT_CHECK_FAILED
