"""Commands about the installation: a new campaign, the doctor, the schemas."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import Annotated, Literal

import typer

from inspect_cli.cli.program import (
    Json,
    print_json,
    stdout_kept_clean,
)
from inspect_cli.errors import (
    EXIT_CHECK_FAILED,
    EXIT_GOOD,
)


def init(
    folder: Annotated[Path, typer.Argument(metavar="DIR", help="New or empty.")],
    as_json: Json = False,
) -> int:
    """Make a campaign folder with the built-in missions and platforms."""
    from inspect_cli.commands.init import init as command

    with stdout_kept_clean():
        made = command(folder)
    if as_json:
        print_json({"folder": str(made.folder), "files": [str(file) for file in made.files]})
    else:
        from inspect_cli import terminal

        terminal.print_campaign(made)
    return EXIT_GOOD


def doctor(as_json: Json = False) -> int:
    """Check this installation and say how to mend what fails."""
    from inspect_cli.commands.doctor import doctor as command

    with stdout_kept_clean():
        diagnosis = command()
    if as_json:
        print_json(diagnosis.as_json())
    else:
        from inspect_cli import terminal

        terminal.print_diagnosis(diagnosis)
    return EXIT_GOOD if diagnosis.healthy else EXIT_CHECK_FAILED


def schema(
    kind: Annotated[Literal["mission", "platform", "survey"], typer.Argument(help="Which file.")],
    as_json: Annotated[bool, typer.Option("--json", help="The same: a schema is JSON.")] = False,
) -> int:
    """Print the JSON Schema of a file, for editors."""
    from inspect_cli.commands.schema import schema as command

    sys.stdout.write(command(kind))
    return EXIT_GOOD
