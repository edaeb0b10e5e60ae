"""Potential and resistivity that were measured on a grid.

Bilinear between nodes, NaN outside. Node (row, column) lies at

    u = u₀ + (column − (columns − 1)/2) pitch,      v = v₀ − (row − (rows − 1)/2) pitch

so that a table looks as its file does to somebody in front of the wall.
"""

from __future__ import annotations

from pathlib import Path
from typing import Final

import numpy as np

from inspect_cli.assessment.electrodes import STANDARD_C
from inspect_cli.errors import InputError
from inspect_cli.schema.specimens import GridSpecimen
from inspect_cli.spatial.arrays import Mask, Matrix, Points, Vector
from inspect_cli.surveys.grids import read_numbers
from inspect_cli.truth.specimens.fields import bilinear, says_active

MV_TO_V: Final = 1e-3
KOHM_CM_TO_OHM_M: Final = 10.0


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

    def active(self, uv_m: Points) -> Mask:
        """Whether the combined rule says active of the values at places (n, 2), m."""
        return says_active(self, uv_m)


def grid_field(model: GridSpecimen, root: Path) -> GridField:
    """The field of the tables that the model names, relative to ``root``.

    Raises:
        InputError: tables that cannot be read, that hold anything but finite numbers, or that
            differ in size.
    """
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
