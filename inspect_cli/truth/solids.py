"""Every true surface in a form for kernels: bounded primitives, then reliefs, in one count.

Simulator and sensors ask through this page and do not care which of the two a surface is. Where
there is no relief, none of its kernels is called: what is not flown is not compiled either.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Points, Structured, Vector
from inspect_cli.spatial.primitives import (
    normal_at,
    plane,
    point_at,
    project,
    raycast,
)
from inspect_cli.truth.relief import (
    RELIEF,
    relief_foot,
    relief_normal,
    relief_point,
)
from inspect_cli.truth.relief_rays import cast_on_reliefs


class Solids(NamedTuple):
    """Surfaces 0 … n − 1 are ``primitives``, those from n on ``reliefs`` with their ``nodes``."""

    primitives: Structured
    reliefs: Structured = np.zeros(0, RELIEF)
    nodes: Matrix = np.zeros((2, 0))


def on_the_ground(solids: Solids) -> Solids:
    """The same with the ground, z = 0, as surface 0."""
    ground = plane(np.zeros(3), np.array([0.0, 0.0, 1.0]), (200.0, 200.0))
    return solids._replace(primitives=np.concatenate([ground, solids.primitives]))


def joined_reliefs(parts: Sequence[tuple[Structured, Matrix]]) -> tuple[Structured, Matrix]:
    """Reliefs (1,) with nodes of their own as one array (n,) with the nodes of all."""
    if not parts:
        return np.zeros(0, RELIEF), np.zeros((2, 0))
    rows = np.concatenate([row for row, _ in parts])
    sizes = [nodes.shape[1] for _, nodes in parts]
    rows["first"] = np.cumsum([0, *sizes[:-1]])
    return rows, np.concatenate([nodes for _, nodes in parts], axis=1)


def cast(
    solids: Solids, origin_W: Vector, directions_W: Points, farthest: Vector, ranges: Vector
) -> None:
    """Write into ``ranges`` (n,) the distance, m, to the first surface that each ray meets.

    ``directions_W`` (n, 3) are unit vectors in W from ``origin_W``. A ray is followed as far as
    its ``farthest`` (n,): NaN, or any larger range, where it meets nothing before.
    """
    if not ranges.size:
        return
    raycast(solids.primitives, origin_W, directions_W, farthest.max(), ranges)
    if len(solids.reliefs):
        cast_on_reliefs(solids.reliefs, solids.nodes, origin_W, directions_W, farthest, ranges)


@kernel
def foot_on(solids: Solids, i: int, p_W: Vector) -> tuple[float, float, float, bool]:
    """(u, v, w, on): where a point stands above surface ``i``, m, and whether that is within it.

    w is its height over the surface, positive on the free side.
    """
    n = solids.primitives.shape[0]
    if i >= n:
        found = relief_foot(solids.reliefs, solids.nodes, i - n, p_W)
        return found[0], found[1], found[2], found[3]
    return foot_on_patch(solids.primitives, i, p_W)


@kernel
def foot_on_patch(prims: Structured, i: int, p_W: Vector) -> tuple[float, float, float, bool]:
    """The same for the bounded patch of primitive ``i`` alone."""
    uvw = project(prims, i, p_W)
    half_u, half_v = prims["half_size"][i, 0], prims["half_size"][i, 1]
    return uvw[0], uvw[1], uvw[2], abs(uvw[0]) <= half_u and abs(uvw[1]) <= half_v


@kernel
def normal_on(solids: Solids, i: int, u: float, v: float) -> Vector:
    """Unit normal (3,) in W of surface ``i`` at (u, v) m, to its free side."""
    n = solids.primitives.shape[0]
    if i < n:
        return normal_at(solids.primitives, i, u, v)
    return relief_normal(solids.reliefs, solids.nodes, i - n, u, v)


@kernel
def point_on(solids: Solids, i: int, u: float, v: float) -> Vector:
    """The point (3,) in W, m, of surface ``i`` at (u, v) m."""
    n = solids.primitives.shape[0]
    if i < n:
        return point_at(solids.primitives, i, u, v)
    return relief_point(solids.reliefs, solids.nodes, i - n, u, v)
