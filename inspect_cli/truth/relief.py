"""Irregular surfaces as smooth heights over a plane, and the kernels that ask them.

A relief is one element of a ``RELIEF`` array and a stretch of ``nodes`` (2, n). In its frame S,
whose origin ``p_WS`` is the middle of its rectangle and whose z_S points to the free side,

    p = p_WS + R_WS [u, v, h(u, v)],      |u| ≤ half_size[0], |v| ≤ half_size[1]

h is the bicubic B-spline through the heights of a regular grid, so it is twice continuously
differentiable: normals never jump. The surface coordinates (u, v) are those of the plane below,
not arc lengths. ``nodes`` holds for each node, row by row, its B-spline coefficient and its
height, m; the height is NaN where nothing is there. A cell of the grid is there if its four
nodes are. Around the rectangle the grid goes on by ``PAD`` nodes of coefficients alone.

A B-spline and its first derivatives are convex combinations of the coefficients and of their
differences: so h lies within [low, high] and its slope |∇h| within ``slope``. ``curvature`` bounds
the second derivative in every direction: along each coordinate that runs straight from node to
node, so the largest one is at a node, up to what a margin covers.
"""

from __future__ import annotations

from typing import Any, TypeAlias

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Structured, Vector

Four: TypeAlias = tuple[float, float, float, float]

RELIEF: np.dtype[Any] = np.dtype(
    [
        ("p_WS", "<f8", (3,)),
        ("R_WS", "<f8", (3, 3)),
        ("half_size", "<f8", (2,)),
        ("pitch", "<f8", (2,)),
        ("columns", "<i8"),
        ("rows", "<i8"),
        ("first", "<i8"),
        ("low", "<f8"),
        ("high", "<f8"),
        ("slope", "<f8"),
        ("curvature", "<f8"),
    ]
)
PAD = 8
"""Nodes around the rectangle: what is beyond them changes h within it by less than 1e-4 of itself,
since a coefficient's influence fades by 0.27 from node to node."""
STRIDE = 8
"""The search for the nearest node looks at every eighth first."""
FOOT_STEPS, FOOT_M = 40, 1e-8


@kernel
def height_at(
    reliefs: Structured, nodes: Matrix, i: int, u: float, v: float
) -> tuple[float, float, float]:
    """(h, ∂h/∂u, ∂h/∂v) of relief ``i`` at (u, v) m; beyond the grid that of its border."""
    columns, rows = reliefs["columns"][i], reliefs["rows"][i]
    pitch_u, pitch_v = reliefs["pitch"][i, 0], reliefs["pitch"][i, 1]
    x = _within(u / pitch_u + 0.5 * (columns - 1), columns)
    y = _within(v / pitch_v + 0.5 * (rows - 1), rows)
    h, h_x, h_y = spline(nodes, reliefs["first"][i], columns, x, y)
    return h, h_x / pitch_u, h_y / pitch_v


@kernel
def spline(
    nodes: Matrix, first: int, columns: int, x: float, y: float
) -> tuple[float, float, float]:
    """(h, ∂h/∂x, ∂h/∂y) in column ``x`` and row ``y``, which lie within the grid."""
    column, row = int(x), int(y)
    s, t = x - column, y - row
    at = first + (row - 1) * columns + column - 1
    # Cubic B-spline weights of the four nodes around, and their derivatives; then line by line.
    a, b = _weights(s), _slopes(s)
    w, g = _weights(t), _slopes(t)
    k_0, b_0 = _line(nodes, at, a, b)
    k_1, b_1 = _line(nodes, at + columns, a, b)
    k_2, b_2 = _line(nodes, at + 2 * columns, a, b)
    k_3, b_3 = _line(nodes, at + 3 * columns, a, b)
    h = w[0] * k_0 + w[1] * k_1 + w[2] * k_2 + w[3] * k_3
    h_x = w[0] * b_0 + w[1] * b_1 + w[2] * b_2 + w[3] * b_3
    h_y = g[0] * k_0 + g[1] * k_1 + g[2] * k_2 + g[3] * k_3
    return h, h_x, h_y


