"""The area that each reading of a surface stands for.

A point stands for the square of one pitch around it, along the surface, and where the squares of
several points overlap the nearest has the place. What lies in no square was not measured. Squares
are cut at the surface's edge.

Areas are sums over small equal samples, so that they do not depend on how fine the truth is known.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.spatial import KDTree

from inspect_cli.log.rasters import TrueRaster
from inspect_cli.spatial.arrays import Mask, Points, Vector

LEAST_SAMPLES, MOST_SAMPLES = 10, 60
"""Along the edge of a square."""
NEIGHBOURS = 12
"""Points whose squares may share a place."""
APART = 1.0 - 1e-6
"""In pitches: points at least this far apart have squares of their own."""

Owners = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Cells:
    """Samples of the measured region."""

    uv_m: Points
    """(n, 2)."""
    owner: Owners
    """The point that each stands for, (n,); −1 where there is no point at all."""
    area_m2: float
    """Of each."""


def cells_around(uv_m: Points, pitch_m: float, raster: TrueRaster) -> Cells:
    """The squares around points (n, 2), one at least, on the surface of a raster."""
    finest_m = min(raster.step_m)
    n = int(np.clip(math.ceil(pitch_m / finest_m), LEAST_SAMPLES, MOST_SAMPLES))
    steps = (np.arange(n) + 0.5) / n - 0.5
    dv, du = (grid.ravel() * pitch_m for grid in np.meshgrid(steps, steps, indexing="ij"))
    v = uv_m[:, 1, None] + dv
    u = uv_m[:, 0, None] + du / np.maximum(raster.across(v), 1e-6)
    samples = np.column_stack([u.ravel(), v.ravel()])
    owner = np.repeat(np.arange(len(uv_m)), n * n)
    kept = raster.cells(samples)[2]
    if _overlap(uv_m, pitch_m, raster):
        kept &= _nearest_square(samples, uv_m, pitch_m, raster) == owner
    return Cells(samples[kept], owner[kept], (pitch_m / n) ** 2)


def in_squares(places_m: Points, uv_m: Points, pitch_m: float, raster: TrueRaster) -> Mask:
    """Which places (m, 2) lie in the square of one of the points (n, 2), n at least one."""
    tree = KDTree(_unrolled(uv_m, raster))
    apart = tree.query(_unrolled(places_m, raster), p=np.inf)[0]
    return np.asarray(apart <= 0.5 * pitch_m * (1.0 + 1e-9))


def nearest_to(region: Cells, uv_m: Points, raster: TrueRaster) -> Cells:
    """The same region, each place of it standing for the nearest of other points (n, 2)."""
    if len(uv_m) == 0:
        return Cells(region.uv_m, np.full(len(region.owner), -1, np.intp), region.area_m2)
    owner = KDTree(_unrolled(uv_m, raster)).query(_unrolled(region.uv_m, raster))[1]
    return Cells(region.uv_m, np.asarray(owner, np.intp), region.area_m2)


def spacing_of(uv_m: Points) -> float | None:
    """The median distance of points (n, 2) from their nearest neighbours; None for one alone."""
    if len(uv_m) < 2:
        return None
    apart = KDTree(uv_m).query(uv_m, k=2)[0][:, 1]
    return float(np.median(apart)) or None


def _unrolled(uv_m: Points, raster: TrueRaster) -> Points:
    """Places in metres along the surface; exact but for distances along u on a sphere."""
    unrolled: Points = np.column_stack([uv_m[:, 0] * raster.across(uv_m[:, 1]), uv_m[:, 1]])
    return unrolled


def _overlap(uv_m: Points, pitch_m: float, raster: TrueRaster) -> bool:
    tree = KDTree(_unrolled(uv_m, raster))
    return bool(len(tree.query_pairs(APART * pitch_m, p=np.inf, output_type="ndarray")))


def _nearest_square(samples: Points, uv_m: Points, pitch_m: float, raster: TrueRaster) -> Owners:
    """The nearest point of those whose squares hold a sample, (m,)."""
    k = min(NEIGHBOURS, len(uv_m))
    tree = KDTree(_unrolled(uv_m, raster))
    near = tree.query(_unrolled(samples, raster), k=range(1, k + 1))[1]
    apart = np.abs(samples[:, None, :] - uv_m[near])
    width: Vector = raster.across(samples[:, 1])
    half_m = 0.5 * pitch_m * (1.0 + 1e-9)
    inside = (apart[..., 0] * width[:, None] <= half_m) & (apart[..., 1] <= half_m)
    chosen = near[np.arange(len(samples)), np.argmax(inside, axis=1)]
    return np.asarray(np.where(inside.any(axis=1), chosen, -1), np.intp)
