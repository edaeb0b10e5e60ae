"""What is written is a proper MCAP file, by the judgement of the plain library."""

from __future__ import annotations

import json
import os
import struct
import subprocess
import sys
import zlib
from collections import defaultdict
from contextlib import suppress

import numpy as np
import pytest
import zstandard
from hypothesis import given, settings
from hypothesis import strategies as st
from logbook import (
    LENGTHS,
    RECORDS,
    attachments,
    flight,
    plan,
    write,
    write_flight,
)
from mcap.exceptions import EndOfFile
from mcap.reader import NonSeekingReader, make_reader
from mcap.records import Chunk, ChunkIndex, Footer, Message, MessageIndex
from mcap.stream_reader import StreamReader
from mcap_protobuf.decoder import DecoderFactory

from inspect_cli.errors import EnvironmentFault
from inspect_cli.log.layout import FieldInfo, descriptor_set, record_layout, rows_dtype
from inspect_cli.log.queues import RowQueue
from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import Estimate, Probe, State, scalar, vector


def plain(path, topic=None):
    with path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True, decoder_factories=[DecoderFactory()])
        yield from reader.iter_decoded_messages(topics=topic)


def numbers_of(message):
    """All doubles of a decoded message in order of declaration, as bytes."""
    flat = []
    for field in message.DESCRIPTOR.fields:
        value = getattr(message, field.name)
        flat += list(value) if field.is_repeated else [value]
    return struct.pack(f"<{len(flat)}d", *flat)


@pytest.mark.parametrize("record", RECORDS)
def test_plain_reader_finds_every_row_bit_for_bit(written, record):
    rows = written.rows[record]
    found = list(plain(written.path, record.topic))
    assert [numbers_of(m.decoded_message) for m in found] == [row.tobytes() for row in rows]
    assert [m.message.log_time for m in found] == [round(t * 1e9) for t in rows["t_s"]]
    assert [m.message.sequence for m in found] == list(range(rows.size))
    assert found[0].schema.name == f"inspect.{record.__name__}"


def test_messages_come_in_order_of_time(written):
    times = [m.message.log_time for m in plain(written.path)]
    assert times == sorted(times)


def test_data_section_crc(written):
    with written.path.open("rb") as stream:
        messages = NonSeekingReader(stream, validate_crcs=True).iter_messages()
        assert sum(1 for _ in messages) == sum(r.size for r in written.rows.values()) + 5


def test_summary_crc_and_attachment_crcs(written, root):
    data = written.path.read_bytes()
    footer_at = len(data) - 8 - 29
    assert data[footer_at] == 2
    start, _, crc = struct.unpack_from("<QQI", data, footer_at + 9)
    assert crc == zlib.crc32(data[start : len(data) - 8 - 4])
    with written.path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        indexes = reader.get_summary().attachment_indexes
        found = {a.name: a.data for a in reader.iter_attachments()}
    assert found == attachments(root)
    for index in indexes:
        record = data[index.offset + 9 : index.offset + index.length]
        assert struct.unpack("<I", record[-4:])[0] == zlib.crc32(record[:-4])


def test_statistics_and_outcome(written):
    with written.path.open("rb") as stream:
        reader = make_reader(stream, validate_crcs=True)
        summary = reader.get_summary()
        outcome = list(reader.iter_metadata())
    counts = {
        summary.channels[channel].topic: count
        for channel, count in summary.statistics.channel_message_counts.items()
    }
    for record, rows in written.rows.items():
        assert counts[record.topic] == rows.size
    assert summary.statistics.message_count == sum(counts.values())
    assert summary.statistics.message_end_time == round(1.3e9)
    assert [(m.name, m.metadata) for m in outcome] == [
        ("outcome", {"status": "completed", "reason": "all points visited"})
    ]


def test_message_indexes_point_at_their_messages(written):
    """Every entry's offset into the chunk holds a message of that channel and time."""
    chunk = None
    entries = 0
    indexes = {}
    with written.path.open("rb") as stream:
        for record in StreamReader(stream, emit_chunks=True, validate_crcs=True).records:
            if isinstance(record, Chunk):
                assert record.uncompressed_crc != 0
                chunk = record
                content = zstandard.decompress(record.data, record.uncompressed_size)
            elif isinstance(record, MessageIndex):
                for time, offset in record.records:
                    opcode, _, channel, _, logged = struct.unpack_from("<BQHIQ", content, offset)
                    assert (opcode, channel, logged) == (5, record.channel_id, time)
                    assert chunk.message_start_time <= time <= chunk.message_end_time
                    entries += 1
            elif isinstance(record, ChunkIndex):
                indexes[record.chunk_start_offset] = record
    assert entries == sum(rows.size for rows in written.rows.values()) + 5
    data = written.path.read_bytes()
    for offset, index in indexes.items():
        assert data[offset] == 6
        for channel, at in index.message_index_offsets.items():
            opcode, _, found = struct.unpack_from("<BQH", data, at)
            assert (opcode, found) == (7, channel)


