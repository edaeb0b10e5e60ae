"""The field of a macro cell, solved for in the concrete (``truth.macro_cell``).

A cubic spline through the solution's nodes, bilinear between points of a grid four times as fine,
NaN outside of the modelled concrete.
"""

from __future__ import annotations

import json
import math
from dataclasses import asdict
from typing import Final

import numpy as np
from scipy.interpolate import RectBivariateSpline

from inspect_cli.errors import InputError
from inspect_cli.schema.specimens import MacroCellSpecimen
from inspect_cli.spatial.arrays import Mask, Points
from inspect_cli.truth.cache import kept
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.solution import (
    VERSION,
    resistivity_at,
    surface_nodes,
    surface_reading,
)
from inspect_cli.truth.specimens.fields import bilinear

FINER: Final = 4
"""Cells in which each cell of a macro cell's solution is divided: bilinear interpolation between
the solution's own nodes would cut the tip of a minimum by some millivolts."""


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

    def active(self, uv_m: Points) -> Mask:
        """Whether places (n, 2), m, lie over an active site, within the modelled concrete."""
        return np.array([self._over_a_site(u, v) for u, v in uv_m.tolist()], np.bool_)

    def _over_a_site(self, u: float, v: float) -> bool:
        if math.isnan(self.at(u, v)[0]):
            return False
        return any(
            math.hypot(u - site.at_m[0], v - site.at_m[1]) <= site.radius_m for site in self._sites
        )


def macro_cell_field(model: MacroCellSpecimen, patch: Patch | None) -> MacroCellField:
    """The field under the surface ``patch``; without it under a plane of the specimen's own size.

    Raises:
        InputError: neither size is known, or the macro cell has no solution.
    """
    patch = patch or (Patch(model.size_m) if model.size_m else None)
    if patch is None:
        raise InputError("a macro cell under an unknown surface has to state its size_m")
    return MacroCellField(model, patch)
