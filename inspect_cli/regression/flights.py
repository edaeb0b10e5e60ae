"""Flying many missions at once, each in a process of its own.

How a mission is flown is handed in, because this floor lies below the commands.
"""

from __future__ import annotations

import signal
import time
import traceback
from collections.abc import Callable, Iterator, Sequence
from concurrent.futures import (
    Executor,
    Future,
    ProcessPoolExecutor,
    ThreadPoolExecutor,
    as_completed,
)
from concurrent.futures.process import BrokenProcessPool
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from pathlib import Path
from typing import Protocol

from inspect_cli.errors import InspectError
from inspect_cli.schema.result import Result


class Flown(Protocol):
    """What comes back from a flight."""

    @property
    def result(self) -> Result:
        """Its metrics."""
        ...

    @property
    def folder(self) -> Path:
        """Where its files are."""
        ...


class Fly(Protocol):
    """Plans, flies and evaluates a mission; a function that other processes can import."""

    def __call__(
        self, mission: Path, *, seed: int | None, platform: Path | None, out: Path | None
    ) -> Flown:
        """Fly ``mission`` with ``seed`` and write its files into the folder ``out``."""
        ...


@dataclass(frozen=True)
class FlightTask:
    """One mission with one seed."""

    mission_file: Path
    seed: int
    out: Path | None = None
    label: str = ""
    """Instead of the mission's file, where several tasks share it."""

    @property
    def name(self) -> str:
        """What it is called while it is flown."""
        return self.label or f"{self.mission_file.stem} seed {self.seed}"


@dataclass(frozen=True)
class FlightEnd:
    """How a task ended: with a result, or with an error in words."""

    task: FlightTask
    wall_s: float = 0.0
    result: Result | None = None
    folder: Path | None = None
    error: str = ""
    details: str = ""


OnEnd = Callable[[FlightEnd], None]


def fly_all(
    tasks: Sequence[FlightTask], *, jobs: int, fly: Fly, on_end: OnEnd | None = None
) -> list[FlightEnd]:
    """Fly every task and return how each ended, in the order of the tasks.

    An exception ends its own flight alone. When a worker process dies, the flights that it took
    down with it are flown again one by one, so that only the guilty one is lost.

    Args:
        tasks: what to fly.
        jobs: flights at a time; with 1 they are flown in this process.
        fly: flies one mission; for ``jobs`` > 1 it must be importable by name.
        on_end: is told of each flight as it ends.
    """
    ends: dict[FlightTask, FlightEnd] = {}
    lost = []
    for task, future in _completed(tasks, jobs, fly):
        if isinstance(future.exception(), BrokenProcessPool):
            lost.append(task)
            continue
        ends[task] = _tell(_end(task, future), on_end)
    for task in lost:
        for _, future in _completed([task], 2, fly):
            ends[task] = _tell(_end(task, future), on_end)
    return [ends[task] for task in tasks]


def _completed(
    tasks: Sequence[FlightTask], jobs: int, fly: Fly
) -> Iterator[tuple[FlightTask, Future[FlightEnd]]]:
    with _executor(jobs, len(tasks)) as executor:
        futures = {executor.submit(_fly, fly, task): task for task in tasks}
        for future in as_completed(futures):
            yield futures[future], future


@contextmanager
def _executor(jobs: int, tasks: int) -> Iterator[Executor]:
    executor: Executor
    if jobs == 1:
        executor = ThreadPoolExecutor(1)
    else:
        # Not forked: MuJoCo, Numba and OpenMP keep threads that do not survive a fork.
        spawn = get_context("spawn")
        workers = max(1, min(jobs, tasks))
        executor = ProcessPoolExecutor(workers, mp_context=spawn, initializer=_ignore_interrupt)
    try:
        yield executor
    finally:
        executor.shutdown(cancel_futures=True)


def _ignore_interrupt() -> None:
    """Leave Ctrl-C to the parent, which lets running flights end and starts no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


def _fly(fly: Fly, task: FlightTask) -> FlightEnd:
    start = time.perf_counter()
    flown = fly(task.mission_file, seed=task.seed, platform=None, out=task.out)
    return FlightEnd(task, time.perf_counter() - start, flown.result, flown.folder)


def _end(task: FlightTask, future: Future[FlightEnd]) -> FlightEnd:
    error = future.exception()
    if error is None:
        return future.result()
    if isinstance(error, BrokenProcessPool):
        return FlightEnd(task, error="the process that flew it died")
    if isinstance(error, InspectError):
        return FlightEnd(task, error=str(error))
    details = "".join(traceback.format_exception(error))
    return FlightEnd(task, error=f"{type(error).__name__}: {error}", details=details)


def _tell(end: FlightEnd, on_end: OnEnd | None) -> FlightEnd:
    if on_end is not None:
        on_end(end)
    return end
