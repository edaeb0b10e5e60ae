"""Every cloud format read back, and every bad file refused by name."""

from __future__ import annotations

import struct
from pathlib import Path

import laspy
import numpy as np
import pytest
from cloud_files import POINTS, WRITERS, write_e57, write_las, write_pcd

from inspect_cli.errors import GeometryError
from inspect_cli.scans.clouds import READERS, read_cloud

PLY_HEAD = "ply\nformat ascii 1.0\nelement vertex 2\n" + "".join(
    f"property float {axis}\n" for axis in "xyz"
)
PLY_HEAD += "end_header\n"
PCD_HEAD = "FIELDS x y z\nSIZE 4 4 4\nPOINTS 2\nDATA ascii\n"


@pytest.mark.parametrize("name", WRITERS)
def test_points_are_read_back(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path, POINTS)
    read = read_cloud(path)
    assert read.dropped == 0
    assert read.points.dtype == np.float64
    # float32 in PCD; the scale of 0.1 mm in LAS.
    np.testing.assert_allclose(read.points, POINTS, atol=1e-6)


@pytest.mark.parametrize("name", [n for n in WRITERS if not n.startswith("scan.")])
def test_invalid_points_are_dropped_and_counted(name: str, tmp_path: Path) -> None:
    points = POINTS.copy()
    points[::4, 1] = np.nan
    points[1, 2] = np.inf
    WRITERS[name](tmp_path / name, points)
    read = read_cloud(tmp_path / name)
    assert read.dropped == 201
    np.testing.assert_allclose(read.points, points[np.isfinite(points).all(axis=1)], atol=1e-6)


@pytest.mark.parametrize("name", [n for n in WRITERS if not n.startswith("scan.")])
def test_cloud_of_nan_is_refused(name: str, tmp_path: Path) -> None:
    WRITERS[name](tmp_path / name, np.full((30, 3), np.nan))
    with pytest.raises(GeometryError, match=r"none of the 30 points is valid") as caught:
        read_cloud(tmp_path / name)
    assert name in str(caught.value)


@pytest.mark.parametrize("share", [0.03, 0.5, 0.97])
@pytest.mark.parametrize(
    "name", [n for n in WRITERS if Path(n).suffix not in (".xyz", ".csv", ".CSV")]
)
def test_truncated_file_is_refused(name: str, share: float, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path, POINTS)
    data = path.read_bytes()
    path.write_bytes(data[: int(share * len(data))])
    with pytest.raises(GeometryError, match=r"truncated|damaged|cut|not a PLY") as caught:
        read_cloud(path)
    assert name in str(caught.value)
    assert "again" in caught.value.problems[0].hint or "first line" in str(caught.value)


def test_las_cut_between_two_points_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scan.las"
    write_las(path, POINTS)
    record = laspy.LasHeader(point_format=3, version="1.2").point_format.size
    path.write_bytes(path.read_bytes()[: -100 * record])
    with pytest.raises(GeometryError, match=r"truncated.*800 points"):
        read_cloud(path)


