"""``inspect doctor``: what it finds and what it says of failures."""

from __future__ import annotations

import json
from importlib.metadata import PackageNotFoundError

import pytest

from inspect_cli import cli
from inspect_cli.commands import doctor as module
from inspect_cli.commands.doctor import TRIALS, Finding, doctor
from inspect_cli.commands.probes import PROBES


def found(what: str) -> Finding:
    return next(f for f in doctor().findings if f.what == what)


def test_this_installation_is_healthy(capsys: pytest.CaptureFixture[str]) -> None:
    assert cli.run(["doctor", "--json"]) == 0
    diagnosis = json.loads(capsys.readouterr().out)
    assert diagnosis["healthy"] is True
    verdicts = {f["what"]: f["verdict"] for f in diagnosis["findings"]}
    assert len(verdicts) == 2 + len(TRIALS)
    del verdicts["headless rendering"]  # a machine may lack a driver; then it is a warning
    assert set(verdicts.values()) == {"ok"}


def test_every_trial_has_its_probe() -> None:
    assert list(TRIALS) == list(PROBES)


def only(monkeypatch: pytest.MonkeyPatch, *names: str) -> None:
    monkeypatch.setattr(module, "TRIALS", {name: TRIALS[name] for name in names})


def test_rendering_without_a_driver_is_a_warning_that_says_what_to_do(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    only(monkeypatch, "rendering")
    monkeypatch.setenv("MUJOCO_GL", "no-such-driver")
    diagnosis = doctor()
    finding = diagnosis.findings[-1]
    assert finding.verdict == "warning"
    assert "MUJOCO_GL" in finding.hint
    assert diagnosis.healthy


def test_a_missing_or_old_library_fails(monkeypatch: pytest.MonkeyPatch) -> None:
    only(monkeypatch)
    versions = {"pydantic": "2.9.4", "mujoco": "4.0.1rc2", "laspy": "2.7"}

    def version(name: str) -> str:
        if name not in versions:
            raise PackageNotFoundError(name)
        return versions[name]

    needs = ["pydantic>=2.10", "mujoco>=4", "laspy[lazrs]", "rich", 'pytest; extra == "dev"']
    monkeypatch.setattr(module, "version", version)
    monkeypatch.setattr(module, "requires", lambda name: needs)
    finding = found("libraries")
    assert finding.verdict == "failed"
    assert finding.found == "pydantic 2.9.4 is older than 2.10; rich is missing"
    assert "pip install" in finding.hint


def test_a_failure_exits_with_one_and_is_printed_with_its_hint(
    monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    only(monkeypatch, "logs")
    monkeypatch.setattr(module.sys, "executable", "/bin/false")
    assert cli.run(["doctor"]) == 1
    told = capsys.readouterr()
    assert told.out == ""
    assert "failed" in told.err
    assert "logs: install again" in told.err
