"""Readings of an instrument without a chapter of its own, valid and invalid."""

from __future__ import annotations

from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.content.values_table import values_marks, values_table
from inspect_cli.reporting.words.language import language
from inspect_cli.schema.result import PointResult

ENGLISH = language("en")
UNITS = {"thickness": "mm", "echoes": "1"}
VALID = ReadPoint(
    PointResult(
        index=0,
        label="A",
        valid=True,
        reason="",
        p_W=(1.0, 2.0, 3.0),
        surface="hull",
        uv_m=(0.5, 0.25),
        probe_force_n=2.0,
        contact_s=1.5,
        instrument="gauge",
        values={"thickness": 12.345678, "echoes": 3.0},
        units=UNITS,
    ),
    None,
)
INVALID = ReadPoint(
    PointResult(
        index=1,
        label="B <2>",
        valid=False,
        reason="not visited",
        p_W=(1.0, 2.5, 3.0),
        surface="hull",
        uv_m=(0.5, 0.75),
        probe_force_n=None,
        contact_s=0.0,
        instrument="gauge",
        units=UNITS,
    ),
    None,
)


def test_a_table_has_name_value_unit_and_validity() -> None:
    table = values_table("gauge", [VALID, INVALID])
    heads = [(ENGLISH.plain(c.heading), ENGLISH.plain(c.unit)) for c in table.columns]
    assert ("thickness", "mm") in heads
    assert ("echoes", "") in heads
    first, second = (
        dict(zip((name for name, _ in heads), map(ENGLISH.plain, row), strict=True))
        for row in table.rows
    )
    assert (first["thickness"], first["echoes"], first["Validity"]) == ("12.3457", "3", "valid")
    assert (second["thickness"], second["Validity"]) == ("–", "invalid: not visited")
    assert "gauge" in ENGLISH.plain(table.caption)


def test_a_column_stays_away_where_nothing_valid_was_read() -> None:
    table = values_table("gauge", [INVALID])
    assert "thickness" not in [ENGLISH.plain(c.heading) for c in table.columns]


def test_marks_tell_values_and_reasons_and_are_invalid_by_validity_alone() -> None:
    valid, invalid = values_marks("gauge", [VALID, INVALID]).traces
    assert ENGLISH.plain(valid["name"]) == "valid readings of gauge"
    assert [ENGLISH.plain(t) for t in valid["customdata"]] == [
        "A<br>thickness 12.3457 mm<br>echoes 3"
    ]
    assert ENGLISH.plain(invalid["name"]) == "invalid readings of gauge"
    assert [ENGLISH.plain(t) for t in invalid["customdata"]] == ["B &lt;2&gt;: not visited"]
