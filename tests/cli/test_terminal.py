"""What people read, and the exit code that goes with it."""

from __future__ import annotations

import json
from collections.abc import Callable
from pathlib import Path
from types import SimpleNamespace

import pytest

from inspect_cli import cli, terminal
from inspect_cli.errors import Location, Problem
from inspect_cli.schema.result import Check, PointResult, Result, Status, Verdict

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


def test_a_flight_is_told_in_full(
    flown: Callable[[Result], None], capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    flown(result("completed", "fail"))
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