def test_channel_metadata_says_everything(written):
    with written.path.open("rb") as stream:
        channels = make_reader(stream, validate_crcs=True).get_summary().channels.values()
    fields = {c.topic: json.loads(c.metadata.get("fields", "[]")) for c in channels}
    for record in RECORDS:
        stated = fields[record.topic]
        declared = list(record.fields())
        assert [f["name"] for f in stated] == [f.name for f in declared]
        for said, field in zip(stated, declared, strict=True):
            assert tuple(said["shape"]) == field.resolved_shape(LENGTHS)
            assert (said["unit"], said["frame"]) == (field.unit, field.frame)
            assert said["meaning"] == field.meaning


def test_foxglove_messages(tmp_path):
    path = tmp_path / "flight.mcap"
    cloud = np.array([[1.0, 2.0, 3.0], [np.nan, 0.0, 0.0], [4.0, 5.0, 6.5]])
    times = [0.0, 0.999999999, 3.25, 1234567.000000001]
    with LogWriter(path, [], {}) as log:
        for t in times:
            log.pose("/pose", t, np.array([t, -2.0, 3.0]), np.array([0.5, -0.5, 0.1, 0.7]))
        log.point_cloud("/cloud", 0.5, cloud)
        log.event(0.25, "error", "no contact")
        log.scene(0.0, plan())
        log.close("aborted", "")
    found = defaultdict(list)
    for m in plain(path):
        found[m.schema.name].append(m)
    poses = [m.decoded_message for m in found["foxglove.PoseInFrame"]]
    assert [p.timestamp.seconds * 10**9 + p.timestamp.nanos for p in poses] == [
        round(t * 1e9) for t in times
    ]
    assert [p.pose.position.x for p in poses] == times
    q = poses[0].pose.orientation
    assert (q.w, q.x, q.y, q.z) == (0.5, -0.5, 0.1, 0.7)
    assert {p.frame_id for p in poses} == {"W"}
    [points] = [m.decoded_message for m in found["foxglove.PointCloud"]]
    assert np.frombuffer(points.data, "<f4").tolist() == [1.0, 2.0, 3.0, 4.0, 5.0, 6.5]
    [event] = [m.decoded_message for m in found["foxglove.Log"]]
    assert (event.message, event.level) == ("no contact", event.ERROR)
    assert event.timestamp.nanos == 250_000_000
    [scene] = [m.decoded_message for m in found["foxglove.SceneUpdate"]]
    assert [e.id for e in scene.entities] == ["surface/wall", "surface/column", "target/0", "path"]


def test_scene_triangles_cover_the_patches_and_face_outward(tmp_path):
    path = tmp_path / "flight.mcap"
    with LogWriter(path, [], {}) as log:
        log.scene(0.0, plan())
        log.close("completed", "")
    [scene] = [m.decoded_message for m in plain(path)]
    # The arc of 1 m on r = 0.5 m in 24 facets: each chord is 2 r sin(1/48) instead of 1/24 m.
    areas = {"surface/wall": 3.0 * 2.0, "surface/column": 24 * 2 * 0.5 * np.sin(1 / 24) * 2.0}
    for entity in scene.entities[:2]:
        [mesh] = entity.triangles
        nodes = np.array([(p.x, p.y, p.z) for p in mesh.points])
        a, b, c = nodes[np.array(mesh.indices).reshape(-1, 3)].transpose(1, 0, 2)
        normals = 0.5 * np.cross(b - a, c - a)
        area = np.linalg.norm(normals, axis=1).sum()
        assert area == pytest.approx(areas[entity.id], rel=1e-9)
        assert (normals[:, 0] < 0).all()  # both patches face −x


def test_same_rows_give_the_same_bytes_in_any_process(tmp_path, root):
    here = tmp_path / "here.mcap"
    write_flight(here, root)
    for hash_seed in ("1", "2"):
        there = tmp_path / f"{hash_seed}.mcap"
        code = (
            "import sys; from pathlib import Path; sys.path.insert(0, sys.argv[1]);"
            "from logbook import write_flight; write_flight(Path(sys.argv[2]), Path(sys.argv[3]))"
        )
        command = [sys.executable, "-c", code, str(root / "tests/log"), str(there), str(root)]
        subprocess.run(
            command, check=True, cwd=root, env=os.environ | {"PYTHONHASHSEED": hash_seed}
        )
        assert there.read_bytes() == here.read_bytes()


def test_a_file_has_its_name_only_when_it_is_whole(tmp_path):
    path = tmp_path / "flight.mcap"
    log = LogWriter(path, RECORDS, LENGTHS)
    write(log, flight(1.0))
    assert not path.exists()
    assert (tmp_path / "flight.mcap.part").exists()
    log.close("completed", "")
    assert path.exists()
    assert not (tmp_path / "flight.mcap.part").exists()


def test_an_exception_leaves_all_rows_in_the_part_file(tmp_path, root):
    path = tmp_path / "flight.mcap"
    rows = flight(0.33)

    def fly():
        with LogWriter(path, RECORDS, LENGTHS) as log:
            for name, data in attachments(root).items():
                log.attach(name, "application/json", data)
            write(log, rows)
            raise RuntimeError

    with pytest.raises(RuntimeError):
        fly()
    log = read_log(tmp_path / "flight.mcap.part")
    assert log.status == "interrupted"
    assert log.channels[State.topic].tobytes() == rows[State].tobytes()


