"""What was logged is read back; logs of other writers are read as far as they can be."""

from __future__ import annotations

import json
import struct
import time

import numpy as np
import pytest
from foxglove_schemas_protobuf.PointCloud_pb2 import PointCloud
from google.protobuf.descriptor_pb2 import FileDescriptorProto, FileDescriptorSet
from google.protobuf.descriptor_pool import DescriptorPool
from google.protobuf.message_factory import GetMessageClassesForFiles
from logbook import LENGTHS, RECORDS, attach, attachments, flight, mission, plan, write
from mcap.writer import CompressionType, Writer

from inspect_cli.errors import LogError
from inspect_cli.log.layout import channel_metadata, descriptor_set, fields_of
from inspect_cli.log.reader import read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import Command, Estimate, Imu, Pose, Probe, Reading, State
from inspect_cli.schema.truth import TruthModel


def test_everything_comes_back(written, root):
    log = read_log(written.path)
    assert (log.status, log.status_reason) == ("completed", "all points visited")
    assert set(log.channels) == {record.topic for record in RECORDS}
    for record, rows in written.rows.items():
        found = log.rows(record)
        assert found.dtype == record.dtype(LENGTHS)
        assert found.tobytes() == rows.tobytes()
    assert log.attachments == attachments(root)
    assert [(e.t_s, e.level, e.text) for e in log.events] == [
        (0.02, "info", "take-off"),
        (1.3, "warning", "wind — 3 N"),
    ]
    [cloud] = log.points
    assert cloud.t_s == 0.04
    assert cloud.points_W.tolist() == np.arange(12.0).reshape(4, 3).tolist()


def test_models_come_back(written):
    log = read_log(written.path)
    assert log.mission() == mission()
    assert log.plan() == plan()
    assert log.platform().name == "tilt_rotor_hexarotor"
    assert log.truth() == TruthModel()
    assert log.seed == 7
    assert log.versions == {"numpy": "1.2.3"}


def test_a_real_flight_has_no_truth_and_no_seed(tmp_path):
    path = tmp_path / "flight.mcap"
    with LogWriter(path, [Probe], {}) as log:
        log.log(Probe.create())
        log.close("completed", "")
    read = read_log(path)
    assert (read.truth(), read.seed, read.versions) == (None, None, {})
    assert read.rows(State) is None
    with pytest.raises(LogError, match=r"flight\.mcap.*no attachment 'mission\.json'"):
        read.mission()


@pytest.mark.parametrize(
    ("name", "data", "what"),
    [
        ("mission.json", b'{"name": "x"}', "breaks the schema at 'platform'"),
        ("mission.json", b"{", "breaks the schema"),
        ("platform.json", b'{"kind": "balloon"}', "kind 'balloon'; known kinds are: .*tilt_rotor"),
        ("platform.json", b"[1]", "not a JSON object"),
        ("platform.json", b"\xff", "not JSON"),
    ],
)
def test_attachments_that_break_the_schema(tmp_path, name, data, what):
    path = tmp_path / "flight.mcap"
    with LogWriter(path, [], {}) as log:
        log.attach(name, "application/json", data)
        log.close("completed", "")
    read = read_log(path)
    with pytest.raises(LogError, match=what):
        getattr(read, name.removesuffix(".json"))()


def test_a_hundred_seconds_are_read_within_one(tmp_path, root):
    path = tmp_path / "flight.mcap"
    rows = flight(100.0)
    with LogWriter(path, RECORDS, LENGTHS) as log:
        attach(log, attachments(root))
        write(log, rows)
        log.close("completed", "")
    begun = time.perf_counter()
    read = read_log(path)
    assert time.perf_counter() - begun < 1.0
    assert read.channels[State.topic].tobytes() == rows[State].tobytes()


class Foreign:
    """A log by the library's own writer, one message at a time, fields as protobuf likes."""

    def __init__(self, path, **options):
        self.stream = path.open("wb")
        self.writer = Writer(self.stream, compression=CompressionType.NONE, **options)
        self.writer.start()
        self.classes = {}
        self.channels = {}

    def declare(self, topic, name, descriptors):
        pool = DescriptorPool()
        [file] = FileDescriptorSet.FromString(descriptors).file
        pool.Add(file)
        self.classes[topic] = GetMessageClassesForFiles([file.name], pool)[name]
        schema = self.writer.register_schema(name, "protobuf", descriptors)
        self.channels[topic] = self.writer.register_channel(topic, "protobuf", schema)

    def message(self, topic, time_ns, **values):
        data = self.classes[topic](**values).SerializeToString()
        self.writer.add_message(self.channels[topic], time_ns, data, time_ns)

    def close(self, status="completed"):
        if status is not None:
            self.writer.add_metadata("outcome", {"status": status, "reason": "landed"})
        self.writer.finish()
        self.stream.close()


