"""Numbers that devices and programs write where there is no reading."""

from __future__ import annotations

from collections.abc import Callable, Set

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.spatial.arrays import Vector
from inspect_cli.surveys.plausible import MOST_MV
from inspect_cli.surveys.units import Unit

SENTINELS = (999.0, 9999.0, 99999.0)
"""Of either sign. What else stands for "no reading", such as 0 or -99, may have been read."""
NEAR_MV = 100.0
"""Potentials of one surface run on from place to place: a real one so negative has others near it.
"""


def refuse_sentinels(
    raw: Vector, unit: Unit, with_unit: Set[int], where: Callable[[int], Location]
) -> None:
    """Refuses numbers that stand for "no reading" among potentials.

    A number of ``SENTINELS`` is one if no other reading lies within ``NEAR_MV`` of it. Whoever
    read it indeed writes it with its unit.

    Args:
        raw: (n,) as they stand in the file; NaN where the file says that there is none.
        unit: theirs.
        with_unit: which of them carry their unit, and are readings therefore.
        where: the address of the k-th.

    Raises:
        InputError: there is one; with its address.
    """
    suspect = np.isin(np.abs(raw), SENTINELS)
    suspect[list(with_unit)] = False
    if not suspect.any():
        return
    others = raw[~suspect & np.isfinite(raw)]
    for k in np.flatnonzero(suspect).tolist():
        if (np.abs(others - raw[k]) <= NEAR_MV).any():
            continue
        count = int((raw == raw[k]).sum())
        times = f" ({count} times)" if count > 1 else ""
        what = f"{raw[k]:.0f}{times} far from all other readings stands for no reading"
        hint = "leave the cell empty"
        if unit.key == "mV" and abs(raw[k]) <= MOST_MV:
            hint += f"; write {raw[k]:.0f} mV, with the unit, if that was read"
        raise InputError(Problem(what, where(k), hint))
