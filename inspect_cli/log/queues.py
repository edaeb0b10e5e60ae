"""What waits for the next chunk, one queue per topic, and becomes MCAP Message records."""

from __future__ import annotations

import struct
from collections.abc import Callable
from typing import Any, TypeAlias

import numpy as np
from mcap.opcode import Opcode
from numpy.typing import NDArray

from inspect_cli.compiled import kernel
from inspect_cli.log.layout import MESSAGE_HEAD, Bytes, MessageLayout, Nanoseconds, nanoseconds
from inspect_cli.log.mcap_file import Block
from inspect_cli.spatial.arrays import Structured

Fill: TypeAlias = Callable[[Structured, Structured, Nanoseconds], None]
"""Writes rows (n,) with their times into messages (n,) of a layout."""


class RowQueue:
    """Rows whose messages have a fixed layout, encoded all at once.

    ``pending`` holds the bytes of each row; ``rows`` is their dtype, with a field ``t_s``.
    """

    def __init__(
        self, channel_id: int, layout: MessageLayout, rows: np.dtype[Any], fill: Fill
    ) -> None:
        self.pending: list[bytes] = []
        self._channel_id = channel_id
        self._layout = layout
        self._rows = rows
        self._fill = fill
        self._count = 0

    def drain(self) -> Block:
        """Everything that waits, encoded; nothing waits afterwards."""
        rows = np.frombuffer(b"".join(self.pending), self._rows)
        self.pending.clear()
        time = nanoseconds(rows["t_s"])
        messages = self._layout.messages(time, self._count)
        self._fill(messages, rows, time)
        self._count += rows.size
        offset = np.arange(0, messages.nbytes, messages.itemsize, dtype=np.uint64)
        return Block(self._channel_id, messages.tobytes(), time, offset)


class MessageQueue:
    """Messages of any length: (time in ns, encoded protobuf)."""

    def __init__(self, channel_id: int) -> None:
        self.pending: list[tuple[int, bytes]] = []
        self._channel_id = channel_id
        self._count = 0

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


class FieldCopy:
    """Copies every field of rows into the part of the messages that has its name."""

    def __init__(self, rows: np.dtype[Any], messages: np.dtype[Any]) -> None:
        self._spans = np.array(
            [
                (_offset(rows, name), _offset(messages, name), rows[name].itemsize)
                for name in rows.names or ()
            ]
        )

    def __call__(self, messages: Structured, rows: Structured, time: Nanoseconds) -> None:
        """Rows (n,) into messages (n,); a row carries its own time, exactly."""
        source = rows.view(np.uint8).reshape(rows.size, rows.itemsize)
        target = messages.view(np.uint8).reshape(messages.size, messages.itemsize)
        copy_spans(source, target, self._spans)


@kernel
def copy_spans(source: Bytes, target: Bytes, spans: NDArray[np.int64]) -> None:
    """Copy bytes (from, to, length) of each row of ``source`` (n, ·) into ``target`` (n, ·)."""
    for row in range(source.shape[0]):
        for k in range(spans.shape[0]):
            start, end = spans[k, 0], spans[k, 1]
            for j in range(spans[k, 2]):
                target[row, end + j] = source[row, start + j]


def _offset(dtype: np.dtype[Any], name: str) -> int:
    assert dtype.fields is not None  # a structured dtype
    return dtype.fields[name][1]
