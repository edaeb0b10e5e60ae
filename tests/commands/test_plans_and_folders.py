"""A saved plan flies what it was made for; a run folder has one writer; reports keep apart."""

from __future__ import annotations

import fcntl
import json
import shutil
from pathlib import Path

import pytest

from inspect_cli.cli import run
from inspect_cli.commands.fly import fly
from inspect_cli.commands.plan import plan, plan_loaded, vehicle_of
from inspect_cli.commands.report import report
from inspect_cli.commands.runs import LOCK_NAME
from inspect_cli.errors import InfeasibleError, InputError, SchemaError
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.tasks import tasks_with

MISSION = """\
schema: 1
name: one
platform: tilt_rotor_hexarotor
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [2, 0, 1.25], normal: [-1, 0, 0], size_m: [3, 2.5]}}
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.1, dwell_s: 2}
"""


@pytest.fixture
def mission(tmp_path: Path, root: Path) -> Path:
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    (tmp_path / "missions").mkdir()
    file = tmp_path / "missions" / "one.yaml"
    file.write_text(MISSION)
    return file


def test_a_plan_of_another_mission_does_not_fly(mission: Path) -> None:
    made = plan(mission)
    mission.write_text(MISSION.replace("dwell_s: 2", "dwell_s: 3"))
    with pytest.raises(InputError, match="has changed since it was planned"):
        fly(made.file)
    mission.write_text(MISSION)
    other = mission.parents[1] / "platforms" / "tilt_rotor_hexarotor_30.yaml"
    with pytest.raises(InputError, match="has changed since it was planned"):
        fly(made.file, platform=other)
    # The truth is no part of a plan.
    mission.write_text(MISSION + "truth: {platform: {mass_factor: 1.05}}\n")
    assert fly(made.file).result.status == "completed"


def test_a_plan_moves_with_its_campaign(mission: Path, tmp_path: Path) -> None:
    made = plan(mission)
    moved = tmp_path / "moved"
    moved.mkdir()
    for name in ("missions", "platforms", "reports"):
        shutil.move(tmp_path / name, moved / name)
    outcome = fly(moved / made.file.relative_to(tmp_path))
    assert outcome.folder.is_relative_to(moved)


@pytest.mark.parametrize(
    ("path", "value", "words"),
    [
        (("targets",), [], "targets"),
        (("legs",), [], "legs"),
        (("legs", 2, "target"), 7, "target 7"),
        (("legs", 0, "postures", 0, "q_WB"), [0, 0, 0, 0], "unit quaternion"),
        (("name",), "more", "name"),
    ],
)
def test_a_plan_that_makes_no_sense_is_refused(
    mission: Path, path: tuple[str | int, ...], value: object, words: str
) -> None:
    file = plan(mission).file
    content = json.loads(file.read_text())
    place = content
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = value
    file.write_text(json.dumps(content))
    with pytest.raises(InputError, match=words) as refused:
        fly(file)
    assert str(file) in str(refused.value)
    assert "http" not in str(refused.value)


def test_the_battery_limits_a_plan(mission: Path) -> None:
    platform = mission.parents[1] / "platforms" / "tilt_rotor_hexarotor.yaml"
    platform.write_text(platform.read_text().replace("energy_wh: 117.0", "energy_wh: 1.0"))
    with pytest.raises(InfeasibleError, match="the battery holds 1 Wh") as refused:
        plan(mission)
    assert str(mission) in str(refused.value)


def test_an_unknown_metric_is_refused_before_the_flight(mission: Path) -> None:
    mission.write_text(MISSION + "acceptance: [{metric: contact.points_vald, min: 1}]\n")
    with pytest.raises(SchemaError, match=r"contact\.points_valid"):
        plan(mission)


def test_a_task_that_the_vehicles_modes_cannot_do_is_refused(mission: Path) -> None:
    loaded = load_mission(mission)
    vehicle = vehicle_of(loaded)
    vehicle.capabilities.tasks = tasks_with({"hold", "slide"})
    with pytest.raises(SchemaError) as refusal:
        plan_loaded(loaded, vehicle)
    (problem,) = refusal.value.problems
    assert problem.what == "tilt_rotor_hexarotor cannot do the task 'contact_grid'"
    assert (problem.where.line, problem.where.path) == (8, "tasks[0].contact_grid")
    assert problem.where.column is not None
    # The platforms of the campaign are built anew, and those are as able as ever.
    can, others = problem.hint.split("; ")
    assert can == "it can do: hold"
    assert others.startswith("platforms that can: ")
    assert "tilt_rotor_hexarotor" in others
    assert tasks_with({"approach", "press", "retreat"}) == {
        "contact_grid", "contact_points", "coverage"
    }  # fmt: skip


def test_a_run_folder_has_one_writer(mission: Path, tmp_path: Path) -> None:
    folder = tmp_path / "run"
    folder.mkdir()
    (folder / "metrics.json").write_text("of the other flight")
    with (folder / LOCK_NAME).open("w") as lock:
        fcntl.flock(lock, fcntl.LOCK_EX)
        with pytest.raises(InputError, match="another flight is writing"):
            fly(mission, out=folder)
    assert (folder / "metrics.json").read_text() == "of the other flight"


def test_a_folder_that_is_a_file_is_refused(mission: Path, tmp_path: Path) -> None:
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written"):
        fly(mission, out=tmp_path / "file")


def test_a_folder_where_a_file_has_to_be_is_refused_first(mission: Path, tmp_path: Path) -> None:
    (tmp_path / "run" / "readings.csv").mkdir(parents=True)
    with pytest.raises(InputError, match=r"readings\.csv is a folder where the flight"):
        fly(mission, out=tmp_path / "run")
    flown = fly(mission, seed=1).folder
    out = tmp_path / "out"
    for name in ("report.html", "report.pdf", "readings.ifc", "film.mp4"):
        (out / name).mkdir(parents=True)
        with pytest.raises(InputError, match="is a folder where the report writes a file"):
            report([flown], out=out)
        assert list(out.iterdir()) == [out / name]
        (out / name).rmdir()


def test_reports_of_several_missions_keep_apart(mission: Path, tmp_path: Path) -> None:
    first = fly(mission, seed=1).folder
    mission.write_text(MISSION.replace("name: one", "name: two"))
    second = fly(mission, seed=1).folder
    pages = {outcome.page for outcome in report([first, second], out=tmp_path / "out")}
    assert pages == {
        tmp_path / "out" / name / "tilt_rotor_hexarotor-seed1" / "report.html"
        for name in ("one", "two")
    }


def test_a_damaged_log_is_refused_and_a_cut_one_is_interrupted(
    mission: Path, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    data = (fly(mission, seed=1).folder / "flight.mcap").read_bytes()
    log = tmp_path / "logs" / "flight.mcap"
    log.parent.mkdir()
    damaged = bytearray(data)
    damaged[len(data) // 2] ^= 0x10
    log.write_bytes(damaged)
    assert run(["report", str(log)]) == 2
    assert "flight.mcap" in capsys.readouterr().err.replace("\n", "")
    assert list(log.parent.iterdir()) == [log]
    log.write_bytes(data[: len(data) // 2])
    assert run(["report", str(log), "--no-pictures"]) == 1
    result = json.loads((log.parent / "metrics.json").read_text())
    assert result["status"] == "interrupted"
