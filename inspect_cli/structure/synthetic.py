"""Point clouds of known surfaces: for tests, for the bench and for trying a mission."""

from __future__ import annotations

from typing import Literal

import numpy as np

from inspect_cli.spatial.arrays import Points, Structured
from inspect_cli.spatial.primitives import SPHERE, cylinder, normal_at, plane, point_at, sphere


def bench_surface(kind: Literal["plane", "sphere", "cylinder"]) -> Structured:
    """The surface of a fitting benchmark.

    A plane of 2 m × 2 m, a sphere's patch of R = 1 m, half of a cylinder of R = 1 m and 3 m
    length; each askew to the world's axes.
    """
    if kind == "plane":
        return plane([0.3, -0.2, 1.1], [-0.9, 0.2, 0.1], [2.0, 2.0])
    if kind == "sphere":
        return sphere([0.3, -0.2, 1.1], 1.0, [-0.9, 0.2, 0.1], [np.pi, 0.5 * np.pi])
    return cylinder([0.3, -0.2, 1.1], [0.1, 0.2, 1.0], 1.0, [-0.9, 0.2, 0.1], [np.pi, 3.0])


def noisy_cloud(
    surface: Structured,
    points: int,
    noise_m: float,
    outlier_share: float,
    rng: np.random.Generator,
) -> Points:
    """Points (n, 3), m, on a bounded primitive, shuffled.

    Positions are uniform over the patch's area; each is shifted along the normal by Gaussian
    noise of standard deviation ``noise_m``. A share of them is replaced by outliers that are
    uniform in the bounding box of the rest.
    """
    outliers = round(outlier_share * points)
    count = points - outliers
    half_u, half_v = surface["half_size"][0]
    u = rng.uniform(-half_u, half_u, count)
    v = rng.uniform(-half_v, half_v, count)
    if surface["kind"][0] == SPHERE:
        # A latitude's circle shrinks with its cosine: uniform in sin(v / r) is uniform in area.
        radius = surface["radius"][0]
        most = np.sin(min(half_v / radius, 0.5 * np.pi))
        v = radius * np.arcsin(rng.uniform(-most, most, count))
    height = noise_m * rng.standard_normal(count)
    seen = np.empty((count, 3))
    for k in range(count):
        seen[k] = point_at(surface, 0, u[k], v[k]) + height[k] * normal_at(surface, 0, u[k], v[k])
    box = rng.uniform(seen.min(axis=0), seen.max(axis=0), (outliers, 3))
    return rng.permutation(np.vstack([seen, box]))
