"""Where rays meet reliefs: safe steps along the smooth heights, Newton's at the end."""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Points, Structured, Vector
from inspect_cli.truth.relief import relief_covers, spline

RAY_STEPS, RAY_M = 200, 1e-6


@kernel
def cast_on_reliefs(
    reliefs: Structured,
    nodes: Matrix,
    origin_W: Vector,
    directions_W: Points,
    farthest: Vector,
    ranges: Vector,
) -> None:
    """Shorten ``ranges`` (n,) to the hits of rays from ``origin_W`` on reliefs, from both sides.

    A NaN is a ray that has met nothing so far; nothing is looked for beyond ``farthest`` (n,).
    """
    for i in range(reliefs.shape[0]):
        R = reliefs["R_WS"][i]
        p = reliefs["p_WS"][i]
        o, d = np.empty(3), np.empty(3)
        for m in range(3):
            o[m] = 0.0
            for n in range(3):
                o[m] += R[n, m] * (origin_W[n] - p[n])
        for k in range(ranges.size):
            for m in range(3):
                d[m] = (
                    R[0, m] * directions_W[k, 0]
                    + R[1, m] * directions_W[k, 1]
                    + R[2, m] * directions_W[k, 2]
                )
            known = farthest[k] if not ranges[k] < farthest[k] else ranges[k]
            t = _ray_on_relief(reliefs, nodes, i, o, d, known)
            if t <= known:
                ranges[k] = t


@kernel
def _ray_on_relief(
    reliefs: Structured, nodes: Matrix, i: int, o: Vector, d: Vector, farthest: float
) -> float:
    """Where the ray o + t d in S first meets relief ``i``, m; infinite beyond ``farthest``.

    Along the ray g(t) = z(t) − h(u(t), v(t)) has |g″| ≤ M = curvature · (d_u² + d_v²). So |g|
    stays above |g| − |g|′τ − ½ M τ² for a while, and the step to this parabola's zero passes no
    crossing. Near one it is Newton's step, which ends the search once it is good to
    M τ² / |g|′ ≤ RAY_M. Where the slope's bound allows a longer step it is taken. Should a step
    have passed a crossing after all, half of it is taken back.
    """
    begin, end = _span_in_box(reliefs, i, o, d, farthest)
    if begin > end or np.isnan(o.sum() + d.sum()):  # what is not a number must not index memory
        return np.inf
    across = d[0] * d[0] + d[1] * d[1]
    bend = reliefs["curvature"][i] * across
    rate = abs(d[2]) + reliefs["slope"][i] * np.sqrt(across)
    pitch_u, pitch_v = reliefs["pitch"][i, 0], reliefs["pitch"][i, 1]
    first, columns = reliefs["first"][i], reliefs["columns"][i]
    # The ray in columns and rows, where the box keeps it within the grid.
    x_0, dx = o[0] / pitch_u + 0.5 * (columns - 1), d[0] / pitch_u
    y_0, dy = o[1] / pitch_v + 0.5 * (reliefs["rows"][i] - 1), d[1] / pitch_v
    z_0, dz = o[2], d[2]
    t, step, side = begin, 0.0, 0.0
    for _ in range(RAY_STEPS):
        h, h_x, h_y = spline(nodes, first, columns, x_0 + t * dx, y_0 + t * dy)
        g = z_0 + t * dz - h
        if g * side < 0.0:
            step *= 0.5
            t -= step
            continue
        side = np.copysign(1.0, g)
        approach = side * (h_x * dx + h_y * dy - dz)
        newton = abs(g) / approach if approach > 0.0 else np.inf
        if bend * newton * newton <= RAY_M * approach:
            hit = t + newton
            if hit > end:
                return np.inf
            if relief_covers(reliefs, nodes, i, o[0] + hit * d[0], o[1] + hit * d[1]):
                return hit
            t, side = hit + 0.25 * pitch_u, 0.0  # through a hole
            if t > end:
                return np.inf
            continue
        root = np.sqrt(approach * approach + 2.0 * bend * abs(g))
        # Of the two ways to write the zero, the one without cancellation.
        if approach > 0.0:
            step = 2.0 * abs(g) / (approach + root)
        else:
            step = (root - approach) / bend if bend > 0.0 else np.inf
        step = max(step, abs(g) / rate)
        t += step
        if t > end:
            return np.inf
    return np.inf


@kernel
def box_distance(reliefs: Structured, i: int, p_W: Vector) -> float:
    """Distance, m, of a point from the box around relief ``i``; zero within it."""
    R, p = reliefs["R_WS"][i], reliefs["p_WS"][i]
    square = 0.0
    for m in range(3):
        x = 0.0
        for n in range(3):
            x += R[n, m] * (p_W[n] - p[n])
        if m == 2:
            low, high = reliefs["low"][i], reliefs["high"][i]
        else:
            high = reliefs["half_size"][i, m]
            low = -high
        off = max(low - x, x - high, 0.0)
        square += off * off
    return float(np.sqrt(square))


@kernel
def _span_in_box(
    reliefs: Structured, i: int, o: Vector, d: Vector, farthest: float
) -> tuple[float, float]:
    """(begin, end) of the ray o + t d, 0 ≤ t ≤ farthest, in the box around relief ``i``."""
    begin, end = 0.0, farthest
    for m in range(3):
        if m == 2:
            low, high = reliefs["low"][i], reliefs["high"][i]
        else:
            high = reliefs["half_size"][i, m]
            low = -high
        if d[m] == 0.0:
            if not low <= o[m] <= high:
                return 1.0, 0.0
            continue
        t_1, t_2 = (low - o[m]) / d[m], (high - o[m]) / d[m]
        begin, end = max(begin, min(t_1, t_2)), min(end, max(t_1, t_2))
    return begin, end
