"""What is wrong beneath a surface only shows when it is computed, and is said in the mission."""

from __future__ import annotations

from pathlib import Path

import pytest

from inspect_cli.cli import run

MISSION = """\
schema: 1
name: steep
platform: tilt_rotor_hexarotor
structure:
  - name: wall
    surface:
      shape: {kind: plane, center_m: [2, 0, 1.25], normal: [-1, 0, 0], size_m: [3, 2.5]}
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.05}
truth:
  structure:
    wall:
      specimen:
        model: macro_cell
        cover_m: 0.03
        size_m: [0.6, 0.6]
        resolution_m: 0.03
"""
UNSETTLED = """\
        resistivity_ohm_m: 1e6
        sites: [{at_m: [0.1, 0], radius_m: 0.05}]
        active: {rest_v: -1.5, current_apm2: 10, anodic_slope_vpdec: 0.02,
                 cathodic_slope_vpdec: 0.02, limit_apm2: null}
        passive: {rest_v: 0.5, current_apm2: 10, anodic_slope_vpdec: 0.02,
                  cathodic_slope_vpdec: 0.02, limit_apm2: 10}
"""
WET = "{at_m: [0, 0], radius_m: 0.3, resistivity_factor: 0.01}"
NO_CONCRETE = f"        moisture: [{', '.join([WET] * 5)}]\n"


@pytest.mark.parametrize(
    ("entries", "said"),
    [
        (UNSETTLED, "the potentials of the macro cell did not settle in 100 steps"),
        (NO_CONCRETE, "sites and moisture together leave resistivities of"),
    ],
)
@pytest.mark.parametrize("is_inherited", [False, True])
def test_a_cell_without_a_solution_is_said_where_it_stands(
    entries: str,
    said: str,
    is_inherited: bool,
    tmp_path: Path,
    root: Path,
    capsys: pytest.CaptureFixture[str],
) -> None:
    for folder in ("missions", "platforms"):
        (tmp_path / folder).mkdir()
    for file in (root / "platforms").glob("*.yaml"):
        (tmp_path / "platforms" / file.name).write_bytes(file.read_bytes())
    mission = tmp_path / "missions" / "steep.yaml"
    mission.write_text(MISSION + entries, encoding="utf-8")
    asked = mission
    if is_inherited:
        asked = mission.with_name("child.yaml")
        text = "schema: 1\nextends: steep.yaml\nname: child\n"
        asked.write_text(text + "truth: {structure: {wall: {friction: 0.4}}}\n", encoding="utf-8")
    assert run(["fly", str(asked), "--out", str(tmp_path / "out")]) == 2
    told = " ".join(capsys.readouterr().err.split())
    assert f"{mission}:14:9: truth.structure.wall.specimen: {said}" in told
    assert not (tmp_path / "out").exists()
