"""The split into flights against every other split."""

from __future__ import annotations

from itertools import combinations, pairwise

import numpy as np
import pytest

from inspect_cli.planning.sorties import Costs, Stage, split


def cost(costs: Costs, stage: Stage) -> float:
    first, last, start = stage
    reach = costs.out[start, first : last + 1] + costs.home[start, first : last + 1]
    if not np.isfinite(reach).all():
        return np.inf
    carried = costs.work[first : last + 1].sum() + costs.between[first:last].sum()
    return carried + costs.out[start, first] + costs.home[start, last]


def brute_force(costs: Costs, budget: float) -> tuple[int, float]:
    n, starts = len(costs.work), len(costs.out)
    best = (n + 1, np.inf)
    for flights in range(1, n + 1):
        for cuts in combinations(range(1, n), flights - 1):
            total = 0.0
            for first, end in pairwise((0, *cuts, n)):
                each = [cost(costs, Stage(first, end - 1, s)) for s in range(starts)]
                total += min((c for c in each if c <= budget), default=np.inf)
            if np.isfinite(total):
                best = min(best, (flights, total))
    return best


@pytest.mark.parametrize("seed", range(25))
def test_against_every_split(seed):
    rng = np.random.default_rng(seed)
    n, starts = int(rng.integers(1, 9)), int(rng.integers(1, 4))
    costs = Costs(
        work=rng.uniform(1, 3, n),
        between=rng.uniform(0.2, 2, n - 1),
        out=rng.uniform(1, 4, (starts, n)),
        home=rng.uniform(1, 4, (starts, n)),
    )
    # Some visits are out of the cable's reach from some starts, some legs have no way.
    costs.out[1:][rng.uniform(size=(starts - 1, n)) < 0.3] = np.inf
    costs.between[rng.uniform(size=n - 1) < 0.15] = np.inf
    budget = float(costs.alone().max() * rng.uniform(1.0, 2.5))
    stages = split(costs, budget)
    assert [k for s in stages for k in range(s.first, s.last + 1)] == list(range(n))
    each = [cost(costs, stage) for stage in stages]
    assert max(each) <= budget
    flights, total = brute_force(costs, budget)
    assert len(stages) == flights
    assert sum(each) == pytest.approx(total, rel=1e-12)


def test_one_flight_when_the_battery_is_large():
    costs = Costs(np.ones(50), np.ones(49), np.ones((1, 50)), np.ones((1, 50)))
    assert split(costs, 101.0) == [Stage(0, 49, 0)]
    assert len(split(costs, 100.9)) == 2


def test_nothing_to_visit():
    assert split(Costs(np.empty(0), np.empty(0), np.empty((1, 0)), np.empty((1, 0))), 1.0) == []


def test_a_visit_that_fits_into_no_flight():
    costs = Costs(np.array([5.0]), np.empty(0), np.ones((1, 1)), np.ones((1, 1)))
    with pytest.raises(ValueError, match="own"):
        split(costs, 6.9)