@kernel
def _line(nodes: Matrix, at: int, a: Four, b: Four) -> tuple[float, float]:
    """Four coefficients from ``at`` on, weighted by ``a`` and by ``b``."""
    c_0, c_1, c_2, c_3 = nodes[0, at], nodes[0, at + 1], nodes[0, at + 2], nodes[0, at + 3]
    return (
        a[0] * c_0 + a[1] * c_1 + a[2] * c_2 + a[3] * c_3,
        b[0] * c_0 + b[1] * c_1 + b[2] * c_2 + b[3] * c_3,
    )


@kernel
def _within(x: float, count: int) -> float:
    """``x`` in a cell that has a node on either side; also of NaN, which must not index memory."""
    if not x >= 1.0:
        return 1.0
    return min(x, count - 2.000001)


@kernel
def _weights(s: float) -> Four:
    r = 1.0 - s
    a, d = r * r * r / 6.0, s * s * s / 6.0
    b = 2.0 / 3.0 - 0.5 * s * s * (2.0 - s)
    return a, b, 1.0 - a - b - d, d


@kernel
def _slopes(s: float) -> Four:
    r = 1.0 - s
    a, d = -0.5 * r * r, 0.5 * s * s
    b = s * (1.5 * s - 2.0)
    return a, b, -a - b - d, d


@kernel
def relief_covers(reliefs: Structured, nodes: Matrix, i: int, u: float, v: float) -> bool:
    """Whether there is a surface at (u, v)."""
    half_u, half_v = reliefs["half_size"][i, 0], reliefs["half_size"][i, 1]
    if not (abs(u) <= half_u and abs(v) <= half_v):
        return False
    columns, rows = reliefs["columns"][i], reliefs["rows"][i]
    column = int(u / reliefs["pitch"][i, 0] + 0.5 * (columns - 1))
    row = int(v / reliefs["pitch"][i, 1] + 0.5 * (rows - 1))
    # On the far edges, and by rounding beside the near ones, the cell is the last or the first.
    column = min(max(column, PAD), columns - PAD - 2)
    row = min(max(row, PAD), rows - PAD - 2)
    at = reliefs["first"][i] + row * columns + column
    total = nodes[1, at] + nodes[1, at + 1] + nodes[1, at + columns] + nodes[1, at + columns + 1]
    return not np.isnan(total)


@kernel
def relief_point(reliefs: Structured, nodes: Matrix, i: int, u: float, v: float) -> Vector:
    """The point (3,) in W, m, at (u, v) m."""
    h, _, _ = height_at(reliefs, nodes, i, u, v)
    R = reliefs["R_WS"][i]
    p = reliefs["p_WS"][i]
    out = np.empty(3)
    for k in range(3):
        out[k] = p[k] + R[k, 0] * u + R[k, 1] * v + R[k, 2] * h
    return out


@kernel
def relief_normal(reliefs: Structured, nodes: Matrix, i: int, u: float, v: float) -> Vector:
    """The unit normal (3,) in W at (u, v) m, to the free side: (−h_u, −h_v, 1) in S, normed."""
    _, h_u, h_v = height_at(reliefs, nodes, i, u, v)
    R = reliefs["R_WS"][i]
    size = np.sqrt(1.0 + h_u * h_u + h_v * h_v)
    out = np.empty(3)
    for k in range(3):
        out[k] = (R[k, 2] - R[k, 0] * h_u - R[k, 1] * h_v) / size
    return out


