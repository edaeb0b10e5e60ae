"""Messages in the schemas that Foxglove and Rerun draw: poses, clouds, events.

Schemas: https://docs.foxglove.dev/docs/sdk/schemas. Poses are many, so they are laid out like
records, in blocks; the others are few and built one by one.
"""

from __future__ import annotations

import struct
from collections.abc import Sequence
from typing import Any, Literal, NamedTuple

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PackedElementField_pb2 import PackedElementField
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from google.protobuf.timestamp_pb2 import Timestamp

from inspect_cli.log.layout import (
    WIRE_DOUBLE,
    WIRE_LENGTH_DELIMITED,
    MessageLayout,
    Numbers,
    tag,
    varint,
)
from inspect_cli.spatial.arrays import Points, Vector

WORLD_FRAME = "W"
Level = Literal["debug", "info", "warning", "error", "fatal"]

VARINT_BYTES = 5
"""Times are written as varints of this length, whatever their value, to keep the layout fixed:
protobuf allows leading zero groups. Seconds up to 2³⁵."""
TIMES = ("seconds", "nanos")
POSITION, ORIENTATION = ("px", "py", "pz"), ("qx", "qy", "qz", "qw")
POSE_ROWS: np.dtype[Any] = np.dtype(
    [
        ("t_s", "<f8"),
        *((name, "u1", (VARINT_BYTES,)) for name in TIMES),
        *((name, "<f8") for name in (*POSITION, *ORIENTATION)),
    ]
)
"""The parts of a pose's message, and its time."""
_POSE = struct.Struct(f"<d{VARINT_BYTES}s{VARINT_BYTES}s7d")
NUMERIC_TYPES: dict[int, str] = {
    PackedElementField.UINT8: "u1",
    PackedElementField.INT8: "i1",
    PackedElementField.UINT16: "<u2",
    PackedElementField.INT16: "<i2",
    PackedElementField.UINT32: "<u4",
    PackedElementField.INT32: "<i4",
    PackedElementField.FLOAT32: "<f4",
    PackedElementField.FLOAT64: "<f8",
}


class Event(NamedTuple):
    """Something that happened, in words."""

    t_s: float
    level: Level
    text: str


class Cloud(NamedTuple):
    """Points (n, 3) in W, m, kept in single precision."""

    t_s: float
    points_W: Points


def pose_layout(channel_id: int) -> MessageLayout:
    """foxglove.PoseInFrame in the world: timestamp 1, frame_id 2, pose 3."""
    timestamp: list[bytes | Numbers] = [
        tag(1, 0),
        Numbers(TIMES[0], "u1", (VARINT_BYTES,)),
        tag(2, 0),
        Numbers(TIMES[1], "u1", (VARINT_BYTES,)),
    ]
    position, orientation = _doubles(*POSITION), _doubles(*ORIENTATION)
    pose = [*_nested(1, position), *_nested(2, orientation)]
    frame = WORLD_FRAME.encode()
    frame_id = tag(2, WIRE_LENGTH_DELIMITED) + varint(len(frame)) + frame
    return MessageLayout(channel_id, [*_nested(1, timestamp), frame_id, *_nested(3, pose)])


def pose_row(t_s: float, p: Sequence[float] | Vector, q: Sequence[float] | Vector) -> bytes:
    """A pose as a row of POSE_ROWS; p (3,) m, unit quaternion q (4,) wxyz."""
    seconds, nanos = divmod(round(t_s * 1e9), 10**9)
    w, x, y, z = q
    times = _fixed_varint(seconds), _fixed_varint(nanos)
    return _POSE.pack(t_s, *times, *p, x, y, z, w)


def point_cloud(time_ns: int, points_W: Points) -> PointCloud:
    """Points (n, 3) m in the world; those that are not finite are left out."""
    finite = points_W[np.isfinite(points_W).all(axis=1)]
    cloud = PointCloud(
        timestamp=timestamp_of(time_ns),
        frame_id=WORLD_FRAME,
        point_stride=12,
        data=finite.astype("<f4").tobytes(),
    )
    cloud.pose.orientation.w = 1.0
    for k, axis in enumerate("xyz"):
        cloud.fields.add(name=axis, offset=4 * k, type=PackedElementField.FLOAT32)
    return cloud


def points_of(cloud: PointCloud) -> Points | None:
    """The reverse of ``point_cloud``; None for a cloud that is not given in the world's axes.

    Raises ValueError where the cloud's data do not have the length that it states.
    """
    pose = cloud.pose
    moved = [pose.position.x, pose.position.y, pose.position.z]
    moved += [pose.orientation.x, pose.orientation.y, pose.orientation.z]
    if cloud.frame_id != WORLD_FRAME or any(moved):
        return None
    fields = {f.name: f for f in cloud.fields}
    if not {"x", "y", "z"} <= fields.keys():
        return None
    dtype = np.dtype(
        {
            "names": ["x", "y", "z"],
            "formats": [NUMERIC_TYPES[fields[axis].type] for axis in "xyz"],
            "offsets": [fields[axis].offset for axis in "xyz"],
            "itemsize": cloud.point_stride,
        }
    )
    rows = np.frombuffer(cloud.data, dtype)
    return np.column_stack([rows[axis].astype(np.float64) for axis in "xyz"])


def event(time_ns: int, level: Level, text: str) -> Log:
    """An event as foxglove.Log."""
    return Log(timestamp=timestamp_of(time_ns), level=Log.Level.Value(level.upper()), message=text)


def level_of(log: Log) -> Level:
    """The level of a foxglove.Log; one without a level informs."""
    levels: dict[int, Level] = {
        Log.DEBUG: "debug",
        Log.WARNING: "warning",
        Log.ERROR: "error",
        Log.FATAL: "fatal",
    }
    return levels.get(log.level, "info")


def timestamp_of(time_ns: int) -> Timestamp:
    """A protobuf Timestamp."""
    return Timestamp(seconds=time_ns // 10**9, nanos=time_ns % 10**9)


def _doubles(*names: str) -> list[bytes | Numbers]:
    parts: list[bytes | Numbers] = []
    for number, name in enumerate(names, start=1):
        parts += [tag(number, WIRE_DOUBLE), Numbers(name, "<f8")]
    return parts


def _nested(number: int, parts: list[bytes | Numbers]) -> list[bytes | Numbers]:
    """A message inside a message: its key, its length and its parts."""
    size = sum(
        len(p) if isinstance(p, bytes) else np.dtype((p.dtype, p.shape)).itemsize for p in parts
    )
    return [tag(number, WIRE_LENGTH_DELIMITED) + varint(size), *parts]


def _fixed_varint(value: int) -> bytes:
    """A varint of VARINT_BYTES: all bytes but the last say "more follows"."""
    more = [value >> shift & 0x7F | 0x80 for shift in range(0, 7 * VARINT_BYTES - 7, 7)]
    return bytes([*more, value >> 7 * VARINT_BYTES - 7])
