"""Views of a scene: camera positions with all given points in the frame and few of them hidden."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.schema.plan import Plan
from inspect_cli.schema.primitives import primitives_of
from inspect_cli.spatial.arrays import Matrix, Points, Structured, Vector
from inspect_cli.spatial.primitives import raycast

MARGIN = 1.06
LOWEST_EYE_M = 0.15
SHORT_M = 0.02
"""A point counts as visible if the ray to it ends at most this far before it, m."""
AZIMUTHS_DEG = (52.0, -52.0, 38.0, -38.0, 70.0, -70.0, 20.0, -20.0, 0.0)
"""Azimuths of the camera from the direction that the surfaces face."""
ELEVATIONS_DEG = {
    "wall": (19.0, 7.0, 24.0, -6.0),
    "above": (-7.0, 2.0, 12.0),
    "below": (24.0, 38.0),
}
OVERHEAD, UNDERFOOT = -0.5, 0.5
"""z of the normal below or above which a surface is overhead or underfoot."""


@dataclass(frozen=True, eq=False)
class View:
    """A camera at ``eye_W`` (3,) that looks at ``at_W`` (3,), m."""

    eye_W: Vector
    at_W: Vector


def facing(plan: Plan) -> Vector:
    """The mean outward normal (3,) at the targets, a unit vector."""
    n_W: Vector = np.mean([target.n_W for target in plan.targets], axis=0)
    length = np.linalg.norm(n_W)
    return n_W / length if length > 0.1 else np.array([-1.0, 0.0, 0.0])


def best_view(
    plan: Plan, shown: Points, watched: Points, beside: Vector, fov_rad: float, aspect: float
) -> View:
    """The view of all points ``shown`` (n, 3) from which most of ``watched`` (m, 3) is seen.

    Of two equally good sides it takes the one to which ``beside`` (3,) points.
    """
    patches = primitives_of([surface.shape for surface in plan.surfaces])
    n_W = facing(plan)
    views = [framed(shown, d, fov_rad, aspect) for d in _directions(n_W, beside)]
    above_ground = [view for view in views if view.eye_W[2] > LOWEST_EYE_M] or views
    return max(above_ground, key=lambda view: _seen(view, patches, watched))


def _directions(n_W: Vector, beside: Vector) -> list[Vector]:
    """Unit vectors from the scene to the camera, the preferred first."""
    level = np.array([n_W[0], n_W[1], 0.0])
    length = np.linalg.norm(level)
    level = level / length if length > 0.3 else np.array([-1.0, 0.0, 0.0])
    side = np.array([-level[1], level[0], 0.0])
    side = -side if side @ beside < 0.0 else side
    kind = "above" if n_W[2] < OVERHEAD else "below" if n_W[2] > UNDERFOOT else "wall"
    directions = []
    for elevation in np.radians(ELEVATIONS_DEG[kind]):
        for azimuth in np.radians(AZIMUTHS_DEG):
            flat = np.cos(azimuth) * level + np.sin(azimuth) * side
            directions.append(np.cos(elevation) * flat + np.array([0.0, 0.0, np.sin(elevation)]))
    return directions


def framed(shown: Points, direction: Vector, fov_rad: float, aspect: float) -> View:
    """The nearest view along ``direction`` (3,) that has every point (n, 3) in its frame.

    With (a, b, c) a point's coordinates to the right, up and towards the camera, and k the
    tangent of half the opening, |a − x| ≤ (D − c) k for all points. So the distance is
    D = (max(a + c k) + max(−a + c k)) / 2k, and x = (max(a + c k) − max(−a + c k)) / 2 is the
    camera's place to the right; upwards alike, and the larger distance holds.
    """
    axes = _axes(direction)
    a, b, c = (shown @ axes).T
    tall = np.tan(0.5 * fov_rad) / MARGIN
    x, distance_x = _fit(a, c, tall * aspect)
    y, distance_y = _fit(b, c, tall)
    depth = max(distance_x, distance_y)
    eye: Vector = axes @ np.array([x, y, depth])
    at: Vector = axes @ np.array([x, y, float(np.mean(c))])
    return View(eye, at)


def _fit(across: Vector, towards: Vector, k: float) -> tuple[float, float]:
    """(place of the camera across, its distance along the view)."""
    right, left = np.max(across + towards * k), np.max(-across + towards * k)
    return float(0.5 * (right - left)), float(0.5 * (right + left) / k)


def _axes(direction: Vector) -> Matrix:
    """Columns: to the right, up, towards the camera."""
    right = np.cross([0.0, 0.0, 1.0], direction)
    right /= np.linalg.norm(right)
    return np.column_stack([right, np.cross(direction, right), direction])


def _seen(view: View, patches: Structured, watched: Points) -> float:
    """Share of the points that no patch hides, rounded so that a few do not decide."""
    rays = watched - view.eye_W
    lengths = np.linalg.norm(rays, axis=1)
    ranges = np.full(len(rays), np.nan)
    if len(patches):
        directions = np.ascontiguousarray(rays / lengths[:, None])
        raycast(patches, view.eye_W, directions, float(lengths.max()) + 1.0, ranges)
    free = np.isnan(ranges) | (ranges > lengths - SHORT_M)
    return round(float(np.mean(free)), 1)


def in_frame(view: View, points: Points, fov_rad: float, aspect: float) -> Points:
    """Places (n, 2) of points in the frame: −1 to 1 from left to right and from bottom to top."""
    towards = view.eye_W - view.at_W
    axes = _axes(towards / np.linalg.norm(towards))
    a, b, c = ((points - view.eye_W) @ axes).T
    k = np.tan(0.5 * fov_rad) * np.maximum(-c, 1e-6)
    return np.column_stack([a / (k * aspect), b / k])


def boxed(points: Points, half_m: float) -> Points:
    """The corners (8 n, 3) of cubes around points (n, 3)."""
    signs = np.array([(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)], dtype=float)
    corners: Points = (points[:, None, :] + half_m * signs).reshape(-1, 3)
    return corners


def near(points: Points, around: Sequence[Vector] | Points, within_m: float) -> Points:
    """Those of the points (n, 3) that lie within the others' bounding box, grown by a margin."""
    low = np.min(around, axis=0) - within_m
    high = np.max(around, axis=0) + within_m
    kept: Points = points[np.all((points >= low) & (points <= high), axis=1)]
    return kept
