"""From a mesh to a relief: heights on a regular grid over a plane, and what is refused.

The mesh is cut at the nodes of a grid whose outermost nodes lie on its bounding rectangle in the
plane, with a spacing of ``pitch_m`` or a little less. A node beside the mesh or over a hole of it
stays empty, so a rim up to one pitch wide is lost where the edge runs askew to the grid. Between
the nodes the surface is the spline that ``truth.relief`` states; how far the mesh's own corners
and middles of faces lie from that is measured and kept.
"""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path

import numpy as np
from scipy.ndimage import (
    binary_dilation,
    correlate1d,
    distance_transform_edt,
    spline_filter,
)

from inspect_cli.compiled import kernel
from inspect_cli.errors import GeometryError
from inspect_cli.scans.files import confined, refused
from inspect_cli.scans.meshes import doubled_normals, read_triangles
from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.schema.primitives import displaced_points, rotation_of
from inspect_cli.spatial.arrays import Mask, Matrix, Points, Structured, Vector
from inspect_cli.spatial.primitives import level_axes
from inspect_cli.truth.relief import PAD, RELIEF, height_at, relief_covers

LEAST_CELLS = 4
"""Along each edge: a smaller grid than this is not worth a spline."""
MOST_NODES = 1_000_000
TWO_SHEETS_M = 0.002
"""Heights at one place that differ by more than this belong to two sheets."""
ONE_WAY = 0.99
"""Share of a mesh's area, seen along the normal, that has to turn to the same side."""
PLANE_NODES = 3
CURVATURE_MARGIN = 1.25
ROUNDING_M = 1e-6
"""A level mesh must not lie in a box without height."""
INSIDE = -1e-9
"""Barycentric: a node on an edge belongs to both triangles."""


@dataclass(frozen=True)
class MeshRelief:
    """A relief (1,), its nodes (2, n), and how far the mesh departs from it at most, m."""

    row: Structured
    nodes: Matrix
    deviation_m: float


def mesh_relief(shape: MeshShape, moved: Displacement, root: Path) -> MeshRelief:
    """The relief of a mesh file in the campaign folder ``root``, after a displacement.

    Raises GeometryError, naming the file, for a mesh that cannot be read or is no graph of heights
    over its plane, and InputError for a file outside of ``root``.
    """
    path = confined(root, shape.file)
    corners = displaced_points(read_triangles(path).corners, moved)
    try:
        return relief_of(corners, _normal(shape, moved, corners), shape.pitch_m)
    except GeometryError as error:
        first = error.problems[0]
        raise refused(path, first.what, first.hint) from error


def relief_of(corners: Points, normal: Vector, pitch_m: float) -> MeshRelief:
    """Resample triangles ``corners`` (n, 3, 3), m, to heights over the plane across ``normal``."""
    R = level_axes(normal)
    flat = corners.reshape(-1, 3) @ R
    low, high = flat.min(axis=0), flat.max(axis=0)
    middle = 0.5 * (low + high)
    cells = np.maximum(np.ceil((high - low)[:2] / pitch_m), 1.0).astype(int)
    _require_size(cells, high - low, pitch_m)
    pitch = (high - low)[:2] / cells
    local = (flat - middle).reshape(-1, 3, 3)
    heights = _cut_at_nodes(local, cells, pitch)
    columns, rows = int(cells[0]) + 1 + 2 * PAD, int(cells[1]) + 1 + 2 * PAD
    padded = np.full((rows, columns), np.nan)
    padded[PAD:-PAD, PAD:-PAD] = heights
    coefficients = spline_filter(_continued(padded), order=3, mode="mirror")
    row = np.zeros(1, RELIEF)
    row["p_WS"], row["R_WS"] = R @ middle, R
    row["half_size"], row["pitch"] = 0.5 * (high - low)[:2], pitch
    row["columns"], row["rows"] = columns, rows
    _set_bounds(row, coefficients, np.isfinite(padded), pitch)
    nodes = np.stack([coefficients.ravel(), padded.ravel()])
    deviation_m = _deviation(row, nodes, local)
    if deviation_m > pitch_m:
        raise GeometryError(
            f"the mesh departs by {deviation_m:.3g} m from the smooth heights that were drawn "
            f"through it every {pitch_m:g} m",
            hint="cut steps and overhangs from the mesh, or give a smaller pitch_m",
        )
    return MeshRelief(row, nodes, deviation_m)


