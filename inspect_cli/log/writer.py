"""Writes the log of a flight while it flies."""

from __future__ import annotations

import os
from collections.abc import Callable, Sequence
from pathlib import Path
from types import TracebackType
from typing import Self, get_args

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from foxglove_schemas_protobuf.PoseInFrame_pb2 import PoseInFrame
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from google.protobuf.message import Message
from mcap_protobuf.schema import build_file_descriptor_set

from inspect_cli.compiled.joined import joined
from inspect_cli.errors import EnvironmentFault
from inspect_cli.log import foxglove, layout
from inspect_cli.log.mcap_file import McapFile
from inspect_cli.log.names import EVENTS, OUTCOME, SCENE
from inspect_cli.log.queues import CAPACITY, MessageQueue, RowQueue
from inspect_cli.log.scene import plan_scene
from inspect_cli.records import Lengths, Record
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Status
from inspect_cli.spatial.arrays import Points, Vector


class LogWriter:
    """Streams a flight to ``path + ".part"``; ``close`` makes it ``path``.

    ``records`` are the record types that will be logged, each to its topic; ``lengths`` are
    those of the vehicle. Attach first, then log. Rows wait in memory until ``flush_due`` writes
    them as a chunk, so a killed process loses at most ``chunk_s`` of flight and what passes
    between two calls. The bytes depend on nothing but what is logged. In a ``with`` block an
    exception leaves what was logged so far in the ``.part`` file.

    Raises EnvironmentFault where the disk refuses.
    """

    def __init__(
        self,
        path: Path,
        records: Sequence[type[Record]],
        lengths: Lengths,
        chunk_s: float = 0.48,
    ) -> None:
        self._path = path
        self._part = path.with_name(path.name + ".part")
        self._file = McapFile(self._part)
        self._chunk_s = chunk_s
        self._due_s = chunk_s
        self._closed = False
        self._lengths = lengths
        self._rows = {record: self._row_queue(record, lengths) for record in records}
        self._room = CAPACITY
        """How many rows still fit into every queue, at the least."""
        self._poses: dict[str, RowQueue] = {}
        self._pose = np.zeros(1, foxglove.POSE_ROWS)
        self._messages: dict[str, MessageQueue] = {}

    def attach(self, name: str, media_type: str, data: bytes) -> None:
        """Store a file in the log."""
        self._file.attach(name, media_type, data)

    def declare(self, record: type[Record]) -> None:
        """Make a channel for a record type that ``records`` did not name."""
        if record not in self._rows:
            self._rows[record] = self._row_queue(record, self._lengths)

    def log(self, record: Record) -> None:
        """Copy one row."""
        self._make_room()
        self._rows[type(record)].append(record.array)

    def tap(self, records: Sequence[Record]) -> Callable[[], None]:
        """What ``log`` does with records of different types, as one call."""
        copy = joined(*(self._rows[type(record)].bind(record.array) for record in records))

        def copy_rows() -> None:
            self._make_room()
            copy()

        return copy_rows

    def pose(
        self, topic: str, t_s: float, p: Sequence[float] | Vector, q: Sequence[float] | Vector
    ) -> None:
        """Log a pose in W for viewers: p (3,) m and unit quaternion q (4,) wxyz."""
        queue = self._poses.get(topic)
        if queue is None:
            queue = self._poses[topic] = self._pose_queue(topic)
        self._pose[:] = np.frombuffer(foxglove.pose_row(t_s, p, q), foxglove.POSE_ROWS)
        self._make_room()
        queue.append(self._pose)

    def point_cloud(self, topic: str, t_s: float, points_W: Points) -> None:
        """Log points (n, 3) m in W, in single precision, without those that are not finite."""
        time = round(t_s * 1e9)
        self._log_message(topic, time, foxglove.point_cloud(time, points_W), PointCloud)

    def event(self, t_s: float, level: foxglove.Level, text: str) -> None:
        """Log something that happened."""
        time = round(t_s * 1e9)
        self._log_message(EVENTS, time, foxglove.event(time, level, text), Log)

    def scene(self, t_s: float, plan: Plan) -> None:
        """Log the plan's surfaces, path and targets for viewers."""
        time = round(t_s * 1e9)
        self._log_message(SCENE, time, plan_scene(time, plan), SceneUpdate)

    def flush_due(self, t_s: float) -> None:
        """Write a chunk and hand it to the operating system if ``chunk_s`` have passed."""
        if t_s >= self._due_s:
            self._due_s = t_s + self._chunk_s
            self._write_chunk()

    def close(self, status: Status, reason: str) -> None:
        """Write the rest, the outcome and the summary, and give the file its name."""
        if status not in get_args(Status):
            raise ValueError(f"'{status}' is not a status")
        self._write_chunk()
        self._file.finish(OUTCOME, {"status": status, "reason": reason})
        self._closed = True
        try:
            os.replace(self._part, self._path)
        except OSError as error:
            raise EnvironmentFault(
                f"{self._part} cannot be renamed to {self._path.name}: {error.strerror}",
                hint="the log is whole: rename it by hand",
            ) from error

    def __enter__(self) -> Self:
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        traceback: TracebackType | None,
    ) -> None:
        if self._closed:
            return
        try:
            self._write_chunk()
        finally:
            self._file.close()

    def _make_room(self) -> None:
        """Room for one row in every queue."""
        if self._room == 0:
            self._write_chunk()
        self._room -= 1

    def _write_chunk(self) -> None:
        queues: list[RowQueue | MessageQueue] = [
            *self._rows.values(),
            *self._poses.values(),
            *self._messages.values(),
        ]
        self._file.write_chunk([queue.drain() for queue in queues if queue.waiting])
        self._room = CAPACITY

    def _row_queue(self, record: type[Record], lengths: Lengths) -> RowQueue:
        fields = layout.fields_of(record, lengths)
        name = layout.message_name(record)
        schema_id = self._file.add_schema(name, layout.descriptor_set(name, fields))
        metadata = layout.channel_metadata(fields)
        channel_id = self._file.add_channel(record.topic, schema_id, metadata)
        messages = layout.record_layout(channel_id, fields)
        return RowQueue(channel_id, messages, layout.rows_dtype(fields))

    def _pose_queue(self, topic: str) -> RowQueue:
        channel_id = self._foxglove_channel(topic, PoseInFrame)
        return RowQueue(channel_id, foxglove.pose_layout(channel_id), foxglove.POSE_ROWS)

    def _foxglove_channel(self, topic: str, kind: type[Message]) -> int:
        descriptors = build_file_descriptor_set(kind).SerializeToString(deterministic=True)
        schema_id = self._file.add_schema(kind.DESCRIPTOR.full_name, descriptors)
        return self._file.add_channel(topic, schema_id, {})

    def _log_message(self, topic: str, time: int, message: Message, kind: type[Message]) -> None:
        queue = self._messages.get(topic)
        if queue is None:
            queue = MessageQueue(self._foxglove_channel(topic, kind))
            self._messages[topic] = queue
        queue.pending.append((time, message.SerializeToString(deterministic=True)))
