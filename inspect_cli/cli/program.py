"""The command line's program, and what its commands share."""

from __future__ import annotations

import json
import sys
from collections.abc import Iterator
from contextlib import contextmanager, redirect_stdout
from pathlib import Path
from typing import Annotated, Literal

import typer

from inspect_cli.errors import InputError

app = typer.Typer(
    name="inspect",
    help="Contact-based non-destructive testing by flying robots: plan, fly, report, regress.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    context_settings={"help_option_names": ["-h", "--help"]},
)


def named_path(text: str) -> Path:
    """A path from the command line.

    Raises:
        InputError: it is empty, as a variable that is not set leaves it; pathlib would take it
            for the working directory.
    """
    if not text.strip():
        raise InputError("a path is empty", hint="name a file or a folder; . is this folder")
    return Path(text)


Mission = Annotated[Path, typer.Argument(metavar="MISSION", help="The mission's YAML file.")]
Json = Annotated[bool, typer.Option("--json", help="Print one JSON object on stdout.")]
Out = Annotated[
    Path | None,
    typer.Option(metavar="DIR", help="Write here instead of in reports/.", parser=named_path),
]
ReportOut = Annotated[
    Path | None,
    typer.Option(
        "--out", metavar="DIR", help="Write here instead of beside the log.", parser=named_path
    ),
]
Language = Annotated[Literal["en", "de"], typer.Option(help="Of the page.")]
Platform = Annotated[
    Path | None,
    typer.Option(metavar="NAME|FILE", help="A platform instead of the one the mission names."),
]


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


@contextmanager
def stdout_kept_clean() -> Iterator[None]:
    """Libraries that print do so on stderr; stdout belongs to the result."""
    with redirect_stdout(sys.stderr):
        yield


def print_json(data: dict[str, object]) -> None:
    """One object on stdout, for programs."""
    sys.stdout.write(json.dumps(data, ensure_ascii=False) + "\n")
