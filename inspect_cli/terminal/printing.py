"""How everything that people read is put on stderr.

Colours go where the terminal has them and ``NO_COLOR`` is not set. User text is never read as
markup. Words are never broken: tables keep to short cells and are as wide as those, and what needs
a sentence stands below as a line of its own."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from rich.box import SIMPLE_HEAD
from rich.console import Console
from rich.table import Table
from rich.text import Text

if TYPE_CHECKING:
    from inspect_cli.errors import Problem

GOOD, BAD, UNSURE = "green", "bold red", "yellow"
STYLES = {
    "pass": GOOD,
    "valid": GOOD,
    "ok": GOOD,
    "completed": GOOD,
    "fail": BAD,
    "failed": BAD,
    "invalid": BAD,
    "not_measured": BAD,
    "aborted": BAD,
    "diverged": BAD,
    "interrupted": BAD,
    "fail-known": UNSURE,
    "warning": UNSURE,
}
ANY_WIDTH = 10_000


def console(width: int | None = ANY_WIDTH) -> Console:
    """The console on stderr; it breaks no line unless it is told the terminal's width."""
    return Console(stderr=True, markup=False, emoji=False, highlight=False, width=width)


def print_problems(problems: Sequence[Problem]) -> None:
    """What was wrong, each where it stands and with what to do about it."""
    out = console()
    for problem in problems:
        out.print(Text.assemble(("error: ", BAD), str(problem)), soft_wrap=True)


def print_lines(lines: Iterable[str]) -> None:
    """Lines for a machine that reads this output, such as annotations."""
    out = console()
    for line in lines:
        out.print(line, soft_wrap=True)


def print_warnings(warnings: Iterable[str]) -> None:
    """A line for each."""
    out = console()
    for warning in warnings:
        out.print(Text.assemble(("warning: ", UNSURE), warning), soft_wrap=True)


def table_of(title: str, *columns: str) -> Table:
    """A table with these columns, none of them broken."""
    table = Table(
        title=title, title_justify="left", box=SIMPLE_HEAD, show_edge=False, padding=(0, 1, 0, 0)
    )
    for column in columns:
        table.add_column(column, no_wrap=True)
    return table


def styled(word: str) -> Text:
    """A word in the colour of what it says."""
    return Text(word, style=STYLES.get(word, ""))


def number(value: float | None, form: str) -> str:
    """A number in this form; a dash where there is none."""
    return "—" if value is None else format(value, form)


def near(path: Path) -> Path:
    """The path as it is written from here, where that is shorter."""
    here = Path.cwd()
    whole = path.resolve()
    return whole.relative_to(here) if whole.is_relative_to(here) else path


def grouped(pairs: Iterable[tuple[str, str]]) -> dict[str, list[str]]:
    """The names by the reason that they share; those without a reason are left out."""
    groups: dict[str, list[str]] = {}
    for reason, name in pairs:
        if reason:
            groups.setdefault(reason, []).append(name)
    return groups


def counted(count: int, what: str) -> str:
    """The number with its noun."""
    return f"{count} {what}" if count == 1 else f"{count} {what}s"
