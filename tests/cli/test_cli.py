"""The command line: exit codes, one JSON object on stdout, people on stderr."""

from __future__ import annotations

import json
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli import cli
from inspect_cli.errors import EnvironmentFault

Shell = Callable[..., subprocess.CompletedProcess[str]]

HEAVY = ("mujoco", "numba", "open3d", "numpy", "pydantic", "scipy", "plotly", "mcap", "yaml")


def files(folder: Path) -> set[Path]:
    return set(folder.rglob("*"))


def spoil(campaign: Path, old: str, new: str) -> tuple[Path, int, int]:
    """A mission with one piece of its text replaced, and the line and column of that piece."""
    mission = campaign / "missions" / "nine_point_half_cell.yaml"
    text = mission.read_text()
    assert text.count(old) == 1
    mission.write_text(text.replace(old, new))
    before = text[: text.index(old)]
    return mission, before.count("\n") + 1, len(before) - before.rfind("\n")


def test_help_names_every_command(shell: Shell) -> None:
    done = shell("--help")
    assert (done.returncode, done.stderr) == (0, "")
    for command in ("init", "plan", "fly", "report", "regress", "study", "doctor", "schema"):
        assert f" {command} " in done.stdout


def test_help_loads_nothing_heavy() -> None:
    program = (
        "import sys; from inspect_cli.cli import run; code = run(['--help']);"
        f"sys.exit(code or ' '.join(m for m in {HEAVY!r} if m in sys.modules) or None)"
    )
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True)
    assert (done.returncode, done.stderr) == (0, "")


def test_version(shell: Shell) -> None:
    done = shell("--version")
    assert done.returncode == 0
    assert done.stdout.startswith("inspect 0.")


def test_schema_prints_json_on_stdout(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["schema", "platform"]) == 0
    text = capsys.readouterr().out
    assert json.loads(text)["title"] == "Platform of inspect"
    assert cli.run(["schema", "platform", "--json"]) == 0
    assert capsys.readouterr().out == text


def test_every_command_takes_json(shell: Shell) -> None:
    for command in ("init", "plan", "fly", "report", "regress", "study", "doctor", "schema"):
        assert "--json" in shell(command, "--help").stdout


def test_help_says_where_a_report_goes(shell: Shell) -> None:
    assert "Write here instead of beside the log." in shell("report", "--help").stdout


def test_a_platform_by_name(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    mission = campaign / "missions" / "nine_point_half_cell.yaml"
    arguments = ["plan", str(mission), "--json", "--platform"]
    assert cli.run([*arguments, "tilt_rotor_hexarotor_30"]) == 0
    assert json.loads(capsys.readouterr().out)["platform"] == "tilt_rotor_hexarotor_30"
    assert cli.run([*arguments, "tilt_rotor_hexarotor_31"]) == 2
    (problem,) = json.loads(capsys.readouterr().out)["error"]["problems"]
    assert problem["what"] == "no platform is named 'tilt_rotor_hexarotor_31'"
    assert "did you mean 'tilt_rotor_hexarotor_30'?" in problem["hint"]


def test_a_missing_mission_is_answered_with_its_neighbours(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert cli.run(["plan", str(campaign / "missions" / "nine_point_halfcell.yaml")]) == 2
    near = campaign / "missions" / "nine_point_half_cell.yaml"
    assert f"there is no such file\n    did you mean {near}" in capsys.readouterr().err


def test_completion_is_offered(shell: Shell) -> None:
    done = shell(_INSPECT_COMPLETE="complete_bash", COMP_WORDS="inspect re", COMP_CWORD="1")
    assert done.stdout.split() == ["report", "regress"]


@pytest.mark.parametrize("command", ["plan", "fly"])
def test_a_bad_mission_is_refused_and_nothing_is_written(
    campaign: Path, shell: Shell, command: str
) -> None:
    mission, line, column = spoil(campaign, "pitch_m: 0.05", "pitch_cm: 5")
    before = files(campaign)
    done = shell(command, mission)
    assert done.returncode == 2
    assert done.stdout == ""
    assert done.stderr.endswith(  # an announcement of the first run may come before
        f"error: {mission}:{line}:{column}: "
        "tasks[0].contact_grid.pitch_cm: unknown key 'pitch_cm'\n"
        "    the key is 'pitch_m', in metres: write pitch_m: 0.05\n"
    )
    assert files(campaign) == before


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("schema: 1", "schema: 1\nschema: 1", ":2:1: schema: the key 'schema' a second time"),
        ("dwell_s: 3", "dwell_s: .nan", "contact_grid.dwell_s: must be a finite number"),
        ("scans/wall.ply", "../../wall.ply", "surface.cloud: leads out of the campaign folder"),
        ("scans/wall.ply", "scans/none.ply", "surface.cloud: no such file: scans/none.ply"),
        ("tags: [quick, paper_a]", "tags: !!python/name:os.system [x]", "is refused"),
    ],
)
def test_other_bad_missions(
    campaign: Path, capsys: pytest.CaptureFixture[str], old: str, new: str, message: str
) -> None:
    mission, _, _ = spoil(campaign, old, new)
    before = files(campaign)
    assert cli.run(["plan", str(mission)]) == 2
    told = capsys.readouterr()
    assert told.out == ""
    assert f"error: {mission}:" in told.err
    assert message in told.err
    assert files(campaign) == before


