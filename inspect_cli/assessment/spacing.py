"""How far apart readings lie, and which of them are neighbours.

Surveys come as grids, with gaps and with points added between, and as plain lists. ``spacing_of``
tells the two apart; the plan of a flight states its spacing (``spacing_of_cells``). What depends on
neighbours measures distances in units of the spacing, so that a grid of 0.25 by 0.5 m has
neighbours along both axes.

Coordinates are taken as those of a plane: a surface that closes upon itself is cut open where its
coordinates jump.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import NDArray

from inspect_cli.spatial.arrays import Points, Vector

NEIGHBOUR_SPACINGS: Final = 1.25
"""Readings of a grid up to this many spacings apart are next to each other: along u or v, but not
across a diagonal (√2); the rows of a sphere are up to √1.25 = 1.12 apart."""
DIAGONAL_SPACINGS: Final = 1.5
"""Includes the diagonals (√2) and not the next but one (2)."""
IRREGULAR_SPACINGS: Final = 3.0
"""Readings of a list that is no grid can be neighbours up to this many typical spacings apart."""
CROWDED: Final = 40
"""Readings around each, itself included, above which they crowd: 9 on a grid, about 21 on one with
a point in the middle of every side and square."""
PLACE_DECIMALS: Final = 6
"""Coordinates that agree to the micrometre are the same row or column."""
GAP_DECIMALS: Final = 9
"""A gap is known to the nanometre; what is finer is rounding of the coordinates."""
LINE: Final = 1e-6
"""Points that spread less than this across than along lie on a line."""
SAME_GAP: Final = 0.01
"""Relative difference of two gaps that count as the same."""


def from_corner(uv_m: Points) -> tuple[Vector, Points]:
    """Where u and v of n > 0 places (n, 2) are least (2,), and the places from there (n, 2), m.

    Coordinates of a national grid are millions of metres. Sums of their squares and products lose
    the digits that geometry within a survey needs; differences of such coordinates do not.
    """
    corner = uv_m.min(axis=0)
    return corner, uv_m - corner


class Spacing(NamedTuple):
    """Typical distance between neighbouring readings along u and v, m, and how it was found."""

    u_m: float
    v_m: float
    is_grid: bool


def spacing_of_cells(cell_m: Points) -> Spacing | None:
    """The spacing of n > 0 places with stated cells (n, 2), m; None if a cell is not known (NaN).

    Places with the same cell are a grid. Of several grids together it is the median, and they are
    no grid.
    """
    if not np.all(np.isfinite(cell_m)):
        return None
    u_m, v_m = (float(x) for x in np.median(cell_m, axis=0))
    return Spacing(u_m, v_m, bool(np.all(cell_m == cell_m[0])))


def spacing_of(uv_m: Points) -> Spacing | None:
    """The spacing of n different places (n, 2), told from where they lie; None for fewer than two.

    It is a grid when at least a third of the points have a next one in their row, as many in their
    column, and half of those gaps are their median, which is the spacing. Of a single row or column
    the other spacing is taken to be the same. The spacing of points on any other line is the median
    gap between them, and that of any other list the median distance of its points to their second
    nearest: 1 of a square grid, about 0.75/√λ of points that are strewn with λ per square metre.
    """
    if len(uv_m) < 2:
        return None
    u_m, v_m = _grid_gap(uv_m, 0), _grid_gap(uv_m, 1)
    if u_m is None and v_m is not None and np.ptp(np.round(uv_m[:, 0], PLACE_DECIMALS)) == 0:
        u_m = v_m
    if v_m is None and u_m is not None and np.ptp(np.round(uv_m[:, 1], PLACE_DECIMALS)) == 0:
        v_m = u_m
    if u_m is not None and v_m is not None:
        return Spacing(u_m, v_m, True)
    typical = _typical_gap(uv_m)
    return Spacing(typical, typical, False)


def _typical_gap(uv_m: Points) -> float:
    """The spacing of n places (n, 2) that are no grid; n ≥ 2."""
    steps = _steps_along_a_line(uv_m)
    if steps is not None:
        return float(np.median(_lengths(uv_m, steps)))
    from scipy.spatial import cKDTree

    distance, _ = cKDTree(uv_m).query(uv_m, 3)
    return float(np.median(distance[:, 2]))


def _grid_gap(uv_m: Points, axis: int) -> float | None:
    """Median gap between points that share the other coordinate; None if they are no grid's."""
    across = np.round(uv_m[:, 1 - axis], PLACE_DECIMALS)
    order = np.lexsort((uv_m[:, axis], across))
    along, across = uv_m[order, axis], across[order]
    gaps = np.diff(along)[np.diff(across) == 0]
    if 3 * len(gaps) < len(uv_m):
        return None
    gap = round(float(np.median(gaps)), GAP_DECIMALS)
    same = np.abs(gaps - gap) <= SAME_GAP * gap
    return gap if 2 * np.count_nonzero(same) >= len(gaps) else None


