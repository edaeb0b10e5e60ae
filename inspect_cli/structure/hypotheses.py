"""Candidate surfaces through minimal samples of points.

Planes go through three points, spheres through four. A cylinder is fixed by two points with
normals: the axis is square to both normals and passes where their lines, seen along it, meet
(Schnabel, Wahl & Klein, "Efficient RANSAC for point-cloud shape detection", 2007). All samples
are drawn at once, and all candidates are computed at once.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.primitives import PLANE, SPHERE
from inspect_cli.structure.least_squares import truncated_cost

CANDIDATES = 2000
"""Samples drawn. With half of the points on the surface, one sphere in 16 is drawn clean."""
NEIGHBOURS = (12, 40)
"""Points that a normal is fitted to: few on tightly curved, many on noisy surfaces."""
LEAST_SINE = 0.05
"""Least sine of the angle between two normals that fix an axis."""
MOST_RADIUS = 50.0
"""Largest radius, in diameters of the cloud; a larger one cannot be told from a plane."""


def candidates(kind: int, points: Points, rng: np.random.Generator) -> Matrix:
    """Models (m, 7) [p, a, r] through minimal samples of ``points`` (n, 3)."""
    if kind == PLANE:
        models = _planes(points, rng)
    elif kind == SPHERE:
        models = _spheres(points, rng)
    else:
        models = _cylinders(points, rng)
    diameter = np.linalg.norm(np.ptp(points, axis=0))
    usable = np.all(np.isfinite(models), axis=1) & (models[:, 6] < MOST_RADIUS * diameter)
    chosen: Matrix = models[usable]
    return chosen


def _planes(points: Points, rng: np.random.Generator) -> Matrix:
    a, b, c = np.moveaxis(points[rng.integers(0, len(points), (CANDIDATES, 3))], 1, 0)
    normal = np.cross(b - a, c - a)
    length = np.linalg.norm(normal, axis=1, keepdims=True)
    ok = length[:, 0] > 0.0
    return np.hstack([a[ok], normal[ok] / length[ok], np.zeros((int(ok.sum()), 1))])


def _spheres(points: Points, rng: np.random.Generator) -> Matrix:
    corners = points[rng.integers(0, len(points), (CANDIDATES, 4))]
    # |x − c|² is the same for all four: 2 (xᵢ − x₀)·c′ = |xᵢ − x₀|² with c′ = c − x₀.
    edges = corners[:, 1:] - corners[:, :1]
    right = 0.5 * np.sum(edges**2, axis=2)
    volume = np.abs(np.linalg.det(edges))
    ok = volume > 1e-12 * np.max(right, axis=1) ** 1.5
    offset = np.linalg.solve(edges[ok], right[ok][:, :, None])[:, :, 0]
    radius = np.linalg.norm(offset, axis=1, keepdims=True)
    direction = np.tile([0.0, 0.0, 1.0], (len(radius), 1))
    return np.hstack([corners[ok, 0] + offset, direction, radius])


def _cylinders(points: Points, rng: np.random.Generator) -> Matrix:
    halves = []
    for count in NEIGHBOURS:
        i, j = rng.integers(0, len(points), (2, CANDIDATES // 2))
        normals = neighbourhood_normals(points, min(count, len(points)))
        halves.append(_cylinders_through(points[i], normals[i], points[j], normals[j]))
    return np.vstack(halves)


def _cylinders_through(x_1: Points, n_1: Points, x_2: Points, n_2: Points) -> Matrix:
    axis = np.cross(n_1, n_2)
    sine = np.linalg.norm(axis, axis=1)
    ok = sine > LEAST_SINE
    x_1, n_1, x_2, n_2 = x_1[ok], n_1[ok], x_2[ok], n_2[ok]
    axis = axis[ok] / sine[ok, None]
    # Seen along the axis, x_1 + s n_1 = x_2 + t n_2; n × axis is square to n in that view.
    between = x_2 - x_1
    s = _dot(between, np.cross(n_2, axis)) / _dot(n_1, np.cross(n_2, axis))
    t = -_dot(between, np.cross(n_1, axis)) / _dot(n_2, np.cross(n_1, axis))
    center = x_1 + s[:, None] * n_1
    radius = 0.5 * (np.abs(s) + np.abs(t))
    return np.hstack([center, axis, radius[:, None]])


def neighbourhood_normals(points: Points, count: int) -> Points:
    """Unit normals (n, 3), of either sign, of planes through each point's ``count`` nearest."""
    from scipy.spatial import cKDTree

    _, nearest = cKDTree(points).query(points, count)
    around = points[nearest] - points[nearest].mean(axis=1, keepdims=True)
    _, vectors = np.linalg.eigh(np.swapaxes(around, 1, 2) @ around)
    normals: Points = vectors[:, :, 0]
    return normals


def _dot(a: Points, b: Points) -> Vector:
    products: Vector = np.einsum("ij,ij->i", a, b)
    return products


@kernel
def best_candidates(
    kind: int, models: Matrix, points: Points, threshold: float, keep: int
) -> Vector:
    """Indices of the ``keep`` models with the least Σ min(r², τ²), best first; −1 for none."""
    costs = np.full(keep, np.inf)
    order = np.full(keep, -1)
    for m in range(models.shape[0]):
        cost = truncated_cost(kind, models[m], points, threshold, costs[keep - 1])
        if cost >= costs[keep - 1]:
            continue
        k = keep - 1
        while k > 0 and costs[k - 1] > cost:
            costs[k] = costs[k - 1]
            order[k] = order[k - 1]
            k -= 1
        costs[k] = cost
        order[k] = m
    return order
