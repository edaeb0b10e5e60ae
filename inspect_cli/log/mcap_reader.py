"""Walks through the records of an MCAP file and believes nothing that no checksum vouches for.

A file that ends in its footer is finished: every checksum must hold. One that ends anywhere else
was cut: what stands before the cut is read, chunk by chunk. In a file of this program's
``LogWriter`` all that matters lies in chunks and attachments, each with its own checksum, so the
same certainty holds there; the message sequence numbers show that no chunk is missing.
Format: https://mcap.dev/spec.
"""

from __future__ import annotations

import struct
import zlib
from collections.abc import Callable
from dataclasses import dataclass, field
from io import BytesIO
from pathlib import Path
from typing import TypeVar

import numpy as np
import zstandard
from mcap.data_stream import ReadDataStream
from mcap.exceptions import McapError
from mcap.opcode import Opcode
from mcap.records import Attachment, Channel, Chunk, DataEnd, Footer, Header, Metadata, Schema
from mcap.writer import MCAP0_MAGIC

from inspect_cli.errors import Location, LogError, Problem
from inspect_cli.log.layout import MESSAGE_HEAD, Bytes
from inspect_cli.log.mcap_file import LIBRARY

T = TypeVar("T")

HEAD = struct.Struct("<BQ")
"""Opcode and length in front of every record."""
SAME_KIND = HEAD.size + 2
"""Messages of one channel and length agree in this many bytes."""
LARGEST_CHUNK = 1 << 30
OURS_OUTSIDE_CHUNKS = {
    Opcode.ATTACHMENT,
    Opcode.CHUNK,
    Opcode.MESSAGE_INDEX,
    Opcode.METADATA,
    Opcode.DATA_END,
}


@dataclass
class RawLog:
    """A file taken apart, nothing decoded."""

    path: Path
    ours: bool = False
    """Written by ``LogWriter``, so its stricter rules hold."""
    finished: bool = False
    attachments: dict[str, bytes] = field(default_factory=dict)
    metadata: dict[str, dict[str, str]] = field(default_factory=dict)
    schemas: dict[int, Schema] = field(default_factory=dict)
    channels: dict[int, Channel] = field(default_factory=dict)
    messages: dict[int, list[Bytes]] = field(default_factory=dict)
    """By channel: Message records (n, length), each array of records of equal length."""


def raw_log(path: Path) -> RawLog:
    """Take a file apart.

    Raises LogError where it cannot be read, is no MCAP file, or its bytes are damaged.
    """
    return _Walk(path, _bytes_of(path)).run()


def _bytes_of(path: Path) -> bytes:
    try:
        data = path.read_bytes()
    except OSError as error:
        part = path.with_name(path.name + ".part")
        hint = f"the flight was cut: read {part.name} instead" if part.exists() else ""
        problem = Problem(f"the log cannot be read: {error.strerror}", Location(str(path)), hint)
        raise LogError(problem) from error
    if not data.startswith(MCAP0_MAGIC):
        what = "the file is not an MCAP log" if data else "the file is empty"
        hint = "give the flight.mcap of a run"
        raise LogError(Problem(what, Location(str(path)), hint))
    return data