def _normal(shape: MeshShape, moved: Displacement, corners: Points) -> Vector:
    """The unit normal (3,) of the mesh's plane, to its free side."""
    if shape.normal is not None:
        given: Vector = rotation_of(moved) @ np.asarray(shape.normal)
        return given
    points = corners.reshape(-1, 3)
    scatter = np.cov((points - points.mean(axis=0)).T)
    normal: Vector = np.linalg.eigh(scatter)[1][:, 0]
    area = doubled_normals(corners) @ normal
    share = area.sum() / np.abs(area).sum()
    if not abs(share) >= ONE_WAY:
        raise GeometryError(
            "its faces do not agree on which side is free, seen along the best plane's normal "
            f"{np.round(normal, 3).tolist()}",
            hint="give 'normal' in the geometry: it points to the side that is touched",
        )
    return normal if share > 0.0 else -normal


def _require_size(cells: Vector, extent_m: Vector, pitch_m: float) -> None:
    size = f"the mesh is {extent_m[0]:.3g} m × {extent_m[1]:.3g} m in its plane"
    if cells.min() < LEAST_CELLS:
        raise GeometryError(
            f"{size}: less than {LEAST_CELLS} cells of {pitch_m:g} m",
            hint="give a smaller pitch_m, or the right 'normal'",
        )
    if np.prod(cells + 1) > MOST_NODES:
        raise GeometryError(
            f"{size}: more than {MOST_NODES} nodes at {pitch_m:g} m",
            hint="give a larger pitch_m, or cut the mesh",
        )


def _cut_at_nodes(local: Points, cells: Vector, pitch: Vector) -> Matrix:
    """Heights (rows, columns) of triangles in S; NaN beside them. GeometryError for two sheets."""
    shape = (int(cells[1]) + 1, int(cells[0]) + 1)
    lowest, highest = np.full(shape, np.inf), np.full(shape, -np.inf)
    cut_triangles(local, pitch, lowest, highest)
    apart = highest - lowest
    row, column = np.unravel_index(np.argmax(apart), shape)
    if apart[row, column] > TWO_SHEETS_M:
        u, v = (column - 0.5 * cells[0]) * pitch[0], (row - 0.5 * cells[1]) * pitch[1]
        raise GeometryError(
            f"the mesh is no graph over its plane: at (u, v) = ({u:.2f}, {v:.2f}) m from its "
            f"middle it has two heights, {apart[row, column]:.3g} m apart",
            hint="cut the sheet that is touched from the mesh, or give another 'normal'",
        )
    known = np.isfinite(apart)
    heights = np.full(shape, np.nan)
    heights[known] = 0.5 * (lowest[known] + highest[known])
    if not (known[:-1, :-1] & known[1:, :-1] & known[:-1, 1:] & known[1:, 1:]).any():
        raise GeometryError(
            "no cell of the grid is covered by the mesh",
            hint="give a smaller pitch_m, or the right 'normal'",
        )
    return heights


@kernel
def cut_triangles(local: Points, pitch: Vector, lowest: Matrix, highest: Matrix) -> None:
    """Widen ``lowest`` and ``highest`` (rows, columns) to the heights of triangles at the nodes."""
    rows, columns = lowest.shape
    for k in range(local.shape[0]):
        a, b, c = local[k, 0], local[k, 1], local[k, 2]
        doubled = (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0])
        if doubled == 0.0:
            continue  # seen from its edge
        left = min(a[0], b[0], c[0]) / pitch[0] + 0.5 * (columns - 1)
        right = max(a[0], b[0], c[0]) / pitch[0] + 0.5 * (columns - 1)
        bottom = min(a[1], b[1], c[1]) / pitch[1] + 0.5 * (rows - 1)
        top = max(a[1], b[1], c[1]) / pitch[1] + 0.5 * (rows - 1)
        # By rounding the mesh's border may lie beside the outermost nodes.
        for row in range(max(int(bottom), 0), min(int(top) + 2, rows)):
            v = (row - 0.5 * (rows - 1)) * pitch[1]
            for column in range(max(int(left), 0), min(int(right) + 2, columns)):
                u = (column - 0.5 * (columns - 1)) * pitch[0]
                s = ((u - a[0]) * (c[1] - a[1]) - (v - a[1]) * (c[0] - a[0])) / doubled
                t = ((b[0] - a[0]) * (v - a[1]) - (b[1] - a[1]) * (u - a[0])) / doubled
                if s >= INSIDE and t >= INSIDE and s + t <= 1.0 - INSIDE:
                    h = a[2] + s * (b[2] - a[2]) + t * (c[2] - a[2])
                    lowest[row, column] = min(lowest[row, column], h)
                    highest[row, column] = max(highest[row, column], h)


