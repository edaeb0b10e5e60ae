"""Studies: which variants there are, what is refused, and what is told of their flights."""

from __future__ import annotations

import dataclasses
import json
import shutil
from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli import cli
from inspect_cli.commands import study as module
from inspect_cli.commands.fly import FlyOutcome
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.commands.study import STUDIES, study
from inspect_cli.commands.study_force import FORCE
from inspect_cli.commands.sweeps import variants
from inspect_cli.errors import InputError
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric, Result
from inspect_cli.schema.study import StudyResult
from inspect_cli.simulation.loop import Ending

MISSION = """\
schema: 1
name: sensed
platform: tilt_rotor_hexarotor_force_evaluation
estimation: onboard
seeds: [7]
flight: {approach_speed_mps: 0.1}
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [1.2, 0, 1.1], normal: [-1, 0, 0], size_m: [2, 2]}}
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.1, dwell_s: 4, standoff_m: 0.15}
    sensor: none
truth: {structure: {wall: {force_sensor: {noise_n: 0.5}}}}
acceptance: [{metric: contact.force_peak_n, max: 10.0}]
"""


@pytest.fixture
def mission(tmp_path: Path, root: Path) -> Path:
    shutil.copytree(root / "platforms", tmp_path / "platforms")
    (tmp_path / "missions").mkdir()
    file = tmp_path / "missions" / "sensed.yaml"
    file.write_text(MISSION)
    return file


class FakeFly:
    """Errors that are (speed / gain); remembers what it was asked to fly."""

    def __init__(self, ends: Callable[[float], str] = lambda gain: "completed") -> None:
        self.flown: list[tuple[Loaded, Plan, int, Path]] = []
        self.ends = ends

    def __call__(self, loaded: Loaded, plan: Plan, *, seed: int, out: Path) -> FlyOutcome:
        self.flown.append((loaded, plan, seed, out))
        gain = loaded.platform.control.observer_gain[0]
        error = loaded.mission.flight.approach_speed_mps / gain
        status = self.ends(gain)
        if status == "crash":
            raise RuntimeError("the gimbal locked")
        result = Result(
            mission=loaded.mission.name,
            platform=loaded.platform.name,
            seed=seed,
            status=status,
            checks=(),
            metrics={name: Metric(value=error, unit=spec.unit) for name, spec in METRICS.items()},
            points=(),
        )
        return FlyOutcome(result, out, Ending(status, "", 1.0, 1.0, 0.0))


@pytest.fixture
def without_logs(monkeypatch: pytest.MonkeyPatch) -> None:
    """The study less what it reads from the logs, which a fake flight does not write."""
    columns = tuple(c for c in FORCE.columns if c.metric not in FORCE.own)
    monkeypatch.setitem(
        module.STUDIES, "force", dataclasses.replace(FORCE, own={}, columns=columns)
    )


def test_each_quantity_is_varied_by_itself_and_files_are_not(mission: Path) -> None:
    loaded = load_mission(mission)
    before = loaded.platform.model_dump_json(), mission.read_text()
    found = variants("force", FORCE, loaded, {})
    assert [variant.name for variant in found] == [
        *(f"gain-{gain}-speed-0.1" for gain in ("0.5", "1", "2", "4")),
        *(f"gain-1-speed-{speed}" for speed in ("0.05", "0.2", "0.4")),
    ]
    for variant in found:
        gain, speed = variant.values["gain"], variant.values["speed"]
        assert variant.loaded.platform.control.observer_gain == (gain, gain, gain)
        assert variant.loaded.mission.flight.approach_speed_mps == speed
        assert variant.loaded.mission.title == f"sensed (K_I = {gain:g} 1/s, v = {speed:g} m/s)"
        # Nothing else is another mission's or platform's.
        same = variant.loaded.platform.control.model_copy(
            update={"observer_gain": loaded.platform.control.observer_gain}
        )
        assert variant.loaded.platform.model_copy(update={"control": same}) == loaded.platform
        assert variant.loaded.mission.tasks == loaded.mission.tasks
        assert variant.loaded.truth == loaded.truth
    assert (loaded.platform.model_dump_json(), mission.read_text()) == before


@pytest.mark.parametrize(
    ("option", "text", "words"),
    [
        ("gains", "1,x", "'x' is not a finite number"),
        ("gains", "nan", "'nan' is not a finite number"),
        ("gains", "", "'' is not a finite number"),
        ("gains", "1,-2", "-2 1/s cannot be had"),
        ("speeds", "0", "0 m/s cannot be had"),
        ("speeds", "1.5", "flies at most 1 m/s"),
        ("pitches", "30", "does not vary --pitches"),
    ],
)
def test_bad_values_are_refused_before_anything_flies(
    mission: Path, option: str, text: str, words: str
) -> None:
    fly = FakeFly()
    with pytest.raises(InputError) as refused:
        study("force", mission, asked={option: text}, fly=fly)
    assert words in str(refused.value)
    assert fly.flown == []
    assert not (mission.parents[1] / "reports").exists()


def test_what_cannot_be_studied_is_refused(mission: Path) -> None:
    with pytest.raises(InputError, match="no study is named 'forse'") as unknown:
        study("forse", mission)
    assert "did you mean 'force'?" in str(unknown.value)
    mission.write_text(MISSION.replace("force_sensor: {noise_n: 0.5}", "friction: 0.4"))
    with pytest.raises(InputError, match="force_sensor"):
        study("force", mission)
    platform = mission.parents[1] / "platforms" / "tilt_rotor_hexarotor.yaml"
    text = platform.read_text()
    old = "observer_gain: [1.0, 1.0, 1.0]"
    assert old in text
    platform.write_text(text.replace(old, "observer_gain: [1.0, 2.0, 1.0]"))
    mission.write_text(MISSION)
    with pytest.raises(InputError, match="another observer_gain along each axis"):
        study("force", mission)