class _Walk:
    def __init__(self, path: Path, data: bytes) -> None:
        self.data = data
        self.log = RawLog(path)
        self.ended = len(data) > len(MCAP0_MAGIC) and data.endswith(MCAP0_MAGIC)

    def run(self) -> RawLog:
        position = len(MCAP0_MAGIC)
        while (head := self._head(position)) is not None:
            opcode, length = head
            start = position + HEAD.size
            body = self.data[start : start + length]
            if opcode == Opcode.DATA_END:
                self._data_end(position, body)
                return self.log
            self._record(opcode, position, body)
            position = start + length
        if self.ended:
            raise self._damage(position, "the file ends without its data's end")
        self._check_sequences()
        return self.log

    def _head(self, position: int) -> tuple[int, int] | None:
        """Opcode and length of the record at ``position``; None if the file is cut inside it."""
        if position + HEAD.size > len(self.data):
            return None
        opcode, length = HEAD.unpack_from(self.data, position)
        if position + HEAD.size + length > len(self.data):
            return None
        if opcode == 0 and not any(self.data[position:]):
            return None  # a file system that lost its power may leave zeros after the last write
        return opcode, length

    def _record(self, opcode: int, position: int, body: bytes) -> None:
        log = self.log
        if (opcode == Opcode.HEADER) != (position == len(MCAP0_MAGIC)):
            raise self._damage(position, "the header is not where it belongs")
        if opcode == Opcode.HEADER:
            log.ours = self._parse(position, body, Header.read).library == LIBRARY
        elif log.ours and opcode not in OURS_OUTSIDE_CHUNKS:
            raise self._damage(position, f"a record of kind {opcode} does not belong here")
        elif opcode == Opcode.ATTACHMENT:
            self._attachment(position, body)
        elif opcode == Opcode.METADATA:
            metadata = self._parse(position, body, Metadata.read)
            log.metadata[metadata.name] = metadata.metadata
        elif opcode == Opcode.CHUNK:
            self._content(self._chunk(position, body), position)
        elif opcode == Opcode.MESSAGE_INDEX:
            if len(body) < 6 or struct.unpack_from("<I", body, 2)[0] != len(body) - 6:
                raise self._damage(position, "a message index has the wrong length")
        elif opcode in (Opcode.SCHEMA, Opcode.CHANNEL, Opcode.MESSAGE):
            # Logs of other origin need not have chunks.
            self._content(HEAD.pack(opcode, len(body)) + body, position)

    def _attachment(self, position: int, body: bytes) -> None:
        attachment = self._parse(position, body, Attachment.read)
        stored = struct.unpack("<I", body[-4:])[0]
        if (stored or self.log.ours) and stored != zlib.crc32(body[:-4]):
            name = attachment.name
            raise self._damage(position, f"the checksum of the attachment '{name}' does not match")
        self.log.attachments[attachment.name] = attachment.data

    def _chunk(self, position: int, body: bytes) -> bytes:
        """The content of a chunk, decompressed and checked."""
        chunk = self._parse(position, body, Chunk.read)
        content: bytes = chunk.data
        if chunk.compression == "zstd":
            content = self._decompressed(position, chunk)
        elif chunk.compression:
            raise self._damage(
                position,
                f"a chunk is compressed with '{chunk.compression}', which is not supported",
                "write the file again with zstd compression or with none",
            )
        if len(content) != chunk.uncompressed_size:
            raise self._damage(position, "a chunk does not have the size that it states")
        stored = chunk.uncompressed_crc
        if (stored or self.log.ours) and stored != zlib.crc32(content):
            raise self._damage(position, "the checksum of the chunk does not match")
        return content

    def _decompressed(self, position: int, chunk: Chunk) -> bytes:
        try:
            size = zstandard.frame_content_size(chunk.data)
            if size not in (-1, chunk.uncompressed_size) or chunk.uncompressed_size > LARGEST_CHUNK:
                raise self._damage(position, "a chunk does not have the size that it states")
            content: bytes = zstandard.decompress(chunk.data, chunk.uncompressed_size)
        except zstandard.ZstdError as error:
            raise self._damage(position, "a chunk cannot be decompressed") from error
        return content

    def _content(self, content: bytes, at: int) -> None:
        """Sort the records of a chunk whose checksum was found right."""
        log = self.log
        position = 0
        while position < len(content):
            opcode, length, channel_id = self._inner_head(content, position, at)
            start = position + HEAD.size
            position = start + length
            if opcode == Opcode.SCHEMA:
                schema = self._parse(at, content[start:position], Schema.read)
                log.schemas[schema.id] = schema
            elif opcode == Opcode.CHANNEL:
                channel = self._parse(at, content[start:position], Channel.read)
                log.channels[channel.id] = channel
            elif opcode == Opcode.MESSAGE:
                if channel_id not in log.channels or length < MESSAGE_HEAD:
                    raise self._damage(at, f"a message on an unknown channel {channel_id}")
                run = _run_of_messages(content, start - HEAD.size, HEAD.size + length)
                log.messages.setdefault(channel_id, []).append(run)
                position = start - HEAD.size + run.size

    def _inner_head(self, content: bytes, position: int, at: int) -> tuple[int, int, int]:
        """Opcode, length and, of a message, the channel."""
        if position + SAME_KIND <= len(content):
            opcode, length, channel_id = struct.unpack_from("<BQH", content, position)
            if position + HEAD.size + length <= len(content):
                return opcode, length, channel_id
        raise self._damage(at, "a record in a chunk is longer than the chunk")

    def _data_end(self, position: int, body: bytes) -> None:
        """Check the whole data section, and the summary behind it if it is there."""
        log = self.log
        stored = self._parse(position, body, DataEnd.read).data_section_crc
        if (stored or log.ours) and stored != zlib.crc32(self.data[:position]):
            raise self._damage(0, "the checksum of the file's data does not match")
        self._check_sequences()
        if not self.ended:
            return
        footer_size = HEAD.size + 20
        start = len(self.data) - len(MCAP0_MAGIC) - footer_size
        opcode, length = HEAD.unpack_from(self.data, max(start, 0))
        if opcode != Opcode.FOOTER or length != footer_size - HEAD.size:
            raise self._damage(start, "the footer is not where it belongs")
        footer = self._parse(start, self.data[start + HEAD.size : start + footer_size], Footer.read)
        first = footer.summary_start or start
        summary = self.data[first : start + footer_size - 4]
        if (footer.summary_crc or log.ours) and footer.summary_crc != zlib.crc32(summary):
            raise self._damage(first, "the checksum of the summary does not match")
        log.finished = True

    def _check_sequences(self) -> None:
        """In our own logs the messages of a channel are numbered without a gap."""
        if not self.log.ours:
            return
        for channel_id, runs in self.log.messages.items():
            sequence = np.concatenate([_sequence(run) for run in runs])
            if (sequence != np.arange(sequence.size)).any():
                topic = self.log.channels[channel_id].topic
                raise self._damage(0, f"messages are missing on {topic}")

    def _parse(self, position: int, body: bytes, read: Callable[[ReadDataStream], T]) -> T:
        """A record by the library's parser, which must use the whole body where it is ours."""
        stream = ReadDataStream(BytesIO(body))
        try:
            record = read(stream)
        except (McapError, struct.error, UnicodeDecodeError, OverflowError) as error:
            raise self._damage(position, "a record cannot be understood") from error
        if stream.count > len(body) or (self.log.ours and stream.count != len(body)):
            raise self._damage(position, "a record does not have the length that it states")
        return record

    def _damage(self, position: int, what: str, hint: str = "") -> LogError:
        hint = hint or "the file is damaged: copy it again from where it was flown, or fly again"
        where = Location(str(self.log.path))
        return LogError(Problem(f"{what} (byte {position})", where, hint))


def _run_of_messages(content: bytes, position: int, size: int) -> Bytes:
    """The records (n, size) at ``position`` that follow each other with one channel and length.

    Each begins where the one before it ends, so equal heads at every ``size`` bytes are enough.
    """
    kind = content[position : position + SAME_KIND]
    count = 1
    if content[position + size : position + size + SAME_KIND] == kind:
        count = (len(content) - position) // size
    run = np.frombuffer(content, np.uint8, count * size, position).reshape(count, size)
    if count == 1:
        return run
    same = (run[:, :SAME_KIND] == run[0, :SAME_KIND]).all(axis=1)
    return run if same.all() else run[: int(np.argmin(same))]


def _sequence(run: Bytes) -> np.ndarray[tuple[int], np.dtype[np.uint32]]:
    return run[:, SAME_KIND : SAME_KIND + 4].copy().view("<u4")[:, 0]