def test_e57_with_a_flipped_byte_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "scan.e57"
    write_e57(path, POINTS)
    data = bytearray(path.read_bytes())
    data[len(data) // 2] ^= 0xFF
    path.write_bytes(bytes(data))
    with pytest.raises(GeometryError, match=r"damaged.*checksum"):
        read_cloud(path)


@pytest.mark.parametrize("name", WRITERS)
def test_empty_file_and_file_of_another_kind_are_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    path.write_bytes(b"")
    with pytest.raises(GeometryError, match="the file is empty"):
        read_cloud(path)
    path.write_bytes(b"\x89PNG\r\n\x1a\n\x00\xff" * 40)
    with pytest.raises(GeometryError) as caught:
        read_cloud(path)
    assert name in str(caught.value)


@pytest.mark.parametrize("name", [n for n in WRITERS if Path(n).suffix != ".e57"])
def test_cloud_without_points_is_refused(name: str, tmp_path: Path) -> None:
    WRITERS[name](tmp_path / name, np.empty((0, 3)))
    with pytest.raises(GeometryError) as caught:
        read_cloud(tmp_path / name)
    assert name in str(caught.value)


def test_missing_file_is_refused(tmp_path: Path) -> None:
    with pytest.raises(GeometryError, match=r"wall\.ply: there is no such file"):
        read_cloud(tmp_path / "wall.ply")


def test_wrong_suffix_lists_the_valid_ones(tmp_path: Path) -> None:
    path = tmp_path / "wall.docx"
    path.write_text("0 0 0\n")
    with pytest.raises(GeometryError) as caught:
        read_cloud(path)
    for suffix in READERS:
        assert suffix in str(caught.value)


def test_columns_are_found_by_name(tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    path.write_text('intensity,"Z",y,X\n9,3,2,1\n9,6,5,4\n')
    np.testing.assert_array_equal(read_cloud(path).points, [[1, 2, 3], [4, 5, 6]])


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("east,north,up\n1,2,3\n", "the header names east, north, up"),
        ("x,y,z\n1,2,3\n1,two,3\n", "a line cannot be read.*two"),
        ("x,y,z\n1,2,3\n1,2\n", "a line cannot be read"),
        ("1,2\n3,4\n", "a line cannot be read"),
        ("# nothing here\n\n", "holds no points"),
        ("x,y,z\n", "holds no points"),
    ],
)
def test_bad_table_is_refused(text: str, message: str, tmp_path: Path) -> None:
    path = tmp_path / "scan.csv"
    path.write_text(text)
    with pytest.raises(GeometryError, match=message):
        read_cloud(path)


@pytest.mark.parametrize(
    ("name", "text", "message"),
    [
        ("a.ply", "ply\nformat ascii 1.0\nelement face 1\nend_header\n1\n", "no vertices"),
        ("a.ply", "ply\nelement vertex 1\nend_header\n1\n", "header is damaged"),
        ("a.ply", "ply\nformat ascii 1.0\nelement vertex x\nend_header\n1\n", "header is damaged"),
        ("a.pcd", "FIELDS x y\nSIZE 4 4\nPOINTS 1\nDATA ascii\n1 2\n", "no fields x y z"),
        ("a.pcd", "FIELDS x y z\nSIZE 4 4 4\nDATA ascii\n1 2 3\n", "header is damaged"),
        ("a.pcd", "FIELDS x y z\n", "its header is cut"),
        ("a.ply", PLY_HEAD + "1 2 3\n1 oops 3\n", "a line cannot be read.*oops"),
        ("a.pcd", PCD_HEAD + "1 2 3\n1 oops 3\n", "a line cannot be read.*oops"),
    ],
)
def test_bad_header_is_refused(name: str, text: str, message: str, tmp_path: Path) -> None:
    (tmp_path / name).write_text(text)
    with pytest.raises(GeometryError, match=message):
        read_cloud(tmp_path / name)


def test_pcd_with_more_compressed_bytes_than_there_are(tmp_path: Path) -> None:
    path = tmp_path / "a.pcd"
    write_pcd(path, POINTS, "binary_compressed")
    head = path.read_bytes().partition(b"binary_compressed\n")
    path.write_bytes(head[0] + head[1] + struct.pack("<II", 5000, 9600) + b"\0" * 100)
    with pytest.raises(GeometryError, match="truncated"):
        read_cloud(path)


@pytest.mark.parametrize("name", ["scan.las", "scan.laz"])
def test_las_that_promises_more_points_than_fit_is_refused(name: str, tmp_path: Path) -> None:
    path = tmp_path / name
    WRITERS[name](path, POINTS)
    data = bytearray(path.read_bytes())
    struct.pack_into("<I", data, 107, 4_000_000_000)  # legacy count, LAS 1.0 to 1.3
    path.write_bytes(bytes(data))
    with pytest.raises(GeometryError, match=r"truncated") as caught:
        read_cloud(path)
    assert name in str(caught.value)


def test_pcd_that_promises_more_points_than_could_be_compressed(tmp_path: Path) -> None:
    path = tmp_path / "a.pcd"
    write_pcd(path, POINTS, "binary_compressed")
    data = path.read_bytes().replace(b"POINTS %d" % len(POINTS), b"POINTS 4000000000")
    assert b"4000000000" in data
    path.write_bytes(data)
    with pytest.raises(GeometryError, match=r"truncated.*4000000000 points"):
        read_cloud(path)
