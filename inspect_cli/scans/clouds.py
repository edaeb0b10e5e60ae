"""Reading point clouds. Every file that cannot be trusted is refused by name."""

from __future__ import annotations

import struct
from collections.abc import Callable
from pathlib import Path

import numpy as np

from inspect_cli.scans.files import (
    ReadPoints,
    muted_stderr,
    open3d,
    refused,
    require_file,
    truncated,
)
from inspect_cli.scans.headers import whole_pcd, whole_ply
from inspect_cli.spatial.arrays import Points

AGAIN = "export or copy it again"
DAMAGED = (RuntimeError, ValueError, KeyError, OverflowError, MemoryError, EOFError, struct.error)
"""What readers of binary formats raise where a header or the bytes make no sense."""
LAS_CHUNK = 1_000_000
"""Points that are read at once, so that a wrong count in a header allocates no more."""


def read_cloud(path: Path) -> ReadPoints:
    """The valid points of a cloud file, m, in its own coordinates.

    PLY, PCD, XYZ, CSV, LAS, LAZ or E57, told by the suffix. Points with a coordinate that
    is NaN or infinite are dropped and counted. Raises GeometryError where the file is missing,
    empty, damaged, truncated or without a valid point.
    """
    suffix = require_file(path, READERS, "cloud")
    points = READERS[suffix](path)
    if len(points) == 0:
        raise refused(path, "the cloud holds no points", "export it again with its points")
    valid = np.all(np.isfinite(points), axis=1)
    if not valid.any():
        raise refused(
            path,
            f"none of the {len(points)} points is valid: each has NaN or infinity",
            "export the cloud with its valid points",
        )
    dropped = int(np.count_nonzero(~valid))
    return ReadPoints(np.ascontiguousarray(points[valid], dtype=np.float64), dropped)


def _read_ply(path: Path) -> Points:
    header = whole_ply(path)
    names = next((e.properties for e in header.elements if e.name == "vertex"), ())
    if not {"x", "y", "z"} <= set(names):
        raise refused(path, "the PLY file has no vertices with x, y, z", "export the points")
    lines = header.vertex_lines()
    if lines is not None:
        return _numbers(path, lines, None, [names.index(axis) for axis in "xyz"])
    return _read_by_open3d(path)


def _read_pcd(path: Path) -> Points:
    header = whole_pcd(path)
    if header.lines is not None:
        return _numbers(path, header.lines, None, [header.columns[axis] for axis in "xyz"])
    return _read_by_open3d(path)


def _read_by_open3d(path: Path) -> Points:
    module = open3d()
    with muted_stderr():
        cloud = module.io.read_point_cloud(
            str(path), remove_nan_points=False, remove_infinite_points=False
        )
    points: Points = np.array(cloud.points)
    return points


def _read_text(path: Path) -> Points:
    """Columns x, y, z: the first three, or those that a header line names so."""
    try:
        lines = path.read_text(encoding="utf-8-sig").splitlines()
    except UnicodeDecodeError as error:
        raise refused(path, "this is not a text file", AGAIN) from error
    rows = [line for line in lines if line.strip() and not line.lstrip().startswith("#")]
    if not rows:
        return np.empty((0, 3))
    delimiter = next((d for d in (",", ";", "\t") if d in rows[0]), None)
    columns = [0, 1, 2]
    header = [word.strip().strip('"').lower() for word in rows[0].split(delimiter)]
    if not all(_is_number(word) for word in header):
        if not {"x", "y", "z"} <= set(header):
            raise refused(
                path,
                f"the header names {', '.join(header)}, but not x, y and z",
                "name the columns x,y,z or leave the header out",
            )
        columns = [header.index(axis) for axis in "xyz"]
        rows = rows[1:]
    return _numbers(path, rows, delimiter, columns)


def _numbers(path: Path, rows: list[str], delimiter: str | None, columns: list[int]) -> Points:
    if not rows:
        return np.empty((0, 3))
    try:
        return np.loadtxt(rows, delimiter=delimiter, usecols=columns, ndmin=2, comments=None)
    except ValueError as error:
        raise refused(
            path, f"a line cannot be read: {error}", "give three numbers x y z"
        ) from error


def _is_number(word: str) -> bool:
    try:
        float(word)
    except ValueError:
        return False
    return True


def _read_las(path: Path) -> Points:
    import laspy

    chunks = [np.empty((0, 3))]
    try:
        with laspy.open(path) as reader:
            header = reader.header
            promised = header.point_count
            if not header.are_points_compressed:
                room = path.stat().st_size - header.offset_to_point_data
                held = max(room, 0) // header.point_format.size
                if held < promised:
                    raise truncated(path, f"{promised} points", str(held))
            for chunk in reader.chunk_iterator(LAS_CHUNK):
                chunks.append(np.column_stack([chunk.x, chunk.y, chunk.z]))
    except (laspy.errors.LaspyException, *DAMAGED) as error:
        # The decompressor of LAZ raises RuntimeErrors of its own.
        raise refused(path, f"the file is truncated or damaged: {error}", AGAIN) from error
    points: Points = np.vstack(chunks)
    if len(points) != promised:
        raise truncated(path, f"{promised} points", str(len(points)))
    return points


def _read_e57(path: Path) -> Points:
    """All scans of the file, each brought to the file's frame by its pose."""
    import pye57

    scans = [np.empty((0, 3))]
    try:
        file = pye57.E57(str(path))
        for index in range(file.scan_count):
            scan = file.read_scan(index, ignore_missing_fields=True)
            scans.append(np.column_stack([scan[f"cartesian{axis}"] for axis in "XYZ"]))
        file.close()
    except (pye57.libe57.E57Exception, *DAMAGED) as error:
        reason = str(error).partition("\n")[0]
        raise refused(path, f"the file is truncated or damaged: {reason}", AGAIN) from error
    return np.vstack(scans)


READERS: dict[str, Callable[[Path], Points]] = {
    ".ply": _read_ply,
    ".pcd": _read_pcd,
    ".xyz": _read_text,
    ".csv": _read_text,
    ".las": _read_las,
    ".laz": _read_las,
    ".e57": _read_e57,
}
