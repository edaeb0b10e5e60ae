"""Lines of equal potential on a kriged map."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.kriging import KrigedMap

_STEPS_MV = (50, 25, 10, 5)
_ENOUGH = 4


@dataclass(frozen=True)
class ContourLine:
    """One line of equal potential; closed if its last point is its first."""

    level_v: float
    uv_m: NDArray[np.float64]
    """(n, 2) m."""


def contour_levels(lowest_v: float, highest_v: float) -> tuple[float, ...]:
    """Levels between two potentials, V, ascending, at multiples of 50, 25, 10 or 5 mV.

    The widest step is taken that gives four levels. Every step divides 50 mV, hence the edges of
    ASTM C876's classes, −200 and −350 mV, are among the levels whenever they are in between, and
    the interval is never above the 100 mV that the standard allows.
    """
    for step in _STEPS_MV:
        first, last = np.ceil(1e3 * lowest_v / step), np.floor(1e3 * highest_v / step)
        levels = tuple(float(k * step / 1e3) for k in range(int(first), int(last) + 1))
        if len(levels) >= _ENOUGH:
            break
    return levels


def contour_lines(kriged: KrigedMap) -> tuple[ContourLine, ...]:
    """The lines of equal potential at ``contour_levels``, ascending; none outside the hull."""
    import contourpy

    potential = np.ma.masked_invalid(kriged.potential_v)
    generator = contourpy.contour_generator(kriged.u_m, kriged.v_m, potential)
    levels = contour_levels(float(potential.min()), float(potential.max()))
    return tuple(
        ContourLine(level, np.asarray(line)) for level in levels for line in generator.lines(level)
    )
