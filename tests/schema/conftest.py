"""A small campaign whose mission is good, and a way to spoil it line by line."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest

from inspect_cli.errors import SchemaError
from inspect_cli.schema.campaign import builtin_root
from inspect_cli.schema.loading import load_mission, load_platform

MISSION = """\
schema: 1
name: two-points
platform: tilt_rotor_hexarotor
seeds: [1, 2]
structure:
  - name: wall
    surface: {shape: {kind: plane, center_m: [3, 0, 1.5], normal: [-1, 0, 0], size_m: [3, 2]}}
  - name: tank
    surface:
      cloud: scans/tank.ply
      fit: cylinder
      crop: {min_m: [0, 0, 0], max_m: [1, 1, 1]}
tasks:
  - contact_grid:
      on: wall
      rows: 1
      columns: 2
      pitch_m: 0.05
      press_m: 0.1
    sensor: half_cell
truth:
  structure:
    wall:
      friction: 0.4
      specimen: {model: grid, potential_mv: ../data/p.csv, resistivity_kohm_cm: ../data/r.csv,
                 pitch_m: 0.1}
acceptance:
  - {metric: contact.force_mean_n, min: 1.44, max: 2.16, ref: A8.force}
"""


@pytest.fixture
def campaign(tmp_path: Path) -> Path:
    """A campaign folder with the mission above and the files that it names."""
    root = tmp_path / "campaign"
    for folder in ("missions/scans", "platforms", "data"):
        (root / folder).mkdir(parents=True)
    (root / "missions" / "scans" / "tank.ply").write_text("ply\n")
    for name in ("p.csv", "r.csv"):
        (root / "data" / name).write_text("1,2\n")
    (root / "missions" / "m.yaml").write_text(MISSION)
    return root


@pytest.fixture
def refusal(campaign: Path) -> Callable[..., list[str]]:
    """The messages for the mission with one line replaced, places without the folder."""

    def problems(old: str, new: str) -> list[str]:
        assert MISSION.count(old) == 1
        file = campaign / "missions" / "m.yaml"
        file.write_text(MISSION.replace(old, new))
        with pytest.raises(SchemaError) as caught:
            load_mission(file)
        return [str(p).replace(f"{file.parent}/", "") for p in caught.value.problems]

    return problems


@pytest.fixture
def platform_refusal(tmp_path: Path) -> Callable[..., list[str]]:
    """The messages for the built-in platform with one piece of its text replaced."""
    text = (builtin_root() / "platforms" / "tilt_rotor_hexarotor.yaml").read_text()

    def problems(old: str, new: str) -> list[str]:
        assert old in text
        file = tmp_path / "p.yaml"
        file.write_text(text.replace(old, new, 1))
        with pytest.raises(SchemaError) as caught:
            load_platform(file)
        return [str(p).replace(f"{file.parent}/", "") for p in caught.value.problems]

    return problems
