"""Meshes as points sampled evenly over their faces."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from inspect_cli.scans.files import ReadPoints
from inspect_cli.scans.meshes import doubled_normals, read_triangles
from inspect_cli.spatial.arrays import Points, Vector


def read_mesh(path: Path, samples: int, rng: np.random.Generator) -> ReadPoints:
    """``samples`` points, uniform over the area of the mesh's triangles, m.

    Raises GeometryError for what ``read_triangles`` refuses.
    """
    read = read_triangles(path)
    area = 0.5 * np.linalg.norm(doubled_normals(read.corners), axis=1)
    return ReadPoints(_sampled(read.corners, area, samples, rng), read.dropped)


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
