"""Vehicles of packages outside inspect, flown in processes in which they are installed.

What a mission and a platform file may name is settled when inspect is imported. Each package here
states its rows in a file ``entry_points.txt``, as an installer leaves it.
"""

from __future__ import annotations

import json
import os
import subprocess
import sys
from pathlib import Path

import yaml

HERE = Path(__file__).parent
PLAN = """
import sys
from inspect_cli.cli import run

for mission in sys.argv[1:]:
    print("exit code", run(["plan", mission]), file=sys.stderr)
"""


def install(site: Path, *packages: str) -> None:
    """Make a folder in which the packages are installed."""
    for name in packages:
        info = site / f"{name}-1.0.dist-info"
        info.mkdir(parents=True)
        (info / "METADATA").write_text(f"Metadata-Version: 2.1\nName: {name}\nVersion: 1.0\n")
        rows = (HERE / name / "entry_points.txt").read_text()
        (info / "entry_points.txt").write_text(rows)


def python(site: Path, campaign: Path, *arguments: str) -> subprocess.CompletedProcess[str]:
    """Run Python in a campaign folder with the packages of a site."""
    env = os.environ | {"PYTHONPATH": os.pathsep.join([str(site), str(HERE)])}
    return subprocess.run(
        [sys.executable, *arguments],
        cwd=campaign,
        env=env,
        capture_output=True,
        text=True,
        check=False,
    )


def run(site: Path, campaign: Path, *arguments: str) -> str:
    """Run ``inspect``, which must succeed, and return what it prints."""
    done = python(site, campaign, "-m", "inspect_cli", *arguments)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def refusals(site: Path, campaign: Path, *missions: Path) -> list[str]:
    """What is said of each mission, none of which can be planned; one process plans them all."""
    files = [str(mission.relative_to(campaign)) for mission in missions]
    done = python(site, campaign, "-c", PLAN, *files)
    said = " ".join(done.stderr.split()).split("exit code 2")
    assert len(said) == len(missions) + 1, said
    return said[:-1]


def without_sensors(platform_file: Path) -> str:
    """A platform file as JSON but for its sensors, some of which only its package knows."""
    entries = yaml.safe_load(platform_file.read_text())
    kept = ("imu", "pose")
    entries["sensors"] = {name: entries["sensors"][name] for name in kept}
    return json.dumps(entries)
