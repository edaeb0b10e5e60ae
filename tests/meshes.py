"""Meshes of known heights, and their files."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np

from inspect_cli.simulation.vault import mesh_ply

Array = np.ndarray
Heights = Callable[[Array, Array], Array]


def graph_corners(
    height: Heights, half_m: tuple[float, float] = (1.0, 0.8), step_m: float = 0.01
) -> Array:
    """Triangles (n, 3, 3), m, of z = height(x, y), which turn upwards."""
    x = np.linspace(-half_m[0], half_m[0], round(2 * half_m[0] / step_m) + 1)
    y = np.linspace(-half_m[1], half_m[1], round(2 * half_m[1] / step_m) + 1)
    X, Y = np.meshgrid(x, y)
    points = np.stack([X, Y, height(X, Y)], axis=-1)
    a, b, c, d = points[:-1, :-1], points[:-1, 1:], points[1:, 1:], points[1:, :-1]
    lower, upper = np.stack([a, b, c], axis=-2), np.stack([a, c, d], axis=-2)
    return np.concatenate([lower.reshape(-1, 3, 3), upper.reshape(-1, 3, 3)])


def box_corners(size: float = 1.0) -> Array:
    """The twelve triangles of a cube, turned outwards."""
    faces = []
    for axis in range(3):
        for side in (-1.0, 1.0):
            u, v, n = np.zeros((3, 3))
            n[axis], u[(axis + 1) % 3], v[(axis + 2) % 3] = side, 1.0, side
            corners = [n - u - v, n + u - v, n + u + v, n - u + v]
            faces += [corners[:3], [corners[0], *corners[2:]]]
    return 0.5 * size * np.array(faces)


def write_mesh(path: Path, corners: Array) -> None:
    """Triangles as a binary PLY file."""
    faces = np.arange(3 * len(corners), dtype=np.int32).reshape(-1, 3)
    path.write_bytes(mesh_ply(corners.reshape(-1, 3), faces))
