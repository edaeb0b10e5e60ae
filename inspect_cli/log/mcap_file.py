"""An MCAP file as it grows: attachments, chunks of ready bytes, summary.

The library's own ``Writer`` takes one message at a time, which costs more than the flight does.
This one takes blocks of encoded messages; records, names and numbers are the library's.
Format: https://mcap.dev/spec.
"""

from __future__ import annotations

import os
import struct
import zlib
from collections.abc import Sequence
from pathlib import Path
from typing import Any, NamedTuple

import numpy as np
import zstandard
from mcap.data_stream import RecordBuilder
from mcap.opcode import Opcode
from mcap.records import (
    Attachment,
    AttachmentIndex,
    Channel,
    Chunk,
    ChunkIndex,
    DataEnd,
    Footer,
    Header,
    McapRecord,
    Metadata,
    MetadataIndex,
    Schema,
    Statistics,
    SummaryOffset,
)
from mcap.writer import MCAP0_MAGIC

from inspect_cli.errors import EnvironmentFault
from inspect_cli.log.layout import Nanoseconds

LIBRARY = "inspect-cli 1"
"""Stands in the header: the writer and the version of its conventions."""
COMPRESSION_LEVEL = -5
"""Measured numbers are mostly noise: level 1 saves 10 % more bytes for thrice the time."""
INDEX_ENTRY = np.dtype([("log_time", "<u8"), ("offset", "<u8")])


class Block(NamedTuple):
    """Encoded Message records of one channel."""

    channel_id: int
    data: bytes | memoryview
    log_time: Nanoseconds
    offset: Nanoseconds
    """Of each record from the start of ``data``."""


