"""Bad input at the command line: refused by name, exit code 2, and nothing written."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from cloud_files import POINTS, WRITERS

from inspect_cli.cli import run

WALL = """\
schema: 1
name: refused
platform: tilt_rotor_hexarotor
structure:
  - name: wall
    surface: {fit: plane, cloud: scan.ply}
tasks:
  - contact_grid: {on: wall, rows: 1, columns: 1, pitch_m: 0.05}
"""
SHAPE = "{shape: {kind: plane, center_m: [2, 0, 1.25], normal: [-1, 0, 0], size_m: [3, 2.5]}}"
GIVEN = WALL.replace("{fit: plane, cloud: scan.ply}", SHAPE)


@pytest.fixture
def refused(tmp_path: Path, root: Path, capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Plans and flies a mission that must be refused; returns what was said."""

    def refuse(mission: str, platform: Callable[[str], str] = lambda text: text) -> str:
        (tmp_path / "missions").mkdir(exist_ok=True)
        (tmp_path / "platforms").mkdir(exist_ok=True)
        for file in (root / "platforms").glob("*.yaml"):
            text = platform(file.read_text(encoding="utf-8"))
            (tmp_path / "platforms" / file.name).write_text(text, encoding="utf-8")
        file = tmp_path / "missions" / "refused.yaml"
        file.write_text(mission, encoding="utf-8")
        before = sorted(tmp_path.rglob("*"))
        said = ""
        for command in ("plan", "fly"):
            assert run([command, str(file)]) == 2
            said = capsys.readouterr().err
        assert sorted(tmp_path.rglob("*")) == before
        return " ".join(said.split())

    return refuse


@pytest.mark.parametrize(
    ("mission", "place", "words"),
    [
        (GIVEN + "colour: red\n", "refused.yaml:9:1", "colour"),
        (GIVEN + "name: again\n", "refused.yaml:9:1", "name"),
        (GIVEN.replace("pitch_m: 0.05", "pitch_cm: 5"), "refused.yaml:8:51", "pitch_m"),
        (GIVEN.replace("pitch_m: 0.05", "pitch_m: .nan"), "refused.yaml:8:60", "pitch_m"),
        (GIVEN.replace("rows: 1", "rows: -1"), "refused.yaml:8:36", "rows"),
        (WALL.replace("scan.ply", "missing.ply"), "refused.yaml:6:34", "missing.ply"),
        (WALL.replace("scan.ply", "../../scan.ply"), "refused.yaml:6:34", "campaign"),
        (
            WALL.replace("scan.ply", "scan.ply, crop: {min_m: [1, 0, 0], max_m: [0, 1, 1]}"),
            "refused.yaml:6",
            "min_m",
        ),
        (
            GIVEN + "tags: &a [x, x]\ntitle: [*a, *a]\n" + "".join(
                f"k{i}: &k{i} [{', '.join([f'*k{i - 1}' if i else '*a'] * 9)}]\n" for i in range(9)
            ),
            "refused.yaml",
            "alias",
        ),
    ],
    ids=[
        "unknown key", "duplicate key", "wrong unit", "NaN", "negative", "missing cloud",
        "out of the campaign", "contradictory crop", "alias bomb",
    ],
)  # fmt: skip
def test_bad_missions(
    refused: Callable[..., str], mission: str, place: str, words: str, tmp_path: Path
) -> None:
    (tmp_path / "missions").mkdir()
    WRITERS["binary.ply"](tmp_path / "missions" / "scan.ply", POINTS)
    said = refused(mission)
    assert place in said
    assert words in said


def test_platform_with_negative_mass(refused: Callable[..., str]) -> None:
    said = refused(GIVEN, lambda text: text.replace("  mass_kg: 2.76", "  mass_kg: -2.76"))
    assert "tilt_rotor_hexarotor.yaml:42:12" in said
    assert "mass_kg" in said


def test_rate_that_is_negative(refused: Callable[..., str]) -> None:
    said = refused(GIVEN, lambda text: text + "rates: {log_hz: -250}\n")
    assert "log_hz" in said
    assert "tilt_rotor_hexarotor.yaml:" in said


CLOUDS = ("text.ply", "binary.pcd", "compressed.pcd", "scan.las", "scan.laz", "scan.e57")
# LAS and LAZ keep integers, and the writer of E57 refuses NaN itself.
SPOILT = [(name, how) for name in CLOUDS for how in ("cut", "empty")]
SPOILT += [(name, "NaN") for name in ("text.ply", "binary.pcd", "compressed.pcd")]


@pytest.mark.parametrize(("name", "how"), SPOILT)
def test_bad_clouds(refused: Callable[..., str], tmp_path: Path, name: str, how: str) -> None:
    (tmp_path / "missions").mkdir()
    cloud = tmp_path / "missions" / name
    WRITERS[name](cloud, np.full_like(POINTS, np.nan) if how == "NaN" else POINTS)
    if how == "cut":
        cloud.write_bytes(cloud.read_bytes()[: cloud.stat().st_size // 2])
    elif how == "empty":
        cloud.write_bytes(b"")
    assert name in refused(WALL.replace("scan.ply", name))


def test_mesh_without_faces(refused: Callable[..., str], tmp_path: Path) -> None:
    (tmp_path / "missions").mkdir()
    mesh = tmp_path / "missions" / "bare.obj"
    mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n")
    said = refused(WALL.replace("cloud: scan.ply", "mesh: bare.obj"))
    assert "bare.obj" in said
    assert "faces" in said


@pytest.mark.parametrize(
    ("point", "words"),
    [
        ("[1.5, 0, 1.2]", "0.5"),  # half a metre in front of the wall
        ("[2.0, 0, 0.05]", "ground"),  # the vehicle would have to be in the ground
        ("[2.0, 9.0, 1.2]", "1"),  # beyond the wall's edge
    ],
)
def test_points_that_cannot_be_touched(refused: Callable[..., str], point: str, words: str) -> None:
    tasks = f"  - contact_points: {{on: wall, at_m: [{point}]}}\n"
    said = refused(GIVEN[: GIVEN.index("  - contact_grid")] + tasks)
    assert "point 1" in said.lower()
    assert words in said


@pytest.mark.parametrize("content", [b"", b"not a log at all", b"\x89MCAP0\r\n"])
def test_file_that_is_no_log(
    content: bytes, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    log = tmp_path / "flight.mcap"
    log.write_bytes(content)
    assert run(["report", str(log)]) == 2
    assert "flight.mcap" in capsys.readouterr().err.replace("\n", "")
    assert list(tmp_path.iterdir()) == [log]
