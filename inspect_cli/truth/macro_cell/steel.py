"""How the steel's current density answers to its potential.

With E the steel's potential against the concrete before it, E₀ and i₀ its rest, β_a and β_c the
Tafel slopes per decade and i_L the limit that oxygen's diffusion sets,

    i_a = i₀ 10^((E − E₀)/β_a)        1/i_c = 1 / (i₀ 10^(−(E − E₀)/β_c)) + 1/i_L
    i(E) = i_a − i_c                  net, anodic positive, A/m²

i rises with E everywhere, so that a mat has one solution. Without a limit i(E₀) = 0; with i_L far
below i₀, as in saturated concrete, isolated passive steel rests where i_a = i_L, much more negative
than E₀ and without corroding. In a mat that holds only where all of it is starved: a starved spot
is held up by the steel around it (``truth.macro_cell``).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from inspect_cli.schema.specimens.macro_cell import Kinetics
from inspect_cli.spatial.arrays import Matrix

DECADES: Final = 100.0
"""Exponents are held within ±100: currents beyond are never reached, numbers would overflow."""
BISECTIONS: Final = 60
LOWEST_V: Final = -5.0
HIGHEST_V: Final = 2.0


@dataclass(frozen=True)
class Steel:
    """Steel of several kinds k under every node."""

    kinetics: tuple[Kinetics, ...]
    oxygen: Matrix
    """(n_v, n_u) factor of the cathodic limits."""

    def currents(self, E: Matrix) -> tuple[Matrix, Matrix, Matrix]:
        """(anodic, cathodic, slope of their difference), each (n_k, n_v, n_u): A/m², A/(m² V)."""
        pairs = zip(self.kinetics, E, strict=True)
        found = [branches(kinetics, at, self.oxygen) for kinetics, at in pairs]
        anodic, cathodic, slope = (np.stack(parts) for parts in zip(*found, strict=True))
        return anodic, cathodic, slope

    def current(self, E: Matrix) -> tuple[Matrix, Matrix]:
        """(net anodic current density, its slope), each (n_k, n_v, n_u): A/m², A/(m² V)."""
        anodic, cathodic, slope = self.currents(E)
        return anodic - cathodic, slope

    def rest(self) -> Matrix:
        """Potentials (n_k, n_v, n_u), V, with i(E) = 0, by bisection."""
        shape = (len(self.kinetics), *self.oxygen.shape)
        low, high = np.full(shape, LOWEST_V), np.full(shape, HIGHEST_V)
        for _ in range(BISECTIONS):
            middle = 0.5 * (low + high)
            above = self.current(middle)[0] > 0.0
            high = np.where(above, middle, high)
            low = np.where(above, low, middle)
        return 0.5 * (low + high)


def branches(kinetics: Kinetics, E: Matrix, oxygen: Matrix) -> tuple[Matrix, Matrix, Matrix]:
    """(i_a, i_c, d(i_a − i_c)/dE) at potentials ``E``."""
    over = E - kinetics.rest_v
    anodic_slope, cathodic_slope = kinetics.anodic_slope_vpdec, kinetics.cathodic_slope_vpdec
    anodic = kinetics.current_apm2 * 10.0 ** np.clip(over / anodic_slope, -DECADES, DECADES)
    free = kinetics.current_apm2 * 10.0 ** np.clip(-over / cathodic_slope, -DECADES, DECADES)
    held = np.ones_like(free)
    if kinetics.limit_apm2 is not None:
        held = 1.0 / (1.0 + free / (kinetics.limit_apm2 * oxygen))
    cathodic = free * held
    slope = math.log(10.0) * (anodic / anodic_slope + cathodic * held / cathodic_slope)
    return anodic, cathodic, slope
