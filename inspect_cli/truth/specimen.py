"""What the half-cell probe would read on the true specimen: potential and resistivity over (u, v).

A field is asked by ``at(u, v)``, coordinates along the surface in m, and answers
(potential in V against copper sulphate, resistivity in Ω·m).

Analytic: with r_i the distance from spot i's middle and g_i = exp(−r_i² / (2 radius_i²))

    potential = E₀ − Σ depth_i g_i,      resistivity = ρ₀ Π (1 + (factor_i − 1) g_i)

Grid: bilinear between nodes, NaN outside. Node (row, column) lies at

    u = u₀ + (column − (columns − 1)/2) pitch,      v = v₀ − (row − (rows − 1)/2) pitch

so that a table looks as its file does to somebody in front of the wall.

Macro cell: solved for in the concrete (``truth.macro_cell``); a cubic spline through the solution's
nodes, bilinear between points of a grid four times as fine, NaN outside of the modelled concrete.

A field also tells where the reinforcement is truly active. A macro cell knows its sites; neither an
analytic field nor a measured grid knows the steel, so there the combined rule
(``assessment.classes``) decides on the true values, on the standard's scale: what a CSE reads in
the concrete, corrected for its temperature as ASTM C876 asks.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from pathlib import Path
from typing import Final, Protocol

import numpy as np
from scipy.interpolate import RectBivariateSpline

from inspect_cli.assessment.classes import combined_verdict
from inspect_cli.assessment.electrodes import STANDARD_C, temperature_correction_v
from inspect_cli.compiled import kernel
from inspect_cli.errors import InputError
from inspect_cli.schema.macro_cell import MacroCellSpecimen
from inspect_cli.schema.truth import AnalyticSpecimen, GridSpecimen, Specimen
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.surveys.grids import read_numbers
from inspect_cli.truth.cache import kept
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.solution import (
    VERSION,
    resistivity_at,
    surface_nodes,
    surface_reading,
)

MV_TO_V: Final = 1e-3
KOHM_CM_TO_OHM_M: Final = 10.0
EDGE: Final = 1e-9
"""In pitches: a point so little outside the grid is on its edge."""
FINER: Final = 4
"""Cells in which each cell of a macro cell's solution is divided: bilinear interpolation between
the solution's own nodes would cut the tip of a minimum by some millivolts."""


class SpecimenField(Protocol):
    """Potential and resistivity along a surface."""

    @property
    def temperature_c(self) -> float:
        """Of the concrete, in which a copper sulphate electrode reads what ``at`` answers."""
        ...

    def at(self, u: float, v: float) -> tuple[float, float]:
        """(V, Ω·m) at (u, v) in m; NaN where the specimen has no values."""
        ...

    def active(self, u: float, v: float) -> bool:
        """Whether the reinforcement under (u, v), m, truly corrodes; False without values."""
        ...


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

    def active(self, u: float, v: float) -> bool:
        """Whether the combined rule says active of the field at (u, v) in m."""
        return _says_active(self, u, v)


class GridField:
    """Values on a grid. ``values`` (rows, columns, 2) in V and Ω·m; at least 2 × 2 nodes."""

    def __init__(
        self,
        values: Matrix,
        pitch_m: float,
        at_m: tuple[float, float],
        temperature_c: float = STANDARD_C,
    ) -> None:
        self.temperature_c = temperature_c
        self._values = np.ascontiguousarray(values, dtype=np.float64)
        rows, columns = values.shape[:2]
        self._pitch = pitch_m
        self._left = at_m[0] - 0.5 * (columns - 1) * pitch_m
        self._top = at_m[1] + 0.5 * (rows - 1) * pitch_m

    def at(self, u: float, v: float) -> tuple[float, float]:
        """(V, Ω·m) at (u, v) in m; NaN outside the grid."""
        x = (u - self._left) / self._pitch
        y = (self._top - v) / self._pitch
        result: tuple[float, float] = bilinear(x, y, self._values)
        return result

    def active(self, u: float, v: float) -> bool:
        """Whether the combined rule says active of the values at (u, v) in m."""
        return _says_active(self, u, v)


