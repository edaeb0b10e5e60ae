"""Bars while something runs."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING

from rich.progress import BarColumn, MofNCompleteColumn, Progress, TextColumn, TimeElapsedColumn

if TYPE_CHECKING:
    from inspect_cli.regression.flights import FlightEnd
from inspect_cli.terminal.printing import console


@contextmanager
def flight_progress(*, shown: bool) -> Iterator[Callable[[float, float], None]]:
    """A bar of the time of flight; the function takes seconds flown and seconds planned."""
    bar = _bar(TextColumn("{task.fields[flown]:.0f} of {task.total:.0f} s"), shown=shown)
    with bar:
        task = bar.add_task("flying", total=1.0, flown=0.0)

        def advance(flown_s: float, planned_s: float) -> None:
            done = min(flown_s, planned_s)
            bar.update(task, total=planned_s, completed=done, flown=flown_s)

        yield advance


@contextmanager
def regression_progress(*, shown: bool) -> Iterator[Callable[[int, int, FlightEnd], None]]:
    """A bar of the flights, or a line for each where there is no terminal.

    The function takes flights done, flights in all and the last.
    """
    with _bar(MofNCompleteColumn(), shown=shown) as bar:
        task = bar.add_task("flights", total=None)

        def advance(done: int, total: int, end: FlightEnd) -> None:
            bar.update(task, total=total, completed=done)
            if shown and bar.disable:
                text = f"{done}/{total} {end.task.name}, {end.wall_s:.1f} s"
                bar.console.print(text, soft_wrap=True)

        yield advance


def _bar(column: TextColumn | MofNCompleteColumn, *, shown: bool) -> Progress:
    out = console(width=None)
    columns = (TextColumn("{task.description}"), BarColumn(), column, TimeElapsedColumn())
    return Progress(*columns, console=out, transient=True, disable=not (shown and out.is_terminal))
