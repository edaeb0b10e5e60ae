"""Runs the regression: from selected missions to a report of their flights."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from pathlib import Path

from inspect_cli.regression.executors import OpenExecutor
from inspect_cli.regression.flights import FlightEnd, FlightTask, Fly, OnEnd, fly_all
from inspect_cli.regression.outcome import FlightReport, RegressReport
from inspect_cli.regression.reference import reference_file, reference_of, write_reference
from inspect_cli.regression.selection import Selection
from inspect_cli.regression.verdict import judge
from inspect_cli.schema.loading import Loaded

Progress = Callable[[int, int, FlightEnd], None]
"""(flights done, flights in all, the one that just ended)."""


def run(
    selections: Sequence[Selection],
    *,
    open_executor: OpenExecutor,
    fly: Fly,
    update: bool = False,
    out: Path | None = None,
    progress: Progress | None = None,
) -> tuple[RegressReport, tuple[Path, ...]]:
    """Fly everything, then judge it, then rewrite references if ``update`` is set.

    References are written after the last flight, each file in one step, so that an interrupted
    run leaves them as they were.

    Returns:
        The report, and the files of the references that were rewritten.

    Raises:
        EnvironmentFault: a reference cannot be written.
    """
    tasks = [_task(s.loaded, seed, out) for s in selections for seed in s.seeds]
    ends = fly_all(
        tasks, fly=fly, open_executor=open_executor, on_end=counted(len(tasks), progress)
    )
    results = {
        (end.task.loaded.root, end.task.loaded.mission.name, end.task.seed): end.result
        for end in ends
    }

    def report(end: FlightEnd) -> FlightReport:
        root, seed = end.task.loaded.root, end.task.seed
        return judge(
            end,
            _reference(end.task),
            lambda mission: results.get((root, mission, seed)),
            updating=update,
        )

    reports = tuple(report(end) for end in ends)
    return RegressReport.of(reports), _update(ends) if update else ()


def counted(total: int, progress: Progress | None) -> OnEnd:
    """Calls ``progress`` with the number of flights that have ended, as each of them ends."""
    done = 0

    def on_end(end: FlightEnd) -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, total, end)

    return on_end


def _task(loaded: Loaded, seed: int, out: Path | None) -> FlightTask:
    folder = None
    if out is not None:
        folder = out / loaded.mission.name / f"{loaded.platform.name}-seed{seed}"
    return FlightTask(loaded, seed, out=folder)


def _reference(task: FlightTask) -> Path:
    """The file of a flight's reference metrics."""
    loaded = task.loaded
    return reference_file(loaded.root, loaded.mission.name, loaded.platform.name, task.seed)


def _update(ends: Sequence[FlightEnd]) -> tuple[Path, ...]:
    """Rewrite the references of the flights that ended as their missions expect.

    Others are no example for later flights: their old references stay.
    """
    updated = []
    for end in ends:
        if end.result is None or end.result.status != end.task.loaded.mission.expect_status:
            continue
        file = _reference(end.task)
        write_reference(file, reference_of(end.result, end.task.seed))
        updated.append(file)
    return tuple(updated)
