"""A cluster's client: an executor with futures of its own, whose workers share no memory with us.

Everything that is submitted and returned is pickled, as it is on its way to another machine. The
tasks run when the client is first asked to wait, the last one first.
"""

from __future__ import annotations

import pickle
from collections.abc import Callable
from concurrent.futures import BrokenExecutor, CancelledError, ThreadPoolExecutor
from typing import Any


class ClusterFuture:
    """Knows what ``fly_all`` may use of a future; none of the standard library's."""

    def __init__(self) -> None:
        self._callbacks: list[Callable[[Any], None]] = []
        self._ended = False
        self._value: Any = None
        self._error: BaseException | None = None
        self._cancelled = False

    def add_done_callback(self, callback: Callable[[Any], None]) -> None:
        if self._ended:
            callback(self)
        else:
            self._callbacks.append(callback)

    def end(
        self, value: Any = None, error: BaseException | None = None, *, cancelled: bool = False
    ) -> None:
        self._ended, self._value, self._error, self._cancelled = True, value, error, cancelled
        for callback in self._callbacks:
            callback(self)

    def exception(self) -> BaseException | None:
        if self._cancelled:
            raise CancelledError
        return self._error

    def result(self) -> Any:
        if self._error is not None:
            raise self._error
        return self._value


class FakeCluster:
    """``breaks_at`` and ``cancels_at`` are numbers of submitted tasks, from 0."""

    def __init__(
        self, flights: int, breaks_at: int | None = None, cancels_at: int | None = None
    ) -> None:
        self._flights, self._breaks_at, self._cancels_at = flights, breaks_at, cancels_at
        self._queued: list[tuple[bytes, ClusterFuture]] = []
        self.shut_down: list[bool] = []
        self._broken = False

    def submit(self, function: Callable[..., Any], *arguments: Any) -> ClusterFuture:
        if self._breaks_at is not None and len(self._queued) > self._breaks_at:
            if not self._broken:
                self._broken = True
                self._run()
            raise BrokenExecutor("a node is gone")
        future = ClusterFuture()
        self._queued.append((pickle.dumps((function, arguments)), future))
        if len(self._queued) == self._flights:
            self._run()
        return future

    def shutdown(self, wait: bool = True, *, cancel_futures: bool = False) -> None:
        self.shut_down.append(cancel_futures)

    def _run(self) -> None:
        for number, (sent, future) in reversed(list(enumerate(self._queued))):
            if self._breaks_at is not None and number >= self._breaks_at:
                future.end(error=BrokenExecutor("a node is gone"))
            elif number == self._cancels_at:
                future.end(cancelled=True)
            else:
                function, arguments = pickle.loads(sent)
                with ThreadPoolExecutor(1) as node:
                    ran = node.submit(function, *arguments)
                if (error := ran.exception()) is not None:
                    future.end(error=error)
                else:
                    future.end(pickle.loads(pickle.dumps(ran.result())))
