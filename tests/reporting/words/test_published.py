"""What was published stands beside what was measured, and nowhere else."""

from __future__ import annotations

import re
from collections.abc import Callable
from pathlib import Path

import pytest
import yaml
from example_flights import Flight
from report_pages import Reported

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.reporting.words.language import language
from inspect_cli.reporting.words.published import (
    NUMBERS,
    PUBLISHED,
    TABLE_IV,
    number_of,
    published_of,
)

Fly = Callable[..., Flight]
Report = Callable[[Flight], Reported]


def test_every_row_that_a_mission_names_is_known(root: Path) -> None:
    texts = [file.read_text() for file in sorted((root / "missions").rglob("*.yaml"))]
    refs = {ref for text in texts for ref in re.findall(r"\bref: (A[0-9.a-z]+)", text)}
    assert refs
    assert refs <= PUBLISHED.keys()


def test_rows_are_short_sentences_with_a_place() -> None:
    for ref, row in PUBLISHED.items():
        assert row.section.startswith("V-"), ref
        assert not row.words.endswith(".")
        assert len(row.short) <= 12, ref
    assert {ref[:2] for ref in PUBLISHED} == {f"A{k}" for k in range(1, 10)}
    assert NUMBERS.keys() <= METRICS.keys()
    assert all(METRICS[name].unit == unit for name, (_, _, unit) in TABLE_IV.items())


def test_a_number_answers_a_row_or_one_of_its_metrics() -> None:
    assert number_of("A8.force", "contact.force_mean_min_n") == "1.8 N"
    assert number_of("A9.force", "force_sensor.rmse_fy_n") == "0.91 N"
    assert number_of("A7.slide", "slide.speed_mean_mps") == "0.17 m/s"
    assert number_of("A7.slide", "slide.gaps") == ""
    assert number_of("A5.yaw", "pull.yaw_max_rad") == "0.5 rad"
    assert number_of(None, "slide.speed_mean_mps") == ""
    assert published_of("Z1") is None
    row = PUBLISHED["A9.force"]
    plain = language("en").plain
    assert plain(row.cited("force_sensor.rmse_fy_n")) == "0.91 N (§\u00a0V-F, Table IV)"
    assert plain(row.cited("contact.force_peak_n")).startswith(row.words)


def test_a_number_has_the_unit_of_the_metric_beside_it(root: Path) -> None:
    """0.5 rad of yaw are not beside the torque under which they were measured."""
    seen = 0
    for file in sorted((root / "missions").rglob("*.yaml")):
        for entry in yaml.safe_load(file.read_text()).get("acceptance", []):
            short = number_of(entry.get("ref"), entry["metric"])
            found = re.fullmatch(r"[<≤] ?[0-9.]+ (\S+)|[0-9.]+ (\S+)", short)
            if found and "over" not in entry:
                unit = found[1] or found[2]
                assert unit == METRICS[entry["metric"]].unit, (file.name, entry["metric"])
                seen += 1
    assert seen > 20
    assert number_of("A8.force", "contact.force_peak_n") == ""


@pytest.mark.parametrize("ref", ["A8.force", None])
def test_the_column_is_there_when_a_check_has_a_row(fly: Fly, report: Report, ref: str) -> None:
    check = {"metric": "contact.force_mean_n", "min": 1.44} | ({"ref": ref} if ref else {})
    text = report(fly(acceptance=(check,))).page.text
    assert ("1.8 N in the contact phase, set-point 10 cm behind (§\u00a0V-E)" in text) == bool(ref)
    assert ("PublishedRequired" in text) == bool(ref)
    assert ("Published values are those of another vehicle" in text) == bool(ref)