def test_chunks_are_due_by_time(tmp_path):
    """After every tick the file holds all but the last ``chunk_s`` and one tick."""
    path = tmp_path / "flight.mcap"
    log = LogWriter(path, [Probe], {}, chunk_s=0.25)
    probe = Probe.create()
    for k in range(500):
        probe.t_s = k / 100
        log.log(probe)
        log.flush_due(k / 100)
        part = tmp_path / "flight.mcap.part"
        if k % 7 == 0:
            with part.open("rb") as stream:
                assert k / 100 - last_time(stream) <= 0.25 + 1e-9
    log.close("completed", "")


def last_time(stream):
    """The last log time of an unfinished file, by the library; −1 tick if there is none."""
    last = -0.01
    with suppress(EndOfFile):
        for record in StreamReader(stream, validate_crcs=True).records:
            if isinstance(record, Message):
                last = record.log_time * 1e-9
            assert not isinstance(record, Footer)
    return last


def test_a_full_disk_is_a_fault_of_the_environment(tmp_path):
    (tmp_path / "flight.mcap.part").symlink_to("/dev/full")
    with pytest.raises(EnvironmentFault, match=r"flight\.mcap\.part.*space"):
        LogWriter(tmp_path / "flight.mcap", RECORDS, LENGTHS)


def test_a_missing_folder_is_a_fault_of_the_environment(tmp_path):
    with pytest.raises(EnvironmentFault, match="No such file"):
        LogWriter(tmp_path / "nowhere" / "flight.mcap", RECORDS, LENGTHS)


def test_an_unknown_status_is_refused(tmp_path):
    with LogWriter(tmp_path / "flight.mcap", [], {}) as log, pytest.raises(ValueError, match="ok"):
        log.close("ok", "")


class Wide(Estimate):
    """More than fifteen fields (two-byte keys), long and empty vectors (two-byte lengths)."""

    topic = "/wide"

    a = scalar("1", "")
    b = vector(40, "1", "", "")
    c = vector("n_none", "1", "", "")
    d = scalar("1", "")
    e = scalar("1", "")
    f = scalar("1", "")
    g = vector(3, "1", "", "")
    h = scalar("1", "")


def test_a_record_of_a_platform_kind_with_many_fields(tmp_path):
    path = tmp_path / "flight.mcap"
    wide = Wide.create({"n_none": 0})
    numbers = wide.array.view("<f8")
    numbers[:] = np.arange(numbers.size)
    wide.t_s = 0.0
    with LogWriter(path, [Wide], {"n_none": 0}) as log:
        log.log(wide)
        log.close("completed", "")
    [message] = [m.decoded_message for m in plain(path)]
    assert numbers_of(message) == wide.array.tobytes()
    assert read_log(path).channels["/wide"].tobytes() == wide.array.tobytes()


SHAPES = st.lists(st.one_of(st.none(), st.integers(0, 40)), min_size=1, max_size=40)


@settings(max_examples=60, deadline=None)
@given(shapes=SHAPES, n=st.integers(1, 5), seed=st.integers(0, 2**32 - 1))
def test_any_layout_is_what_protobuf_reads(shapes, n, seed):
    """Messages of any shapes, filled with random bits, parsed by the protobuf library."""
    fields = [
        FieldInfo(f"x{k}", () if length is None else (length,), "", "", "")
        for k, length in enumerate(shapes)
    ]
    fields.insert(0, FieldInfo("t_s", (), "s", "", ""))
    layout = record_layout(9, fields)
    queue = RowQueue(9, layout, rows_dtype(fields))
    rng = np.random.default_rng(seed)
    rows = np.zeros(n, rows_dtype(fields))
    for field in fields[1:]:
        rows[field.name] = rng.integers(0, 2**63, (n, *field.shape)).view("<f8")
    rows["t_s"] = np.arange(n) * 0.01
    for row in np.split(rows, n):
        queue.append(row)
    raw = np.frombuffer(bytes(queue.drain().data), np.uint8).reshape(n, -1)
    assert layout.matches(raw)
    schema = Schema("inspect.Any", descriptor_set("inspect.Any", fields))
    decode = DecoderFactory().decoder_for("protobuf", schema)
    for k, row in enumerate(raw):
        opcode, length, channel, sequence, time, published = struct.unpack_from("<BQHIQQ", row)
        assert (opcode, length, channel) == (5, row.size - 9, 9)
        assert (sequence, time, published) == (k, k * 10**7, k * 10**7)
        decoded = decode(row[31:].tobytes())
        for field in fields:
            value = getattr(decoded, field.name)
            assert np.float64(value).tobytes() == rows[field.name][k].tobytes()


class Schema:
    """What the decoder asks of a schema record."""

    encoding = "protobuf"
    id = 1

    def __init__(self, name, data):
        self.name = name
        self.data = data
