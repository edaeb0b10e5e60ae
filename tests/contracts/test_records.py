"""What every declaration of a record keeps to."""

from __future__ import annotations

import re

import numpy as np
import pytest

from inspect_cli.records import CORE_RECORDS, Record

LENGTHS = {"n_rotors": 8, "n_joints": 5, "n_servos": 4, "n_drives": 1, "n_arm": 2}
FRAMES = {"", "W", "B", "S"}
FRAME_IN_NAME = re.compile(r"_(?P<frame>[WBS])$")
"""p_WB is expressed in W, v_WB_W in W, w_WB_B and wrench_B in B; see ``inspect_cli.spatial``."""
UNITS = {
    "s", "m", "1", "m/s", "rad/s", "m/s²", "rad/s²", "N", "N·m", "rad", "V", "Ω", "Ω·m",
}  # fmt: skip


def declarations() -> list[object]:
    return [
        pytest.param(record, field, id=f"{record.__name__}.{field.name}")
        for record in CORE_RECORDS
        for field in record.fields()
    ]


@pytest.mark.parametrize("record", CORE_RECORDS)
def test_its_layout_is_packed_and_begins_with_the_time(record: type[Record]) -> None:
    dtype = record.dtype(LENGTHS)
    numbers = sum(np.prod(field.resolved_shape(LENGTHS), dtype=int) for field in record.fields())
    assert dtype.itemsize == 8 * numbers
    assert dtype.names is not None
    assert dtype.names[0] == "t_s"
    assert record.__doc__


def test_topics_are_different() -> None:
    topics = [record.topic for record in CORE_RECORDS]
    assert len(set(topics)) == len(topics)
    assert all(re.fullmatch(r"(/[a-z_]+)+", topic) for topic in topics)


@pytest.mark.parametrize(("record", "field"), declarations())
def test_its_fields_state_unit_frame_and_meaning(record, field) -> None:
    assert field.frame in FRAMES
    assert set(field.unit.split(", ")) <= UNITS
    assert field.meaning
    assert not field.meaning.endswith(".")
    assert all(length in LENGTHS for length in field.shape if isinstance(length, str))
    in_name = FRAME_IN_NAME.search(field.name)
    if in_name and not field.name.startswith(("p_", "q_")):
        assert in_name["frame"] == field.frame
    if re.fullmatch(r"[pq]_W[A-Z]", field.name):
        assert field.frame == "W"


@pytest.mark.parametrize("record", CORE_RECORDS)
def test_what_is_written_by_name_is_read_by_name(record: type[Record]) -> None:
    rng = np.random.default_rng(1)
    row = record.create(LENGTHS)
    values = {f.name: rng.normal(size=f.resolved_shape(LENGTHS)) for f in record.fields()}
    for name, value in values.items():
        setattr(row, name, value)
    for name, value in values.items():
        assert np.array_equal(getattr(row, name), value)
        assert np.array_equal(row.array[name][0], value)
