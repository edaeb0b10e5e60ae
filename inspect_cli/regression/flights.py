"""Flies many tasks at once through an executor and returns how each ended.

A task holds the loaded mission itself, not the path of its file: what is flown is what was
loaded, on whatever machine the executor flies it. The function that flies one task is an
argument, because the commands that define it may import this package and not the reverse.
"""

from __future__ import annotations

import time
import traceback
from collections.abc import Callable, Generator, Sequence
from concurrent.futures import BrokenExecutor, CancelledError, Future
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path
from queue import SimpleQueue
from typing import Protocol

from inspect_cli.errors import InspectError
from inspect_cli.regression.executors import OpenExecutor
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


class Flown(Protocol):
    """What a flight returns."""

    @property
    def result(self) -> Result:
        """Its metrics."""
        ...

    @property
    def folder(self) -> Path:
        """The folder of its files."""
        ...


class Fly(Protocol):
    """Flies and evaluates a loaded mission; worker processes import the function by its name."""

    def __call__(
        self, loaded: Loaded, plan: Plan | CoveragePlan | None, *, seed: int, out: Path | None
    ) -> Flown:
        """Fly ``loaded`` with ``seed`` and write the files of the run into the folder ``out``.

        The mission is planned first if ``plan`` is None.
        """
        ...


@dataclass(frozen=True)
class FlightTask:
    """One flight to fly: a mission with one seed.

    It can be pickled. Only scans, drawings and other data that the mission refers to are read
    when it is flown, from the campaign folder ``loaded.root``.
    """

    loaded: Loaded
    seed: int
    plan: Plan | CoveragePlan | None = None
    """The mission's plan, if there is one already."""
    out: Path | None = None
    """The folder of the run; None for the mission's own in ``reports/``."""
    label: str = ""
    """Its name where several tasks share a mission file and a seed."""

    @property
    def name(self) -> str:
        """The name that progress shows."""
        return self.label or f"{self.loaded.mission_file.stem} seed {self.seed}"


@dataclass(frozen=True)
class FlightEnd:
    """How a task ended: with a result, or with an error text."""

    task: FlightTask
    wall_s: float = 0.0
    result: Result | None = None
    folder: Path | None = None
    error: str = ""
    details: str = ""
    """The traceback of an error that is a defect of the program."""


@dataclass(frozen=True)
class _Returned:
    """What a worker sends back: not the task, which the parent has."""

    wall_s: float
    result: Result
    folder: Path


OnEnd = Callable[[FlightEnd], None]


def fly_all(
    tasks: Sequence[FlightTask],
    *,
    fly: Fly,
    open_executor: OpenExecutor,
    on_end: OnEnd | None = None,
) -> list[FlightEnd]:
    """Fly every task and return how each ended, in the order of the tasks.

    An exception ends its own flight alone. When a worker process dies and breaks its executor,
    the flights that were lost with it are flown again one by one, each in an executor of its own,
    so that only the flight that kills its worker stays lost.

    Args:
        tasks: what to fly.
        fly: flies one mission; it is pickled if the executor uses other processes.
        open_executor: opens the executor that runs the flights.
        on_end: called with each flight as it ends, in the thread of the caller.
    """
    ends: dict[int, FlightEnd] = {}

    def note(index: int, end: FlightEnd) -> None:
        ends[index] = end
        if on_end is not None:
            on_end(end)

    lost = []
    # Closed explicitly, so that an interrupt shuts the executor down before anything else runs.
    with closing(_completed(tasks, fly, open_executor)) as completed:
        for index, future in completed:
            if isinstance(_error(future), BrokenExecutor):
                lost.append(index)
            else:
                note(index, _end(tasks[index], future))
    for index in lost:
        with closing(_completed([tasks[index]], fly, open_executor)) as completed:
            for _, future in completed:
                note(index, _end(tasks[index], future))
    return [ends[index] for index in range(len(tasks))]


def _completed(
    tasks: Sequence[FlightTask], fly: Fly, open_executor: OpenExecutor
) -> Generator[tuple[int, Future[_Returned]]]:
    """Each task's index with its future, in the order in which they end.

    Of a future only ``add_done_callback`` is used here, because ``as_completed`` takes the
    futures of the standard library alone.
    """
    done: SimpleQueue[tuple[int, Future[_Returned]]] = SimpleQueue()
    executor = open_executor(len(tasks))

    def submit(index: int, task: FlightTask) -> None:
        try:
            future = executor.submit(_fly, fly, task)
        except BrokenExecutor as error:  # an earlier flight has broken it already
            future = Future()
            future.set_exception(error)
        future.add_done_callback(lambda ended: done.put((index, ended)))

    try:
        for index, task in enumerate(tasks):
            submit(index, task)
        for _ in tasks:
            yield done.get()
    finally:
        executor.shutdown(cancel_futures=True)


def _fly(fly: Fly, task: FlightTask) -> _Returned:
    """Fly one task; it runs in the worker."""
    start = time.perf_counter()
    flown = fly(task.loaded, task.plan, seed=task.seed, out=task.out)
    return _Returned(time.perf_counter() - start, flown.result, flown.folder)


def _error(future: Future[_Returned]) -> BaseException | None:
    try:
        return future.exception()
    except CancelledError as error:
        return error


def _end(task: FlightTask, future: Future[_Returned]) -> FlightEnd:
    error = _error(future)
    if error is None:
        returned = future.result()
        return FlightEnd(task, returned.wall_s, returned.result, returned.folder)
    if isinstance(error, BrokenExecutor):
        return FlightEnd(task, error="the process that flew it died")
    if isinstance(error, CancelledError):
        return FlightEnd(task, error="its executor cancelled it")
    if isinstance(error, InspectError):
        return FlightEnd(task, error=str(error))
    details = "".join(traceback.format_exception(error))
    return FlightEnd(task, error=f"{type(error).__name__}: {error}", details=details)