@pytest.mark.parametrize("chunked", [True, False])
def test_a_foreign_log_with_the_documented_channels(tmp_path, chunked):
    """proto3 leaves zeros out, so messages differ in length."""
    path = tmp_path / "real.mcap"
    foreign = Foreign(path, use_chunking=chunked, enable_data_crcs=True)
    fields = fields_of(Estimate, LENGTHS)
    foreign.declare(Estimate.topic, "inspect.Estimate", descriptor_set("inspect.Estimate", fields))
    rows = flight(0.5)[Estimate]
    for row in rows:
        values = {name: row[name].tolist() for name in rows.dtype.names}
        foreign.message(Estimate.topic, round(row["t_s"] * 1e9), **values)
    foreign.close()
    log = read_log(path)
    assert (log.status, log.status_reason) == ("completed", "landed")
    found = log.rows(Estimate)
    assert found.dtype == rows.dtype
    # proto3 takes −0.0 for a value and keeps it, so even the bits agree.
    assert found.tobytes() == rows.tobytes()


def test_fields_in_another_order_on_the_wire(tmp_path):
    """Protobuf lets a writer choose: same length and metadata as ours, other bytes."""
    path = tmp_path / "real.mcap"
    fields = fields_of(Probe, {})
    foreign = Foreign(path)
    descriptors = descriptor_set("inspect.Probe", fields)
    schema = foreign.writer.register_schema("inspect.Probe", "protobuf", descriptors)
    channel = foreign.writer.register_channel(
        Probe.topic, "protobuf", schema, channel_metadata(fields)
    )
    values = {4: 1.5, 2: -0.25, 1: 0.5, 3: 800.0}  # t_s, potential, resistance, force are 1…4
    data = b"".join(struct.pack("<Bd", number << 3 | 1, x) for number, x in values.items())
    foreign.writer.add_message(channel, 5 * 10**8, data, 0)
    foreign.close()
    assert read_log(path).rows(Probe).tolist() == [(0.5, -0.25, 800.0, 1.5)]


def one_field_file(name, **fields):
    """Descriptors of a message whose fields have these (type, label)."""
    file = FileDescriptorProto(name=f"{name}.proto", syntax="proto3")
    message = file.message_type.add(name=name)
    for number, (field, (kind, label)) in enumerate(fields.items(), start=1):
        message.field.add(name=field, number=number, type=kind, label=label)
    return FileDescriptorSet(file=[file]).SerializeToString()


DOUBLE, FLOAT, INT32, STRING = 1, 2, 5, 9
ONE, MANY = 1, 3


def test_a_foreign_log_without_times_and_with_fewer_fields(tmp_path):
    """t_s comes from the log times; what is not there is NaN; other types are converted."""
    path = tmp_path / "real.mcap"
    foreign = Foreign(path)
    descriptors = one_field_file(
        "P", p_WB=(FLOAT, MANY), note=(STRING, ONE), count=(INT32, ONE), q_WB=(DOUBLE, MANY)
    )
    foreign.declare(Pose.topic, "P", descriptors)
    epoch = 1_700_000_000_000_000_000
    for k in (0, 2, 1):  # out of order, as recorders may write
        foreign.message(
            Pose.topic, epoch + k * 10**7, p_WB=[k, 0.5, 2.0], note="x", count=k, q_WB=[1, 0, 0, 0]
        )
    foreign.declare(Estimate.topic, "E", one_field_file("E", p_WB=(DOUBLE, MANY)))
    foreign.message(Estimate.topic, epoch + 10**9, p_WB=[1.0, 2.0, 3.0])
    foreign.declare(Command.topic, "C", one_field_file("C", wrench_B=(DOUBLE, MANY)))
    foreign.message(Command.topic, epoch, wrench_B=[1.0] * 6)
    foreign.close()
    log = read_log(path)
    poses = log.rows(Pose)
    assert poses["t_s"] == pytest.approx([0.0, 0.01, 0.02], abs=1e-12)
    assert poses["p_WB"].tolist() == [[k, 0.5, 2.0] for k in range(3)]
    assert log.channels[Pose.topic]["count"].tolist() == [0.0, 1.0, 2.0]
    estimate = log.rows(Estimate)
    assert estimate["t_s"] == pytest.approx([1.0])
    assert estimate["p_WB"].tolist() == [[1.0, 2.0, 3.0]]
    assert np.isnan(estimate["sigma"]).all()
    assert estimate["sigma"].shape == (1, 15)
    assert log.rows(Command)["rotor_thrust"].shape == (1, 0)


