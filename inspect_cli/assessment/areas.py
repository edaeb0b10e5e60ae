"""How many square metres each reading stands for.

A reading stands for the places that are nearer to it than to any other reading, but not beyond its
reach, and not beyond the edge of what was surveyed:

    cell_i = Voronoi cell of i ∩ rectangle around i of 2 h_u by 2 h_v ∩ surveyed region

On a grid h is half the spacing: every reading of a full grid, those at its edge too, stands for
exactly Δu Δv, and n of them for n Δu Δv; a reading that is missing leaves its share unmeasured.
Where the plan of a flight states the cell of each point, h is half of that. A list that is no grid
has h of one and a half typical spacings, so that only real gaps stay open, and its region is the
convex hull of its readings grown by half a spacing, as on a grid.

The cells do not overlap; their sum is the area that was measured. Readings without a valid
potential keep their cell, so that a failed reading is not covered up by its neighbours.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Final

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.spacing import Spacing, from_corner
from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Points, Vector

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry

GRID_REACH: Final = 0.5
"""Spacings to each side that a reading of a grid stands for."""
IRREGULAR_REACH: Final = 1.5
"""The same in a list that is no grid."""
FIRST_NEAREST: Final = 16
"""Neighbours to cut a cell with before it is asked for more; a grid needs 9."""
ROUND_OFF: Final = 1e-12
"""Relative; a bisector that takes less of a cell does not cut it."""


@dataclass(frozen=True)
class Cells:
    """The cell of each reading of n."""

    area_m2: Vector
    """(n,)"""
    corners_m: Points
    """(k, 2) of all cells, one after the other, counter-clockwise; not cut by a given region."""
    start: NDArray[np.int64]
    """(n,) the first corner of each cell."""
    count: NDArray[np.int64]
    """(n,) its number of corners."""
    spacing: Spacing

    def corners_of(self, i: int) -> Points:
        """The corners (m, 2) of one cell, m."""
        return self.corners_m[self.start[i] : self.start[i] + self.count[i]]


def cells_of(
    uv_m: Points,
    spacing: Spacing | None,
    region: BaseGeometry | None = None,
    cell_m: Points | None = None,
) -> Cells | None:
    """The cells of n different places (n, 2); None without any, or without a spacing.

    Args:
        uv_m: places, m; no two the same.
        spacing: of ``spacing_of``, or of ``spacing_of_cells``.
        region: the surveyed part of the surface in (u, v), m, where it is known: a polygon of
            shapely, with holes where nothing was to be measured.
        cell_m: widths (n, 2) along u and v of the rectangle that each place stands for, where the
            plan states them.
    """
    if spacing is None or not len(uv_m):
        return None
    scale = np.array([spacing.u_m, spacing.v_m])
    stated = spacing.is_grid or cell_m is not None
    widths = np.broadcast_to(scale, uv_m.shape) if cell_m is None else cell_m
    reach = (GRID_REACH if stated else IRREGULAR_REACH) * widths
    corner, places = from_corner(uv_m)
    edges = np.zeros((0, 3)) if stated else _hull_edges(places, 0.5 * scale)
    cells = _cut_cells(places, reach, edges, spacing)
    cells = replace(cells, corners_m=cells.corners_m + corner)
    if region is None:
        return cells
    return replace(cells, area_m2=_areas_within(cells, region))


def _hull_edges(uv_m: Points, margin: Vector) -> Points:
    """Half planes (k, 3), a u + b v + c ≤ 0, of the hull of a rectangle around each place."""
    from scipy.spatial import ConvexHull

    signs = np.array([[-1, -1], [-1, 1], [1, -1], [1, 1]])
    grown = (uv_m[:, np.newaxis, :] + signs * margin).reshape(-1, 2)
    return np.asarray(np.unique(np.round(ConvexHull(grown).equations, 12), axis=0))


def _cut_cells(uv_m: Points, reach: Points, edges: Points, spacing: Spacing) -> Cells:
    """Cut each cell by its nearest neighbours, by more of them where these may not be enough."""
    from scipy.spatial import cKDTree

    n = len(uv_m)
    area_m2, start, count = np.zeros(n), np.zeros(n, np.int64), np.zeros(n, np.int64)
    corners: list[Points] = []
    tree, open_cells, nearest, written = cKDTree(uv_m), np.arange(n), FIRST_NEAREST, 0
    while len(open_cells):
        nearest = min(nearest, n)
        _, around = tree.query(uv_m[open_cells], nearest)
        around = np.asarray(around, dtype=np.int64).reshape(-1, nearest)
        flat = np.empty((len(open_cells) * (4 + len(edges) + nearest), 2))
        areas, counts, is_whole = cut_cells(uv_m, open_cells, around, reach, edges, flat)
        area_m2[open_cells], count[open_cells] = areas, counts
        start[open_cells] = written + np.cumsum(counts) - counts
        corners.append(flat[: counts.sum()].copy())
        written += len(corners[-1])
        if nearest == n:
            break
        open_cells, nearest = open_cells[~is_whole], 4 * nearest
    return Cells(area_m2, np.concatenate(corners), start, count, spacing)


@kernel
def cut_cells(
    uv_m: Points,
    chosen: NDArray[np.int64],
    around: NDArray[np.int64],
    reach: Points,
    edges: Points,
    corners: Points,
) -> tuple[Vector, NDArray[np.int64], NDArray[np.bool_]]:
    """Cut the rectangle around each chosen place by the bisectors to its neighbours.

    Args:
        uv_m: places (n, 2), m.
        chosen: places to cut (k,).
        around: their neighbours (k, m), the nearest first.
        reach: half the sides (n, 2) of the rectangle around each place.
        edges: half planes (e, 3) that every cell lies in.
        corners: (k (4 + e + m), 2), written to: all corners, one cell after the other.

    Returns:
        The areas (k,), m²; the numbers of corners (k,); and whether a cell is whole (k,): its
        farthest neighbour here is too far to cut it, so that none is missing.
    """
    k, m = around.shape
    areas, counts, is_whole = np.zeros(k), np.zeros(k, np.int64), np.zeros(k, np.bool_)
    cell = np.zeros((4 + len(edges) + m, 2))
    kept = np.zeros((4 + len(edges) + m, 2))
    written = 0
    for row in range(k):
        u, v = uv_m[chosen[row], 0], uv_m[chosen[row], 1]
        half_u, half_v = reach[chosen[row], 0], reach[chosen[row], 1]
        for c in range(4):  # from the lower left, counter-clockwise
            cell[c, 0] = half_u if c == 1 or c == 2 else -half_u
            cell[c, 1] = half_v if c >= 2 else -half_v
        count = 4
        for e in range(len(edges)):
            a, b = edges[e, 0], edges[e, 1]
            room = -(edges[e, 2] + a * u + b * v)
            if room < abs(a) * half_u + abs(b) * half_v:
                count = cut(cell, count, a, b, room, kept)
        for j in around[row]:
            du, dv = uv_m[j, 0] - u, uv_m[j, 1] - v
            square = du * du + dv * dv
            farthest = 0.0
            for c in range(count):
                farthest = max(farthest, cell[c, 0] ** 2 + cell[c, 1] ** 2)
            if square > 4.0 * farthest:
                is_whole[row] = True
                break
            if square > 0.0:
                count = cut(cell, count, du, dv, 0.5 * square, kept)
        twice = 0.0
        for c in range(count):
            d = (c + 1) % count
            twice += cell[c, 0] * cell[d, 1] - cell[d, 0] * cell[c, 1]
            corners[written, 0], corners[written, 1] = u + cell[c, 0], v + cell[c, 1]
            written += 1
        areas[row], counts[row] = 0.5 * twice, count
    return areas, counts, is_whole


@kernel
def cut(cell: Points, count: int, a: float, b: float, limit: float, kept: Points) -> int:
    """Keep the part a x + b y ≤ limit of a convex polygon; the number of its corners.

    The polygon is the first ``count`` rows of ``cell``, which is written to; ``kept`` is working
    space of the same shape. (Sutherland & Hodgman, CACM 17 (1974) 32–42.)
    """
    outside = 0.0
    size = abs(limit)
    for c in range(count):
        outside = max(outside, a * cell[c, 0] + b * cell[c, 1] - limit)
        size = max(size, abs(a * cell[c, 0]) + abs(b * cell[c, 1]))
    if outside <= ROUND_OFF * size:
        return count
    new = 0
    for c in range(count):
        d = (c + 1) % count
        here = a * cell[c, 0] + b * cell[c, 1] - limit
        there = a * cell[d, 0] + b * cell[d, 1] - limit
        if here <= 0.0:
            kept[new, 0], kept[new, 1] = cell[c, 0], cell[c, 1]
            new += 1
        if here < 0.0 < there or there < 0.0 < here:
            share = here / (here - there)
            kept[new, 0] = cell[c, 0] + share * (cell[d, 0] - cell[c, 0])
            kept[new, 1] = cell[c, 1] + share * (cell[d, 1] - cell[c, 1])
            new += 1
    for c in range(new):
        cell[c, 0], cell[c, 1] = kept[c, 0], kept[c, 1]
    return new


def _areas_within(cells: Cells, region: BaseGeometry) -> Vector:
    """The areas (n,), m², of the cells' parts in the region."""
    import shapely

    index = np.repeat(np.arange(len(cells.count)), cells.count)
    ahead = cells.start - (np.cumsum(cells.count) - cells.count)
    order = np.arange(len(index)) + ahead[index]
    polygons = shapely.polygons(shapely.linearrings(cells.corners_m[order], indices=index))
    shapely.prepare(region)
    area_m2 = cells.area_m2.copy()
    beyond = ~shapely.covers(region, polygons)
    area_m2[beyond] = shapely.area(shapely.intersection(polygons[beyond], region))
    return area_m2
