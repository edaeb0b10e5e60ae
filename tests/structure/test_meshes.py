"""Meshes sampled evenly, and bad meshes refused by name."""

from __future__ import annotations

import os
import struct
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.errors import GeometryError
from inspect_cli.structure.meshes import read_mesh

# A 3 m × 1 m rectangle in the plane z = 2: a large and a small half.
CORNERS = np.array([[0, 0, 2], [3, 0, 2], [3, 1, 2], [0, 1, 2]], dtype=np.float64)
FACES = np.array([[0, 1, 2], [0, 2, 3]])


def write_obj(path: Path) -> None:
    path.write_text(
        "".join(f"v {x} {y} {z}\n" for x, y, z in CORNERS)
        + "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in FACES)
    )


def write_ply(path: Path, faces: int = 2) -> None:
    head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\n"
    head += f"property float z\nelement face {faces}\nproperty list uchar int vertex_indices\n"
    rows = [" ".join(map(str, c)) for c in CORNERS] + [
        f"3 {a} {b} {c}" for a, b, c in FACES[:faces]
    ]
    path.write_text(head + "end_header\n" + "\n".join(rows) + "\n")


def write_stl(path: Path) -> None:
    data = b"made for a test".ljust(80) + struct.pack("<I", 2)
    for face in FACES:
        data += struct.pack("<12fH", 0, 0, 1, *CORNERS[face].ravel(), 0)
    path.write_bytes(data)


def write_text_stl(path: Path) -> None:
    text = "solid made for a test\n"
    for face in FACES:
        corners = "".join(f"      vertex {x} {y} {z}\n" for x, y, z in CORNERS[face])
        text += f"  facet normal 0 0 1\n    outer loop\n{corners}    endloop\n  endfacet\n"
    path.write_text(text + "endsolid\n")


WRITERS = {
    "wall.obj": write_obj,
    "wall.ply": write_ply,
    "binary.stl": write_stl,
    "text.stl": write_text_stl,
}


@pytest.mark.parametrize("name", WRITERS)
def test_samples_are_uniform_over_the_faces(name: str, tmp_path: Path) -> None:
    WRITERS[name](tmp_path / name)
    count = 20_000
    points = read_mesh(tmp_path / name, count, np.random.default_rng(0)).points
    assert points.shape == (count, 3)
    np.testing.assert_allclose(points[:, 2], 2.0)
    # Cells of a 6 × 2 grid are binomial; five standard deviations.
    cells, _, _ = np.histogram2d(points[:, 0], points[:, 1], [6, 2], [[0, 3], [0, 1]])
    expected = count / 12
    assert np.all(np.abs(cells - expected) < 5.0 * np.sqrt(expected))
    assert cells.sum() == count


def test_sampling_is_the_generators(tmp_path: Path) -> None:
    write_obj(tmp_path / "wall.obj")
    a, b, c = (
        read_mesh(tmp_path / "wall.obj", 50, np.random.default_rng(s)).points for s in (1, 1, 2)
    )
    np.testing.assert_array_equal(a, b)
    assert not np.array_equal(a, c)


@pytest.mark.parametrize("name", ["wall.ply", "binary.stl", "text.stl"])
@pytest.mark.parametrize("share", [0.2, 0.6, 0.95])
def test_truncated_mesh_is_refused(name: str, share: float, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(GeometryError, match=r"truncated|not an? |damaged") as caught:
        read_mesh(path, 10, np.random.default_rng(0))
    assert name in str(caught.value)


def test_binary_ply_cut_within_its_faces_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "wall.ply"
    head = "ply\nformat binary_little_endian 1.0\nelement vertex 4\nproperty float x\n"
    head += "property float y\nproperty float z\nelement face 2\n"
    head += "property list uchar int vertex_indices\nend_header\n"
    body = CORNERS.astype("<f4").tobytes()
    body += b"".join(b"\x03" + face.astype("<i4").tobytes() for face in FACES)
    path.write_bytes(head.encode() + body)
    assert len(read_mesh(path, 10, np.random.default_rng(0)).points) == 10
    path.write_bytes(head.encode() + body[:-6])
    with pytest.raises(GeometryError, match=r"truncated.*2 faces"):
        read_mesh(path, 10, np.random.default_rng(0))


def test_mesh_without_faces_is_refused(tmp_path: Path) -> None:
    write_ply(tmp_path / "wall.ply", faces=0)
    (tmp_path / "wall.obj").write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\n")
    (tmp_path / "wall.stl").write_bytes(bytes(84))
    for name in ("wall.ply", "wall.obj", "wall.stl"):
        with pytest.raises(GeometryError, match=rf"{name}: the mesh has no faces"):
            read_mesh(tmp_path / name, 10, np.random.default_rng(0))


def test_mesh_without_area_is_refused(tmp_path: Path) -> None:
    (tmp_path / "a.obj").write_text("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\n")
    with pytest.raises(GeometryError, match=r"no area|no faces"):
        read_mesh(tmp_path / "a.obj", 10, np.random.default_rng(0))


@pytest.mark.parametrize("corner", [-1, 4, 99])
def test_faces_of_corners_that_are_not_there_are_refused(corner: int, tmp_path: Path) -> None:
    write_ply(tmp_path / "wall.ply")
    text = (tmp_path / "wall.ply").read_text()
    (tmp_path / "wall.ply").write_text(text.replace("3 0 2 3", f"3 0 2 {corner}"))
    with pytest.raises(GeometryError, match=r"wall\.ply: a face names a corner .* 4 vertices"):
        read_mesh(tmp_path / "wall.ply", 10, np.random.default_rng(0))


def test_missing_empty_and_foreign_files_are_refused(tmp_path: Path) -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(GeometryError, match="there is no such file"):
        read_mesh(tmp_path / "wall.stl", 10, rng)
    (tmp_path / "wall.stl").write_bytes(b"")
    with pytest.raises(GeometryError, match="the file is empty"):
        read_mesh(tmp_path / "wall.stl", 10, rng)
    (tmp_path / "wall.step").write_text("x")
    with pytest.raises(GeometryError, match=r"\.stl \.obj \.ply"):
        read_mesh(tmp_path / "wall.step", 10, rng)


def test_the_parser_of_ply_files_stays_silent(
    tmp_path: Path, capfd: pytest.CaptureFixture[str]
) -> None:
    path = tmp_path / "wall.ply"
    write_ply(path)
    path.write_text(path.read_text().replace("3 0 2 3", "3 0 x 3"))
    with pytest.raises(GeometryError, match=r"wall\.ply"):
        read_mesh(path, 10, np.random.default_rng(0))
    os.write(2, b"heard again")
    assert capfd.readouterr().err == "heard again"
