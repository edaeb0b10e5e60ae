"""Reads the log of a flight: its channels, its attachments and how it ended."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path
from typing import TypeVar, get_args

import numpy as np
from foxglove_schemas_protobuf.Log_pb2 import Log
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from google.protobuf.message import DecodeError
from mcap.records import Channel, Schema
from pydantic import BaseModel, ValidationError

from inspect_cli.errors import Location, LogError, Problem
from inspect_cli.log import names
from inspect_cli.log.decode import UndecodableError, decode_rows, log_times, payloads
from inspect_cli.log.foxglove import Cloud, Event, level_of, points_of
from inspect_cli.log.layout import Bytes
from inspect_cli.log.mcap_reader import RawLog, raw_log
from inspect_cli.log.rasters import TrueRaster, decoded
from inspect_cli.records import CORE_RECORDS, Record
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.modes import ModeTable
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Status
from inspect_cli.schema.truth import TruthModel
from inspect_cli.schema.vehicle import PLATFORM_KINDS, PlatformBase
from inspect_cli.spatial.arrays import Structured

Model = TypeVar("Model", bound=BaseModel)

FOXGLOVE = "foxglove."


@dataclass(frozen=True, eq=False)
class RunLog:
    """Everything that a flight left behind."""

    path: Path
    status: Status
    """``interrupted`` for a log that was cut or that does not say how the flight ended."""
    status_reason: str
    channels: dict[str, Structured]
    """By topic: one row (n,) per message in order of time, with the fields that the file has."""
    attachments: dict[str, bytes]
    events: tuple[Event, ...]
    points: tuple[Cloud, ...]

    def rows(self, record: type[Record]) -> Structured | None:
        """A record's rows (n,) with all its fields, NaN where the file lacks one.

        None without such a channel. A missing field whose length the vehicle decides has length
        0. Raises LogError where a field has another shape than the record declares.
        """
        rows = self.channels.get(record.topic)
        if rows is None:
            return None
        shapes = {name: rows.dtype[name].shape for name in rows.dtype.names or ()}
        missing = False
        for field in record.fields():
            declared = tuple(0 if isinstance(n, str) else n for n in field.shape)
            if field.name not in shapes:
                missing = True
                shapes[field.name] = declared
            elif not _fits(shapes[field.name], field.shape):
                found, topic = shapes[field.name], record.topic
                raise self._error(
                    f"{field.name} on {topic} has the shape {found}, not {field.shape}"
                )
        if not missing:
            return rows
        filled = np.full(rows.size, np.nan, [(name, "<f8", shapes[name]) for name in shapes])
        for name in rows.dtype.names or ():
            filled[name] = rows[name]
        return filled

    def mission(self) -> Mission:
        """The mission that was flown, with defaults written out."""
        return self._model(names.MISSION, Mission)

    def plan(self) -> Plan:
        """The plan that was flown."""
        return self._model(names.PLAN, Plan)

    def platform(self) -> PlatformBase:
        """The vehicle that flew, as the model of its kind."""
        kind = self._object(names.PLATFORM).get("kind")
        model = PLATFORM_KINDS.get(str(kind))
        if model is None:
            known = ", ".join(sorted(PLATFORM_KINDS))
            raise self._error(f"the platform is of kind '{kind}'; known kinds are: {known}")
        return self._model(names.PLATFORM, model)

    def modes(self) -> ModeTable:
        """What the numbers of modes in ``/reference`` stand for."""
        return self._model(names.MODE_TABLE, ModeTable)

    def truth(self) -> TruthModel | None:
        """What was so in a simulated flight; None for a real one."""
        if names.TRUTH not in self.attachments:
            return None
        return self._model(names.TRUTH, TruthModel)

    def true_rasters(self) -> tuple[TrueRaster, ...]:
        """What was so beneath the surfaces of a simulated flight; nothing for a real one."""
        data = self.attachments.get(names.SPECIMEN)
        if data is None:
            return ()
        try:
            return decoded(data)
        except ValueError as error:
            what = f"the attachment '{names.SPECIMEN}' cannot be read: {error}"
            raise self._error(what, "fly again, or leave it out: then nothing is scored") from error

    @property
    def seed(self) -> int | None:
        """The seed of a simulated flight."""
        seed = self._run().get("seed")
        return seed if isinstance(seed, int) else None

    @property
    def versions(self) -> dict[str, str]:
        """What computed the flight, by name."""
        versions = self._run().get("versions")
        return {str(k): str(v) for k, v in versions.items()} if isinstance(versions, dict) else {}

    def _run(self) -> dict[str, object]:
        return self._object(names.RUN) if names.RUN in self.attachments else {}

    def _attachment(self, name: str) -> bytes:
        if name not in self.attachments:
            raise self._error(
                f"the log has no attachment '{name}'",
                "attach mission.json, platform.json, plan.json and modes.json to what is recorded",
            )
        return self.attachments[name]

    def _object(self, name: str) -> dict[str, object]:
        try:
            value = json.loads(self._attachment(name))
        except ValueError as error:
            raise self._error(f"the attachment '{name}' is not JSON") from error
        if not isinstance(value, dict):
            raise self._error(f"the attachment '{name}' is not a JSON object")
        return value

    def _model(self, name: str, model: type[Model]) -> Model:
        try:
            return model.model_validate_json(self._attachment(name))
        except ValidationError as error:
            first = error.errors()[0]
            where = ".".join(map(str, first["loc"]))
            raise self._error(
                f"the attachment '{name}' breaks the schema at '{where}': {first['msg']}",
                "it was written by another version of this program; fly again",
            ) from error

    def _error(self, what: str, hint: str = "") -> LogError:
        return LogError(Problem(what, Location(str(self.path)), hint))


def read_log(path: Path) -> RunLog:
    """Read a flight's log, finished or cut (then also under its name ``….mcap.part``).

    A cut log is read up to its last whole chunk and has the status ``interrupted``. Logs of other
    writers are read too, see ``decode``. Raises LogError where the file cannot be read, is no
    MCAP log, is damaged, or was cut before its mission, platform, plan and modes were written.
    """
    raw = raw_log(path)
    if not raw.finished:
        _require_attachments(raw)
    status, reason = _outcome(raw)
    try:
        channels, events, points = _contents(raw)
    except (UndecodableError, DecodeError, ValueError, KeyError) as error:
        what = str(error) if isinstance(error, UndecodableError) else "a message is malformed"
        hint = "see the channel table in CONTRIBUTING for what a log holds"
        raise LogError(Problem(what, Location(str(path)), hint)) from error
    return RunLog(path, status, reason, channels, raw.attachments, events, points)


def _require_attachments(raw: RawLog) -> None:
    needed = (names.MISSION, names.PLATFORM, names.PLAN, names.MODE_TABLE)
    missing = [name for name in needed if name not in raw.attachments]
    if missing:
        what = f"the log was cut before its {missing[0]} was written: there is nothing to evaluate"
        raise LogError(Problem(what, Location(str(raw.path)), "fly the mission again"))


def _outcome(raw: RawLog) -> tuple[Status, str]:
    if not raw.finished:
        times = [log_times(runs).max() for runs in raw.messages.values()]
        until = f"up to t = {max(times) * 1e-9:.2f} s" if times else "but holds no flight"
        return "interrupted", f"the log was cut; it was read {until}"
    outcome = raw.metadata.get(names.OUTCOME)
    if outcome is None:
        return "interrupted", "the log does not say how the flight ended"
    for status in get_args(Status):
        if outcome.get("status") == status:
            return status, outcome.get("reason", "")
    known = ", ".join(get_args(Status))
    what = f"the outcome's status is '{outcome.get('status')}'; it must be one of: {known}"
    raise LogError(Problem(what, Location(str(raw.path))))


def _contents(
    raw: RawLog,
) -> tuple[dict[str, Structured], tuple[Event, ...], tuple[Cloud, ...]]:
    origin_ns = _origin_ns(raw)
    channels: dict[str, Structured] = {}
    events: list[Event] = []
    points: list[Cloud] = []
    for channel_id, runs in raw.messages.items():
        channel = raw.channels[channel_id]
        schema = raw.schemas.get(channel.schema_id)
        name = schema.name if schema else ""
        if name == Log.DESCRIPTOR.full_name:
            events += _events(runs, origin_ns)
        elif name == PointCloud.DESCRIPTOR.full_name:
            points += _clouds(runs, origin_ns)
        elif not name.startswith(FOXGLOVE):
            rows = _rows(raw, channel, schema, runs, origin_ns)
            if rows is not None:
                _add(channels, channel, rows)
    events.sort(key=lambda event: event.t_s)
    points.sort(key=lambda cloud: cloud.t_s)
    return channels, tuple(events), tuple(points)


def _rows(
    raw: RawLog, channel: Channel, schema: Schema | None, runs: list[Bytes], origin_ns: int
) -> Structured | None:
    """A channel's numbers; what we do not know may be as it likes in logs of other writers."""
    try:
        return decode_rows(channel, schema, runs, origin_ns)
    except UndecodableError:
        if raw.ours or channel.topic in {record.topic for record in CORE_RECORDS}:
            raise
        return None


