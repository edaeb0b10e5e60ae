"""Nodes on the bounded patch of a primitive, for whatever draws it."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from inspect_cli.spatial.arrays import Points, Structured, Vector
from inspect_cli.spatial.primitives import point_at


def patch_coordinates(patch: Structured, segments: tuple[int, int]) -> tuple[Vector, Vector]:
    """(u, v), m: those of the nodes' columns (segments[0] + 1,) and rows (segments[1] + 1,).

    ``patch`` is a PRIMITIVE array of length 1.
    """
    half_u, half_v = patch["half_size"][0]
    u = np.linspace(-half_u, half_u, segments[0] + 1)
    return u, np.linspace(-half_v, half_v, segments[1] + 1)


def patch_nodes(patch: Structured, segments: tuple[int, int]) -> Points:
    """Nodes (rows, columns, 3) in W, m, evenly spaced in (u, v) over the whole patch."""
    u, v = patch_coordinates(patch, segments)
    return np.array([[point_at(patch, 0, a, b) for a in u] for b in v])


def grid_triangles(segments: tuple[int, int]) -> NDArray[np.int64]:
    """Triangles (n, 3): numbers of the nodes, row by row, counter-clockwise seen against n."""
    columns = segments[0] + 1
    corner = np.arange(segments[1])[:, None] * columns + np.arange(segments[0])
    right, above = corner + 1, corner + columns
    return np.stack([corner, right, above, right, above + 1, above], axis=-1).reshape(-1, 3)
