"""Where a survey has measured: the region between neighbouring readings, and nothing beyond it.

The readings' Delaunay triangles are kept where they join neighbours and dropped where they span a
gap: an L stays an L, a hole stays a hole, whatever the convex hull says. Lengths are measured in
pitches, along each axis in its own, so that 1 m by 1 cm is as regular a grid as 1 m by 1 m.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

LARGEST_GAP = 3.5
"""Longest edge of a triangle that is drawn, in local spacings: a gap of three missing readings in
line (four pitches) stays empty, one or two missing readings are interpolated."""

_SECOND = 2
"""A place's spacing is the distance to its second neighbour: one pitch even in a grid's corner."""
_WINDOWS, _IN_WINDOW = 9, 400
"""Of a large survey the pitch is found in windows: nine with 400 readings each."""
_ON_BORDER = 1e-6
"""A node this near to a drawn triangle, in pitches or barycentric coordinates, counts as inside:
borders run along rows of readings, and so do rows of nodes."""

Floats = NDArray[np.float64]


@dataclass(frozen=True)
class MeasuredHull:
    """The triangles between neighbouring readings."""

    triangulation: Any
    """scipy.spatial.Delaunay of the readings, coordinates in pitches."""
    edges: Floats
    """(k, 3) outward normals and offsets of the triangulation's convex hull, in pitches."""
    readings_edges: Floats
    """(m, 3) the same of all readings, before any were averaged."""
    drawn: NDArray[np.bool_]
    """(triangles,) whether a triangle joins neighbours."""
    pitch_m: Floats
    """(2,) typical distance of neighbours along u and v, m."""

    def contains(self, uv_m: Floats, crowded: NDArray[np.bool_]) -> NDArray[np.bool_]:
        """Whether each of ``uv_m`` (n, 2), m, is in the measured region or on its border.

        Args:
            uv_m: nodes of a map.
            crowded: (n,) whether several readings are nearest to a node. Such a node is measured
                though the mean place of its readings may lie further inside than itself.
        """
        places = uv_m / self.pitch_m
        inside = crowded & _within(places, self.readings_edges)
        # Of a place outside the triangulation every triangle would be tried.
        rest = np.flatnonzero(~inside & _within(places, self.edges))
        triangle = self.triangulation.find_simplex(places[rest], tol=1e-9)
        rest, triangle = rest[triangle >= 0], triangle[triangle >= 0]
        inside[rest] = self.drawn[triangle]
        aside = ~self.drawn[triangle]
        inside[rest[aside]] = self._on_border(places[rest[aside]], triangle[aside])
        return inside

    def _on_border(self, places: Floats, triangle: NDArray[np.intp]) -> NDArray[np.bool_]:
        """Whether places in undrawn triangles lie on an edge or corner of a drawn one."""
        transform = self.triangulation.transform[triangle]
        first_two = np.einsum("nij,nj->ni", transform[:, :2], places - transform[:, 2])
        share = np.column_stack([first_two, 1.0 - first_two.sum(axis=1)])
        beside = self.triangulation.neighbors[triangle]
        beside_drawn = (beside >= 0) & self.drawn[beside]
        corners = self.triangulation.simplices
        corner_drawn = np.zeros(len(self.triangulation.points), dtype=bool)
        corner_drawn[corners[self.drawn]] = True
        on_edge = (share <= _ON_BORDER) & beside_drawn
        on_corner = (share >= 1.0 - _ON_BORDER) & corner_drawn[corners[triangle]]
        return np.asarray((on_edge | on_corner).any(axis=1))


def _within(places: Floats, edges: Floats) -> NDArray[np.bool_]:
    """Whether each of ``places`` (n, 2) is in the convex hull with these ``edges`` (k, 3)."""
    beyond = np.full(len(places), -np.inf)
    for normal_u, normal_v, offset in edges:
        edge = places[:, 0] * normal_u + places[:, 1] * normal_v + offset
        np.maximum(beyond, edge, out=beyond)
    return np.asarray(beyond <= _ON_BORDER)


