"""A kind of task from another package: loaded, planned and refused like the built-in ones.

It touches a point twice. The model and the planner are modules of their own, one for each floor.
"""

from __future__ import annotations

import json
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

MODEL = """
from inspect_cli.schema.base import Name
from inspect_cli.schema.tasks.base import CONTACT_MODES, ContactOptions, TaskKind


class Tap(ContactOptions):
    on: Name
    at_m: tuple[float, float]


KIND = TaskKind(Tap, modes=CONTACT_MODES, surface_key="on", reads=True)
"""
PLANNER = """
from inspect_cli.planning.points import point_on
from inspect_cli.planning.tasks.situation import Planners
from inspect_cli.planning.tasks.touch import TouchPlanner


def planners_of(asked):
    tap, task = asked.task.work, asked.task
    taps = [
        TouchPlanner(
            point_on(
                asked.prims[tap.on], tap.at_m, str(asked.number + k), tap.on, tap,
                asked.impedance, task.instrument, cell_m=(0.1, 0.1),
            ),
            tap,
        )
        for k in range(2)
    ]
    return Planners(tuple(taps), taps[-1].point.in_front(tap.standoff_m))
"""
ENTRIES = """
[inspect_cli.tasks]
tap = inspect_tap_model:KIND

[inspect_cli.task_planners]
tap = inspect_tap_planner:planners_of
"""
MISSION = """
schema: 1
name: tapped
platform: tilt_rotor_hexarotor
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [3, 0, 1.5], normal: [-1, 0, 0], size_m: [3, 2]}}
tasks:
  - tap: {on: SURFACE, at_m: [0.1, 0.2]}
"""


@pytest.fixture
def site(tmp_path: Path) -> Path:
    """A folder of packages with one that brings the task, as an installer leaves it."""
    site = tmp_path / "site"
    metadata = site / "inspect_tap-1.0.dist-info"
    metadata.mkdir(parents=True)
    (site / "inspect_tap_model.py").write_text(MODEL)
    (site / "inspect_tap_planner.py").write_text(PLANNER)
    (metadata / "METADATA").write_text("Metadata-Version: 2.1\nName: inspect-tap\nVersion: 1.0\n")
    (metadata / "entry_points.txt").write_text(ENTRIES)
    return site


def planned(root: Path, site: Path, campaign: Path, surface: str) -> subprocess.CompletedProcess:
    """``inspect plan`` in a process that has the package."""
    (campaign / "missions").mkdir(parents=True)
    shutil.copytree(root / "platforms", campaign / "platforms")
    (campaign / "missions" / "tapped.yaml").write_text(MISSION.replace("SURFACE", surface))
    program = (
        f"import sys; sys.path.insert(0, {str(site)!r}); from inspect_cli.cli import main; main()"
    )
    return subprocess.run(
        [sys.executable, "-c", program, "plan", "missions/tapped.yaml", "--out", "made"],
        cwd=campaign, capture_output=True, text=True, check=False,
    )  # fmt: skip


def test_it_is_planned(root: Path, site: Path, tmp_path: Path) -> None:
    run = planned(root, site, tmp_path / "campaign", "wall")
    assert run.returncode == 0, run.stderr
    plan = json.loads((tmp_path / "campaign" / "made" / "plan.json").read_text())
    assert [target["label"] for target in plan["targets"]] == ["1", "2"]
    assert [target["uv_m"] for target in plan["targets"]] == [[0.1, 0.2]] * 2
    assert [target["sensor"] for target in plan["targets"]] == ["half_cell"] * 2
    assert plan["targets"][0]["law"]["depth_m"] == 0.1


def test_the_surface_that_it_names_must_be_there(root: Path, site: Path, tmp_path: Path) -> None:
    run = planned(root, site, tmp_path / "campaign", "wal")
    assert run.returncode == 2, run.stdout + run.stderr
    message = " ".join((run.stdout + run.stderr).split())
    assert "missions/tapped.yaml:9:" in message
    assert "no surface is named 'wal'" in message