class McapFile:
    """Appends to a file and keeps what its summary needs.

    Whatever a call has written has been handed to the operating system when it returns, so a
    killed process loses nothing of it. Raises EnvironmentFault where the disk refuses.
    """

    def __init__(self, path: Path) -> None:
        self._path = path
        try:
            self._file = path.open("wb", buffering=0)
        except OSError as error:
            raise self._fault(error) from error
        self._position = 0
        self._data_crc = 0
        self._compressor = zstandard.ZstdCompressor(level=COMPRESSION_LEVEL)
        self._schemas: list[Schema] = []
        self._channels: list[Channel] = []
        self._undeclared: list[McapRecord] = []
        self._chunk_indexes: list[ChunkIndex] = []
        self._attachment_indexes: list[AttachmentIndex] = []
        self._metadata_indexes: list[MetadataIndex] = []
        self._counts: dict[int, int] = {}
        try:
            self._write(MCAP0_MAGIC + _encoded(Header(profile="", library=LIBRARY)))
        except EnvironmentFault:
            self.close()
            raise

    def add_schema(self, name: str, descriptor_set: bytes) -> int:
        """Declare a protobuf message; it stands in the next chunk, under that chunk's CRC."""
        schema = Schema(
            id=len(self._schemas) + 1, name=name, encoding="protobuf", data=descriptor_set
        )
        self._schemas.append(schema)
        self._undeclared.append(schema)
        return schema.id

    def add_channel(self, topic: str, schema_id: int, metadata: dict[str, str]) -> int:
        """Declare a topic; it stands in the next chunk, under that chunk's CRC."""
        channel = Channel(
            id=len(self._channels) + 1,
            topic=topic,
            message_encoding="protobuf",
            metadata=metadata,
            schema_id=schema_id,
        )
        self._channels.append(channel)
        self._undeclared.append(channel)
        self._counts[channel.id] = 0
        return channel.id

    def attach(self, name: str, media_type: str, data: bytes) -> None:
        """Store a file. Times are zero, for the same flight shall give the same bytes."""
        attachment = Attachment(
            create_time=0, log_time=0, name=name, media_type=media_type, data=data
        )
        record = _encoded(attachment)
        self._attachment_indexes.append(
            AttachmentIndex(
                offset=self._position,
                length=len(record),
                log_time=0,
                create_time=0,
                data_size=len(data),
                name=name,
                media_type=media_type,
            )
        )
        self._write(record)

    def write_chunk(self, blocks: Sequence[Block]) -> None:
        """Write one chunk with the blocks in their order, and its message indexes."""
        if not blocks:
            return
        content = b"".join(map(_encoded, self._undeclared))
        self._undeclared.clear()
        indexes: dict[int, bytes] = {}
        position = len(content)
        for block in blocks:
            indexes[block.channel_id] = _message_index(block, position)
            self._counts[block.channel_id] += block.log_time.size
            position += len(block.data)
        content = b"".join([content, *(block.data for block in blocks)])
        compressed = self._compressor.compress(content)
        chunk = Chunk(
            compression="zstd",
            data=compressed,
            message_start_time=min(int(block.log_time.min()) for block in blocks),
            message_end_time=max(int(block.log_time.max()) for block in blocks),
            uncompressed_crc=zlib.crc32(content),
            uncompressed_size=len(content),
        )
        record = _encoded(chunk)
        self._remember_chunk(chunk, len(record), indexes)
        self._write(b"".join([record, *indexes.values()]))

    def _remember_chunk(self, chunk: Chunk, length: int, indexes: dict[int, bytes]) -> None:
        offsets = {}
        position = self._position + length
        for channel_id, index in indexes.items():
            offsets[channel_id] = position
            position += len(index)
        self._chunk_indexes.append(
            ChunkIndex(
                chunk_start_offset=self._position,
                chunk_length=length,
                compression=chunk.compression,
                compressed_size=len(chunk.data),
                uncompressed_size=chunk.uncompressed_size,
                message_start_time=chunk.message_start_time,
                message_end_time=chunk.message_end_time,
                message_index_length=position - self._position - length,
                message_index_offsets=offsets,
            )
        )

    def finish(self, metadata_name: str, metadata: dict[str, str]) -> None:
        """Write a metadata record, the summary and the footer, and bring all to the disk."""
        record = _encoded(Metadata(name=metadata_name, metadata=metadata))
        self._metadata_indexes.append(
            MetadataIndex(offset=self._position, length=len(record), name=metadata_name)
        )
        self._write(record)
        self._write(_encoded(DataEnd(data_section_crc=self._data_crc)))
        self._write(self._summary())
        try:
            os.fsync(self._file.fileno())
        except OSError as error:
            raise self._fault(error) from error
        self.close()

    def close(self) -> None:
        """Let go of the file as it is."""
        self._file.close()

    def _summary(self) -> bytes:
        """Summary, footer and closing magic, for a data section that ends here."""
        start = self._position
        groups: list[tuple[Opcode, Sequence[McapRecord]]] = [
            (Opcode.SCHEMA, self._schemas),
            (Opcode.CHANNEL, self._channels),
            (Opcode.STATISTICS, [self._statistics()]),
            (Opcode.CHUNK_INDEX, self._chunk_indexes),
            (Opcode.ATTACHMENT_INDEX, self._attachment_indexes),
            (Opcode.METADATA_INDEX, self._metadata_indexes),
        ]
        summary = bytearray()
        offsets = bytearray()
        for opcode, records in groups:
            if not records:
                continue
            group = b"".join(map(_encoded, records))
            offsets += _encoded(
                SummaryOffset(
                    group_opcode=opcode,
                    group_start=start + len(summary),
                    group_length=len(group),
                )
            )
            summary += group
        footer = Footer(
            summary_start=start, summary_offset_start=start + len(summary), summary_crc=0
        )
        # The CRC runs over everything up to itself, which is the footer's last four bytes.
        before_crc = bytes(summary + offsets) + _encoded(footer)[:-4]
        return before_crc + struct.pack("<I", zlib.crc32(before_crc)) + MCAP0_MAGIC

    def _statistics(self) -> Statistics:
        chunks = self._chunk_indexes
        return Statistics(
            attachment_count=len(self._attachment_indexes),
            channel_count=len(self._channels),
            channel_message_counts=self._counts,
            chunk_count=len(chunks),
            message_count=sum(self._counts.values()),
            message_start_time=min((c.message_start_time for c in chunks), default=0),
            message_end_time=max((c.message_end_time for c in chunks), default=0),
            metadata_count=len(self._metadata_indexes),
            schema_count=len(self._schemas),
        )

    def _write(self, data: bytes) -> None:
        self._data_crc = zlib.crc32(data, self._data_crc)
        self._position += len(data)
        try:
            # An unbuffered file may take less than it is given when the disk is nearly full.
            rest = memoryview(data)
            while rest:
                rest = rest[self._file.write(rest) :]
        except OSError as error:
            raise self._fault(error) from error

    def _fault(self, error: OSError) -> EnvironmentFault:
        return EnvironmentFault(
            f"{self._path}: the log cannot be written: {error.strerror}",
            hint="see to the folder's permissions and to the space on its disk",
        )


def _encoded(record: McapRecord) -> bytes:
    builder: Any = RecordBuilder()  # its ``end`` has no annotations
    record.write(builder)
    data: bytes = builder.end()
    return data


def _message_index(block: Block, start: int) -> bytes:
    """A MessageIndex record: where in the chunk's content each message of a channel begins."""
    entries = np.empty(block.log_time.size, INDEX_ENTRY)
    entries["log_time"] = block.log_time
    entries["offset"] = block.offset + np.uint64(start)
    body = struct.pack("<HI", block.channel_id, entries.nbytes) + entries.tobytes()
    return struct.pack("<BQ", Opcode.MESSAGE_INDEX, len(body)) + body
