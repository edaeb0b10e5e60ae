"""The regression from selected missions to a report."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.regression.flights import FlightEnd, FlightTask, Fly, fly_all
from inspect_cli.regression.outcome import FlightReport, RegressReport
from inspect_cli.regression.reference import reference_file, reference_of, write_reference
from inspect_cli.regression.selection import Selection
from inspect_cli.regression.verdict import judge
from inspect_cli.schema.loading import Loaded

Progress = Callable[[int, int, FlightEnd], None]
"""(flights done, flights in all, the one that just ended)."""


@dataclass(frozen=True)
class Flight:
    """One mission with one seed, and how it ended."""

    loaded: Loaded
    end: FlightEnd

    @property
    def reference(self) -> Path:
        """The file of its reference metrics."""
        loaded = self.loaded
        return reference_file(
            loaded.root, loaded.mission.name, loaded.platform.name, self.end.task.seed
        )


def run(
    selections: Sequence[Selection],
    *,
    jobs: int,
    fly: Fly,
    update: bool = False,
    out: Path | None = None,
    progress: Progress | None = None,
) -> tuple[RegressReport, tuple[Path, ...]]:
    """Fly everything, then judge, then rewrite references if asked to.

    References are written after the last flight, each file in one step, so that an interrupted
    run leaves them as they were.

    Returns:
        The report, and the references that were rewritten.

    Raises:
        EnvironmentFault: a reference cannot be written.
    """
    flights = _fly(selections, jobs, fly, out, progress)
    results = {
        (flight.loaded.root, flight.loaded.mission.name, flight.end.task.seed): flight.end.result
        for flight in flights
    }

    def report(flight: Flight) -> FlightReport:
        root, seed = flight.loaded.root, flight.end.task.seed
        return judge(
            flight.loaded,
            flight.end,
            flight.reference,
            lambda mission: results.get((root, mission, seed)),
            updating=update,
        )

    reports = tuple(report(flight) for flight in flights)
    return RegressReport.of(reports), _update(flights) if update else ()


def _fly(
    selections: Sequence[Selection],
    jobs: int,
    fly: Fly,
    out: Path | None,
    progress: Progress | None,
) -> list[Flight]:
    loaded = [selection.loaded for selection in selections for _ in selection.seeds]
    tasks = [_task(s.loaded, seed, out) for s in selections for seed in s.seeds]
    done = 0

    def on_end(end: FlightEnd) -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, len(tasks), end)

    ends = fly_all(tasks, jobs=jobs, fly=fly, on_end=on_end)
    return [Flight(*pair) for pair in zip(loaded, ends, strict=True)]


def _task(loaded: Loaded, seed: int, out: Path | None) -> FlightTask:
    folder = None
    if out is not None:
        folder = out / loaded.mission.name / f"{loaded.platform.name}-seed{seed}"
    return FlightTask(loaded.mission_file, seed, folder)


def _update(flights: Sequence[Flight]) -> tuple[Path, ...]:
    """Rewrite the references of the flights that ended as their missions expect.

    A flight that ended otherwise is no example for later ones; its old reference stays.
    """
    updated = []
    for flight in flights:
        result = flight.end.result
        if result is None or result.status != flight.loaded.mission.expect_status:
            continue
        write_reference(flight.reference, reference_of(result, flight.end.task.seed))
        updated.append(flight.reference)
    return tuple(updated)
