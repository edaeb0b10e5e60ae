"""A chapter from an installed package stands in the report like one of the package's own."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from example_flights import Flight
from experiment_flights import force_evaluation, hold
from report_pages import Reported

from inspect_cli.errors import EnvironmentFault
from inspect_cli.reporting.chapters.registry import CHAPTERS, chapters

Report = Callable[[Flight], Reported]

MODULE = """
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.content.blocks import Box, Paragraph
from inspect_cli.reporting.content.metrics_table import metrics_table

CHAPTER = Chapter(
    heading="Battery",
    applies=lambda material: bool(material.profile.poses),
    blocks=lambda material: [
        Paragraph(f"Flown on one battery: {material.result.mission}."),
        *metrics_table("Energy.", material.result, ("actuators",)),
    ],
    subjects=lambda material: ["battery test"],
    sentences=lambda material: ["The battery held."],
    boxes=lambda material: [Box("cells", "6")],
    caveats=lambda material: ["Batteries age."],
    metric_groups=("actuators",),
)
"""


@pytest.fixture
def battery(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    """A package as an installer leaves it, with one chapter."""
    (tmp_path / "battery_chapter.py").write_text(MODULE)
    metadata = tmp_path / "battery_chapter-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: battery_chapter\n")
    row = "[inspect_cli.chapters]\nbattery = battery_chapter:CHAPTER\n"
    (metadata / "entry_points.txt").write_text(row)
    monkeypatch.syspath_prepend(tmp_path)


def _sections(reported: Reported) -> list[str]:
    return [str(a["id"]) for tag, a in reported.page.tags if tag == "section"]


@pytest.mark.usefixtures("battery")
def test_every_part_of_an_installed_chapter_is_in_the_report(
    report: Report, platform_file: Path
) -> None:
    reported = report(hold(platform_file))
    text = reported.page.text
    before, after = ["summary", "pulls"], ["flight", "structure", "provenance"]
    assert _sections(reported) == [*before, "battery", *after]
    assert "Flight report · rope pulls in free flight, battery test" in text
    assert "The battery held." in text
    assert "Batteries age." in text
    assert "Flown on one battery: " in text
    shown = [name for name in reported.result.metrics if name.startswith("actuators.")]
    assert shown
    for name in shown:  # in the chapter's table, and not again among those of the flight
        assert text.count(name) == 1, name


@pytest.mark.usefixtures("battery")
def test_a_chapter_that_does_not_apply_leaves_no_trace(report: Report, platform_file: Path) -> None:
    reported = report(force_evaluation(platform_file))
    assert "battery" not in _sections(reported)
    assert "The battery held." not in reported.page.text
    assert "actuators." not in reported.page.text


def test_chapters_on_the_mission_come_before_those_of_every_flight() -> None:
    assert list(chapters()) == list(CHAPTERS)
    assert list(CHAPTERS)[-3:] == ["flight", "structure", "provenance"]


def test_a_chapter_under_a_name_that_is_taken_is_refused(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    metadata = tmp_path / "another-1.0.dist-info"
    metadata.mkdir()
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: another\n")
    (metadata / "entry_points.txt").write_text("[inspect_cli.chapters]\npulls = os:name\n")
    monkeypatch.syspath_prepend(tmp_path)
    with pytest.raises(EnvironmentFault, match="package another registers 'pulls'"):
        chapters()
