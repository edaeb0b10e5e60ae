"""Splitting an order of visits into consecutive flights by energy and reach.

The order is kept; what is chosen is where to land in between and which start each flight takes
off from. Dynamic programming over the order finds the fewest flights and, of those, the least
energy in all, exactly: best(j) = min over i ≤ j and starts s of best(i − 1) + cost(s, i … j).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np

from inspect_cli.spatial.arrays import Points, Vector


class Stage(NamedTuple):
    """One flight: the visits ``first`` … ``last`` of the order, from one of the starts."""

    first: int
    last: int
    start: int


@dataclass(frozen=True)
class Costs:
    """Energies, J, of n visits in their order; infinite where something cannot be flown."""

    work: Vector
    """(n,) of the contact itself: approach, press, dwell, retreat."""
    between: Vector
    """(n − 1,) from each visit to the next."""
    out: Points
    """(starts, n) of take-off and the way to a visit."""
    home: Points
    """(starts, n) of the way home from a visit and of landing."""

    def alone(self) -> Vector:
        """(n,) the least energy of a flight to one visit alone."""
        cost: Vector = self.work + (self.out + self.home).min(axis=0)
        return cost


def split(costs: Costs, budget_j: float) -> list[Stage]:
    """The fewest flights within ``budget_j`` each and, of those, the cheapest in all.

    A flight's visits must all be within reach of its start: finite in ``out`` and ``home``.
    Every visit must fit into a flight of its own.

    Raises:
        ValueError: a visit does not.
    """
    n = len(costs.work)
    if n and not np.all(costs.alone() <= budget_j):
        raise ValueError("a visit does not fit into a flight of its own")
    best: list[tuple[int, float]] = [(0, 0.0)]
    chosen: list[Stage] = []
    for last in range(n):
        found, stage = _last_flight(costs, budget_j, best, last)
        best.append(found)
        chosen.append(stage)
    stages: list[Stage] = []
    end = n - 1
    while end >= 0:
        stages.append(chosen[end])
        end = chosen[end].first - 1
    return stages[::-1]


def _last_flight(
    costs: Costs, budget_j: float, best: Sequence[tuple[int, float]], last: int
) -> tuple[tuple[int, float], Stage]:
    """The best flight that ends with visit ``last``, and (flights, J) of everything up to it.

    ``best`` holds (flights, J) of the first k visits for k = 0 … ``last``.
    """
    reached = np.isfinite(costs.out) & np.isfinite(costs.home)
    found, stage = (len(costs.work) + 1, np.inf), Stage(last, last, 0)
    within, carried_j = reached[:, last].copy(), 0.0
    for first in range(last, -1, -1):
        carried_j += costs.work[first]
        if first < last:
            carried_j += costs.between[first]
        within &= reached[:, first]
        if carried_j > budget_j or not within.any():
            break
        total_j = np.where(within, carried_j + costs.out[:, first] + costs.home[:, last], np.inf)
        start = int(np.argmin(total_j))
        flights, spent_j = best[first]
        candidate = (flights + 1, spent_j + float(total_j[start]))
        if total_j[start] <= budget_j and candidate < found:
            found, stage = candidate, Stage(first, last, start)
    return found, stage
