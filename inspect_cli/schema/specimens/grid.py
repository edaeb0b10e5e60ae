"""``model: grid``: potential and resistivity that were measured on a grid."""

from __future__ import annotations

from typing import ClassVar, Literal

from inspect_cli.schema.base import Positive
from inspect_cli.schema.specimens.base import SpecimenModel


class GridSpecimen(SpecimenModel):
    """Potential and resistivity measured on a grid, interpolated bilinearly between its nodes."""

    files: ClassVar[tuple[str, ...]] = ("potential_mv", "resistivity_kohm_cm")

    model: Literal["grid"]
    potential_mv: str
    """File of potentials, mV against copper sulphate: CSV, or columns of plain numbers."""
    resistivity_kohm_cm: str
    """File of resistivities of the same grid, kΩ·cm."""
    pitch_m: Positive
    at_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) of the grid's middle on the surface; columns run along u, rows along −v."""
