"""Sound concrete with Gaussian active spots.

With r_i the distance from spot i's middle and g_i = exp(−r_i² / (2 radius_i²))

    potential = E₀ − Σ depth_i g_i,      resistivity = ρ₀ Π (1 + (factor_i − 1) g_i)
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.schema.specimens import AnalyticSpecimen
from inspect_cli.spatial.arrays import Mask, Points
from inspect_cli.truth.specimens.fields import says_active


@kernel
def spots_at(
    u: float, v: float, potential: float, resistivity: float, spots: Points
) -> tuple[float, float]:
    """The analytic field; ``spots`` (n, 5) = (u, v, depth in V, radius in m, factor)."""
    for i in range(spots.shape[0]):
        du, dv, radius = u - spots[i, 0], v - spots[i, 1], spots[i, 3]
        bell = np.exp(-(du * du + dv * dv) / (2.0 * radius * radius))
        potential -= spots[i, 2] * bell
        resistivity *= 1.0 + (spots[i, 4] - 1.0) * bell
    return potential, resistivity


class SpotField:
    """Sound concrete with Gaussian active spots."""

    def __init__(self, model: AnalyticSpecimen) -> None:
        self._sound = (model.potential_v, model.resistivity_ohm_m)
        rows = [(*s.at_m, s.depth_v, s.radius_m, s.resistivity_factor) for s in model.spots]
        self.temperature_c = model.temperature_c
        self._spots: Points = np.array(rows, dtype=np.float64).reshape(-1, 5)

    def at(self, u: float, v: float) -> tuple[float, float]:
        """(V, Ω·m) at (u, v) in m."""
        result: tuple[float, float] = spots_at(u, v, *self._sound, self._spots)
        return result

    def active(self, uv_m: Points) -> Mask:
        """Whether the combined rule says active of the field at places (n, 2), m."""
        return says_active(self, uv_m)