class MacroCellField:
    """The solved field of a macro cell under a surface."""

    def __init__(self, model: MacroCellSpecimen, patch: Patch) -> None:
        u, v = surface_nodes(model, patch)
        inputs = json.dumps([VERSION, np.__version__, asdict(patch), model.model_dump(mode="json")])
        reading = kept("macro_cell", inputs, lambda: surface_reading(model, patch))
        fine_u, fine_v = surface_nodes(model, patch, FINER)
        potential = RectBivariateSpline(v, u, reading)(fine_v, fine_u)
        resistivity = resistivity_at(model, fine_u, fine_v)
        self._values = np.dstack([potential, resistivity])
        self._origin = (float(fine_u[0]), float(fine_v[0]))
        self._pitch = (float(fine_u[1] - fine_u[0]), float(fine_v[1] - fine_v[0]))
        self._sites = model.sites
        self.temperature_c = model.temperature_c

    def at(self, u: float, v: float) -> tuple[float, float]:
        """(V, Ω·m) at (u, v) in m; NaN outside of the modelled concrete."""
        x = (u - self._origin[0]) / self._pitch[0]
        y = (v - self._origin[1]) / self._pitch[1]
        result: tuple[float, float] = bilinear(x, y, self._values)
        return result

    def active(self, u: float, v: float) -> bool:
        """Whether (u, v), m, lies over an active site, within the modelled concrete."""
        if math.isnan(self.at(u, v)[0]):
            return False
        return any(
            math.hypot(u - site.at_m[0], v - site.at_m[1]) <= site.radius_m for site in self._sites
        )


def _says_active(field: SpecimenField, u: float, v: float) -> bool:
    potential, resistivity = field.at(u, v)
    if math.isnan(potential):
        return False
    standard = potential + temperature_correction_v(field.temperature_c)
    return combined_verdict(standard, resistivity) == "active"


def load_specimen(model: Specimen, root: Path, patch: Patch | None = None) -> SpecimenField:
    """The field that a truth file describes; its files are relative to ``root``.

    ``patch`` is the surface that a macro cell lies under; without it a plane of the specimen's own
    size.

    Raises InputError, naming file, line and cell, for tables that cannot be read, that hold
    anything but finite numbers, or that differ in size, and for a macro cell that has no solution.
    """
    if isinstance(model, AnalyticSpecimen):
        return SpotField(model)
    if isinstance(model, GridSpecimen):
        return _load_grid(model, root)
    patch = patch or (Patch(model.size_m) if model.size_m else None)
    if patch is None:
        raise InputError("a macro cell under an unknown surface has to state its size_m")
    return MacroCellField(model, patch)


def _load_grid(model: GridSpecimen, root: Path) -> GridField:
    potential = read_numbers(root / model.potential_mv).values * MV_TO_V
    resistivity = read_numbers(root / model.resistivity_kohm_cm).values * KOHM_CM_TO_OHM_M
    if potential.shape != resistivity.shape:
        raise InputError(
            f"{model.potential_mv} has {_size(potential)} but "
            f"{model.resistivity_kohm_cm} has {_size(resistivity)}",
            hint="potential and resistivity have to be given at the same points",
        )
    if min(potential.shape) < 2:
        raise InputError(
            f"{model.potential_mv} has {_size(potential)}",
            hint="interpolation needs at least two rows and two columns",
        )
    if (resistivity <= 0.0).any():
        row, column = np.argwhere(resistivity <= 0.0)[0] + 1
        raise InputError(
            f"{model.resistivity_kohm_cm}: row {row}, column {column} is not a positive resistivity"
        )
    return GridField(
        np.dstack([potential, resistivity]), model.pitch_m, model.at_m, model.temperature_c
    )


def _size(table: Vector) -> str:
    return f"{table.shape[0]} rows × {table.shape[1]} columns"
