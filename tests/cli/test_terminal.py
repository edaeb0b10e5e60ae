"""What people read, and the exit code that goes with it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from inspect_cli import cli, terminal
from inspect_cli.errors import Location, Problem
from inspect_cli.schema.result import Check, Metric, PointResult, Result, Status, Verdict

POINT = PointResult(
    index=0,
    label="r1c1",
    valid=False,
    reason="force [below 1 N]",
    p_W=(2.0, 0.0, 1.0),
    uv_m=(0.0, 0.0),
    potential_mv=None,
    resistance_ohm=None,
    resistivity_ohm_m=None,
    probe_force_n=0.42,
    contact_s=1.0,
    astm_class=None,
    corrosion=None,
)


def result(status: Status = "completed", *verdicts: Verdict) -> Result:
    checks = tuple(
        Check(metric="m.x", value=3.0, unit="N", min=3.0, max=3.0, ref="A8", verdict=verdict)
        for verdict in verdicts
    )
    return Result(
        mission="wall",
        platform="hexarotor",
        seed=7,
        status=status,
        checks=checks,
        metrics={},
        points=(POINT,),
    )


@pytest.fixture
def flown(monkeypatch: pytest.MonkeyPatch, tmp_path: Path) -> Callable[[Result], None]:
    """Makes ``inspect fly`` come back with a result without flying."""

    def set_result(made: Result) -> None:
        def fly(*arguments: object, **options: object) -> SimpleNamespace:
            return SimpleNamespace(result=made, folder=tmp_path / "run")

        monkeypatch.setattr("inspect_cli.commands.fly.fly", fly)

    return set_result


@pytest.mark.parametrize(
    ("made", "code"),
    [
        (result("completed"), 0),
        (result("completed", "pass", "fail-known"), 0),
        (result("completed", "pass", "fail"), 1),
        (result("completed", "not_measured"), 1),
        (result("aborted", "pass"), 1),
        (result("diverged"), 1),
        (result("interrupted"), 1),
    ],
)
def test_the_exit_code_of_a_flight(
    flown: Callable[[Result], None],
    capsys: pytest.CaptureFixture[str],
    made: Result,
    code: int,
) -> None:
    flown(made)
    assert cli.run(["fly", "m.yaml"]) == code
    assert capsys.readouterr().out == ""
    assert cli.run(["fly", "m.yaml", "--json"]) == code
    told = capsys.readouterr()
    assert told.err == ""
    assert json.loads(told.out) == json.loads(made.model_dump_json(by_alias=True))


@pytest.mark.parametrize("columns", ["20", "80", "200"])
def test_a_flight_is_told_in_full(
    flown: Callable[[Result], None],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
    tmp_path: Path,
    columns: str,
) -> None:
    flown(result("completed", "fail"))
    monkeypatch.setenv("COLUMNS", columns)
    cli.run(["fly", "m.yaml"])
    told = capsys.readouterr().err
    for text in (
        "wall on hexarotor, seed 7: completed",
        "force [below 1 N]",  # not taken for markup
        "0.42",
        "= 3",
        "0 of 1 readings valid, 0 of 1 checks passed",
        f"next: inspect report {tmp_path / 'run'}",
    ):
        assert text in told


def test_words_stay_whole_where_the_terminal_is_narrow(
    flown: Callable[[Result], None],
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setenv("COLUMNS", "40")
    check = result("completed", "not_measured").checks[0]
    check = check.model_copy(update={"metric": "tracking.position_rmse_x_m", "max": 2.16})
    point = POINT.model_copy(update={"corrosion": "possible", "resistivity_ohm_m": 200.0})
    flown(result("completed").model_copy(update={"checks": (check,), "points": (point,)}))
    cli.run(["fly", "m.yaml"])
    told = capsys.readouterr().err
    for word in ("resistivity", "potential", "corrosion", "possible", check.metric, "not_measured"):
        assert word in told
    tables = told[told.index("points ") : told.index("0 of 1 readings")]
    assert max(len(line) for line in tables.splitlines()) <= 80


@pytest.mark.parametrize(("ref", "published"), [("A8.force", "1.8 N"), ("A1", ""), (None, "")])
def test_the_papers_number_stands_below_the_row(
    flown: Callable[[Result], None],
    capsys: pytest.CaptureFixture[str],
    ref: str | None,
    published: str,
) -> None:
    check = result("completed", "pass").checks[0].model_copy(update={"ref": ref})
    flown(result("completed").model_copy(update={"checks": (check,), "points": ()}))
    cli.run(["fly", "m.yaml"])
    told = capsys.readouterr().err
    assert ("published" in told) == bool(published)
    assert (published or "answers") in told


def test_points_that_share_a_reason_share_a_line(
    flown: Callable[[Result], None], capsys: pytest.CaptureFixture[str]
) -> None:
    given = {"1": "force: too little", "2": "force: too little", "3": "", "4": "not visited"}
    points = tuple(
        POINT.model_copy(update={"label": label, "reason": reason, "valid": not reason})
        for label, reason in given.items()
    )
    flown(result("completed").model_copy(update={"points": points}))
    cli.run(["fly", "m.yaml"])
    told = capsys.readouterr().err
    assert "points 1, 2: force: too little\npoint 4: not visited\n" in told
    assert "warning: 3 of 4 points have no valid reading\n" in told


FORCE, SPEED = "contact.body_force_max_n", "flight.end_speed_mps"


@pytest.mark.parametrize(
    ("metrics", "warnings"),
    [
        ({}, []),
        ({FORCE: 0.0, SPEED: 0.2}, []),
        ({FORCE: None, SPEED: None}, []),
        (
            {FORCE: 263.1, SPEED: 0.61},
            [
                "warning: the vehicle's body touched something: 263 N",
                "warning: the vehicle was still moving at the end: 0.6 m/s",
            ],
        ),
    ],
)
def test_what_went_wrong_unasked_is_warned_of(
    capsys: pytest.CaptureFixture[str],
    tmp_path: Path,
    metrics: dict[str, float | None],
    warnings: list[str],
) -> None:
    measured = {name: Metric(value=value, unit="") for name, value in metrics.items()}
    made = result("completed").model_copy(update={"points": (), "metrics": measured})
    for show in (terminal.print_flight, terminal.print_report):
        show(made, tmp_path)
        told = capsys.readouterr().err.splitlines()
        assert [line for line in told if line.startswith("warning")] == warnings


def test_an_interrupted_flight_says_what_was_kept(
    campaign: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(*arguments: object) -> None:
        raise KeyboardInterrupt

    mission = campaign / "missions" / "nine_point_half_cell.yaml"
    folder = campaign / "reports" / "nine-point-half-cell" / "tilt_rotor_hexarotor-seed1"
    monkeypatch.setattr("inspect_cli.commands.fly.load_mission", stopped)
    assert cli.run(["fly", str(mission)]) == 130
    assert capsys.readouterr().err.endswith("error: interrupted\n")  # there was nothing to keep
    monkeypatch.undo()

    monkeypatch.setattr("inspect_cli.simulation.loop.Flight.run", stopped)
    assert cli.run(["fly", str(mission)]) == 130
    assert capsys.readouterr().err.endswith(
        "error: interrupted\n"
        f"    the flown part of the log was kept; report it: inspect report {folder}\n"
    )
    assert cli.run(["plan", str(mission)]) == 0
    plan = folder.parent / "tilt_rotor_hexarotor" / "plan.json"
    capsys.readouterr()
    assert cli.run(["fly", str(plan), "--seed", "7", "--json"]) == 130
    (problem,) = json.loads(capsys.readouterr().out)["error"]["problems"]
    assert problem["hint"].endswith("inspect report " + str(folder).replace("seed1", "seed7"))


def test_a_problem_is_printed_unbroken_and_unchanged(capsys: pytest.CaptureFixture[str]) -> None:
    place = Location("m.yaml", 3, 5, "tasks[0].contact_grid[bold]")
    terminal.print_problems([Problem("w" * 300, place, "do [this]")])
    assert capsys.readouterr().err == (
        f"error: m.yaml:3:5: tasks[0].contact_grid[bold]: {'w' * 300}\n    do [this]\n"
    )


def test_the_first_run_is_announced_once(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    monkeypatch.delenv("NUMBA_DISABLE_JIT", raising=False)
    monkeypatch.setenv("NUMBA_CACHE_DIR", str(tmp_path))
    terminal.announce_compilation(shown=True)
    assert "compiling" in capsys.readouterr().err
    (tmp_path / "room").mkdir()
    (tmp_path / "room" / "kernel.nbi").write_text("")
    terminal.announce_compilation(shown=True)
    assert capsys.readouterr().err == ""
