"""Executors of ``concurrent.futures`` that run flights on this machine.

Whoever flies many missions is handed a function that opens an executor, so that the client of a
cluster can take the place of this machine's processes: anything with ``submit`` and ``shutdown``
whose futures report when they are done.
"""

from __future__ import annotations

import signal
from collections.abc import Callable
from concurrent.futures import Executor, ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

OpenExecutor = Callable[[int], Executor]
"""Opens an executor for the number of flights given.

It is called again for each flight that a broken executor lost. Every executor that it opens is
shut down when its flights have ended.
"""


def local_executors(jobs: int) -> OpenExecutor:
    """Executors on this machine for at most ``jobs`` flights at a time.

    With one job flights are flown in a thread of this process, one after the other; otherwise in
    processes, of which one that dies breaks the executor alone and not this process.
    """

    def open_executor(flights: int) -> Executor:
        if jobs == 1:
            return ThreadPoolExecutor(1)
        # Spawned, because MuJoCo, Numba and OpenMP keep threads that do not survive a fork.
        spawn = get_context("spawn")
        workers = max(1, min(jobs, flights))
        return ProcessPoolExecutor(workers, mp_context=spawn, initializer=_ignore_interrupt)

    return open_executor


def _ignore_interrupt() -> None:
    """Leave Ctrl-C to the parent, which lets running flights end and starts no more."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
