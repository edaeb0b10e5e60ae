"""A survey from its plan to its report: sorties in folders of their own, refined, joined."""

from __future__ import annotations

import csv
import json
import re
import shutil
from pathlib import Path

import pytest

from inspect_cli.cli import run
from inspect_cli.commands.fly import FlyOutcome, fly
from inspect_cli.commands.plan import plan
from inspect_cli.commands.regress import regress
from inspect_cli.commands.report import report
from inspect_cli.errors import InputError, LogError
from inspect_cli.log.reader import read_log
from inspect_cli.schema.coverage import CoveragePlan

TWO = """\
schema: 1
extends: wall_coverage.yaml
name: two
structure:
  - name: wall
    surface:
      shape: {kind: plane, center_m: [1.8, 0, 1.2], normal: [-1, 0, 0], size_m: [1.0, 0.5]}
tasks:
  - coverage: {on: wall, pitch_m: 0.5, dwell_s: 2, reserve: 0.94}
acceptance:
  - {metric: contact.points_valid, min: 2}
"""
"""A point for each of two sorties: 7 of the battery's 117 Wh may be used."""


@pytest.fixture(scope="module")
def campaign(tmp_path_factory: pytest.TempPathFactory, root: Path) -> Path:
    folder = tmp_path_factory.mktemp("campaign")
    (folder / "missions").mkdir()
    shutil.copytree(root / "platforms", folder / "platforms")
    shutil.copy(root / "missions" / "wall_coverage.yaml", folder / "missions")
    (folder / "missions" / "two.yaml").write_text(TWO)
    return folder


@pytest.fixture(scope="module")
def flown(campaign: Path) -> FlyOutcome:
    """The survey of the wall, flown from its saved plan."""
    made = plan(campaign / "missions" / "wall_coverage.yaml")
    return fly(made.file)


@pytest.fixture(scope="module")
def reported(flown: FlyOutcome) -> Path:
    (outcome,) = report([flown.folder])
    assert outcome.result == flown.result
    return outcome.page


def survey_in(folder: Path) -> CoveragePlan:
    return CoveragePlan.model_validate_json((folder / "plan.json").read_bytes())


def test_all_points_of_all_sorties_are_in_one_result(flown: FlyOutcome) -> None:
    result = flown.result
    assert result.passed
    assert result.seed == 1
    assert [point.index for point in result.points] == list(range(13))
    survey = survey_in(flown.folder)
    assert [point.label for point in result.points] == [
        target.label for sortie in survey.sorties for target in sortie.plan.targets
    ]
    assert [point.label for point in survey.skipped] == ["9"]
    assert flown.ending.flight_s > result.metrics["flight.duration_s"].value


def test_each_sortie_is_a_run_of_its_own(flown: FlyOutcome) -> None:
    survey = survey_in(flown.folder)
    seeds = set()
    for sortie in survey.sorties:
        folder = flown.folder / sortie.folder
        names = {"flight.mcap", "metrics.json", "plan.json", "timing.json"}
        assert names <= {file.name for file in folder.iterdir()}
        log = read_log(folder / "flight.mcap")
        assert log.status == "completed"
        assert log.plan() == sortie.plan
        seeds.add(log.seed)
    assert len(seeds) == len(survey.sorties) == 3
    assert not (flown.folder / "flight.mcap").exists()


def test_points_are_added_where_neighbours_differ(flown: FlyOutcome) -> None:
    """Point 4 stands on the only active spot: between it and its two neighbours."""
    added = [sortie for sortie in survey_in(flown.folder).sorties if sortie.added]
    assert len(added) == 1
    targets = {target.label: target.uv_m for target in added[0].plan.targets}
    assert targets == {"4-3": (0.25, 0.25), "8-4": (0.375, 0.125)}


def test_planned_and_flown_energy_agree(flown: FlyOutcome) -> None:
    """Two models: momentum theory at rest, and the moments of rotors at their true speeds."""
    ratio = flown.result.metrics["flight.energy_planned_over_flown"].value
    assert 0.9 <= ratio <= 1.1
    each = [
        json.loads((flown.folder / sortie.folder / "metrics.json").read_bytes())["metrics"]
        for sortie in survey_in(flown.folder).sorties
    ]
    flown_wh = sum(metrics["flight.energy_wh_flown"]["value"] for metrics in each)
    assert flown.result.metrics["flight.energy_wh_flown"].value == pytest.approx(flown_wh)


def test_the_report_joins_the_sorties(flown: FlyOutcome, reported: Path) -> None:
    page = reported.read_text(encoding="utf-8")
    for k in (1, 2, 3):
        assert f'href="sortie-{k}/report.html"' in page
        assert (flown.folder / f"sortie-{k}" / "report.html").is_file()
    assert "added by the refinement rule" in page
    assert "kept out: 0.000 m from (-0.38, -0.25), radius_m is 0.1" in page
    with (flown.folder / "readings.csv").open(encoding="utf-8") as file:
        rows = list(csv.DictReader(file))
    assert len(rows) == 13
    assert {row["surface"] for row in rows} == {"wall"}


def test_one_sortie_is_reported_alone(flown: FlyOutcome, tmp_path: Path) -> None:
    (outcome,) = report([flown.folder / "sortie-2"], tmp_path)
    assert len(outcome.result.points) == 5
    assert outcome.page == tmp_path / "report.html"


def test_a_killed_survey_keeps_its_finished_sorties(flown: FlyOutcome, tmp_path: Path) -> None:
    killed = tmp_path / "killed"
    shutil.copytree(flown.folder, killed, ignore=shutil.ignore_patterns("sortie-2", "sortie-3"))
    (outcome,) = report([killed])
    result = outcome.result
    assert result.status == "interrupted"
    assert result.status_reason == "only the first sortie was flown"
    assert sum(point.valid for point in result.points) == 6
    assert [point.reason for point in result.points[6:]] == ["not visited"] * 7
    shutil.rmtree(killed / "sortie-1")
    with pytest.raises(InputError, match="holds no flown sortie"):
        report([killed])


