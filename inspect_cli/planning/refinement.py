"""Where neighbouring readings differ so much that points belong between them.

ASTM C876 asks for a closer spacing where neighbours differ by more than 150 mV. Neighbours are
points of the lattice that are next to each other along u or v, or on a sphere in neighbouring
rows; across a diagonal they are farther apart than ``NEIGHBOUR_SPACINGS`` pitches. Only what was
measured is looked at.
"""

from __future__ import annotations

from collections.abc import Mapping
from itertools import combinations, islice
from typing import NamedTuple

from inspect_cli.assessment.spacing import NEIGHBOUR_SPACINGS
from inspect_cli.planning.lattice import Place, along_m, between
from inspect_cli.schema.tasks.coverage import Coverage, Refinement
from inspect_cli.spatial.arrays import Structured


class Measured(NamedTuple):
    """A valid reading at a place of a surface."""

    place: Place
    potential_mv: float


def places_between(
    prim: Structured, coverage: Coverage, rule: Refinement, readings: Mapping[str, Measured]
) -> dict[str, Place]:
    """The places that the rule asks for, by a label made of their neighbours' labels.

    The greatest differences come first; there are at most ``rule.max_points``.
    """
    pitch_m = rule.pitch_m or 0.5 * coverage.pitch_m
    doubtful = []
    for (a, at_a), (b, at_b) in combinations(readings.items(), 2):
        difference_mv = abs(at_a.potential_mv - at_b.potential_mv)
        if difference_mv <= rule.difference_mv:
            continue
        if along_m(prim, at_a.place, at_b.place) <= NEIGHBOUR_SPACINGS * coverage.pitch_m:
            doubtful.append((-difference_mv, a, b))
    found: dict[str, Place] = {}
    for _, a, b in sorted(doubtful):
        on_the_way = between(prim, readings[a].place, readings[b].place, pitch_m)
        steps = list(islice(on_the_way, rule.max_points + 1))  # one alone has no number
        for k, place in enumerate(steps, 1):
            found[f"{a}-{b}" if len(steps) == 1 else f"{a}-{b}.{k}"] = place
    return dict(list(found.items())[: rule.max_points])
