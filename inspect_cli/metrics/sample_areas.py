"""The area that each reading of a surface stands for.

A point stands for the rectangle around it, along the surface, that the plan states as its cell: of
a grid the square of one pitch. Where the cells of several points overlap the nearest has the
place. What lies in no cell was not measured. Cells are cut at the surface's edge.

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
"""Along the edge of a cell."""
NEIGHBOURS = 12
"""Points with cells of one size that may share a place."""
APART = 1.0 - 1e-6
"""In widths: points at least this far apart do not share a place."""

Owners = NDArray[np.intp]


@dataclass(frozen=True, eq=False)
class Cells:
    """Samples of the measured region."""

    uv_m: Points
    """(n, 2)."""
    owner: Owners
    """The point that each stands for, (n,); −1 where there is no point at all."""
    area_m2: Vector
    """(n,) of each."""


def cells_around(uv_m: Points, cell_m: Points | float, raster: TrueRaster) -> Cells:
    """The cells around points (n, 2), one at least, on the surface of a raster.

    ``cell_m`` (n, 2) are their widths along u and v, m; a number is that of squares.
    """
    widths = np.broadcast_to(np.asarray(cell_m, np.float64), uv_m.shape)
    sizes = _sizes(widths)
    parts = [_samples(uv_m, group, widths[group[0]], raster) for group in sizes]
    samples = np.concatenate([part.uv_m for part in parts])
    owner = np.concatenate([part.owner for part in parts])
    area_m2 = np.concatenate([part.area_m2 for part in parts])
    kept = raster.cells(samples)[2]
    if len(sizes) > 1 or _overlap(uv_m, widths[0], raster):
        kept &= _nearest_cell(samples, uv_m, widths, raster) == owner
    return Cells(samples[kept], owner[kept], area_m2[kept])


def weighed(codes: NDArray[np.intp], area_m2: Vector, length: int) -> Vector:
    """The area (length,), m², of the samples with each code: count times area, size by size."""
    total = np.zeros(length)
    for each_m2 in np.unique(area_m2):
        total += np.bincount(codes[area_m2 == each_m2], minlength=length) * each_m2
    return total


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


def _unrolled(uv_m: Points, raster: TrueRaster) -> Points:
    """Places in metres along the surface; exact but for distances along u on a sphere."""
    unrolled: Points = np.column_stack([uv_m[:, 0] * raster.across(uv_m[:, 1]), uv_m[:, 1]])
    return unrolled


def _sizes(widths: Points) -> list[Owners]:
    """The points (n, 2) in groups with cells of one size."""
    _, group = np.unique(widths, axis=0, return_inverse=True)
    group = group.reshape(-1)
    return [np.flatnonzero(group == k) for k in range(int(group.max()) + 1)]


def _samples(uv_m: Points, group: Owners, width: Vector, raster: TrueRaster) -> Cells:
    """Samples in rows and columns that fill the cells, of one size (2,), of a group of points."""
    n = int(np.clip(math.ceil(max(width) / min(raster.step_m)), LEAST_SAMPLES, MOST_SAMPLES))
    steps = (np.arange(n) + 0.5) / n - 0.5
    dv, du = (grid.ravel() for grid in np.meshgrid(steps, steps, indexing="ij"))
    v = uv_m[group, 1, None] + dv * width[1]
    u = uv_m[group, 0, None] + du * width[0] / np.maximum(raster.across(v), 1e-6)
    samples = np.column_stack([u.ravel(), v.ravel()])
    each_m2 = float((width[0] / n) * (width[1] / n))
    return Cells(samples, np.repeat(group, n * n), np.full(len(samples), each_m2))


def _overlap(uv_m: Points, width: Vector, raster: TrueRaster) -> bool:
    """Whether cells of one size (2,) share a place."""
    tree = KDTree(_unrolled(uv_m, raster) / width)
    return bool(len(tree.query_pairs(APART, p=np.inf, output_type="ndarray")))


def _nearest_cell(samples: Points, uv_m: Points, widths: Points, raster: TrueRaster) -> Owners:
    """The nearest point of those whose cells hold a sample, (m,); −1 where none does."""
    places, points = _unrolled(samples, raster), _unrolled(uv_m, raster)
    across: Vector = raster.across(samples[:, 1])
    rows = np.arange(len(samples))
    chosen, chosen_m = np.full(len(samples), -1, np.intp), np.full(len(samples), np.inf)
    for group in _sizes(widths):
        half_u, half_v = 0.5 * widths[group[0]] * (1.0 + 1e-9)
        k = min(NEIGHBOURS, len(group))
        apart_m, near = KDTree(points[group]).query(places, k=range(1, k + 1))
        near = group[near]
        apart = np.abs(samples[:, None, :] - uv_m[near])
        inside = (apart[..., 0] * across[:, None] <= half_u) & (apart[..., 1] <= half_v)
        first = np.argmax(inside, axis=1)
        nearest_m = np.where(inside.any(axis=1), apart_m[rows, first], np.inf)
        closer = nearest_m < chosen_m
        chosen[closer], chosen_m[closer] = near[rows, first][closer], nearest_m[closer]
    return chosen
