"""Which states of concrete and steel a potential is typical of (RILEM TC 154-EMC).

The ranges overlap and leave gaps: a potential may be typical of several conditions or of none,
and saturated concrete is very negative without any corrosion.
"""

from __future__ import annotations

from typing import Final, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inspect_cli.assessment.classes import millivolts


class Condition(NamedTuple):
    """A condition of concrete and its typical potentials against CSE; both ends belong to it."""

    name: str
    low_mv: float
    high_mv: float


SATURATED: Final = "water-saturated, without oxygen"

CONDITIONS: Final = (
    Condition(SATURATED, -1000.0, -900.0),
    Condition("moist, chloride-contaminated", -600.0, -400.0),
    Condition("moist, chloride-free", -200.0, 100.0),
    Condition("moist, carbonated", -400.0, 100.0),
    Condition("dry, carbonated", 0.0, 200.0),
    Condition("dry, non-carbonated", 0.0, 200.0),
)
"""Source: Elsener and others, "Half-cell potential measurements – potential mapping on reinforced
concrete structures", RILEM TC 154-EMC, Materials and Structures 36 (2003) 461–471."""


def compatible(potential_v: ArrayLike) -> NDArray[np.bool_]:
    """Which of ``CONDITIONS`` (last axis, 6) potentials (...), V against CSE, are typical of."""
    mv = millivolts(potential_v)[..., np.newaxis]
    low = np.array([c.low_mv for c in CONDITIONS])
    high = np.array([c.high_mv for c in CONDITIONS])
    return np.asarray((mv >= low) & (mv <= high))


def rilem_conditions(potential_v: float) -> tuple[str, ...]:
    """The names of the conditions that a single potential is typical of; none for NaN."""
    typical = compatible(potential_v)
    return tuple(c.name for c, yes in zip(CONDITIONS, typical, strict=True) if yes)
