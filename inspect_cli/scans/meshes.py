"""Reading meshes, as triangles."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np

from inspect_cli.scans.files import muted_stderr, open3d, refused, require_file, truncated
from inspect_cli.scans.headers import require_whole_stl, whole_ply
from inspect_cli.spatial.arrays import Points

SUFFIXES = (".stl", ".obj", ".ply")


@dataclass(frozen=True)
class ReadTriangles:
    """Corners (n, 3, 3), m, of a mesh's triangles, and how many invalid ones its file held."""

    corners: Points
    dropped: int


def read_triangles(path: Path) -> ReadTriangles:
    """The triangles of an STL, OBJ or PLY file, told by its suffix, in the file's coordinates.

    Triangles with an invalid corner are dropped and counted. Raises GeometryError where the file
    is missing, empty, damaged, truncated or without faces, or where the faces have no area or
    corners that the file does not hold. An
    OBJ file does not say how many faces it should have: a cut is noticed only where it leaves a
    broken line.
    """
    suffix = require_file(path, SUFFIXES, "mesh")
    promised = 0
    if suffix == ".stl":
        require_whole_stl(path)
    if suffix == ".ply":
        promised = whole_ply(path).count("face")
        if promised == 0:
            raise _without_faces(path)
    module = open3d()
    with muted_stderr():
        mesh = module.io.read_triangle_mesh(str(path))
    vertices, triangles = np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if len(triangles) == 0:
        raise _without_faces(path)
    if len(triangles) < promised:
        raise truncated(path, f"{promised} faces", str(len(triangles)))
    if triangles.min() < 0 or triangles.max() >= len(vertices):
        what = f"a face names a corner that is not among the {len(vertices)} vertices"
        raise refused(path, what, "export the mesh again")
    corners = vertices[triangles]
    valid = np.all(np.isfinite(corners), axis=(1, 2))
    if not valid.any():
        raise refused(path, "every face has an invalid corner", "export the mesh again")
    corners = corners[valid]
    if not np.linalg.norm(doubled_normals(corners), axis=1).sum() > 0.0:
        raise refused(path, "the faces have no area", "export the mesh again")
    return ReadTriangles(corners, int(np.count_nonzero(~valid)))


def doubled_normals(corners: Points) -> Points:
    """Normals (n, 3) of triangles (n, 3, 3) by the right hand, twice as long as their area."""
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.cross(b - a, c - a)


def _without_faces(path: Path) -> Exception:
    return refused(
        path,
        "the mesh has no faces, or they cannot be read",
        "export it with its faces, or give a file of points under 'cloud'",
    )
