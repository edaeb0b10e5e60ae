"""What waits for the next chunk, one queue per topic, and becomes MCAP Message records."""

from __future__ import annotations

import struct
from typing import Any, Final, NamedTuple

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from inspect_cli.compiled import Bound, bound, kernel
from inspect_cli.log.layout import (
    LOG_TIME,
    MESSAGE_HEAD,
    PUBLISH_TIME,
    SEQUENCE,
    Bytes,
    MessageLayout,
    Nanoseconds,
)
from inspect_cli.log.mcap_file import Block
from inspect_cli.spatial.arrays import Structured, Vector

CAPACITY: Final = 1024
"""Rows of one channel that can wait."""


class Waiting(NamedTuple):
    """Messages of a fixed layout that wait, as kernels fill them.

    ``messages`` (CAPACITY, length) are their bytes, the others parts of the same memory; ``counts``
    (2,) is how many wait and how many were written before them.
    """

    messages: Bytes
    sequence: NDArray[np.uint32]
    log_time: Nanoseconds
    publish_time: Nanoseconds
    counts: NDArray[np.int64]


@kernel
def append_row(row: Bytes, t_s: Vector, spans: NDArray[np.int64], waiting: Waiting) -> None:
    """Encode a row of bytes (n,) as the next message.

    Each of ``spans`` is (from, to, length), in bytes; ``t_s`` (1,) is a view of the row's time.
    """
    k = waiting.counts[0]
    message = waiting.messages[k]
    for span in range(spans.shape[0]):
        start, end = spans[span, 0], spans[span, 1]
        for j in range(spans[span, 2]):
            message[end + j] = row[start + j]
    time = np.uint64(np.rint(t_s[0] * 1e9))
    waiting.log_time[k] = time
    waiting.publish_time[k] = time
    waiting.sequence[k] = waiting.counts[1] + k
    waiting.counts[0] = k + 1


class RowQueue:
    """Rows whose messages have a fixed layout; a row is encoded as it comes.

    ``rows`` is the dtype of a row: a field ``t_s``, and one for each part of the message.
    """

    def __init__(self, channel_id: int, layout: MessageLayout, rows: np.dtype[Any]) -> None:
        self._channel_id = channel_id
        size = layout.dtype.itemsize
        self._offsets = np.arange(CAPACITY, dtype=np.uint64) * size
        self._spans = np.array(
            [
                (_offset(rows, name), _offset(layout.dtype, name), rows[name].itemsize)
                for name in rows.names or ()
                if name in (layout.dtype.names or ())
            ]
        )
        messages = layout.blank(CAPACITY)
        self._waiting = Waiting(
            messages.view(np.uint8).reshape(CAPACITY, size),
            messages[SEQUENCE],
            messages[LOG_TIME],
            messages[PUBLISH_TIME],
            np.zeros(2, np.int64),
        )
        self._row: Structured | None = None

    @property
    def waiting(self) -> int:
        """How many messages wait."""
        return int(self._waiting.counts[0])

    def bind(self, row: Structured) -> Bound:
        """The call that copies a row (1,) and encodes it; there has to be room for it."""
        data = row.view(np.uint8)
        return bound(append_row, data, row["t_s"], self._spans, self._waiting)

    def append(self, row: Structured) -> None:
        """Copy a row (1,) and encode it; there has to be room for it."""
        if row is not self._row:
            self._row, self._append = row, self.bind(row)
        self._append()

    def drain(self) -> Block:
        """Everything that waits, in memory that the next rows overwrite."""
        waiting, n = self._waiting, self.waiting
        waiting.counts[0] = 0
        waiting.counts[1] += n
        data = waiting.messages[:n].reshape(-1).data
        return Block(self._channel_id, data, waiting.log_time[:n], self._offsets[:n])


class MessageQueue:
    """Messages of any length: (time in ns, encoded protobuf)."""

    def __init__(self, channel_id: int) -> None:
        self.pending: list[tuple[int, bytes]] = []
        self._channel_id = channel_id
        self._count = 0

    @property
    def waiting(self) -> int:
        """How many messages wait."""
        return len(self.pending)

    def drain(self) -> Block:
        """Everything that waits, as records; nothing waits afterwards."""
        records = []
        for sequence, (time, payload) in enumerate(self.pending, start=self._count):
            length = MESSAGE_HEAD + len(payload)
            head = struct.pack(
                "<BQHIQQ", Opcode.MESSAGE, length, self._channel_id, sequence, time, time
            )
            records.append(head + payload)
        times = np.array([time for time, _ in self.pending], np.uint64)
        ends = np.cumsum([len(record) for record in records], dtype=np.uint64)
        offset = np.concatenate([np.zeros(1, np.uint64), ends[:-1]])
        self._count += len(records)
        self.pending.clear()
        return Block(self._channel_id, b"".join(records), times, offset)


def _offset(dtype: np.dtype[Any], name: str) -> int:
    assert dtype.fields is not None  # a structured dtype
    return dtype.fields[name][1]
