"""What the half-cell probe would read on the true specimen: potential and resistivity over (u, v).

A field is asked by ``at(u, v)``, coordinates along the surface in m, and answers
(potential in V against copper sulphate, resistivity in Ω·m).

A field also tells where the reinforcement is truly active. A macro cell knows its sites; neither an
analytic field nor a measured grid knows the steel, so there the combined rule
(``assessment.classes``) decides on the true values, on the standard's scale: what a CSE reads in
the concrete, corrected for its temperature as ASTM C876 asks.
"""

from __future__ import annotations

from typing import Final, Protocol

import numpy as np

from inspect_cli.assessment.classes import VERDICTS, verdict_codes
from inspect_cli.assessment.electrodes import temperature_correction_v
from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Mask, Matrix, Points

EDGE: Final = 1e-9
"""In pitches: a point so little outside the grid is on its edge."""


class SpecimenField(Protocol):
    """Potential and resistivity along a surface."""

    @property
    def temperature_c(self) -> float:
        """Of the concrete, in which a copper sulphate electrode reads what ``at`` answers."""
        ...

    def at(self, u: float, v: float) -> tuple[float, float]:
        """(V, Ω·m) at (u, v) in m; NaN where the specimen has no values."""
        ...

    def active(self, uv_m: Points) -> Mask:
        """Whether the reinforcement under places (n, 2), m, truly corrodes; not without values."""
        ...


@kernel
def bilinear(x: float, y: float, values: Matrix) -> tuple[float, float]:
    """Both tables of ``values`` (rows, columns, 2) at column ``x`` and row ``y``; NaN outside."""
    rows, columns = values.shape[0], values.shape[1]
    inside = -EDGE <= x <= columns - 1 + EDGE and -EDGE <= y <= rows - 1 + EDGE
    if not inside:
        return np.nan, np.nan
    x = min(max(x, 0.0), columns - 1.0)
    y = min(max(y, 0.0), rows - 1.0)
    j = min(int(x), columns - 2)
    i = min(int(y), rows - 2)
    s, t = x - j, y - i
    a, b, c, d = (1 - t) * (1 - s), (1 - t) * s, t * (1 - s), t * s
    return (
        a * values[i, j, 0]
        + b * values[i, j + 1, 0]
        + c * values[i + 1, j, 0]
        + d * values[i + 1, j + 1, 0],
        a * values[i, j, 1]
        + b * values[i, j + 1, 1]
        + c * values[i + 1, j, 1]
        + d * values[i + 1, j + 1, 1],
    )


def says_active(field: SpecimenField, uv_m: Points) -> Mask:
    """Whether the combined rule says active of the values at places (n, 2), m.

    On the standard's scale. The rule is asked once for all places: asked one by one it takes 50 µs.
    """
    values = np.array([field.at(u, v) for u, v in uv_m.tolist()]).reshape(-1, 2)
    standard = values[:, 0] + temperature_correction_v(field.temperature_c)
    active: Mask = verdict_codes(standard, values[:, 1]) == VERDICTS.index("active")
    return active
