"""Wall, ceiling and ground effect on rotors: a factor on each rotor's thrust at constant command.

Stated model, for a rotor of radius R at distance d from a surface (all three multiply):

ceiling   T/T∞ = γ^(2/3), γ = ½ + ½ √(1 + R²/(8 d²)): momentum theory at constant power
          (Hsiao & Chirarattananon, "Ceiling effects for hybrid aerial-surface locomotion",
          arXiv 1905.04632, gives P = T^1.5/(γ √(2 ρ A))). The paper's gain at constant rotor
          speed needs blade-element theory; constant power is chosen. d ≥ 0.1 R is clamped,
          where the momentum theory diverges.
ground    T/T∞ = 1/(1 − (R/4z)²), Cheeseman & Bennett (ARC R&M 3021, 1955); z ≥ R/2 is clamped.
wall      T/T∞ = 1 − 0.03 e^(−d/R), chosen without a source: a loss of a few per cent that fades
          within a rotor's radius.

Distances are measured from the rotor's hub: along the thrust for the ceiling, against it for the
ground, and to the nearest surface for the wall.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.schema.truth import ProximityEffects
from inspect_cli.spatial.arrays import Indices, Matrix, Points
from inspect_cli.truth.solids import Solids, cast, count_of, distance_from, on_the_ground

REACH_M = 2.0
"""Beyond this a surface has no effect worth computing."""
CEILING_CLAMP = 0.1
GROUND_CLAMP = 0.5
WALL_LOSS = 0.03


@kernel
def ceiling_factor(distance_m: float, radius_m: float) -> float:
    """T/T∞ under a ceiling at constant power."""
    d = max(distance_m, CEILING_CLAMP * radius_m)
    gamma = 0.5 + 0.5 * np.sqrt(1.0 + radius_m * radius_m / (8.0 * d * d))
    return float(gamma ** (2.0 / 3.0))


@kernel
def ground_factor(height_m: float, radius_m: float) -> float:
    """T/T∞ above the ground."""
    z = max(height_m, GROUND_CLAMP * radius_m)
    return float(1.0 / (1.0 - (radius_m / (4.0 * z)) ** 2))


@kernel
def wall_factor(distance_m: float, radius_m: float) -> float:
    """T/T∞ beside a wall."""
    return float(1.0 - WALL_LOSS * np.exp(-max(distance_m, 0.0) / radius_m))


@kernel
def set_thrust_factors(
    solids: Solids,
    site_xpos: Points,
    site_xmat: Points,
    hubs: Indices,
    radius_m: float,
    ground: bool,
    ceiling: bool,
    wall: bool,
    gains: Matrix,
) -> None:
    """Write the factor of each hub into the first column of ``gains``.

    ``hubs`` (n,) are the sites of the rotors, in MuJoCo's arrays of positions and rotations; a
    rotor's thrust is along its site's z. The first of ``solids`` is the ground, no wall.
    """
    directions = np.empty((2, 3))
    ranges = np.empty(2)
    for i in range(hubs.shape[0]):
        hub_W = site_xpos[hubs[i]]
        for k in range(3):
            directions[0, k] = site_xmat[hubs[i], 3 * k + 2]
            directions[1, k] = -directions[0, k]
        cast(solids, hub_W, directions, REACH_M, ranges)
        factor = 1.0
        if ceiling and not np.isnan(ranges[0]):
            factor *= ceiling_factor(ranges[0], radius_m)
        if ground and not np.isnan(ranges[1]):
            factor *= ground_factor(ranges[1], radius_m)
        if wall:
            nearest = REACH_M
            for j in range(1, count_of(solids)):
                nearest = min(nearest, abs(distance_from(solids, j, hub_W)))
            if nearest < REACH_M:
                factor *= wall_factor(nearest, radius_m)
        gains[i, 0] = factor


class Proximity:
    """The effect of the true surfaces and the ground on a vehicle's rotors."""

    def __init__(self, effects: ProximityEffects, solids: Solids, radius_m: float) -> None:
        self._solids = on_the_ground(solids)
        self._effects = effects
        self._radius_m = radius_m

    @property
    def any(self) -> bool:
        """Whether any effect is switched on."""
        return self._effects.ground or self._effects.ceiling or self._effects.wall

    def update(self, site_xpos: Points, site_xmat: Points, hubs: Indices, gains: Matrix) -> None:
        """Set each rotor's gain to its factor; see ``set_thrust_factors``."""
        effects = self._effects
        set_thrust_factors(
            self._solids,
            site_xpos,
            site_xmat,
            hubs,
            self._radius_m,
            effects.ground,
            effects.ceiling,
            effects.wall,
            gains,
        )