def _continued(heights: Matrix) -> Matrix:
    """Heights without NaN: continued for ``PAD`` nodes as a plane, farther out as the nearest.

    Ring by ring, a missing node lies on the plane that fits those within ``PLANE_NODES`` of it
    best, weighted by their nearness: it follows the slope without a kink, which would ring on
    into what is known.
    """
    filled = heights
    for _ in range(PAD):
        known = np.isfinite(filled)
        ring = np.argwhere(binary_dilation(known) & ~known)
        if len(ring) == 0:
            break
        wide = np.pad(filled, PLANE_NODES, constant_values=np.nan)
        reach = np.arange(2 * PLANE_NODES + 1)
        window = wide[
            ring[:, 0, None, None] + reach[:, None], ring[:, 1, None, None] + reach
        ].reshape(len(ring), -1)
        filled = filled.copy()
        filled[ring[:, 0], ring[:, 1]] = _planes_at_middle(window)
    nearest = distance_transform_edt(np.isnan(filled), return_distances=False, return_indices=True)
    continued: Matrix = filled[tuple(nearest)]
    return continued


def _planes_at_middle(window: Matrix) -> Vector:
    """In the middle of square windows (n, k²) with gaps, the height of the plane that fits best."""
    reach = np.arange(2 * PLANE_NODES + 1) - PLANE_NODES
    y, x = (axis.ravel() for axis in np.meshgrid(reach, reach, indexing="ij"))
    basis = np.stack([np.ones_like(x), x, y], axis=-1).astype(np.float64)
    nearness = np.exp(-0.5 * (x * x + y * y))
    weight = np.where(np.isnan(window), 0.0, nearness)
    height = np.where(np.isnan(window), 0.0, window)
    # A faint ridge on the slopes keeps a plane through one line of nodes from tipping over.
    normal = np.einsum("nk,ki,kj->nij", weight, basis, basis) + np.diag([0.0, 1e-6, 1e-6])
    right = np.einsum("nk,ki->ni", weight * height, basis)
    at_middle: Vector = np.linalg.solve(normal, right[..., None])[:, 0, 0]
    return at_middle


def _set_bounds(row: Structured, c: Matrix, known: Mask, pitch: Vector) -> None:
    """Bounds of height, slope and curvature of what is there."""
    near = binary_dilation(known, np.ones((5, 5)))  # the coefficients that reach a known cell
    row["low"], row["high"] = c[near].min() - ROUNDING_M, c[near].max() + ROUNDING_M
    d_u = np.abs(np.diff(c, axis=1))[near[:, 1:] & near[:, :-1]].max() / pitch[0]
    d_v = np.abs(np.diff(c, axis=0))[near[1:] & near[:-1]].max() / pitch[1]
    row["slope"] = np.hypot(d_u, d_v)
    # Second derivatives at the nodes: a B-spline is (1, 4, 1)/6 there, its slope (−1, 0, 1)/2.
    value = np.array([1.0, 4.0, 1.0]) / 6.0
    slope, bend = np.array([-0.5, 0.0, 0.5]), np.array([1.0, -2.0, 1.0])
    h_uu = correlate1d(correlate1d(c, bend, 1), value, 0) / pitch[0] ** 2
    h_vv = correlate1d(correlate1d(c, bend, 0), value, 1) / pitch[1] ** 2
    h_uv = correlate1d(correlate1d(c, slope, 0), slope, 1) / (pitch[0] * pitch[1])
    # The largest eigenvalue in size of [[h_uu, h_uv], [h_uv, h_vv]].
    largest = 0.5 * np.abs(h_uu + h_vv) + np.hypot(0.5 * (h_uu - h_vv), h_uv)
    row["curvature"] = CURVATURE_MARGIN * largest[known].max()


def _deviation(row: Structured, nodes: Matrix, local: Points) -> float:
    """Largest distance, m, of corners and middles of triangles in S from the relief below them."""
    probes = np.concatenate([local.reshape(-1, 3), local.mean(axis=1)])
    deviation: float = largest_deviation(row, nodes, probes)
    return deviation


@kernel
def largest_deviation(row: Structured, nodes: Matrix, probes: Points) -> float:
    """Largest distance, m, of points (n, 3) in S from a relief (1,), where it covers them."""
    largest = 0.0
    for k in range(probes.shape[0]):
        u, v = probes[k, 0], probes[k, 1]
        if relief_covers(row, nodes, 0, u, v):
            h, h_u, h_v = height_at(row, nodes, 0, u, v)
            away = abs(probes[k, 2] - h) / np.sqrt(1.0 + h_u * h_u + h_v * h_v)
            largest = max(largest, away)
    return largest
