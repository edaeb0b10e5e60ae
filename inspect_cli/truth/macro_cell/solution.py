"""From a ``macro_cell`` specimen to the potential and the resistivity along its surface.

With g the Gaussian of a spot or site over (u, v), f its factor, and T the concrete's temperature,

    ρ(u, v) = ρ₀ · exp(E_a/(R T) − E_a/(R T₂₀)) · Π (1 + (f − 1) g)
    E_read  = E − 0.9 mV/K (T − 22.2 °C)

ρ₀ is stated at 20 °C, as the classes of Polder are (RILEM TC 154-EMC, Materials and Structures 33
(2000) 603–611). E_a = 25 kJ/mol is amid the 9 to 39 kJ/mol that Coyle et al. (Advances
in Civil Engineering Materials, 2019) collected for the conduction of concrete, and makes 3.5 % per
kelvin at 20 °C, of Polder's 3 to 5 %. The shift of the reading is the correction of ASTM C876,
E(22.2 °C) = E_read + 0.9 mV/K (T − 22.2 °C), turned round. The kinetics of the steel are those at
22.2 °C: what the standard's factor says of temperature is all that is modelled of it.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from inspect_cli.assessment.electrodes import COEFFICIENT_V_PER_C, STANDARD_C
from inspect_cli.errors import InputError
from inspect_cli.schema.specimens.macro_cell import (
    LEAST_OHM_M,
    MOST_OHM_M,
    ActiveSite,
    MacroCellSpecimen,
    MoistSpot,
    layers,
)
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.truth.macro_cell.concrete import Concrete, box_widths, concrete_of
from inspect_cli.truth.macro_cell.mat import constriction_m, steel_share
from inspect_cli.truth.macro_cell.newton import Joint, Potentials, solve_potentials
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.steel import Steel

VERSION: Final = 1
"""Of the equations and their discretisation; a new one makes cached solutions worthless."""
KELVIN: Final = 273.15
RESISTIVITY_C: Final = 20.0
ACTIVATION_JPMOL: Final = 25e3
GAS_JPMOLK: Final = 8.314462618
BEYOND: Final = 1e3
"""How far spots that lie over each other may take the resistivity beyond what concrete has."""
LEAST_SHARE: Final = 1e-12
"""Of a node's steel that is active, and that is passive: no kind of steel is nowhere, so that no
equation is empty."""
SAMPLES: Final = 8
"""In each direction, for the share of a node's box that a site covers."""


@dataclass(frozen=True)
class MacroCell:
    """A specimen's network and its solution."""

    concrete: Concrete
    joint: Joint
    steel: Steel
    potentials: Potentials

    @property
    def charge(self) -> tuple[float, float]:
        """(anodic, cathodic) current of all steel, A."""
        anodic, cathodic, _ = self.steel.currents(self.potentials.bars)
        area = self.joint.steel_area
        return float(np.sum(area * anodic)), float(np.sum(area * cathodic))


def solve_cell(model: MacroCellSpecimen, patch: Patch) -> MacroCell:
    """Solve for the potentials. Raises InputError where they do not converge."""
    u, v = surface_nodes(model, patch)
    d, steel_index = depth_nodes(model)
    resistivity = resistivity_at(model, u, v)
    _refuse_extremes(resistivity)
    concrete = concrete_of(patch, u, v, d, steel_index, resistivity)
    share, reach = steel_share(model.bars), constriction_m(model.bars)
    active = np.clip(active_shares(model, u, v), LEAST_SHARE, 1.0 - LEAST_SHARE)
    areas = np.stack([active, 1.0 - active]) * concrete.area
    joint = Joint(share * areas, areas / (reach * resistivity))
    oxygen = np.ones_like(resistivity)
    for spot in model.moisture:
        oxygen *= 1.0 + (spot.oxygen_factor - 1.0) * _bell(u, v, spot.at_m, spot.radius_m)
    steel = Steel((model.active, model.passive), oxygen)
    return MacroCell(concrete, joint, steel, solve_potentials(concrete, joint, steel))


