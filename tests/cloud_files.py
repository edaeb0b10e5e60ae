"""The same points in every format that a cloud may come in."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import laspy
import numpy as np
import pye57

from inspect_cli.scans.files import open3d
from inspect_cli.spatial.arrays import Points

POINTS: Points = np.round(np.random.default_rng(0).uniform(-3.0, 3.0, (800, 3)), 4)


def write_ply(path: Path, points: Points, ascii_text: bool = False) -> None:
    form = "ascii" if ascii_text else "binary_little_endian"
    head = f"ply\nformat {form} 1.0\ncomment made for a test\nelement vertex {len(points)}\n"
    head += "".join(f"property double {axis}\n" for axis in "xyz") + "end_header\n"
    body = text_of(points, " ").encode() if ascii_text else points.astype("<f8").tobytes()
    path.write_bytes(head.encode() + body)


def write_pcd(path: Path, points: Points, data: str) -> None:
    head = "# .PCD v0.7\nVERSION 0.7\nFIELDS x y z\nSIZE 4 4 4\nTYPE F F F\nCOUNT 1 1 1\n"
    head += f"WIDTH {len(points)}\nHEIGHT 1\nVIEWPOINT 0 0 0 1 0 0 0\n"
    head += f"POINTS {len(points)}\nDATA {data}\n"
    body = text_of(points, " ").encode() if data == "ascii" else points.astype("<f4").tobytes()
    path.write_bytes(head.encode() + body)


def write_compressed_pcd(path: Path, points: Points) -> None:
    module = open3d()
    cloud = module.geometry.PointCloud(module.utility.Vector3dVector(points))
    module.io.write_point_cloud(str(path), cloud, compressed=True)


def text_of(points: Points, delimiter: str) -> str:
    return "".join(delimiter.join(f"{x:.6g}" for x in p) + "\n" for p in points)


def write_las(path: Path, points: Points) -> None:
    header = laspy.LasHeader(point_format=3, version="1.2")
    header.scales = [1e-4] * 3
    las = laspy.LasData(header)
    las.xyz = points
    las.write(str(path))


def write_e57(path: Path, points: Points) -> None:
    """Two scans, the second turned by 90° about z and shifted."""
    file = pye57.E57(str(path), mode="w")
    half = len(points) // 2
    turned = (points[half:] - [1.0, 2.0, 3.0]) @ np.array([[0, -1, 0], [1, 0, 0], [0, 0, 1]])
    quaternion = np.array([np.sqrt(0.5), 0.0, 0.0, np.sqrt(0.5)])
    for part, q, t in (
        (points[:half], np.array([1.0, 0, 0, 0]), np.zeros(3)),
        (turned, quaternion, np.array([1.0, 2.0, 3.0])),
    ):
        scan = {f"cartesian{axis}": part[:, k] for k, axis in enumerate("XYZ")}
        file.write_scan_raw(scan, rotation=q, translation=t)
    file.close()


WRITERS: dict[str, Callable[[Path, Points], object]] = {
    "text.ply": lambda path, points: write_ply(path, points, ascii_text=True),
    "binary.ply": write_ply,
    "text.pcd": lambda path, points: write_pcd(path, points, "ascii"),
    "binary.pcd": lambda path, points: write_pcd(path, points, "binary"),
    "compressed.pcd": write_compressed_pcd,
    "plain.xyz": lambda path, points: path.write_text("# survey\n" + text_of(points, " ")),
    "plain.csv": lambda path, points: path.write_text(text_of(points, ",")),
    "SCAN.CSV": lambda path, points: path.write_text("x;y;z\n" + text_of(points, ";")),
    "scan.las": write_las,
    "scan.laz": write_las,
    "scan.e57": write_e57,
}