@kernel
def relief_foot(
    reliefs: Structured, nodes: Matrix, i: int, p_W: Vector
) -> tuple[float, float, float, bool]:
    """(u, v, w, on) of a point: its foot, its distance from it, m, and whether it has one.

    The foot is where p − s(u, v) stands square to the surface: Gauss-Newton on ½|p − s|², from
    the nearest node on. It contracts by curvature times distance in each step, so a touching tip
    is within 1e-9 m after a few. w is positive on the free side. Without a foot (beside the mesh,
    over a hole) it is the nearest node, found among every eighth and then around the best of
    them, and w > 0 is the distance from that.
    """
    R = reliefs["R_WS"][i]
    p = reliefs["p_WS"][i]
    dx, dy, dz = p_W[0] - p[0], p_W[1] - p[1], p_W[2] - p[2]
    a = R[0, 0] * dx + R[1, 0] * dy + R[2, 0] * dz
    b = R[0, 1] * dx + R[1, 1] * dy + R[2, 1] * dz
    c = R[0, 2] * dx + R[1, 2] * dy + R[2, 2] * dz
    u_0, v_0, nearest = _nearest_node(reliefs, nodes, i, a, b, c)
    far_u = reliefs["half_size"][i, 0] + PAD * reliefs["pitch"][i, 0]
    far_v = reliefs["half_size"][i, 1] + PAD * reliefs["pitch"][i, 1]
    u, v = u_0, v_0
    h, h_u, h_v = height_at(reliefs, nodes, i, u, v)
    for _ in range(FOOT_STEPS):
        above = c - h
        g_u, g_v = a - u + above * h_u, b - v + above * h_v
        scale = 1.0 + h_u * h_u + h_v * h_v
        step_u = ((1.0 + h_v * h_v) * g_u - h_u * h_v * g_v) / scale
        step_v = ((1.0 + h_u * h_u) * g_v - h_u * h_v * g_u) / scale
        # Kept near the grid: far from the surface the steps may stray.
        u = min(max(u + step_u, -far_u), far_u)
        v = min(max(v + step_v, -far_v), far_v)
        h, h_u, h_v = height_at(reliefs, nodes, i, u, v)
        if abs(step_u) + abs(step_v) < FOOT_M:
            break
    above = c - h
    distance = np.sqrt((a - u) * (a - u) + (b - v) * (b - v) + above * above)
    # No farther than the node from which the search set out, or it has strayed.
    if distance <= nearest + FOOT_M and relief_covers(reliefs, nodes, i, u, v):
        return u, v, np.copysign(distance, above), True
    return u_0, v_0, nearest, False


@kernel
def _nearest_node(
    reliefs: Structured, nodes: Matrix, i: int, a: float, b: float, c: float
) -> tuple[float, float, float]:
    """(u, v, distance) of the node nearest to (a, b, c) m in S."""
    columns, rows = reliefs["columns"][i], reliefs["rows"][i]
    pitch_u, pitch_v = reliefs["pitch"][i, 0], reliefs["pitch"][i, 1]
    half_column, half_row = 0.5 * (columns - 1), 0.5 * (rows - 1)
    first = reliefs["first"][i]
    best, best_row, best_column = np.inf, PAD, PAD
    top, bottom, left, right, stride = PAD, rows - PAD, PAD, columns - PAD, STRIDE
    for _ in range(2):
        for row in range(top, bottom, stride):
            dv = b - (row - half_row) * pitch_v
            for column in range(left, right, stride):
                du = a - (column - half_column) * pitch_u
                dh = c - nodes[1, first + row * columns + column]
                square = du * du + dv * dv + dh * dh
                if square < best:  # never where the height is NaN
                    best, best_row, best_column = square, row, column
        top, bottom = max(best_row - STRIDE, PAD), min(best_row + STRIDE + 1, rows - PAD)
        left = max(best_column - STRIDE, PAD)
        right = min(best_column + STRIDE + 1, columns - PAD)
        stride = 1
    u, v = (best_column - half_column) * pitch_u, (best_row - half_row) * pitch_v
    return u, v, np.sqrt(best)
