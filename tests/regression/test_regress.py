"""Verdicts of whole regressions over fake flights."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import pytest
from fake_flights import Campaign, fly

from inspect_cli.commands.regress import RegressOutcome, regress
from inspect_cli.errors import InputError
from inspect_cli.regression.flights import FlightEnd
from inspect_cli.regression.outcome import FlightReport

FORCE = {"metric": "contact.force_mean_n", "min": 1.44, "max": 2.16}


def run(campaign: Campaign, paths: list[Path] | None = None, **options: Any) -> RegressOutcome:
    options = {"environment": {}, "fly": fly} | options
    return regress(paths or [], campaign=campaign.root, **options)


def only(outcome: RegressOutcome) -> FlightReport:
    (flight,) = outcome.report.missions
    return flight


def test_a_mission_that_repeats_its_reference_passes(campaign: Campaign) -> None:
    campaign.mission("wall", seeds=[1, 2], acceptance=[FORCE])
    run(campaign, update=True)
    outcome = run(campaign)
    report = outcome.report
    assert [(f.mission, f.seed, f.verdict) for f in report.missions] == [
        ("wall", 1, "pass"),
        ("wall", 2, "pass"),
    ]
    assert (report.passed, report.failed, report.known) == (2, 0, 0)
    assert outcome.exit_code == 0


def test_json_has_the_documented_shape(campaign: Campaign) -> None:
    campaign.mission("wall", acceptance=[FORCE])
    data = json.loads(run(campaign, update=True).report.model_dump_json(by_alias=True))
    assert data.keys() == {"missions", "passed", "failed", "known"}
    flight = data["missions"][0]
    assert {"mission", "platform", "seed", "verdict", "checks", "changes"} <= flight.keys()
    assert flight["checks"][0]["verdict"] == "pass"


def test_a_tampered_metric_is_found_with_its_amount(campaign: Campaign) -> None:
    campaign.mission("wall")
    run(campaign, update=True)
    campaign.tell("wall", metrics={"contact.force_mean_n": 2.0})
    outcome = run(campaign)
    flight = only(outcome)
    assert (flight.verdict, outcome.exit_code) == ("fail", 1)
    (change,) = flight.changes
    assert (change.metric, change.reference, change.value) == ("contact.force_mean_n", 1.8, 2.0)
    assert change.difference == pytest.approx(0.2)
    assert change.relative == pytest.approx(1 / 9)
    assert "1.8 → 2 N, by +0.2 (+11.1%)" in change.what
    assert any("contact.force_mean_n" in reason for reason in flight.reasons)


def test_a_change_within_tolerance_is_none(campaign: Campaign) -> None:
    campaign.mission("wall")
    run(campaign, update=True)
    campaign.tell("wall", metrics={"contact.force_mean_n": 1.84})
    assert only(run(campaign)).changes == ()


@pytest.mark.parametrize(
    ("metrics", "what"),
    [
        ({"contact.points_valid": 8.0}, "9 → 8"),
        ({"contact.force_peak_n": None}, "not measured any more: it was lost"),
        ({"contact.bounce_gaps": 0.0}, "is new"),
    ],
)
def test_counts_gaps_and_new_metrics_are_changes(
    campaign: Campaign, metrics: dict[str, float], what: str
) -> None:
    campaign.mission("wall")
    run(campaign, update=True)
    campaign.tell("wall", metrics=metrics)
    flight = only(run(campaign))
    assert flight.verdict == "fail"
    assert [what in change.what for change in flight.changes] == [True]


def test_a_vanished_metric_is_a_change(campaign: Campaign) -> None:
    campaign.mission("wall")
    campaign.tell("wall", metrics={"contact.bounce_gaps": 0.0})
    run(campaign, update=True)
    campaign.tell("wall")
    assert [change.what for change in only(run(campaign)).changes] == ["is gone"]


def test_a_missing_reference_fails_unless_it_is_being_written(campaign: Campaign) -> None:
    campaign.mission("wall")
    flight = only(run(campaign))
    assert flight.verdict == "fail"
    assert "--update" in flight.reasons[0]
    assert only(run(campaign, update=True)).verdict == "pass"


def test_a_damaged_reference_fails_its_flight_alone(campaign: Campaign) -> None:
    campaign.mission("one")
    campaign.mission("two")
    run(campaign, update=True)
    campaign.reference("one").write_text("{")
    assert [f.verdict for f in run(campaign).report.missions] == ["fail", "pass"]
    run(campaign, update=True)
    assert run(campaign).exit_code == 0


def test_a_failed_check_fails_even_when_the_reference_agrees(campaign: Campaign) -> None:
    campaign.mission("wall", acceptance=[FORCE | {"min": 2.0}])
    run(campaign, update=True)
    flight = only(run(campaign))
    assert flight.verdict == "fail"
    assert flight.reasons == (
        "contact.force_mean_n is 1.8 N, asked for at least 2 and at most 2.16 N",
    )


def test_an_unmeasured_check_fails(campaign: Campaign) -> None:
    campaign.mission("wall", acceptance=[{"metric": "contact.force_maen_n", "max": 1.0}])
    run(campaign, update=True)
    flight = only(run(campaign))
    assert flight.checks[0].verdict == "not_measured"
    assert "did you mean 'contact.force_mean_n'" in flight.reasons[0]


def test_known_failures_are_counted_apart(campaign: Campaign) -> None:
    entry = FORCE | {"min": 2.0, "known_failure": "the arm bends"}
    campaign.mission("wall", acceptance=[entry])
    run(campaign, update=True)
    outcome = run(campaign)
    report = outcome.report
    assert (report.passed, report.failed, report.known) == (0, 0, 1)
    assert only(outcome).verdict == "fail-known"
    assert outcome.exit_code == 0


def test_status_must_be_the_expected_one(campaign: Campaign) -> None:
    campaign.mission("gone", expect_status="aborted")
    campaign.mission("wall")
    for name in ("gone", "wall"):
        campaign.tell(name, status="aborted", reason="no surface")
    outcome = run(campaign, update=True)
    gone, wall = outcome.report.missions
    assert (gone.verdict, wall.verdict) == ("pass", "fail")
    assert wall.reasons == ("the flight was aborted (no surface), expected completed",)
    assert outcome.updated == (campaign.reference("gone"),)
    assert not campaign.reference("wall").exists()


@pytest.mark.parametrize("jobs", [1, 2])
def test_a_crash_fails_its_own_flight_alone(campaign: Campaign, jobs: int) -> None:
    for name in ("a", "b", "c"):
        campaign.mission(name)
    campaign.tell("a", **{"raise": "boom"})
    campaign.tell("b", refuse=["point 3 cannot be reached", "point 4 neither"])
    a, b, c = run(campaign, update=True, jobs=jobs).report.missions
    assert (a.verdict, b.verdict, c.verdict) == ("fail", "fail", "pass")
    assert "RuntimeError: boom" in a.reasons[0]
    assert "fake_flights.py" in a.details
    assert "point 3 cannot be reached\npoint 4 neither" in b.reasons[0]
    assert (a.status, b.status, b.details) == (None, None, "")


def test_a_dying_worker_takes_no_other_flight_with_it(campaign: Campaign) -> None:
    for name in ("a", "b", "c"):
        campaign.mission(name)
    campaign.tell("b", die=True)
    report = run(campaign, update=True, jobs=2).report
    assert [f.verdict for f in report.missions] == ["pass", "fail", "pass"]
    assert "died" in report.missions[1].reasons[0]


def test_parallel_and_serial_agree_in_a_fixed_order(campaign: Campaign) -> None:
    for name in ("b", "a", "c"):
        campaign.mission(name, seeds=[3, 1])
    files = [campaign.root / "missions" / f"{name}.yaml" for name in ("c", "a", "b", "a")]
    serial = run(campaign, files, update=True).report
    parallel = run(campaign, jobs=3).report
    order = [(f.mission, f.seed) for f in parallel.missions]
    assert order == [(name, seed) for name in ("a", "b", "c") for seed in (1, 3)]
    assert [(f.mission, f.seed, f.verdict) for f in serial.missions] == [
        (f.mission, f.seed, f.verdict) for f in parallel.missions
    ]


def test_progress_is_told_of_every_flight(campaign: Campaign) -> None:
    campaign.mission("wall", seeds=[1, 2, 3])
    told: list[tuple[int, int, int]] = []

    def progress(done: int, total: int, end: FlightEnd) -> None:
        told.append((done, total, end.task.seed))

    run(campaign, progress=progress)
    assert told == [(1, 3, 1), (2, 3, 2), (3, 3, 3)]


def test_out_moves_the_runs(campaign: Campaign, tmp_path: Path) -> None:
    campaign.mission("wall", seeds=[7])
    flight = only(run(campaign, out=tmp_path / "runs"))
    assert flight.folder == str(tmp_path / "runs" / "wall" / "tilt_rotor_hexarotor-seed7")


PULL = {
    "metric": "contact.force_mean_n",
    "min": 1.5,
    "over": {"mission": "first", "metric": "contact.force_mean_n"},
}


def test_over_flies_the_other_mission_at_the_same_seeds(campaign: Campaign) -> None:
    campaign.mission("first", seeds=[1])
    second = campaign.mission("second", seeds=[1, 5], acceptance=[PULL])
    campaign.tell("second", metrics={"contact.force_mean_n": 3.6})
    campaign.tell("first", seeds={"5": {"contact.force_mean_n": 3.0}})
    report = run(campaign, [second], update=True).report
    assert sorted(campaign.flown()) == [("first", 1), ("first", 5), ("second", 1), ("second", 5)]
    checks = [f.checks[0] for f in report.missions if f.mission == "second"]
    assert [(c.value, c.verdict) for c in checks] == [(2.0, "pass"), (1.2, "fail")]
    assert checks[0].over == "first:contact.force_mean_n"


def test_over_an_unknown_or_crashed_mission_is_not_measured(campaign: Campaign) -> None:
    campaign.mission("second", acceptance=[PULL])
    assert only(run(campaign, update=True)).checks[0].verdict == "not_measured"
    campaign.mission("first")
    campaign.tell("first", **{"raise": "boom"})
    first, second = run(campaign, update=True).report.missions
    assert (first.verdict, second.verdict) == ("fail", "fail")
    assert second.checks[0].verdict == "not_measured"


def test_what_is_not_there_is_refused_before_anything_flies(campaign: Campaign) -> None:
    good = campaign.mission("good")
    with pytest.raises(InputError, match=r"nothing\.yaml"):
        run(campaign, [good, campaign.root / "nothing.yaml"])
    empty = campaign.root / "empty"
    empty.mkdir()
    with pytest.raises(InputError, match="no mission"):
        run(campaign, [empty])
    with pytest.raises(InputError, match="--jobs"):
        run(campaign, jobs=0)
    assert campaign.flown() == []


def test_all_broken_missions_are_named_at_once(campaign: Campaign) -> None:
    campaign.mission("good")
    campaign.mission("one", seeds=[-1])
    campaign.mission("two", colour="red")
    with pytest.raises(InputError) as refused:
        run(campaign)
    assert {"one.yaml", "two.yaml"} == {
        Path(problem.where.file).name for problem in refused.value.problems if problem.where
    }
    assert campaign.flown() == []


def test_two_missions_of_one_name_are_refused(campaign: Campaign) -> None:
    path = campaign.mission("wall")
    path.with_name("copy.yaml").write_text(path.read_text())
    with pytest.raises(InputError, match="both named 'wall'"):
        run(campaign)
