"""The values that are kriged: readings, averaged where they stand closer than a map can show."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]

_SAME_PLACE_M = 1e-4
"""No surveyor and no robot tells two places apart that are nearer than 0.1 mm."""
_NEAR_CELLS = 0.3


@dataclass(frozen=True)
class Supports:
    """Potentials at distinct places."""

    uv_m: Floats
    """(n, 2) m."""
    potential_v: Floats
    """(n,) V."""
    measurement_v2: float
    """Mean variance by measurement of one of these potentials, V²; 0 if it is not known."""

    def taken(self, index: NDArray[np.intp]) -> Supports:
        """Those at ``index``."""
        return Supports(self.uv_m[index], self.potential_v[index], self.measurement_v2)


def distinct_places(uv_m: Floats) -> Floats:
    """(m, 2) the places among ``uv_m`` (n, 2) that are 0.1 mm apart, sorted by u, then v."""
    steps = np.round(uv_m / _SAME_PLACE_M)
    places = np.unique(steps[:, 0] + 1j * steps[:, 1]) * _SAME_PLACE_M
    return np.column_stack([places.real, places.imag])


def supports(uv_m: Floats, potential_v: Floats, variance_v2: Floats, cell_m: Floats) -> Supports:
    """Mean place and mean potential of readings that are nearer to each other than a map's nodes.

    Readings in one cell of the size ``cell_m`` (2,) are averaged, the cells being those about
    the nodes of a map that begins at the lowest u and v; then means that are still within 0.3
    cells, each near the common border. Alone a reading stays as it is, to the last bit. Errors
    of measurement are independent: the variance of a mean of k is Σ s_i² / k².

    Args:
        uv_m: (n, 2) places, m.
        potential_v: (n,) V.
        variance_v2: (n,) variances of the measurements, V², NaN unknown. The unknown ones are
            taken to be as large as the mean of the others.
        cell_m: (2,) m.
    """
    known = np.isfinite(variance_v2)
    variance = np.where(known, variance_v2, variance_v2[known].mean() if known.any() else 0.0)
    column, row = _cells(uv_m, cell_m)
    group = np.unique(row * (int(column.max()) + 1) + column, return_inverse=True)[1]
    means, _ = _means(np.column_stack([uv_m, potential_v]), group)
    group = _joined(means[:, :2] / cell_m)[group]
    means, count = _means(np.column_stack([uv_m, potential_v]), group)
    of_mean = np.bincount(group, variance) / count**2
    return Supports(means[:, :2], means[:, 2], float(of_mean.mean()))


def readings_per_cell(uv_m: Floats, cell_m: Floats, shape: tuple[int, int]) -> NDArray[np.intp]:
    """(rows, columns) how many of ``uv_m`` are in each of the cells that ``supports`` takes."""
    column, row = _cells(uv_m, cell_m)
    return np.bincount(row * shape[1] + column, minlength=shape[0] * shape[1]).reshape(shape)


def _cells(uv_m: Floats, cell_m: Floats) -> NDArray[np.int64]:
    """(2, n) column and row of each reading's cell."""
    return np.asarray(np.round((uv_m - uv_m.min(axis=0)) / cell_m).astype(np.int64).T)


def _joined(places: Floats) -> NDArray[np.intp]:
    """(n,) number of the chain of near places that each of ``places`` (n, 2), in cells, is in."""
    from scipy.sparse import coo_array
    from scipy.sparse.csgraph import connected_components
    from scipy.spatial import cKDTree

    start, end = cKDTree(places).query_pairs(_NEAR_CELLS, output_type="ndarray").T
    near = coo_array((np.ones(len(start)), (start, end)), shape=(len(places), len(places)))
    return np.asarray(connected_components(near, directed=False)[1], dtype=np.intp)


def _means(values: Floats, group: NDArray[np.intp]) -> tuple[Floats, NDArray[np.intp]]:
    """(groups, k) means of ``values`` (n, k) and (groups,) how many are in each group."""
    _, first, count = np.unique(group, return_index=True, return_counts=True)
    # About each group's first row, so that no digits are lost and equal ones stay equal.
    base = values[first]
    rest = values - base[group]
    sums = np.column_stack([np.bincount(group, column) for column in rest.T])
    return base + sums / count[:, None], count
