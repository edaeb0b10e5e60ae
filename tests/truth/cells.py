"""Macro cells to try: a small wall, and what is read on it."""

from __future__ import annotations

from typing import Any

import numpy as np

from inspect_cli.schema.specimens.macro_cell import ActiveSite, MacroCellSpecimen
from inspect_cli.truth.macro_cell.patch import Patch
from inspect_cli.truth.macro_cell.solution import MacroCell, solve_cell

WALL = Patch((0.8, 0.8))
SITE = ActiveSite(at_m=(0.0, 0.0), radius_m=0.05)


def specimen(**entries: Any) -> MacroCellSpecimen:
    """A site of 5 cm under 3 cm of cover, unless ``entries`` say otherwise."""
    given = {"cover_m": 0.03, "sites": (SITE,), "resolution_m": 0.025} | entries
    return MacroCellSpecimen(model="macro_cell", **given)


def solved(patch: Patch = WALL, **entries: Any) -> MacroCell:
    return solve_cell(specimen(**entries), patch)


def read_along_u(cell: MacroCell, u: float) -> float:
    """E, V, at the surface on the level of the wall's middle."""
    middle = len(cell.concrete.v) // 2
    return float(np.interp(u, cell.concrete.u, cell.potentials.concrete[0, middle]))
