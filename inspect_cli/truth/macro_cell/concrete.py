"""Finite volumes in the concrete: nodes, conductances, and the linear solver.

Nodes lie on a tensor grid in (d, v, u) that includes the surface, the steel's depth and the back.
Around each node stands a box that reaches half way to its neighbours. The conductance between
neighbours along u, and in the same way along v and d, is

    g_u = h_v / h_u · w_v w_d / (ρ Δu)

with the metric in the middle between them, box widths w and the mean of both nodes' ρ, which is
the series connection of two half steps. The matrix is symmetric and an M-matrix, conserves current
exactly and has an error of the order Δ² for smooth fields. Faces without a neighbour are insulated.

The system is solved by conjugate gradients, preconditioned by the exact solution of every line in
depth (Thomas's algorithm). Sums are NumPy's own, in one thread: the same input gives the same
bytes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.truth.macro_cell.patch import Patch

MOST_ITERATIONS = 5000


@dataclass(frozen=True)
class Concrete:
    """Nodes along ``u`` (n_u,), ``v`` (n_v,), ``d`` (n_d,), m, and conductances, S."""

    u: Vector
    v: Vector
    d: Vector
    steel: int
    """Index in ``d`` of the sheet of steel."""
    g_u: Matrix
    """(n_d, n_v, n_u − 1)."""
    g_v: Matrix
    """(n_d, n_v − 1, n_u)."""
    g_d: Matrix
    """(n_d − 1, n_v, n_u)."""
    volume: Matrix
    """(n_d, n_v, n_u), m³."""
    area: Matrix
    """(n_v, n_u) of the sheet of steel, m²."""
    diagonal: Matrix
    """(n_d, n_v, n_u): sum of the conductances at each node."""


def box_widths(x: Vector) -> Vector:
    """Widths (n,) of the boxes around nodes ``x`` (n,)."""
    gaps = np.diff(x)
    return 0.5 * (np.append(gaps, 0.0) + np.insert(gaps, 0, 0.0))


def concrete_of(
    patch: Patch, u: Vector, v: Vector, d: Vector, steel: int, resistivity: Matrix
) -> Concrete:
    """The concrete with ``resistivity`` (n_v, n_u), Ω·m, the same through its depth."""
    w_u, w_v = box_widths(u), box_widths(v)[:, None]
    w_d, depth = box_widths(d)[:, None, None], d[:, None, None]
    across = v[:, None]
    h_u, h_v = patch.scales(across, depth)
    mean = 0.5 * (resistivity[:, 1:] + resistivity[:, :-1])
    g_u = h_v / h_u * w_v * w_d / (mean * np.diff(u))
    middle = 0.5 * (v[1:] + v[:-1])[:, None]
    face_u, face_v = patch.scales(middle, depth)
    mean = 0.5 * (resistivity[1:] + resistivity[:-1])
    g_v = face_u / face_v * w_u * w_d / (mean * np.diff(v)[:, None])
    gap = np.diff(d)[:, None, None]
    face_u, face_v = patch.scales(across, 0.5 * (depth[1:] + depth[:-1]))
    g_d = face_u * face_v * w_u * w_v / (resistivity * gap)
    area = (h_u * h_v * w_u * w_v)[steel]
    volume = h_u * h_v * w_u * w_v * w_d
    diagonal = np.zeros(volume.shape)
    _add_ends(diagonal, g_u, 2)
    _add_ends(diagonal, g_v, 1)
    _add_ends(diagonal, g_d, 0)
    return Concrete(u, v, d, steel, g_u, g_v, g_d, volume, area, diagonal)


def _add_ends(total: Matrix, g: Matrix, axis: int) -> None:
    """Add each conductance to both of its nodes."""
    for first in (slice(None, -1), slice(1, None)):
        index = [slice(None)] * 3
        index[axis] = first
        total[tuple(index)] += g


def outflow(concrete: Concrete, x: Matrix) -> Matrix:
    """Σ g (x − x_neighbour) at every node, (n_d, n_v, n_u)."""
    flow = concrete.diagonal * x
    flow[:, :, :-1] -= concrete.g_u * x[:, :, 1:]
    flow[:, :, 1:] -= concrete.g_u * x[:, :, :-1]
    flow[:, :-1] -= concrete.g_v * x[:, 1:]
    flow[:, 1:] -= concrete.g_v * x[:, :-1]
    flow[:-1] -= concrete.g_d * x[1:]
    flow[1:] -= concrete.g_d * x[:-1]
    return flow


def solve_linear(concrete: Concrete, grounding: Matrix, load: Matrix, tolerance: float) -> Matrix:
    """x with outflow(x) + grounding · x at the steel = load, all of them per node.

    Args:
        concrete: the network.
        grounding: (n_v, n_u) conductances, S, from the nodes of the sheet to ground.
        load: (n_d, n_v, n_u), A.
        tolerance: of the residual, relative to the load, in the preconditioner's norm.
    """
    x = np.zeros_like(load)
    residual = load.copy()
    factors = _factors(concrete, grounding)
    z = _lines(concrete, factors, residual)
    direction = z.copy()
    product = float(np.sum(residual * z))
    goal = tolerance * tolerance * product
    for _ in range(MOST_ITERATIONS):
        if product <= goal:
            break
        image = outflow(concrete, direction)
        image[concrete.steel] += grounding * direction[concrete.steel]
        step = product / float(np.sum(direction * image))
        x += step * direction
        residual -= step * image
        z = _lines(concrete, factors, residual)
        before, product = product, float(np.sum(residual * z))
        direction *= product / before
        direction += z
    return x


def _factors(concrete: Concrete, grounding: Matrix) -> Matrix:
    """Pivots (n_d, n_v, n_u) of the lines in depth, eliminated downwards."""
    pivots = concrete.diagonal.copy()
    pivots[concrete.steel] += grounding
    for k in range(1, len(pivots)):
        pivots[k] -= concrete.g_d[k - 1] ** 2 / pivots[k - 1]
    return pivots


def _lines(concrete: Concrete, pivots: Matrix, load: Matrix) -> Matrix:
    """The solution of every line in depth for ``load`` (n_d, n_v, n_u)."""
    x = load.copy()
    for k in range(1, len(x)):
        x[k] += concrete.g_d[k - 1] / pivots[k - 1] * x[k - 1]
    x[-1] /= pivots[-1]
    for k in range(len(x) - 2, -1, -1):
        x[k] = (x[k] + concrete.g_d[k] * x[k + 1]) / pivots[k]
    return x