def _add(channels: dict[str, Structured], channel: Channel, rows: Structured) -> None:
    if channel.topic in channels:
        raise UndecodableError(f"two channels have the topic {channel.topic}")
    channels[channel.topic] = rows


def _origin_ns(raw: RawLog) -> int:
    """The log time of t = 0: zero in our own logs, else the first message's."""
    if raw.ours or not raw.messages:
        return 0
    return min(int(log_times(runs).min()) for runs in raw.messages.values())


def _events(runs: list[Bytes], origin_ns: int) -> list[Event]:
    logs = map(Log.FromString, payloads(runs))
    times = (log_times(runs).astype(np.int64) - origin_ns) / 1e9
    return [
        Event(t_s, level_of(log), log.message)
        for t_s, log in zip(times.tolist(), logs, strict=True)
    ]


def _clouds(runs: list[Bytes], origin_ns: int) -> list[Cloud]:
    times = (log_times(runs).astype(np.int64) - origin_ns) / 1e9
    points = [points_of(PointCloud.FromString(data)) for data in payloads(runs)]
    return [Cloud(t_s, p) for t_s, p in zip(times.tolist(), points, strict=True) if p is not None]


def _fits(found: tuple[int, ...], declared: tuple[int | str, ...]) -> bool:
    return len(found) == len(declared) and all(
        isinstance(want, str) or have == want for have, want in zip(found, declared, strict=True)
    )