def _refuse_extremes(resistivity: Matrix) -> None:
    low, high = float(resistivity.min()), float(resistivity.max())
    if not LEAST_OHM_M / BEYOND <= low <= high <= MOST_OHM_M * BEYOND:
        raise InputError(
            f"sites and moisture together leave resistivities of {low:g} to {high:g} Ω·m",
            hint="give those that lie over each other factors nearer to 1",
        )


def surface_reading(model: MacroCellSpecimen, patch: Patch) -> Matrix:
    """What a half-cell reads at the surface's nodes (n_v, n_u), V against CSE."""
    shift = COEFFICIENT_V_PER_C * (model.temperature_c - STANDARD_C)
    reading: Matrix = solve_cell(model, patch).potentials.concrete[0] - shift
    return reading


def surface_nodes(
    model: MacroCellSpecimen, patch: Patch, per_cell: int = 1
) -> tuple[Vector, Vector]:
    """Nodes along u and v, m; ``per_cell`` divides each cell of the solution."""
    size_m = model.size_m or patch.size_m
    nodes = []
    for size, middle in zip(size_m, model.at_m, strict=True):
        cells = max(math.ceil(size / model.resolution_m - 1e-9), 4) * per_cell
        nodes.append(middle + size * (np.arange(cells + 1) / cells - 0.5))
    return nodes[0], nodes[1]


def depth_nodes(model: MacroCellSpecimen) -> tuple[Vector, int]:
    """Nodes in depth, m, and the index of the steel's: even above it, even below it."""
    above, below = layers(model, model.resolution_m)
    over = np.linspace(0.0, model.cover_m, above + 1)
    under = np.linspace(model.cover_m, model.thickness_m, below + 1)
    return np.concatenate([over, under[1:]]), above


def resistivity_at(model: MacroCellSpecimen, u: Vector, v: Vector) -> Matrix:
    """ρ, Ω·m, at the nodes (n_v, n_u)."""
    warmth = 1.0 / (model.temperature_c + KELVIN) - 1.0 / (RESISTIVITY_C + KELVIN)
    sound = model.resistivity_ohm_m * math.exp(ACTIVATION_JPMOL / GAS_JPMOLK * warmth)
    resistivity = np.full((len(v), len(u)), sound)
    spots: tuple[ActiveSite | MoistSpot, ...] = (*model.sites, *model.moisture)
    for spot in spots:
        bell = _bell(u, v, spot.at_m, spot.radius_m)
        resistivity *= 1.0 + (spot.resistivity_factor - 1.0) * bell
    return resistivity


def active_shares(model: MacroCellSpecimen, u: Vector, v: Vector) -> Matrix:
    """Share (n_v, n_u) of each node's box that lies within a site."""
    fine_u, fine_v = _samples(u), _samples(v)
    inside = np.zeros((len(fine_v), len(fine_u)), dtype=np.bool_)
    for site in model.sites:
        du, dv = fine_u - site.at_m[0], (fine_v - site.at_m[1])[:, None]
        inside |= du * du + dv * dv <= site.radius_m**2
    means: Matrix = inside.reshape(len(v), SAMPLES, len(u), SAMPLES).mean(axis=(1, 3))
    return means


def _samples(x: Vector) -> Vector:
    """Middles of ``SAMPLES`` parts of the box around each node, one after the other."""
    edges = np.concatenate([x[:1], 0.5 * (x[1:] + x[:-1]), x[-1:]])
    parts = (np.arange(SAMPLES) + 0.5) / SAMPLES
    samples: Vector = (edges[:-1, None] + box_widths(x)[:, None] * parts).ravel()
    return samples


def _bell(u: Vector, v: Vector, at_m: tuple[float, float], radius_m: float) -> Matrix:
    du, dv = u - at_m[0], (v - at_m[1])[:, None]
    bell: Matrix = np.exp(-(du * du + dv * dv) / (2.0 * radius_m * radius_m))
    return bell