def test_a_foreign_log_in_json(tmp_path):
    path = tmp_path / "real.mcap"
    with path.open("wb") as stream:
        writer = Writer(stream)
        writer.start()
        channel = writer.register_channel(Imu.topic, "json", 0)
        for k in range(3):
            fields = {"t_s": k * 0.004, "f_B": [0.0, None, 9.81], "w_B": [k, 0, 0], "note": "x"}
            writer.add_message(channel, k * 4_000_000, json.dumps(fields).encode(), 0)
        writer.add_metadata("outcome", {"status": "completed", "reason": ""})
        writer.finish()
    imu = read_log(path).rows(Imu)
    assert imu["t_s"].tolist() == [0.0, 0.004, 0.008]
    assert imu["w_B"].tolist() == [[k, 0.0, 0.0] for k in range(3)]
    assert np.isnan(imu["f_B"][:, 1]).all()


@pytest.mark.parametrize(
    ("topic", "what"),
    [(Probe.topic, "potential on /sensor/probe.*same shape"), ("/my/own", None)],
)
def test_messages_of_changing_shape(tmp_path, topic, what):
    """Refused on a channel that metrics read; left out on any other."""
    path = tmp_path / "real.mcap"
    foreign = Foreign(path)
    foreign.declare(topic, "P", one_field_file("P", potential=(DOUBLE, MANY)))
    foreign.message(topic, 0, potential=[1.0])
    foreign.message(topic, 1, potential=[1.0, 2.0])
    foreign.close()
    if what is None:
        assert read_log(path).channels == {}
        return
    with pytest.raises(LogError, match=what):
        read_log(path)


def test_a_field_of_another_shape_is_refused(tmp_path):
    path = tmp_path / "real.mcap"
    foreign = Foreign(path)
    foreign.declare(Reading.topic, "R", one_field_file("R", p_WT=(DOUBLE, MANY)))
    foreign.message(Reading.topic, 0, p_WT=[1.0, 2.0])
    foreign.close()
    with pytest.raises(LogError, match=r"p_WT on /reading has the shape \(2,\), not \(3,\)"):
        read_log(path).rows(Reading)


def test_two_channels_with_one_topic(tmp_path):
    path = tmp_path / "real.mcap"
    foreign = Foreign(path)
    for name in ("A", "B"):
        foreign.declare(Probe.topic, name, one_field_file(name, force=(DOUBLE, ONE)))
        foreign.message(Probe.topic, 0, force=1.0)
    foreign.close()
    with pytest.raises(LogError, match="two channels have the topic /sensor/probe"):
        read_log(path)


def test_a_log_that_does_not_say_how_it_ended(tmp_path):
    path = tmp_path / "real.mcap"
    Foreign(path).close(status=None)
    log = read_log(path)
    assert (log.status, log.status_reason) == (
        "interrupted",
        "the log does not say how the flight ended",
    )


def test_an_outcome_that_is_none(tmp_path):
    path = tmp_path / "real.mcap"
    Foreign(path).close(status="fine")
    with pytest.raises(LogError, match="status is 'fine'; it must be one of: completed"):
        read_log(path)


def test_clouds_in_other_frames_are_left_out(tmp_path):
    path = tmp_path / "real.mcap"
    with LogWriter(path, [], {}) as log:
        log.point_cloud("/tof/points", 0.0, np.zeros((2, 3)))
        other = PointCloud(frame_id="D", point_stride=12, data=bytes(24))
        log._log_message("/tof/points", 1, other, PointCloud)
        log.close("completed", "")
    assert len(read_log(path).points) == 1


def test_a_malformed_cloud(tmp_path):
    path = tmp_path / "real.mcap"
    with LogWriter(path, [], {}) as log:
        bad = PointCloud(frame_id="W", point_stride=12, data=bytes(25))
        for k, axis in enumerate("xyz"):
            bad.fields.add(name=axis, offset=4 * k, type=7)
        log._log_message("/tof/points", 1, bad, PointCloud)
        log.close("completed", "")
    with pytest.raises(LogError, match="malformed"):
        read_log(path)
