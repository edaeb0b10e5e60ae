"""The channel table says what a log holds."""

from __future__ import annotations

from logbook import LENGTHS, RECORDS

from inspect_cli.log.channels import channel_table
from inspect_cli.log.reader import read_log
from inspect_cli.records import CORE_RECORDS, State, scalar


def test_every_field_of_a_log_stands_in_the_table(written):
    rows = {(row.topic, row.field): row for row in channel_table()}
    for topic, array in read_log(written.path).channels.items():
        for name in array.dtype.names:
            shape = rows[topic, name].shape
            lengths = [] if shape == "scalar" else shape.split(" × ")
            assert array.dtype[name].shape == tuple(
                int(LENGTHS.get(length, length)) for length in lengths
            )


def test_table_in_words():
    [row] = [r for r in channel_table() if (r.topic, r.field) == ("/truth/state", "joint_rate")]
    assert row == (
        "/truth/state",
        "joint_rate",
        "n_joints",
        "rad/s",
        "",
        "rates of tilt and arm joints",
    )
    assert set(RECORDS) <= set(CORE_RECORDS)
    assert all(row.unit and row.meaning for row in channel_table())


class Winged(State):
    """A platform kind that adds a field."""

    topic = "/truth/winged"

    lift = scalar("N", "lift of the wing")


def test_fields_of_a_platform_kind():
    table = channel_table([Winged])
    assert table[0].field == "t_s"
    assert table[-1] == ("/truth/winged", "lift", "scalar", "N", "", "lift of the wing")