def neighbours(uv_m: Points, spacing: Spacing) -> NDArray[np.intp]:
    """Pairs (k, 2) of neighbouring places, each once, the smaller index first, sorted.

    On a grid all that are at most ``DIAGONAL_SPACINGS`` apart. In another list, or where readings
    crowd between a grid's, the edges of Delaunay's triangulation up to ``IRREGULAR_SPACINGS``, or
    as far as on the grid; on a line, each and the next.
    """
    if len(uv_m) < 2:
        return np.zeros((0, 2), np.intp)
    from scipy.spatial import cKDTree

    scaled = _in_spacings(from_corner(uv_m)[1], spacing)
    reach = DIAGONAL_SPACINGS if spacing.is_grid else IRREGULAR_SPACINGS
    tree = cKDTree(scaled)
    if spacing.is_grid and tree.count_neighbors(tree, reach) <= CROWDED * len(uv_m):
        pairs = np.sort(tree.query_pairs(reach, output_type="ndarray").astype(np.intp), axis=1)
    else:
        pairs = _delaunay_edges(scaled)
        pairs = pairs[_lengths(scaled, pairs) <= reach]
    return np.asarray(pairs[np.lexsort((pairs[:, 1], pairs[:, 0]))])


def side_by_side(pairs: NDArray[np.intp], uv_m: Points, spacing: Spacing) -> NDArray[np.intp]:
    """Those pairs of ``neighbours`` that are not across a diagonal of the grid."""
    if not spacing.is_grid:
        return pairs
    return pairs[_lengths(_in_spacings(uv_m, spacing), pairs) <= NEIGHBOUR_SPACINGS]


def _in_spacings(uv_m: Points, spacing: Spacing) -> Points:
    return np.asarray(uv_m / np.array([spacing.u_m, spacing.v_m]))


def _lengths(points: Points, pairs: NDArray[np.intp]) -> Vector:
    return np.asarray(np.linalg.norm(points[pairs[:, 0]] - points[pairs[:, 1]], axis=1))


def _delaunay_edges(points: Points) -> NDArray[np.intp]:
    """Edges (k, 2) of the triangulation; of points on a line, those from each to the next."""
    from scipy.spatial import Delaunay

    steps = _steps_along_a_line(points)
    if steps is not None:
        return steps
    triangles = Delaunay(points).simplices
    sides = np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1)
    keys = np.unique(sides[:, 0].astype(np.int64) * len(points) + sides[:, 1])
    return np.column_stack(np.divmod(keys, len(points))).astype(np.intp)


def _steps_along_a_line(points: Points) -> NDArray[np.intp] | None:
    """Pairs (n − 1, 2) from each point to the next; None if they do not lie on a line."""
    centred = points - points.mean(axis=0)
    variances, vectors = np.linalg.eigh(centred.T @ centred)
    if variances[0] > LINE**2 * variances[1]:
        return None
    order = np.argsort(centred @ vectors[:, 1], kind="stable")
    steps = np.column_stack([order[:-1], order[1:]]).astype(np.intp)
    return np.sort(steps, axis=1)