def test_a_damaged_sortie_is_not_taken_for_one_that_was_not_flown(
    flown: FlyOutcome, tmp_path: Path
) -> None:
    run_folder = tmp_path / "damaged"
    shutil.copytree(flown.folder, run_folder)
    log = run_folder / "sortie-2" / "flight.mcap"
    whole = log.read_bytes()
    log.write_bytes(whole[: len(whole) // 2] + bytes(200) + whole[len(whole) // 2 + 200 :])
    with pytest.raises(LogError, match="sortie-2"):
        report([run_folder])
    log.unlink()
    with pytest.raises(InputError, match=r"sortie-2 has no flight\.mcap, yet sortie-3 was"):
        report([run_folder])


def test_a_sortie_killed_before_its_first_byte_was_not_flown(
    flown: FlyOutcome, tmp_path: Path
) -> None:
    killed = tmp_path / "killed"
    shutil.copytree(flown.folder, killed, ignore=shutil.ignore_patterns("sortie-2", "sortie-3"))
    (killed / "sortie-2").mkdir()
    (killed / "sortie-2" / "flight.mcap.part").write_bytes(b"")
    (outcome,) = report([killed])
    assert outcome.result.status_reason == "only the first sortie was flown"


@pytest.mark.parametrize(
    ("plan_file", "message"),
    [
        ('{"kind": "coverage"}', "plan.json: not the plan of a survey: mission: Field required$"),
        ('{"kind":', "plan.json: the plan of the survey is damaged"),
    ],
)
def test_a_damaged_plan_of_a_survey(
    flown: FlyOutcome, tmp_path: Path, plan_file: str, message: str
) -> None:
    run_folder = tmp_path / "damaged"
    shutil.copytree(flown.folder, run_folder)
    (run_folder / "plan.json").write_text(plan_file)
    with pytest.raises(InputError) as raised:
        report([run_folder])
    assert re.search(message, raised.value.problems[0].what)


def test_the_command_line_prints_the_plan(campaign: Path, capfd: pytest.CaptureFixture) -> None:
    mission = str(campaign / "missions" / "wall_coverage.yaml")
    assert run(["plan", mission]) == 0
    told = capfd.readouterr().err
    assert "11 points in 2 sorties, 1 left out" in told
    assert max(map(len, told.splitlines()[:-1])) <= 80
    assert "left out, point 9: kept out" in told
    assert run(["plan", mission, "--json"]) == 0
    printed = json.loads(capfd.readouterr().out)
    assert (printed["points"], len(printed["sorties"])) == (11, 2)
    assert printed["energy_wh"] == pytest.approx(
        sum(sortie["plan"]["energy_wh"] for sortie in printed["sorties"])
    )


def test_a_plan_of_every_kind_fits_a_terminal(campaign: Path, capfd: pytest.CaptureFixture) -> None:
    tasks = """tasks:
  - hold: {position_m: [0, 0.5, 1.2], duration_s: 1}
  - trace: {on: wall, polyline_m: [[-0.1, 0], [0.1, 0]]}
  - servo: {start: {position_m: [0.3, 0, 1.2]}, slide_m: 0}
"""
    head, rest = TWO.replace("name: two", "name: kinds").split("tasks:\n")
    mission = campaign / "missions" / "kinds.yaml"
    mission.write_text(head + tasks + rest[rest.index("acceptance:") :])
    assert run(["plan", str(mission)]) == 0
    told = capfd.readouterr().err
    assert max(map(len, told.splitlines()[:-1])) <= 80
    (held,) = [line for line in told.splitlines() if " pose " in line]
    assert held.split()[-4:-2] == ["—", "—"]
    assert float(held.split()[-1]) > 0.5


def test_an_aborted_sortie_ends_the_survey(campaign: Path) -> None:
    mission = campaign / "missions" / "lost.yaml"
    faults = "truth: {faults: [{sensor: pose, start_s: 15.0}]}\n"
    mission.write_text(TWO.replace("name: two", "name: lost") + faults)
    outcome = fly(mission)
    result = outcome.result
    assert result.status == "aborted"
    assert result.status_reason.startswith("sortie 1 was aborted: ")
    assert [point.valid for point in result.points] == [False, False]
    assert result.points[1].reason == "not visited"
    assert result.metrics["contact.points_total"].value == 2.0
    assert not (outcome.folder / "sortie-2").exists()


def test_a_new_run_leaves_nothing_of_an_older_one(campaign: Path, tmp_path: Path) -> None:
    """Also where the older one was a survey; what is not ours stays."""
    old = tmp_path / "run" / "sortie-7"
    old.mkdir(parents=True)
    (old / "flight.mcap").write_bytes(b"old")
    other = tmp_path / "run" / "sortie-8"
    other.mkdir()
    (other / "notes.txt").write_text("mine")
    fly(campaign / "missions" / "two.yaml", out=tmp_path / "run")
    assert not old.exists()
    assert (other / "notes.txt").read_text() == "mine"


def test_surveys_are_held_against_references(campaign: Path) -> None:
    mission = campaign / "missions" / "two.yaml"
    updated = regress([mission], update=True, campaign=campaign)
    assert [file.name for file in updated.updated] == ["tilt_rotor_hexarotor-seed1.json"]
    again = regress([mission], campaign=campaign)
    assert again.exit_code == 0
    (flight,) = again.report.missions
    assert flight.verdict == "pass"
    assert flight.changes == ()
