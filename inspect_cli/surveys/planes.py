"""Readings in space, laid out on the plane that fits them best."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.primitives import level_axes

TOLERANCE_M = 0.02
"""Farther from the plane than this, (u, v) misstates distances along the surface."""
THIN = 1e-3
"""Points whose second extent is less than this share of the first lie on a line."""
LEVEL = np.sqrt(0.5)
"""A normal whose vertical part is larger belongs to a surface that is rather level than steep."""


@dataclass(frozen=True)
class FittedPlane:
    """p = p_WS + R_WS [u, v, 0], z_S outward, x_S level where the plane lets it be."""

    p_WS: Vector
    R_WS: Matrix
    rms_m: float
    """Root mean square of the points' distances from the plane,"""
    max_m: float
    """and the largest."""


def fitted_plane(p_W: Points, seen_from_m: Vector | None) -> tuple[FittedPlane, Points] | str:
    """The plane of least squared distances and the points' (u, v) (n, 2) on it, m.

    The normal is the right singular vector of the centred points with the least singular value,
    turned outward; u then runs to the right and v up for whoever stands there
    (``spatial.primitives.level_axes``). The origin is where u and v are least.

    Args:
        p_W: (n, 3), m.
        seen_from_m: a place on the side that the readings were taken from. Without it, what is
            rather level than steep is taken for a deck that is seen from above, and what is
            steep is taken to be seen from the origin, where a total station stands.

    Returns:
        why there is none, if the points do not determine a plane or the place not its side.
    """
    middle = p_W.mean(axis=0)
    _, extents, axes = np.linalg.svd(p_W - middle, full_matrices=False)
    if len(p_W) < 3 or extents[1] <= THIN * extents[0]:
        return "the points lie on a line and determine no plane"
    n = axes[2]
    outward = -middle @ n if seen_from_m is None else (seen_from_m - middle) @ n
    if seen_from_m is None and abs(n[2]) > LEVEL:
        outward = n[2]
    elif abs(outward) < TOLERANCE_M:
        place = "the origin of the coordinates" if seen_from_m is None else "seen_from_m"
        return f"{place} lies on the surface, so that nothing tells its outer side"
    R_WS = level_axes(n if outward > 0 else -n)
    along = (p_W - middle) @ R_WS
    corner = np.array([*along[:, :2].min(axis=0), 0.0])
    off = np.abs(along[:, 2])
    plane = FittedPlane(
        middle + R_WS @ corner, R_WS, float(np.sqrt(np.mean(off**2))), float(off.max())
    )
    return plane, along[:, :2] - corner[:2]
