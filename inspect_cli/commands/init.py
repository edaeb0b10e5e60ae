"""``inspect init``: a new campaign folder."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

from inspect_cli.errors import EnvironmentFault, InputError
from inspect_cli.files import write_whole
from inspect_cli.schema.campaign import FOLDERS, builtin_root

COPIED = ("missions", "platforms")

GITIGNORE = """\
reports/*
!reports/reference/
"""

README = """\
# An inspection campaign

`missions/` says what to touch and what must come out, `platforms/` with which vehicle,
`reports/` holds what came out.

    inspect plan {mission}
    inspect fly {mission}
    inspect report reports/*/*-seed*

Make the references first, and commit them; from then on every flight is held against them:

    inspect regress --update
    inspect regress

The references are the metrics of each mission and seed, in `reports/reference/`, which belongs
under version control. Renew them with `--update` when a change was meant.

`inspect schema mission` prints a JSON Schema for your editor.
"""


@dataclass(frozen=True)
class Campaign:
    """A campaign folder that was just made."""

    folder: Path
    files: tuple[Path, ...]
    """What was written, relative to the folder."""
    first_mission: Path | None
    """A mission to begin with."""


def init(folder: Path) -> Campaign:
    """Make a campaign with the built-in missions and platforms.

    Raises:
        InputError: the folder exists and is not empty; nothing was written.
        EnvironmentFault: it cannot be written.
    """
    _require_empty(folder)
    contents = _builtin_files()
    missions = [file for file in contents if file.parent == Path("missions")]
    first = min((file for file in missions if file.suffix == ".yaml"), default=None)
    contents[Path("README.md")] = README.format(mission=first or "MISSION").encode()
    contents[Path(".gitignore")] = GITIGNORE.encode()
    for file, data in contents.items():
        write_whole(folder / file, data)
    for name in FOLDERS:
        (folder / name).mkdir(exist_ok=True)
    return Campaign(folder, tuple(sorted(contents)), first)


def _require_empty(folder: Path) -> None:
    hint = "give a new or empty folder"
    if folder.exists() and not folder.is_dir():
        raise InputError(f"{folder} is a file", hint=hint)
    try:
        if folder.exists() and any(folder.iterdir()):
            raise InputError(f"{folder} is not empty", hint=hint)
    except OSError as error:
        raise EnvironmentFault(f"cannot read {folder}: {error.strerror}", hint=hint) from error


def _builtin_files() -> dict[Path, bytes]:
    """The built-in files by their path in a campaign."""
    root = builtin_root()
    return {
        file.relative_to(root): file.read_bytes()
        for name in COPIED
        for file in sorted((root / name).rglob("*"))
        if file.is_file() and not file.name.startswith((".", "__"))
    }
