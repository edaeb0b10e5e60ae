"""A cut log is read up to the cut; damaged bytes are never taken for data."""

from __future__ import annotations

import io
import struct

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from logbook import LENGTHS, attach, attachments, flight, write
from mcap.exceptions import EndOfFile
from mcap.records import Attachment, Chunk
from mcap.stream_reader import StreamReader, breakup_chunk

from inspect_cli.errors import LogError
from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import Probe, State

NEEDED = {"mission.json", "platform.json", "plan.json", "modes.json"}
RECORDS = (State, Probe)
DURATION_S = 0.35
CHUNK_S = 0.05
PARTS = 10**6
SHARE = st.integers(0, PARTS - 1)
"""A place in a file, in millionths."""


class Whole:
    """A finished log, where its records begin, and what a cut at each place must leave."""

    def __init__(self, folder, root):
        path = folder / "flight.mcap"
        self.attachments = attachments(root)
        every = flight(DURATION_S)
        self.rows = {record.topic: every[record] for record in RECORDS}
        with LogWriter(path, RECORDS, LENGTHS, chunk_s=CHUNK_S) as log:
            attach(log, self.attachments)
            write(log, {record: every[record] for record in RECORDS})
            log.close("completed", "done")
        self.data = path.read_bytes()
        self.scratch = folder / "scratch.mcap"
        self.starts = starts(self.data)

    def read(self, data):
        self.scratch.write_bytes(data)
        return read_log(self.scratch)

    def check(self, log):
        """What is read is a whole prefix of what was logged."""
        for name, data in log.attachments.items():
            assert self.attachments[name] == data
        for topic, rows in log.channels.items():
            assert rows.tobytes() == self.rows[topic][: rows.size].tobytes()


def starts(data):
    """Byte positions of all records, and of the end, by a walk of three lines."""
    positions = [8]
    while positions[-1] < len(data) - 8:
        positions.append(positions[-1] + 9 + struct.unpack_from("<Q", data, positions[-1] + 1)[0])
    assert positions[-1] == len(data) - 8
    return positions


def by_the_library(data):
    """(attachments, number of messages) of a cut file, by the library's streaming reader."""
    names, messages = set(), 0
    try:
        for record in StreamReader(io.BytesIO(data), emit_chunks=True).records:
            if isinstance(record, Attachment):
                names.add(record.name)
            if isinstance(record, Chunk):
                messages += sum(hasattr(r, "sequence") for r in breakup_chunk(record, True))
    except (EndOfFile, struct.error):
        pass
    return names, messages


@pytest.fixture(scope="module")
def whole(tmp_path_factory, root):
    return Whole(tmp_path_factory.mktemp("damage"), root)


def check_cut(whole, cut):
    data = whole.data[:cut]
    if cut < 8:
        with pytest.raises(LogError, match="empty" if cut == 0 else "not an MCAP log"):
            whole.read(data)
        return
    complete = max(start for start in whole.starts if start <= cut)
    names, messages = by_the_library(whole.data[:complete])
    if not names >= NEEDED:
        with pytest.raises(LogError, match="nothing to evaluate"):
            whole.read(data)
        return
    log = whole.read(data)
    assert log.status == "interrupted"
    assert "cut" in log.status_reason
    assert set(log.attachments) == names
    assert sum(rows.size for rows in log.channels.values()) == messages
    whole.check(log)


def test_cut_around_every_record(whole):
    kinds = set()
    for start in whole.starts:
        kinds.add(whole.data[start])
        for cut in {start - 1, start, start + 1, start + 9, start + 10}:
            if cut < len(whole.data):
                check_cut(whole, cut)
    # header, footer, schema … summary offset: every kind that a log of ours has
    assert {0x01, 0x02, 0x06, 0x07, 0x09, 0x0C, 0x0F, 0x08, 0x0A, 0x0B, 0x0D, 0x0E} <= kinds


