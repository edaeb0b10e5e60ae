"""readings.csv parses back to what the result holds."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable

from example_flights import Flight, spoil
from report_pages import Reported

from inspect_cli.records import InvalidReason
from inspect_cli.reporting.readings_csv import readings_csv

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]


def test_it_parses_back_to_the_result(fly: Fly, report: Report) -> None:
    flight = fly(2, 3, words={"label": 'comma, "quote"\nand line'})
    spoil(flight, 2, InvalidReason.UNSTABLE)
    reported = report(flight)
    text = (reported.path.parent / "readings.csv").read_text(encoding="utf-8")
    rows = list(csv.DictReader(io.StringIO(text)))
    assert len(rows) == 6
    for row, point in zip(rows, reported.result.points, strict=True):
        for name, value in point.model_dump(exclude={"p_W", "uv_m", "valid"}).items():
            read = row[name] if isinstance(value, str) else number(row[name])
            assert read == value, name
        assert row["valid"] == ("true" if point.valid else "false")
        assert tuple(number(row[k]) for k in ("x_m", "y_m", "z_m")) == point.p_W
        assert tuple(number(row[k]) for k in ("u_m", "v_m")) == point.uv_m
        assert row["surface"] == "wall"
    assert rows[2]["potential_mv"] == ""
    assert rows[2]["valid"] == "false"


def test_a_flight_without_truth_leaves_its_columns_empty(fly: Fly, report: Report) -> None:
    reported = report(fly(1, 2).without_truth())
    rows = list(csv.DictReader(io.StringIO(readings_csv(reported.result, reported.flight.plan))))
    assert [row["true_force_n"] for row in rows] == ["", ""]
    assert list(rows[0])[:8] == ["index", "label", "surface", "u_m", "v_m", "x_m", "y_m", "z_m"]


def number(text: str) -> float | None:
    return float(text) if text else None
