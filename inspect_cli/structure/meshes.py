"""Reading meshes, as points sampled evenly over their faces."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.structure.files import (
    ReadPoints,
    muted_stderr,
    open3d,
    refused,
    require_file,
    truncated,
)
from inspect_cli.structure.headers import require_whole_stl, whole_ply

SUFFIXES = (".stl", ".obj", ".ply")


def read_mesh(path: Path, samples: int, rng: np.random.Generator) -> ReadPoints:
    """``samples`` points, uniform over the area of the mesh's triangles, m.

    STL, OBJ or PLY, told by the suffix. Triangles with an invalid corner are dropped and
    counted. Raises GeometryError where the file is missing, empty, damaged, truncated or
    without faces. An OBJ file does not say how many faces it should have: a cut is noticed
    only where it leaves a broken line.
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
    corners = vertices[triangles]
    valid = np.all(np.isfinite(corners), axis=(1, 2))
    if not valid.any():
        raise refused(path, "every face has an invalid corner", "export the mesh again")
    corners = corners[valid]
    area = 0.5 * np.linalg.norm(_doubled_normals(corners), axis=1)
    if not area.sum() > 0.0:
        raise refused(path, "the faces have no area", "export the mesh again")
    points = _sampled(corners, area, samples, rng)
    return ReadPoints(points, int(np.count_nonzero(~valid)))


def _without_faces(path: Path) -> Exception:
    return refused(
        path,
        "the mesh has no faces, or they cannot be read",
        "export it with its faces, or give a file of points under 'cloud'",
    )


def _doubled_normals(corners: Points) -> Points:
    a, b, c = corners[:, 0], corners[:, 1], corners[:, 2]
    return np.cross(b - a, c - a)


def _sampled(corners: Points, area: Vector, samples: int, rng: np.random.Generator) -> Points:
    """Points uniform over the triangles ``corners`` (n, 3, 3).

    In a triangle, a + s (b − a) + t (c − a) with (s, t) uniform in the unit square, folded
    along its diagonal, is uniform.
    """
    chosen = corners[rng.choice(len(corners), samples, p=area / area.sum())]
    st = rng.random((samples, 2))
    folded = np.where(st.sum(axis=1, keepdims=True) > 1.0, 1.0 - st, st)
    a, b, c = chosen[:, 0], chosen[:, 1], chosen[:, 2]
    points: Points = a + folded[:, :1] * (b - a) + folded[:, 1:] * (c - a)
    return points
