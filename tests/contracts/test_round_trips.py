"""What is written is read back the same, and each file is enough for the step after it."""

from __future__ import annotations

import shutil
from pathlib import Path
from types import SimpleNamespace

import pytest

from inspect_cli.commands.fly import fly
from inspect_cli.commands.plan import plan
from inspect_cli.commands.report import report
from inspect_cli.log.reader import read_log
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import Plan, PlanFile
from inspect_cli.schema.result import Result

pytestmark = pytest.mark.xdist_group("round_trips")  # one flight for all

MISSION = """\
schema: 1
name: one-point
platform: tilt_rotor_hexarotor
start: {position_m: [1.0, 0.0]}
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [2, 0, 1], normal: [-1, 0, 0], size_m: [2, 2]}}
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.1}
truth:
  structure:
    wall: {specimen: {model: analytic}}
acceptance:
  - {metric: contact.points_valid, min: 1}
"""


@pytest.fixture(scope="module")
def run(tmp_path_factory: pytest.TempPathFactory) -> SimpleNamespace:
    """A mission, its plan and its flight."""
    mission = tmp_path_factory.mktemp("campaign") / "missions" / "one_point.yaml"
    mission.parent.mkdir()
    mission.write_text(MISSION)
    return SimpleNamespace(mission=mission, planned=plan(mission), flown=fly(mission))


def test_a_plan_is_read_as_it_was_made(run: SimpleNamespace) -> None:
    saved = PlanFile.model_validate_json(run.planned.file.read_bytes())
    assert saved.plan() == run.planned.plan
    assert (run.planned.file.parent / saved.mission_file).resolve() == run.mission.resolve()


def test_a_saved_plan_flies_like_its_mission(run: SimpleNamespace, tmp_path: Path) -> None:
    again = fly(run.planned.file, out=tmp_path)
    for name in ("flight.mcap", "plan.json", "metrics.json"):
        assert (again.folder / name).read_bytes() == (run.flown.folder / name).read_bytes()


def test_a_run_is_read_as_it_was_flown(run: SimpleNamespace) -> None:
    folder, result = run.flown.folder, run.flown.result
    assert result.passed
    assert Result.model_validate_json((folder / "metrics.json").read_bytes()) == result
    assert Plan.model_validate_json((folder / "plan.json").read_bytes()) == run.planned.plan


def test_a_log_carries_what_it_was_flown_from(run: SimpleNamespace) -> None:
    log, loaded = read_log(run.flown.folder / "flight.mcap"), load_mission(run.mission)
    assert log.mission() == loaded.mission
    assert log.platform() == loaded.platform
    assert log.truth() == loaded.truth
    assert log.plan() == run.planned.plan
    assert log.seed == loaded.mission.seeds[0]
    assert set(log.versions) >= {"inspect-cli", "mujoco", "numpy", "python"}


def test_a_log_alone_is_enough_for_its_report(run: SimpleNamespace, tmp_path: Path) -> None:
    log = shutil.copy(run.flown.folder / "flight.mcap", tmp_path)
    [reported] = report([Path(log)])
    assert reported.result == run.flown.result
    written = (tmp_path / "metrics.json").read_bytes()
    assert written == (run.flown.folder / "metrics.json").read_bytes()