@pytest.mark.usefixtures("without_logs")
def test_what_was_flown_is_told_and_written(mission: Path, tmp_path: Path) -> None:
    fly, told = FakeFly(), []
    outcome = study(
        "force",
        mission,
        asked={"gains": "1, 2", "speeds": "0.2"},
        out=tmp_path / "out",
        progress=lambda done, total, end: told.append((done, total, end.task.name)),
        fly=fly,
    )
    folder = tmp_path / "out" / "study-force"
    assert [out for *_, out in fly.flown] == [
        folder / name for name in ("gain-1-speed-0.1", "gain-2-speed-0.1", "gain-1-speed-0.2")
    ]
    assert {seed for *_, seed, _ in fly.flown} == {7}
    for loaded, plan, *_ in fly.flown:
        assert plan == plan_loaded(loaded, vehicle_of(loaded))
    assert told[-1] == (3, 3, "gain-1-speed-0.2")
    assert outcome.exit_code == 0
    result = StudyResult.model_validate_json((folder / "study.json").read_text())
    assert result == outcome.result
    gain, speed = result.quantities
    rmse = "force_sensor.rmse_fx_n"
    assert [v.value(rmse) for v in result.sweep(gain)] == pytest.approx([0.1, 0.05])
    assert [v.value(rmse) for v in result.sweep(speed)] == pytest.approx([0.1, 0.2])
    assert {c.metric: c.published for c in result.columns}[rmse] == 1.62
    page = outcome.page.read_text()
    assert "published, 1.62 N" in page
    assert page.count("<td") > 0


@pytest.mark.usefixtures("without_logs")
@pytest.mark.parametrize(
    ("status", "words"),
    [("aborted", "aborted"), ("crash", "not flown: RuntimeError: the gimbal locked")],
)
def test_a_flight_that_fails_leaves_the_others(mission: Path, status: str, words: str) -> None:
    fly = FakeFly(lambda gain: status if gain == 4.0 else "completed")
    outcome = study("force", mission, asked={"speeds": "0.1"}, fly=fly)
    assert outcome.exit_code == 1
    assert outcome.result.shortfalls == (f"gain-4-speed-0.1: {words}",)
    assert [v.status for v in outcome.result.variants][:3] == ["completed"] * 3
    assert outcome.page.is_file()


@pytest.mark.usefixtures("without_logs")
def test_the_command_line(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    fly = FakeFly()
    monkeypatch.setattr(study, "__kwdefaults__", {**study.__kwdefaults__, "fly": fly})
    arguments = ["study", "force", str(mission), "--gains", "2", "--speeds", "0.1"]
    assert cli.run([*arguments, "--seed", "3", "--json"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["variants"][0]["name"] == "gain-2-speed-0.1"
    assert told.err == ""
    assert fly.flown[0][2] == 3
    assert cli.run(arguments) == 0
    told = capsys.readouterr()
    assert told.out == ""
    assert "gain-2-speed-0.1" in told.err
    assert "1.62" in told.err
    assert cli.run(["study", "forse", str(mission)]) == 2


def test_the_help_names_every_study(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["study", "--help"]) == 0
    told = capsys.readouterr().out
    for name, known in STUDIES.items():
        assert name in told
        for factor in known.factors:
            assert f"--{factor.option}" in told


def test_a_new_study_brings_its_options(
    mission: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """One row in the registry: the help names its option, and the command line takes it."""
    gain, _ = FORCE.factors
    renamed = dataclasses.replace(gain, option="trial-gains", help="gains of a trial", name="trial")
    columns = tuple(c for c in FORCE.columns if c.metric not in FORCE.own)
    trial = dataclasses.replace(FORCE, factors=(renamed,), own={}, columns=columns, figures=())
    monkeypatch.setitem(module.STUDIES, "trial", trial)
    fly = FakeFly()
    monkeypatch.setattr(study, "__kwdefaults__", {**study.__kwdefaults__, "fly": fly})
    assert cli.run(["study", "--help"]) == 0
    told = " ".join(capsys.readouterr().out.split())
    assert "force, pitch, trial" in told
    assert "trial: gains of a trial." in told
    assert cli.run(["study", "trial", str(mission), "--trial-gains", "3"]) == 0
    assert [out.name for *_, out in fly.flown] == ["trial-3"]
    assert cli.run(["study", "force", str(mission), "--trial-gains", "3"]) == 2


@pytest.mark.xdist_group("flights")
def test_a_real_study_finds_the_lag(mission: Path) -> None:
    """Two gains: the faster observer errs less, each as its lag predicts.

    Beyond the lag there are near surfaces and the tilt error: 0.15 N together, as in the tests of
    the observer's flights.
    """
    outcome = study("force", mission, asked={"gains": "1,3", "speeds": "0.1"})
    assert outcome.exit_code == 0
    slow, fast = outcome.result.sweep(outcome.result.quantities[0])
    errors = []
    for variant in (slow, fast):
        flown = variant.value("force_sensor.contact_rmse_fx_n")
        predicted = variant.value("study.lag_contact_rmse_fx_n")
        assert flown == pytest.approx(predicted, abs=0.15)
        errors.append(flown)
        log = read_log(outcome.folder / variant.folder / "flight.mcap")
        assert log.platform().control.observer_gain[0] == variant.values["gain"]
        assert log.seed == 7
    assert errors[1] < errors[0]
    assert outcome.folder == mission.parents[1] / "reports" / "sensed" / "study-force"
    assert cli.run(["report", str(outcome.folder / fast.folder), "--no-pictures"]) == 0
