"""In which order the points of a task are visited."""

from __future__ import annotations

from typing import Literal

import numpy as np

from inspect_cli.planning.points import ContactPoint
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.contact_points import ContactPoints
from inspect_cli.spatial.arrays import Matrix, Points, Vector

Order = Literal["boustrophedon", "rows", "given", "shortest"]

RESTARTS = 200
"""Points times restarts of the search: small tasks are searched from every first point."""
LONGEST_MOVED = 3
"""Points that or-opt moves at once."""
GAIN_M = 1e-9


def visiting_order(
    contact: ContactGrid | ContactPoints, points: list[ContactPoint], start_W: Vector
) -> list[int]:
    """The indices of ``points`` in the order of the visits.

    ``shortest`` is by the distances between the tool's tips at standoff, from ``start_W`` (3,)
    m, the tip of the posture before; it ends wherever that is shortest.
    """
    if contact.order == "shortest":
        tips = np.array([point.in_front(point.options.standoff_m) for point in points])
        return shortest(tips, start_W)
    if contact.order == "boustrophedon":
        return boustrophedon(contact.rows, contact.columns)
    return list(range(len(points)))


def boustrophedon(rows: int, columns: int) -> list[int]:
    """Indices of a grid stored by rows, as the ox ploughs: every second row backwards."""
    order: list[int] = []
    for row in range(rows):
        indices = range(row * columns, (row + 1) * columns)
        order.extend(reversed(indices) if row % 2 else indices)
    return order


def shortest(points_W: Points, start_W: Vector) -> list[int]:
    """A short open path from ``start_W`` (d,) through all ``points_W`` (n, d); indices (n,).

    Nearest neighbour from several first points, each improved by 2-opt (Croes, Oper. Res. 6,
    1958) and or-opt (Or, thesis, 1976) until neither gains; the best of them.
    """
    n = len(points_W)
    # Node 0 is the start, n + 1 a free end at no distance from anything: both ends are fixed.
    nodes = np.vstack([start_W, points_W])
    D = np.zeros((n + 2, n + 2))
    D[:-1, :-1] = np.linalg.norm(nodes[:, None] - nodes[None], axis=2)
    restarts = min(n, max(1, RESTARTS // n))
    firsts = 1 + np.argsort(D[0, 1:-1], kind="stable")[:restarts]
    tours = [_improved(D, _nearest_neighbour(D, int(first))) for first in firsts]
    best = min(tours, key=lambda tour: _length(D, tour))
    return [int(node) - 1 for node in best[1:-1]]


def _length(D: Matrix, tour: Vector) -> float:
    return float(D[tour[:-1], tour[1:]].sum())


def _nearest_neighbour(D: Matrix, first: int) -> Vector:
    end = len(D) - 1
    tour = [0, first]
    left = np.ones(end, dtype=bool)
    left[[0, first]] = False
    while left.any():
        candidates = np.flatnonzero(left)
        nearest = int(candidates[np.argmin(D[tour[-1], candidates])])
        tour.append(nearest)
        left[nearest] = False
    return np.array([*tour, end])


def _improved(D: Matrix, tour: Vector) -> Vector:
    while True:
        shorter = _or_opt(D, _two_opt(D, tour))
        if _length(D, shorter) > _length(D, tour) - GAIN_M:
            return tour
        tour = shorter


def _two_opt(D: Matrix, tour: Vector) -> Vector:
    """One sweep: for each edge the best reversal tour[i+1 … j] that begins behind it."""
    tour = tour.copy()
    for i in range(len(tour) - 3):
        heads, tails = tour[i + 1 : -1], tour[i + 2 :]
        change = D[tour[i], heads] + D[tour[i + 1], tails]
        change -= D[tour[i], tour[i + 1]] + D[heads, tails]
        best = int(np.argmin(change))
        if change[best] < -GAIN_M:
            tour[i + 1 : i + 2 + best] = tour[i + 1 : i + 2 + best][::-1].copy()
    return tour


def _or_opt(D: Matrix, tour: Vector) -> Vector:
    """One sweep: each run of one to three points goes where it costs least, either way round."""
    for length in range(1, min(LONGEST_MOVED, len(tour) - 3) + 1):
        for i in range(1, len(tour) - 1 - length):
            run = tour[i : i + length]
            rest = np.concatenate([tour[:i], tour[i + length :]])
            before, after = rest[:-1], rest[1:]
            gap = D[before, after]
            forward = D[before, run[0]] + D[run[-1], after] - gap
            backward = D[before, run[-1]] + D[run[0], after] - gap
            here = forward[i - 1] - GAIN_M
            turned = backward.min() < forward.min()
            cost = backward if turned else forward
            best = int(np.argmin(cost))
            if cost[best] < here:
                run = run[::-1] if turned else run
                tour = np.concatenate([rest[: best + 1], run, rest[best + 1 :]])
    return tour
