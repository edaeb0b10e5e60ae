"""The bytes of a numeric channel, from the declaration of its record.

A record's message is protobuf (https://protobuf.dev/programming-guides/encoding): a scalar field
is a ``double``, a vector a packed ``repeated double``, numbered from 1 in order of declaration.
Every number is written, zeros too, so all messages of a channel have the same length and the
same bytes but for the numbers. A block of rows is therefore encoded and decoded as one array.
An MCAP Message record (https://mcap.dev/spec) around it has a fixed length for the same reason.

The channel's metadata holds, under ``fields``, a JSON list with name, shape, unit, frame and
meaning of each field: a reader needs no copy of this program.
"""

from __future__ import annotations

import json
import math
import struct
from collections.abc import Mapping, Sequence
from typing import Any, NamedTuple

import numpy as np
from google.protobuf.descriptor_pb2 import FieldDescriptorProto, FileDescriptorProto
from google.protobuf.descriptor_pb2 import FileDescriptorSet as DescriptorSet
from mcap.opcode import Opcode
from numpy.typing import NDArray

from inspect_cli.records import Lengths, Record
from inspect_cli.spatial.arrays import Structured

Bytes = NDArray[np.uint8]
Nanoseconds = NDArray[np.uint64]

PACKAGE = "inspect"
"""Protobuf package of the record's messages."""
METADATA_KEY = "fields"
WIRE_DOUBLE = 1
WIRE_LENGTH_DELIMITED = 2
MESSAGE_HEAD = 22
"""Bytes of channel, sequence and the two times, which an MCAP Message's length includes."""
SEQUENCE, LOG_TIME, PUBLISH_TIME = "#sequence", "#log_time", "#publish_time"
"""Parts of a Message's head; a field of a record cannot have such a name."""


class FieldInfo(NamedTuple):
    """A record's field with its shape in numbers, as the file states it."""

    name: str
    shape: tuple[int, ...]
    unit: str
    frame: str
    meaning: str


class Numbers(NamedTuple):
    """A named part of a message whose bytes change from row to row."""

    name: str
    dtype: str
    shape: tuple[int, ...] = ()


def fields_of(record: type[Record], lengths: Lengths) -> tuple[FieldInfo, ...]:
    """The declared fields of a record for a vehicle with these lengths."""
    return tuple(
        FieldInfo(f.name, f.resolved_shape(lengths), f.unit, f.frame, f.meaning)
        for f in record.fields()
    )


def rows_dtype(fields: Sequence[FieldInfo]) -> np.dtype[Any]:
    """The layout of one row in memory; equals ``Record.dtype`` of the record written."""
    return np.dtype([(f.name, "<f8", f.shape) for f in fields])


def channel_metadata(fields: Sequence[FieldInfo]) -> dict[str, str]:
    """What the channel says of its fields."""
    return {METADATA_KEY: json.dumps([f._asdict() for f in fields], ensure_ascii=False)}


def fields_from_metadata(metadata: Mapping[str, str]) -> tuple[FieldInfo, ...] | None:
    """The reverse of ``channel_metadata``; None where a channel of other origin says nothing."""
    text = metadata.get(METADATA_KEY)
    if text is None:
        return None
    try:
        return tuple(
            FieldInfo(e["name"], tuple(map(int, e["shape"])), e["unit"], e["frame"], e["meaning"])
            for e in json.loads(text)
        )
    except (ValueError, KeyError, TypeError):
        return None


def message_name(record: type[Record]) -> str:
    """The full protobuf name of a record's message."""
    return f"{PACKAGE}.{record.__name__}"


def descriptor_set(name: str, fields: Sequence[FieldInfo]) -> bytes:
    """The serialised protobuf FileDescriptorSet that declares message ``name``."""
    package, _, short = name.rpartition(".")
    file = FileDescriptorProto(name=f"{package}/{short}.proto", package=package, syntax="proto3")
    message = file.message_type.add(name=short)
    for number, field in enumerate(fields, start=1):
        message.field.add(
            name=field.name,
            number=number,
            type=FieldDescriptorProto.TYPE_DOUBLE,
            label=(
                FieldDescriptorProto.LABEL_REPEATED
                if field.shape
                else FieldDescriptorProto.LABEL_OPTIONAL
            ),
        )
    serialised: bytes = DescriptorSet(file=[file]).SerializeToString(deterministic=True)
    return serialised


def varint(value: int) -> bytes:
    """A protobuf base-128 varint."""
    encoded = bytearray()
    while value >= 0x80:
        encoded.append(value & 0x7F | 0x80)
        value >>= 7
    encoded.append(value)
    return bytes(encoded)


def tag(number: int, wire_type: int) -> bytes:
    """The key in front of a protobuf field."""
    return varint(number << 3 | wire_type)


class MessageLayout:
    """MCAP Message records of one channel whose protobuf payloads have fixed positions.

    ``payload`` lists the parts in order: bytes that never change, and ``Numbers``.
    """

    def __init__(self, channel_id: int, payload: Sequence[bytes | Numbers]) -> None:
        size = sum(_size(part) for part in payload)
        head = struct.pack("<BQH", Opcode.MESSAGE, MESSAGE_HEAD + size, channel_id)
        times = [Numbers(LOG_TIME, "<u8"), Numbers(PUBLISH_TIME, "<u8")]
        parts = [head, Numbers(SEQUENCE, "<u4"), *times, *payload]
        self.dtype = np.dtype([_dtype_entry(k, part) for k, part in enumerate(parts)])
        self._blank = b"".join(p if isinstance(p, bytes) else bytes(_size(p)) for p in parts)
        fixed = [np.full(_size(part), isinstance(part, bytes)) for part in parts]
        self._fixed = np.flatnonzero(np.concatenate(fixed))

    def blank(self, n: int) -> Structured:
        """Messages (n,) whose numbers, and those of their heads, are zero."""
        return np.frombuffer(bytearray(self._blank * n), self.dtype)

    def matches(self, raw: Bytes) -> bool:
        """Whether message records (n, length) have this layout, byte for byte."""
        if raw.shape[1] != self.dtype.itemsize:
            return False
        blank = np.frombuffer(self._blank, np.uint8)
        return bool((raw[:, self._fixed] == blank[self._fixed]).all())


def record_layout(channel_id: int, fields: Sequence[FieldInfo]) -> MessageLayout:
    """The layout of a record's messages; its ``Numbers`` have the fields' names."""
    payload: list[bytes | Numbers] = []
    for number, field in enumerate(fields, start=1):
        if field.shape:
            key = tag(number, WIRE_LENGTH_DELIMITED) + varint(8 * math.prod(field.shape))
        else:
            key = tag(number, WIRE_DOUBLE)
        payload += [key, Numbers(field.name, "<f8", field.shape)]
    return MessageLayout(channel_id, payload)


def nanoseconds(t_s: NDArray[np.float64]) -> Nanoseconds:
    """MCAP times: round(t_s · 10⁹), with t_s the time since the start of the run."""
    return np.rint(t_s * 1e9).astype(np.uint64)


def _size(part: bytes | Numbers) -> int:
    if isinstance(part, bytes):
        return len(part)
    return np.dtype(part.dtype).itemsize * math.prod(part.shape)


def _dtype_entry(k: int, part: bytes | Numbers) -> tuple[str, str, tuple[int, ...]]:
    # No field of a record can be called by a number, so the constant parts never clash.
    if isinstance(part, bytes):
        return str(k), "u1", (len(part),)
    return part.name, part.dtype, part.shape
