"""What is truly so beneath the places of a believed surface.

The planner's (u, v) lie on the surface as it is believed, the specimen's on the surface as it is.
A place of the belief stands for its foot on the true surface, where a tool that comes straight
down to it would touch.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.log.rasters import TrueRaster
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.arrays import Mask, Points, Structured, Vector
from inspect_cli.spatial.primitives import PLANE, SPHERE, point_at
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.solids import Solids, foot_on, foot_on_patch
from inspect_cli.truth.specimens.fields import SpecimenField

MOST_CELLS = 25_000
"""Of all rasters of a flight together, so that they take 50 ms at the most."""
MOST_CELLS_OF_A_RELIEF = 10_000
"""A foot on a relief takes thrice the time of one on a primitive."""
MOST_ALONG = 200
FINEST_M = 0.001


@kernel
def feet_on(solids: Solids, i: int, believed: Structured, uv_m: Points, feet: Points) -> None:
    """Write where places (n, 2) of a believed surface have their foot on the ``i``-th true one.

    ``feet`` (n, 2) are (u, v) in m; NaN where the true surface does not reach.
    """
    for k in range(uv_m.shape[0]):
        p_W = point_at(believed, 0, uv_m[k, 0], uv_m[k, 1])
        u, v, _, on = foot_on(solids, i, p_W)
        feet[k, 0] = u if on else np.nan
        feet[k, 1] = v if on else np.nan


@kernel
def feet_on_patch(
    prims: Structured, i: int, believed: Structured, uv_m: Points, feet: Points
) -> None:
    """``feet_on`` of a true surface that is the primitive ``i``."""
    for k in range(uv_m.shape[0]):
        p_W = point_at(believed, 0, uv_m[k, 0], uv_m[k, 1])
        u, v, _, on = foot_on_patch(prims, i, p_W)
        feet[k, 0] = u if on else np.nan
        feet[k, 1] = v if on else np.nan


@dataclass(frozen=True)
class UnderSurface:
    """The specimen beneath one believed surface."""

    surface: str
    prim: Structured
    """The believed surface, a PRIMITIVE array of length 1."""
    index: int
    """Of the true surface."""
    solids: Solids
    specimen: SpecimenField

    def at(self, uv_m: Points) -> tuple[Vector, Vector, Mask]:
        """Potential (n,) V, resistivity (n,) Ω·m and whether the steel is active at (n, 2) m.

        NaN and not active where the true surface or the specimen does not reach.
        """
        feet = np.empty_like(uv_m)
        primitives = self.solids.primitives
        if self.index < len(primitives):  # reliefs take long to compile
            feet_on_patch(primitives, self.index, self.prim, uv_m, feet)
        else:
            feet_on(self.solids, self.index, self.prim, uv_m, feet)
        values = np.full((len(feet), 2), np.nan)
        active = np.zeros(len(feet), np.bool_)
        there = ~np.isnan(feet[:, 0])
        for k in np.flatnonzero(there).tolist():
            values[k] = self.specimen.at(*feet[k].tolist())
        active[there] = self.specimen.active(feet[there])
        return values[:, 0], values[:, 1], active

    def raster(self, share: float = 1.0) -> TrueRaster:
        """What is so over the whole believed surface, with a share of the cells that are due."""
        half_u, half_v = (float(x) for x in self.prim["half_size"][0])
        is_relief = self.index >= len(self.solids.primitives)
        most = MOST_CELLS_OF_A_RELIEF if is_relief else MOST_CELLS
        u_m, v_m = _middles(half_u, half_v, share * most)
        places = np.column_stack([np.tile(u_m, len(v_m)), np.repeat(v_m, len(u_m))])
        shape = (len(v_m), len(u_m))
        potential, resistivity, active = self.at(places)
        kind, radius_m = int(self.prim["kind"][0]), float(self.prim["radius"][0])
        turn_m = 2.0 * np.pi * radius_m
        closed = kind != PLANE and 2.0 * half_u >= turn_m - 1e-9
        return TrueRaster(
            self.surface,
            u_m,
            v_m,
            potential.reshape(shape),
            resistivity.reshape(shape),
            active.reshape(shape),
            radius_m if kind == SPHERE else 0.0,
            turn_m if closed else 0.0,
        )


def all_under_surfaces(
    structure: StructureTruth, believed: Sequence[PlannedSurface]
) -> Iterator[UnderSurface]:
    """The believed surfaces beneath which there is a specimen, in the belief's order."""
    true = {surface.name: k for k, surface in enumerate(structure.surfaces)}
    for surface in believed:
        index = true.get(surface.name)
        specimen = None if index is None else structure.surfaces[index].specimen
        if index is not None and specimen is not None:
            prim = primitive_of(surface.shape)
            yield UnderSurface(surface.name, prim, index, structure.solids, specimen)


def true_rasters(
    structure: StructureTruth, believed: Sequence[PlannedSurface]
) -> tuple[TrueRaster, ...]:
    """A raster for each believed surface with a specimen."""
    found = list(all_under_surfaces(structure, believed))
    return tuple(one.raster(1.0 / len(found)) for one in found)


def _middles(half_u: float, half_v: float, most_cells: float) -> tuple[Vector, Vector]:
    """The middles of about square cells that divide the patch evenly."""
    size = np.array([2.0 * half_u, 2.0 * half_v])
    step_m = max(math.sqrt(size.prod() / most_cells), size.max() / MOST_ALONG, FINEST_M)
    counts = np.clip(np.floor(size / step_m), 2, MOST_ALONG).astype(int)
    u_m, v_m = (
        (np.arange(n) + 0.5) * (length / n) - 0.5 * length
        for n, length in zip(counts, size, strict=True)
    )
    return u_m, v_m
