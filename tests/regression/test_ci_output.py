"""JUnit XML and GitHub's formats, also with names and messages that want to break them."""

from __future__ import annotations

from pathlib import Path
from typing import Any
from xml.etree import ElementTree

from fake_flights import Campaign, fly

from inspect_cli.commands.regress import RegressOutcome, regress
from inspect_cli.regression.github import annotation_lines, step_summary
from inspect_cli.regression.junit import junit_xml
from inspect_cli.regression.outcome import FlightReport, RegressReport

FORCE = {"metric": "contact.force_mean_n", "min": 2.0}


def three_flights(campaign: Campaign, **options: Any) -> RegressOutcome:
    """One passes, one fails a check, one crashes with an ugly message, one fails as declared."""
    campaign.mission("a-pass")
    campaign.mission("b-fail", acceptance=[FORCE])
    campaign.mission("c-crash")
    campaign.mission("d-known", acceptance=[FORCE | {"known_failure": "50 % <too> weak"}])
    campaign.tell("c-crash", **{"raise": "<&>'\"]]>\x1b[31m\x00 100 %\nsecond | line"})
    return regress([], campaign=campaign.root, fly=fly, update=True, **options)


def test_junit_is_well_formed_and_counts(campaign: Campaign, tmp_path: Path) -> None:
    path = tmp_path / "new" / "junit.xml"
    three_flights(campaign, junit=path, environment={})
    suite = ElementTree.fromstring(path.read_bytes()).find("testsuite")
    assert suite is not None
    counts = {name: suite.get(name) for name in ("tests", "failures", "errors", "skipped")}
    assert counts == {"tests": "4", "failures": "1", "errors": "1", "skipped": "1"}
    cases = suite.findall("testcase")
    assert [(c.get("classname"), c.get("name")) for c in cases] == [
        (name, "tilt_rotor_hexarotor-seed1") for name in ("a-pass", "b-fail", "c-crash", "d-known")
    ]
    assert [[child.tag for child in case] for case in cases] == [
        [],
        ["failure"],
        ["error"],
        ["skipped"],
    ]
    crash = cases[2][0]
    assert "<&>'\"]]>\ufffd[31m\ufffd 100 %" in (crash.text or "")
    assert "<too> weak" in (cases[3][0].get("message") or "")


def test_junit_of_hostile_names() -> None:
    flight = FlightReport(
        mission="<\"&'>\x07",
        platform="]]>\ud800",
        seed=1,
        verdict="fail",
        status="completed",
        reasons=("",),
        checks=(),
        changes=(),
        wall_s=0.0,
        folder=None,
    )
    suites = ElementTree.fromstring(junit_xml(RegressReport.of((flight,))).encode())
    case = suites.find("testsuite/testcase")
    assert case is not None
    assert case.get("classname") == "<\"&'>\ufffd"


def test_annotations_are_escaped(campaign: Campaign) -> None:
    lines = three_flights(campaign, environment={"GITHUB_ACTIONS": "true"}).annotations
    assert len(lines) == 3
    assert all("\n" not in line and "\r" not in line for line in lines)
    fail, crash, known = lines
    assert fail.startswith("::error title=b-fail%2C tilt_rotor_hexarotor%2C seed 1::contact.force")
    assert "100 %25%0Asecond | line" in crash
    assert known.startswith("::notice title=d-known")
    assert "50 %25 <too> weak" in known


def test_outside_github_nothing_is_annotated(campaign: Campaign, tmp_path: Path) -> None:
    summary = tmp_path / "summary.md"
    outcome = three_flights(campaign, environment={"GITHUB_STEP_SUMMARY": str(summary)})
    assert outcome.annotations == ()
    assert not summary.exists()
    assert len(annotation_lines(outcome.report)) == 3


def test_step_summary_is_appended(campaign: Campaign, tmp_path: Path) -> None:
    summary = tmp_path / "summary.md"
    summary.write_text("earlier step\n")
    environment = {"GITHUB_ACTIONS": "true", "GITHUB_STEP_SUMMARY": str(summary)}
    report = three_flights(campaign, environment=environment).report
    text = summary.read_text()
    assert text == "earlier step\n" + step_summary(report)
    assert "1 passed, 2 failed, 1 fail as declared" in text
    table = [line for line in text.splitlines() if line.startswith("|")]
    assert len(table) == 2 + 4
    assert all(line.count("|") - line.count("\\|") == 8 for line in table)
    assert "&lt;too> weak" in text