@settings(max_examples=200, deadline=None)
@given(share=SHARE)
def test_cut_anywhere(whole, share):
    check_cut(whole, share * len(whole.data) // PARTS)


@pytest.mark.parametrize("zeros", [1, 9, 4096])
def test_a_tail_of_zeros_is_a_cut(whole, zeros):
    """What a file system may leave behind a power failure."""
    chunks = [start for start in whole.starts if whole.data[start] == 6]
    log = whole.read(whole.data[: chunks[3]] + bytes(zeros))
    assert log.status == "interrupted"
    assert log.channels[Probe.topic].size > 0
    whole.check(log)


def flipped(data, position, mask):
    return data[:position] + bytes([data[position] ^ mask]) + data[position + 1 :]


def check_flip(whole, data, position, mask):
    """A file with one wrong byte is refused, or it is read as interrupted and holds no lie."""
    try:
        log = whole.read(flipped(data, position, mask))
    except LogError:
        return
    assert log.status == "interrupted"
    if log.channels:
        assert set(log.attachments) == set(whole.attachments)
    whole.check(log)


def test_flip_around_every_record(whole):
    """Opcodes and lengths, in finished and in cut files; all single bits of an opcode."""
    cut = whole.data[: next(s for s in whole.starts if whole.data[s] == 0x0F)]
    for data in (whole.data, cut):
        for start in whole.starts:
            for position in (start, start + 1, start + 3, start + 8, start + 9):
                for bit in range(8) if position == start else (0, 7):
                    if position < len(data):
                        check_flip(whole, data, position, 1 << bit)


@settings(max_examples=300, deadline=None)
@given(
    share=SHARE,
    mask=st.integers(1, 255),
    end=SHARE,
)
def test_flip_anywhere(whole, share, mask, end):
    """Half of the files are cut, so the checksum of the whole is not there to help."""
    data = whole.data[: min(2 * end, PARTS) * len(whole.data) // PARTS]
    if data:
        check_flip(whole, data, share * len(data) // PARTS, mask)


@settings(max_examples=100, deadline=None)
@given(data=st.binary(max_size=400))
def test_noise_behind_the_magic(whole, data):
    try:
        log = whole.read(whole.data[:8] + data)
    except LogError:
        return
    assert log.channels == {}


@settings(max_examples=100, deadline=None)
@given(share=SHARE, data=st.binary(min_size=1, max_size=64))
def test_noise_over_a_finished_file(whole, share, data):
    position = share * len(whole.data) // PARTS
    wrong = whole.data[:position] + data + whole.data[position + len(data) :]
    if wrong == whole.data:
        return
    try:
        log = whole.read(wrong)
    except LogError:
        return
    assert log.status == "interrupted"
    whole.check(log)


def test_a_broken_chunk_names_file_and_byte(whole):
    """One byte of a chunk's stated CRC is wrong."""
    chunk = [start for start in whole.starts if whole.data[start] == 6][2]
    wrong = flipped(whole.data, chunk + 9 + 24, 0x10)
    what = rf"scratch\.mcap: the checksum of the chunk does not match \(byte {chunk}\)\n.*copy it"
    with pytest.raises(LogError, match=what) as caught:
        whole.read(wrong)
    assert caught.value.exit_code == 2


def test_a_broken_attachment_names_itself(whole):
    at = whole.data.index(b'"wall"')
    with pytest.raises(LogError, match=r"checksum of the attachment 'mission\.json'"):
        whole.read(flipped(whole.data, at + 1, 1))


def test_a_record_longer_than_its_finished_file(whole):
    """The footer is there, so this is damage and not a cut."""
    chunk = next(start for start in whole.starts if whole.data[start] == 6)
    with pytest.raises(LogError, match=rf"ends without its data's end \(byte {chunk}\)"):
        whole.read(flipped(whole.data, chunk + 5, 1))


def test_a_chunk_that_lost_its_opcode_is_missed_by_the_sequence(whole):
    """A cut file in which one chunk was removed cleanly: numbering shows the hole."""
    chunks = [start for start in whole.starts if whole.data[start] == 6]
    holed = whole.data[: chunks[2]] + whole.data[chunks[3] : chunks[5]]
    with pytest.raises(LogError, match="messages are missing on /truth/state"):
        whole.read(holed)


@pytest.mark.parametrize("data", [b"", b"x", b"ply\nformat ascii 1.0\n" * 10])
def test_other_files(whole, data):
    with pytest.raises(LogError, match="is empty" if not data else "not an MCAP log"):
        whole.read(data)


def test_a_missing_file_points_to_the_part(tmp_path):
    path = tmp_path / "flight.mcap"
    with pytest.raises(LogError, match="No such file"):
        read_log(path)
    (tmp_path / "flight.mcap.part").write_bytes(b"")
    with pytest.raises(LogError, match=r"read flight\.mcap\.part instead"):
        read_log(path)


def test_a_folder_is_no_log(tmp_path):
    with pytest.raises(LogError, match="cannot be read"):
        read_log(tmp_path)


def test_the_log_is_as_long_as_it_should_be(whole):
    log = whole.read(whole.data)
    assert log.status == "completed"
    assert log.channels[State.topic]["t_s"].tolist() == [k / 100 for k in range(35)]
    assert np.isnan(log.channels[State.topic]["p_WB"]).any()