def measured_hull(uv_m: Floats, readings_m: Floats, pitch_m: Floats) -> MeasuredHull:
    """The region between neighbouring readings.

    A triangle is drawn if its longest edge is at most ``LARGEST_GAP`` times the spacing about its
    corners. The spacing is local, so a fine grid within a coarse one leaves the coarse one drawn.

    Args:
        uv_m: (n, 2) distinct places that are not in one line, m.
        readings_m: (m, 2) places of the readings of which those are the means, m.
        pitch_m: (2,) typical distance of neighbours along u and v, m.
    """
    from scipy.spatial import ConvexHull, Delaunay, cKDTree

    places = uv_m / pitch_m
    triangulation = Delaunay(places)
    edges_of = (ConvexHull(points).equations for points in (places, readings_m / pitch_m))
    edges, readings_edges = (np.unique(equations, axis=0) for equations in edges_of)
    second_nearest = cKDTree(places).query(places, k=[_SECOND + 1])[0][:, 0]
    spacing = _shared(second_nearest, *triangulation.vertex_neighbor_vertices)
    corners = triangulation.simplices
    sides = places[corners] - places[np.roll(corners, 1, axis=1)]
    longest = np.sqrt((sides**2).sum(axis=2).max(axis=1))
    drawn = longest <= LARGEST_GAP * spacing[corners].max(axis=1)
    return MeasuredHull(triangulation, edges, readings_edges, drawn, pitch_m)


def _shared(own: Floats, first: NDArray[np.intp], neighbours: NDArray[np.intp]) -> Floats:
    """Spacings (n,) that two neighbours share: the own one, or theirs if they stand closer.

    A reading in a coarse grid has coarse neighbours even where it borders on a fine one; one
    stray reading or two have neighbours in the survey alone, and take their spacing.
    """
    count = np.diff(first)
    of = np.repeat(np.arange(len(own)), count)
    theirs = own[neighbours][np.lexsort((own[neighbours], of))]
    known = count >= _SECOND
    second_largest = theirs[first[1:][known] - _SECOND]
    spacing = own.copy()
    spacing[known] = np.minimum(own[known], second_largest)
    return spacing


def typical_pitch(uv_m: Floats) -> Floats:
    """(2,) distance of neighbouring readings along u and along v, m; exact for a regular grid.

    A rectangular cell is a pair of Delaunay triangles however the axes are scaled; a third of its
    edges run along u, a third along v, a third are diagonals. Two thirds of them therefore span
    the pitch of an axis, and the upper third begins in the middle of those. Scattered readings
    have one pitch, about as long along u as along v.

    Args:
        uv_m: (n, 2), distinct places that are not all in one line, m.
    """
    scaled = (uv_m - uv_m.min(axis=0)) / np.ptp(uv_m, axis=0)
    steps = [_steps(uv_m[window]) for window in _windows(scaled)]
    pitch = np.quantile(np.concatenate(steps), 2.0 / 3.0, axis=0)
    # Readings of which most share a column have no pitch across it; the extent stands in for it.
    return np.where(pitch > 1e-6 * np.ptp(uv_m, axis=0), pitch, np.ptp(uv_m, axis=0))


def _windows(scaled: Floats) -> list[NDArray[np.intp]]:
    """Indices of the readings among which the pitch is found; ``scaled`` into a unit square."""
    from scipy.spatial import cKDTree

    count = len(scaled)
    if count <= _WINDOWS * _IN_WINDOW:
        return [np.arange(count)]
    by_column = np.lexsort((scaled[:, 1], scaled[:, 0]))
    middles = by_column[np.linspace(0, count - 1, _WINDOWS + 2).astype(int)[1:-1]]
    _, index = cKDTree(scaled).query(scaled[middles], k=_IN_WINDOW)
    wide = [window for window in index if np.ptp(scaled[window], axis=0).min() > 1e-6]
    # Windows within one row each: a few rows with very many readings. Thinned they still have
    # more readings along the rows than a map has nodes.
    return wide or [by_column[:: count // (_WINDOWS * _IN_WINDOW)]]


def _steps(uv_m: Floats) -> Floats:
    """(edges, 2) |Δu| and |Δv| along the Delaunay edges of ``uv_m``, m, each edge once."""
    from scipy.spatial import Delaunay

    corners = Delaunay(uv_m).simplices
    pairs = np.sort(np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]))
    start, end = np.unique(pairs, axis=0).T
    return np.asarray(np.abs(uv_m[end] - uv_m[start]))
