"""readings.csv parses back to what the result holds, and runs nothing in a spreadsheet."""

from __future__ import annotations

import csv
import io
from pathlib import Path

import numpy as np
import pytest
from handed import handed, point
from hypothesis import given
from hypothesis import strategies as st

from inspect_cli.exchange.readings_csv import readings_csv
from inspect_cli.surveys.defusing import defused, undefused
from inspect_cli.surveys.survey import read_survey


def rows_of(text: str) -> list[dict[str, str]]:
    return list(csv.DictReader(io.StringIO(text, newline="")))


def number(text: str) -> float | None:
    return float(text) if text else None


def test_it_parses_back_to_the_points() -> None:
    readings = handed()
    rows = rows_of(readings_csv(readings.points))
    assert list(rows[0])[:8] == ["index", "label", "surface", "u_m", "v_m", "x_m", "y_m", "z_m"]
    for row, each in zip(rows, readings.points, strict=True):
        for name, value in each.model_dump(exclude={"p_W", "uv_m", "valid"}).items():
            read = undefused(row[name]) if isinstance(value, str) else number(row[name])
            assert read == value, name
        assert row["valid"] == ("true" if each.valid else "false")
        assert tuple(number(row[k]) for k in ("x_m", "y_m", "z_m")) == each.p_W
        assert tuple(number(row[k]) for k in ("u_m", "v_m")) == (each.uv_m or (None, None))
    assert [row["surface"] for row in rows] == ["deck", "deck", "soffit", "soffit"]
    assert rows[3]["potential_mv"] == ""


def test_what_another_instrument_read_has_columns_of_its_own() -> None:
    plain = readings_csv([point(0)]).splitlines()[0]
    assert "values" not in plain
    rows = rows_of(readings_csv([point(0), point(1, values={"temperature_c": 12.5})]))
    assert ",".join(rows[0]) == f"{plain},temperature_c"
    assert [row["temperature_c"] for row in rows] == ["", "12.5"]


def test_units_and_instrument_stand_beside_what_was_read() -> None:
    warm = {"instrument": "thermometer", "units": {"temperature": "°C"}}
    read = point(1, values={"temperature": 12.5}, **warm)
    lost = point(2, valid=False, reason="not visited", **warm)
    rows = rows_of(readings_csv([point(0), read, lost]))
    shown = [(row["instrument"], row["temperature"], row["temperature_unit"]) for row in rows]
    assert shown == [("", "", ""), ("thermometer", "12.5", "°C"), ("thermometer", "", "°C")]


@pytest.mark.parametrize("start", ["=1+1", "+1", "-1", "@SUM(A1)", "\t=1", "\r=1", "'=1"])
def test_no_text_runs_as_a_formula(start: str) -> None:
    points = [point(0, label=start, surface=start, valid=False, reason=start, potential_mv=-5.5)]
    row = rows_of(readings_csv(points))[0]
    for name in ("label", "reason", "surface"):
        assert row[name] == f"'{start}".replace("\r", "\n"), name
    assert row["potential_mv"] == "-5.5"  # numbers stay numbers


@given(st.text())
def test_what_was_defused_comes_back(text: str) -> None:
    assert undefused(defused(text)) == text
    assert not defused(text).startswith(("=", "+", "-", "@", "\t", "\r"))


def test_our_own_readings_can_be_read_as_a_survey(tmp_path: Path) -> None:
    readings = handed()
    points = list(readings.points)
    (tmp_path / "readings.csv").write_text(
        readings_csv([p.model_copy(update={"surface": "deck"}) for p in points[:3]]),
        encoding="utf-8",
        newline="",
    )
    survey = read_survey(tmp_path / "readings.csv")
    assert survey.labels == tuple(p.label for p in points[:3])
    assert survey.potential_mv.tolist() == [p.potential_mv for p in points[:3]]
    assert survey.resistivity_ohm_m.tolist() == [p.resistivity_ohm_m for p in points[:3]]
    assert survey.p_W is not None
    np.testing.assert_array_equal(survey.p_W, [p.p_W for p in points[:3]])
    np.testing.assert_array_equal(survey.uv_m, [p.uv_m for p in points[:3]])
    assert "potential_unit" not in survey.assumed


def test_an_invalid_reading_comes_back_as_one(tmp_path: Path) -> None:
    points = [point(0), point(1, label="-7", valid=False, reason="unstable", potential_mv=None)]
    file = tmp_path / "readings.csv"
    file.write_text(readings_csv(points), encoding="utf-8", newline="")
    survey = read_survey(file)
    assert survey.labels == ("P0", "-7")
    assert survey.valid.tolist() == [True, False]
