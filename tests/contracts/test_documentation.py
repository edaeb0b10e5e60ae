"""The tables of README and CONTRIBUTING name what there is."""

from __future__ import annotations

import re
from pathlib import Path

from inspect_cli.cli import app
from inspect_cli.log.channels import channel_markdown


def first_cells(file: Path, heading: str) -> list[str]:
    """The first column of the table under a heading."""
    section = file.read_text(encoding="utf-8").split(f"\n## {heading}\n")[1].split("\n## ")[0]
    rows = [line for line in section.splitlines() if line.startswith("| ")]
    return [re.split(r"(?<!\\)\|", row)[1].strip() for row in rows[1:]]


def test_readme_lists_the_commands(root: Path) -> None:
    commands = {c.name or c.callback.__name__ for c in app.registered_commands}
    cells = first_cells(root / "README.md", "Commands")
    assert {cell.strip("`").split()[1] for cell in cells} == commands


def test_contributing_lists_every_floor(root: Path) -> None:
    cells = first_cells(root / "CONTRIBUTING.md", "The floors")
    named = {name for cell in cells for name in re.findall(r"`([^`]+)`", cell)}
    package = root / "inspect_cli"
    there = {f"{folder.parent.name}/" for folder in package.glob("*/__init__.py")}
    there |= {file.name for file in package.glob("*.py") if not file.name.startswith("__")}
    assert named == there


def test_contributing_lists_every_channel(root: Path) -> None:
    assert channel_markdown() in (root / "CONTRIBUTING.md").read_text(encoding="utf-8")
