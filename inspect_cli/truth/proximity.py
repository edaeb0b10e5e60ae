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

from inspect_cli.compiled import bound, kernel
from inspect_cli.schema.truth import ProximityEffects
from inspect_cli.spatial.arrays import Indices, Matrix, Points, Structured, Vector
from inspect_cli.spatial.primitives import patch_distance, raycast
from inspect_cli.truth.relief import relief_foot
from inspect_cli.truth.relief_rays import cast_on_reliefs
from inspect_cli.truth.solids import Solids, on_the_ground

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
    surfaces: Structured,
    near: Points,
    site_xpos: Points,
    site_xmat: Points,
    hubs: Indices,
    rotors: Indices,
    radii_m: Vector,
    ground: bool,
    ceiling: bool,
    wall: bool,
    gains: Matrix,
) -> None:
    """Write the factor of each hub into the first column of ``gains``, in its rotor's row.

    ``hubs`` (n,) are the sites of the rotors, in MuJoCo's arrays of positions and rotations, and
    ``rotors`` (n,) their actuators; a rotor's thrust is along its site's z. The first of
    ``surfaces`` is the ground, no wall. ``near`` (n, 3) are distances from other things: along
    the thrust, against it and to the nearest, m; NaN along a direction in which there is nothing.
    """
    directions = np.empty((2, 3))
    ranges = np.empty(2)
    for i in range(hubs.shape[0]):
        hub_W = site_xpos[hubs[i]]
        for k in range(3):
            directions[0, k] = site_xmat[hubs[i], 3 * k + 2]
            directions[1, k] = -directions[0, k]
        raycast(surfaces, hub_W, directions, REACH_M, ranges)
        for k in range(2):
            if not ranges[k] <= near[i, k] and not np.isnan(near[i, k]):
                ranges[k] = near[i, k]
        factor = 1.0
        if ceiling and not np.isnan(ranges[0]):
            factor *= ceiling_factor(ranges[0], radii_m[i])
        if ground and not np.isnan(ranges[1]):
            factor *= ground_factor(ranges[1], radii_m[i])
        if wall:
            nearest = min(near[i, 2], REACH_M)
            for j in range(1, surfaces.shape[0]):
                nearest = min(nearest, abs(patch_distance(surfaces, j, hub_W)))
            if nearest < REACH_M:
                factor *= wall_factor(nearest, radii_m[i])
        gains[rotors[i], 0] = factor


@kernel
def near_reliefs(
    reliefs: Structured,
    nodes: Matrix,
    site_xpos: Points,
    site_xmat: Points,
    hubs: Indices,
    near: Points,
) -> None:
    """Write the reliefs' distances from each hub into ``near``; see ``set_thrust_factors``."""
    directions = np.empty((2, 3))
    ranges, reach = np.empty(2), np.array([REACH_M, REACH_M])
    for i in range(hubs.shape[0]):
        hub_W = site_xpos[hubs[i]]
        for k in range(3):
            directions[0, k] = site_xmat[hubs[i], 3 * k + 2]
            directions[1, k] = -directions[0, k]
        ranges[:] = np.nan
        cast_on_reliefs(reliefs, nodes, hub_W, directions, reach, ranges)
        near[i, 0] = ranges[0]
        near[i, 1] = ranges[1]
        near[i, 2] = np.inf
        for j in range(reliefs.shape[0]):
            near[i, 2] = min(near[i, 2], abs(relief_foot(reliefs, nodes, j, hub_W)[2]))


class Proximity:
    """The effect of the true surfaces and the ground on rotors of the radii (n,), m."""

    def __init__(self, effects: ProximityEffects, solids: Solids, radii_m: Vector) -> None:
        self._solids = on_the_ground(solids)
        self._effects = effects
        self._radii_m = radii_m
        self._gains: Matrix | None = None

    @property
    def any(self) -> bool:
        """Whether any effect is switched on."""
        return self._effects.ground or self._effects.ceiling or self._effects.wall

    def update(
        self,
        site_xpos: Points,
        site_xmat: Points,
        hubs: Indices,
        rotors: Indices,
        gains: Matrix,
    ) -> None:
        """Set each rotor's gain to its factor; see ``set_thrust_factors``."""
        if gains is not self._gains or hubs is not self._hubs or site_xpos is not self._xpos:
            self._bind(site_xpos, site_xmat, hubs, rotors, gains)
        if self._look_for_reliefs is not None:
            self._look_for_reliefs()
        self._set()

    def _bind(
        self,
        site_xpos: Points,
        site_xmat: Points,
        hubs: Indices,
        rotors: Indices,
        gains: Matrix,
    ) -> None:
        effects, solids = self._effects, self._solids
        self._gains, self._hubs, self._xpos = gains, hubs, site_xpos
        near = np.tile([np.nan, np.nan, np.inf], (len(hubs), 1))
        places = (site_xpos, site_xmat, hubs)
        self._look_for_reliefs = None
        if len(solids.reliefs):
            self._look_for_reliefs = bound(
                near_reliefs, solids.reliefs, solids.nodes, *places, near
            )
        self._set = bound(
            set_thrust_factors,
            solids.primitives,
            near,
            *places,
            rotors,
            self._radii_m,
            effects.ground,
            effects.ceiling,
            effects.wall,
            gains,
        )
