"""From the messages of a channel to a structured array.

Channels of this program's writer are decoded as one block. Messages of any other writer are
decoded one by one: protobuf by the schema in the file, or JSON objects; a field is numeric if it
is a number or a list of numbers, and others are left out.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Mapping, Sequence
from typing import Any

import numpy as np
from google.protobuf.descriptor import FieldDescriptor
from google.protobuf.message import DecodeError
from mcap.exceptions import McapError
from mcap.records import Channel, Schema
from mcap_protobuf.decoder import DecoderFactory

from inspect_cli.log.layout import (
    MESSAGE_HEAD,
    Bytes,
    FieldInfo,
    Nanoseconds,
    fields_from_metadata,
    record_layout,
    rows_dtype,
)
from inspect_cli.spatial.arrays import Structured

PAYLOAD = 9 + MESSAGE_HEAD
"""Bytes of a Message record in front of its data."""
LOG_TIME_AT = 15
NUMERIC = {
    FieldDescriptor.CPPTYPE_INT32,
    FieldDescriptor.CPPTYPE_INT64,
    FieldDescriptor.CPPTYPE_UINT32,
    FieldDescriptor.CPPTYPE_UINT64,
    FieldDescriptor.CPPTYPE_DOUBLE,
    FieldDescriptor.CPPTYPE_FLOAT,
    FieldDescriptor.CPPTYPE_BOOL,
    FieldDescriptor.CPPTYPE_ENUM,
}
Values = Mapping[str, float | Sequence[float]]


class UndecodableError(Exception):
    """A channel's messages contradict its schema or each other; the text says how."""


def decode_rows(
    channel: Channel, schema: Schema | None, runs: Sequence[Bytes], origin_ns: int
) -> Structured | None:
    """The numbers of a channel, (n,) in order of log time; None if it has none.

    A channel without a field ``t_s`` gets one from its log times, counted from ``origin_ns``.
    """
    fields = fields_from_metadata(channel.metadata)
    rows = _decode_block(channel, fields, runs) if fields else None
    if rows is None:
        rows = _decode_each(channel, schema, fields, runs)
    if rows is None:
        return None
    times = log_times(runs)
    if "t_s" not in (rows.dtype.names or ()):
        rows = _with_time(rows, times, origin_ns)
    if (times[1:] < times[:-1]).any():
        rows = rows[np.argsort(times, kind="stable")]
    return rows


def log_times(runs: Sequence[Bytes]) -> Nanoseconds:
    """The log times (n,) of message records, ns."""
    times = [run[:, LOG_TIME_AT : LOG_TIME_AT + 8].copy().view("<u8")[:, 0] for run in runs]
    joined: Nanoseconds = np.concatenate(times)
    return joined


def payloads(runs: Sequence[Bytes]) -> list[bytes]:
    """The data of each message."""
    return [row[PAYLOAD:].tobytes() for run in runs for row in run]


def _decode_block(
    channel: Channel, fields: Sequence[FieldInfo], runs: Sequence[Bytes]
) -> Structured | None:
    """All rows at once; None if the messages do not have the fixed layout of these fields."""
    layout = record_layout(channel.id, fields)
    if any(run.shape[1] != layout.dtype.itemsize for run in runs):
        return None
    raw = np.concatenate(runs)
    if not layout.matches(raw):
        return None
    messages = raw.view(layout.dtype)[:, 0]
    rows = np.empty(messages.size, rows_dtype(fields))
    for field in fields:
        rows[field.name] = messages[field.name]
    return rows


def _decode_each(
    channel: Channel,
    schema: Schema | None,
    fields: Sequence[FieldInfo] | None,
    runs: Sequence[Bytes],
) -> Structured | None:
    values_of = _decoder(channel, schema)
    if values_of is None:
        return None
    try:
        messages = [values_of(data) for data in payloads(runs)]
    except (DecodeError, ValueError, TypeError) as error:
        raise UndecodableError(f"a message on {channel.topic} cannot be decoded") from error
    names = list(dict.fromkeys(name for message in messages for name in message))
    shapes = {field.name: field.shape for field in fields or ()}
    columns = {name: _column(channel.topic, name, messages, shapes.get(name)) for name in names}
    if not columns:
        return None
    dtype = np.dtype([(name, "<f8", column.shape[1:]) for name, column in columns.items()])
    rows = np.empty(len(messages), dtype)
    for name, column in columns.items():
        rows[name] = column
    return rows


def _column(
    topic: str, name: str, messages: Sequence[Values], shape: tuple[int, ...] | None
) -> np.ndarray[Any, np.dtype[np.float64]]:
    """One field of all messages, (n, *shape)."""
    try:
        column = np.array([message[name] for message in messages], dtype=np.float64)
        return column if shape is None else column.reshape(len(messages), *shape)
    except (KeyError, ValueError, TypeError) as error:
        raise UndecodableError(
            f"{name} on {topic} does not have the same shape in all messages"
        ) from error


def _decoder(channel: Channel, schema: Schema | None) -> Callable[[bytes], Values] | None:
    """What turns one message into its numeric fields; None for other encodings."""
    if channel.message_encoding == "json":
        return _values_of_json
    try:
        decode = DecoderFactory().decoder_for(channel.message_encoding, schema)
    except (McapError, DecodeError, TypeError, KeyError, ValueError) as error:
        raise UndecodableError(f"the schema of {channel.topic} cannot be understood") from error
    if decode is None:
        return None

    def values(data: bytes) -> Values:
        message = decode(data)
        return {
            field.name: _plain(field, getattr(message, field.name))
            for field in message.DESCRIPTOR.fields
            if field.cpp_type in NUMERIC
        }

    return values


def _plain(field: FieldDescriptor, value: Any) -> float | list[float]:
    return list(value) if field.is_repeated else float(value)


def _values_of_json(data: bytes) -> Values:
    message = json.loads(data)
    if not isinstance(message, dict):
        return {}
    return {name: value for name, value in message.items() if _is_numeric(value)}


def _is_numeric(value: object) -> bool:
    if isinstance(value, list):
        return all(_is_numeric(entry) for entry in value)
    # JSON has no NaN; writers put null in its place, which becomes NaN again as a float64.
    return value is None or isinstance(value, (int, float))


def _with_time(rows: Structured, times: Nanoseconds, origin_ns: int) -> Structured:
    dtype = np.dtype([("t_s", "<f8"), *((n, rows.dtype[n]) for n in rows.dtype.names or ())])
    timed = np.empty(rows.size, dtype)
    timed["t_s"] = (times.astype(np.int64) - origin_ns) * 1e-9
    for name in rows.dtype.names or ():
        timed[name] = rows[name]
    return timed
