"""Orders of visits, the short ones against brute force."""

from __future__ import annotations

from itertools import permutations

import numpy as np
import pytest

from inspect_cli.planning.order import boustrophedon, shortest


def length(points, start, order):
    path = np.vstack([start, points[list(order)]])
    return np.linalg.norm(np.diff(path, axis=0), axis=1).sum()


@pytest.mark.parametrize("n", [1, 2, 3, 4, 5, 6, 7])
def test_short_paths_against_brute_force(n):
    rng = np.random.default_rng(n)
    excess = []
    for _ in range(12):
        points, start = rng.uniform(size=(n, 3)), rng.uniform(size=3)
        order = shortest(points, start)
        assert sorted(order) == list(range(n))
        best = min(length(points, start, p) for p in permutations(range(n)))
        excess.append(length(points, start, order) / best - 1.0)
    # A local search promises no optimum; from every first point it should all but find it.
    assert max(excess) < 0.05
    assert np.mean(np.array(excess) < 1e-9) >= 0.9


def test_points_on_a_line_are_visited_along_it():
    rng = np.random.default_rng(0)
    shuffled = rng.permutation(40)
    points = np.column_stack([shuffled, np.zeros(40), np.zeros(40)]).astype(float)
    order = shortest(points, np.array([-1.0, 0.0, 0.0]))
    assert list(shuffled[order]) == list(range(40))


def test_lattice_is_close_to_its_known_optimum():
    """The shortest path through a lattice from a neighbour of its corner has unit steps."""
    rng = np.random.default_rng(1)
    x, y = np.meshgrid(np.arange(10.0), np.arange(8.0))
    points = rng.permutation(np.column_stack([x.ravel(), y.ravel(), np.zeros(80)]))
    start = np.array([-1.0, 0.0, 0.0])
    # 2-opt with or-opt stays within about 5 % of the optimum on such instances.
    assert length(points, start, shortest(points, start)) <= 80.0 * 1.08


def test_coincident_points_are_all_visited():
    order = shortest(np.zeros((6, 3)), np.zeros(3))
    assert sorted(order) == list(range(6))


def test_boustrophedon_turns_at_the_end_of_each_row():
    assert boustrophedon(3, 3) == [0, 1, 2, 5, 4, 3, 6, 7, 8]
    assert boustrophedon(1, 4) == [0, 1, 2, 3]
