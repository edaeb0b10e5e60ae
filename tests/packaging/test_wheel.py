"""The wheel carries what it needs, and works where there is no checkout."""

from __future__ import annotations

import json
import re
import subprocess
import tomllib
import zipfile
from pathlib import Path

import pytest

# One worker builds, installs and compiles once for all of these.
pytestmark = pytest.mark.xdist_group("packaging")

RUN = "reports/nine-point-half-cell/tilt_rotor_hexarotor-seed1"


def test_it_carries_missions_platforms_schemas_and_pages(wheel: Path, root: Path) -> None:
    names = set(zipfile.ZipFile(wheel).namelist())
    for folder in ("missions", "platforms"):
        files = [path for path in (root / folder).rglob("*") if path.is_file()]
        assert files
        assert {f"inspect_cli/builtin/{path.relative_to(root)}" for path in files} <= names
    kinds = (".json", ".css", ".js", ".po")
    data = [p for p in (root / "inspect_cli").rglob("*") if p.suffix in kinds]
    assert {str(path.relative_to(root)) for path in data} <= names
    modules = (root / "inspect_cli").rglob("*.py")
    assert {str(path.relative_to(root)) for path in modules} <= names
    assert "inspect_cli/py.typed" in names


def test_it_carries_nothing_else(wheel: Path) -> None:
    for name in zipfile.ZipFile(wheel).namelist():
        assert name.startswith(("inspect_cli/", "inspect_cli-")), name
        assert "__pycache__" not in name


def test_every_dependency_is_pinned(root: Path) -> None:
    project = tomllib.loads((root / "pyproject.toml").read_text(encoding="utf-8"))["project"]
    wanted = project["dependencies"] + project["optional-dependencies"]["dev"]
    lines = (root / "constraints.txt").read_text(encoding="utf-8").splitlines()
    pins = [line for line in lines if line and not line.startswith("#")]
    assert all(re.fullmatch(r"[A-Za-z0-9._-]+==[A-Za-z0-9.+!_-]+", pin) for pin in pins)
    pinned = {_plain(pin.partition("==")[0]) for pin in pins}
    names = {_plain(re.split(r"[\[<>=!~ ;]", requirement)[0]) for requirement in wanted}
    assert names <= pinned


def test_a_mission_goes_all_the_way_without_a_checkout(installation, root: Path) -> None:
    where = "import inspect_cli; print(inspect_cli.__file__)"
    told = subprocess.run(
        [installation.python, "-P", "-c", where], capture_output=True, text=True, check=True
    )
    assert Path(told.stdout.strip()).is_relative_to(installation.folder)

    _ran(installation, "init", "campaign")
    mission = "campaign/missions/nine_point_half_cell.yaml"
    planned = json.loads(_ran(installation, "plan", mission, "--json"))
    flown = json.loads(_ran(installation, "fly", mission, "--seed", "1", "--json"))
    # The PDF shows that fonts and layout came along; pictures need a driver of the machine's.
    _ran(installation, "report", f"campaign/{RUN}", "--no-pictures", "--pdf")

    folder = installation.folder / "campaign" / RUN
    written = {path.name for path in folder.iterdir()}
    assert written == {
        *("flight.mcap", "metrics.json", "plan.json"),
        *("readings.csv", "report.html", "report.pdf", "timing.json"),
    }
    assert planned
    assert flown["status"] == "completed"
    assert {check["verdict"] for check in flown["checks"]} == {"pass"}
    assert (installation.folder / "campaign/reports/nine-point-half-cell").is_dir()


def _ran(installation, *arguments: str) -> str:
    done = installation.run(*arguments)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def _plain(name: str) -> str:
    """A distribution's name as registries compare it."""
    return re.sub(r"[-_.]+", "-", name).lower()