def test_an_alias_bomb_is_refused(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    lines = ["a0: &a0 [x, x, x, x, x, x, x, x, x]"]
    lines += [f"a{i}: &a{i} [{', '.join([f'*a{i - 1}'] * 9)}]" for i in range(1, 12)]
    mission = campaign / "missions" / "bomb.yaml"
    mission.write_text("\n".join(lines))
    assert cli.run(["plan", str(mission)]) == 2
    assert f"error: {mission}:" in capsys.readouterr().err


def test_a_platform_of_negative_mass(campaign: Path, capsys: pytest.CaptureFixture[str]) -> None:
    platform = campaign / "platforms" / "tilt_rotor_hexarotor.yaml"
    platform.write_text(platform.read_text().replace("mass_kg: 2.76", "mass_kg: -2.76"))
    mission = campaign / "missions" / "nine_point_half_cell.yaml"
    before = files(campaign)
    assert cli.run(["plan", str(mission), "--platform", str(platform)]) == 2
    message = f"error: {platform}:42:12: core.mass_kg: must be above 0; found -2.76\n"
    assert capsys.readouterr().err.endswith(message)
    assert files(campaign) == before


def test_an_error_with_json_is_one_object(
    campaign: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    mission, line, column = spoil(campaign, "pitch_m: 0.05", "pitch_m: -1")
    assert cli.run(["plan", str(mission), "--json"]) == 2
    told = capsys.readouterr()
    assert told.err == ""
    problem = {
        "what": "must be above 0; found -1",
        "where": {
            "file": str(mission),
            "line": line,
            "column": column + len("pitch_m: "),
            "path": "tasks[0].contact_grid.pitch_m",
        },
        "hint": "",
    }
    assert json.loads(told.out) == {"error": {"exit_code": 2, "problems": [problem]}}


def test_misuse_exits_with_two(shell: Shell) -> None:
    done = shell("plan", "--colour")
    assert done.returncode == 2
    assert "No such option" in done.stderr
    with_json = shell("plan", "--json")
    assert with_json.returncode == 2
    assert with_json.stderr == ""
    assert "Missing argument" in json.loads(with_json.stdout)["error"]["problems"][0]["what"]


def test_colours_only_where_they_are_wanted(campaign: Path, shell: Shell) -> None:
    assert "\x1b[" in shell("init", campaign, FORCE_COLOR="1").stderr
    assert "\x1b[3" not in shell("init", campaign, FORCE_COLOR="1", NO_COLOR="1").stderr
    assert "\x1b[" not in shell("init", campaign).stderr


def test_init_then_plan_with_pure_json(campaign: Path, shell: Shell) -> None:
    done = shell("plan", campaign / "missions" / "nine_point_half_cell.yaml", "--json")
    assert done.returncode == 0, done.stderr
    plan = json.loads(done.stdout)
    assert plan["mission"] == "nine-point-half-cell"
    assert len(plan["targets"]) == 9
    assert list(campaign.glob("reports/nine-point-half-cell/*/plan.json"))


@pytest.mark.parametrize(
    ("error", "code", "message"),
    [
        (EnvironmentFault("the disk is full"), 3, "error: the disk is full\n"),
        (KeyboardInterrupt(), 130, "error: interrupted\n"),
        (
            ZeroDivisionError("division by zero"),
            3,
            "error: a defect of inspect: ZeroDivisionError: division by zero\n"
            "    set INSPECT_TRACEBACK=1 to see where, and report it with the files you used\n",
        ),
    ],
)
def test_faults_and_interrupts(
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
    error: BaseException,
    code: int,
    message: str,
) -> None:
    def fails(folder: Path) -> None:
        raise error

    monkeypatch.setattr("inspect_cli.commands.init.init", fails)
    assert cli.run(["init", str(tmp_path)]) == code
    assert capsys.readouterr().err == message
    assert cli.run(["init", str(tmp_path), "--json"]) == code
    assert json.loads(capsys.readouterr().out)["error"]["exit_code"] == code


def test_a_traceback_is_shown_when_asked_for(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def fails(folder: Path) -> None:
        raise ZeroDivisionError

    monkeypatch.setattr("inspect_cli.commands.init.init", fails)
    monkeypatch.setenv("INSPECT_TRACEBACK", "1")
    with pytest.raises(ZeroDivisionError):
        cli.run(["init", str(tmp_path)])


def test_what_libraries_print_does_not_reach_stdout(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    from inspect_cli.commands import init as module

    real = module.init

    def chatty(folder: Path) -> module.Campaign:
        print("a library says hello")
        return real(folder)

    monkeypatch.setattr(module, "init", chatty)
    assert cli.run(["init", str(tmp_path / "new"), "--json"]) == 0
    told = capsys.readouterr()
    assert json.loads(told.out)["folder"] == str(tmp_path / "new")
    assert told.err == "a library says hello\n"
