"""Whether numbers can be potentials of reinforcement, and resistivities of concrete.

Typical potentials are −1000 to +200 mV against CSE (RILEM TC 154-EMC), so what lies beyond
±2000 mV was read in another unit, and a whole survey of large positive numbers was taken by a
device that leaves the minus out. What is merely unusual is for the assessment to say.
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.schema.survey import SurveySettings
from inspect_cli.spatial.arrays import Mask, Vector
from inspect_cli.surveys.units import Unit

Where = Callable[[int], Location]

MOST_MV = 2000.0
POSITIVE_MV = 150.0
"""Chloride-free and dry concrete reads up to about +200 mV, but not everywhere."""
MOST_POSITIVE_MV = 250.0
"""More than any steel in concrete reads: a sign is missing, or was turned that was right."""
VOLTS_BELOW, MILLIVOLTS_ABOVE = 2.0, 20.0
MOST_LIKE_VOLTS = 3.0
"""A survey that never leaves ±3 is one in volts, or none of steel: steel in concrete spreads over
tens of millivolts. A little more than potentials in volts can be, since one of them may be wrong.
"""
MOST_DECIMALS = 6
LEAST_OHM_M, MOST_OHM_M = 1e-3, 1e9
"""A thousandth of wet concrete's resistivity, and a thousand times dry concrete's."""
LEAST_C, MOST_C = 0.0, 49.0
"""Where ASTM C876 corrects potentials for the temperature."""


def potentials_mv(
    raw: Vector, unit: Unit, stated: bool, settings: SurveySettings, where: Where
) -> Vector:
    """Potentials (n,) in mV, with the sign that the settings ask for; NaN stays.

    Args:
        raw: as they stand in the file.
        unit: theirs.
        stated: whether somebody said so; otherwise it is assumed.
        settings: for the sign.
        where: the address of the k-th.

    Raises:
        InputError: they cannot be potentials in this unit; with the first odd cell's address.
    """
    valid = np.isfinite(raw)
    if not valid.any():
        raise InputError(Problem("there is not one reading", where(0)))
    if unit.key == "mV":
        _refuse_volts(raw, valid, stated, where)
    # Rounded to a billionth of a millivolt: −0.35 V is −350 mV and nothing else.
    values: Vector = raw if unit.key == "mV" else np.round(raw * unit.factor, 9)
    beyond = valid & (np.abs(values) > MOST_MV)
    if beyond.any():
        k = int(np.flatnonzero(beyond)[0])
        other = "mV" if unit.key == "V" else "V"
        what = f"{raw[k]:g} {unit.name} is no half-cell potential: beyond ±{MOST_MV:g} mV"
        hint = f"correct the cell, or state potential_unit: {other} if that is what was read"
        raise InputError(Problem(what, where(k), hint if unit.key == "V" else "correct the cell"))
    if settings.sign == "inverted":
        hint = "leave sign: inverted out if the file has the minus signs already"
        return _not_too_positive(-values, where, hint)
    positive = (values[valid] > 0).all() and values[valid].max() > POSITIVE_MV
    if positive and "sign" not in settings.model_fields_set:
        what = f"all potentials are positive, up to {values[valid].max():g} mV"
        hint = (
            "state sign: inverted if the device showed −350 mV as 350, "
            "or sign: as_read if they are positive indeed"
        )
        raise InputError(Problem(what, where(int(np.flatnonzero(valid)[0])), hint))
    if "sign" in settings.model_fields_set:
        return values
    hint = "correct the sign, or state sign: as_read if it is so"
    return _not_too_positive(values, where, hint)


def _not_too_positive(values: Vector, where: Where, hint: str) -> Vector:
    """The potentials, mV, if each can be one of steel in concrete."""
    odd = np.flatnonzero(values > MOST_POSITIVE_MV)
    if len(odd):
        k = int(odd[0])
        what = f"{values[k]:+g} mV is more positive than steel in concrete reads"
        raise InputError(Problem(what, where(k), hint))
    return values


def resistivities_ohm_m(raw: Vector, unit: Unit, where: Where) -> Vector:
    """Resistivities (n,) in Ω·m; NaN stays.

    Raises:
        InputError: one is not positive, or no concrete's; with its address.
    """
    wrong = raw <= 0.0
    if wrong.any():
        k = int(np.flatnonzero(wrong)[0])
        raise InputError(Problem(f"{raw[k]:g} is not a positive resistivity", where(k)))
    values: Vector = raw * unit.factor
    odd = np.flatnonzero((values < LEAST_OHM_M) | (values > MOST_OHM_M))
    if len(odd):
        k = int(odd[0])
        what = f"{raw[k]:g} {unit.name} is no resistivity of concrete"
        raise InputError(Problem(what, where(k), "correct the cell, or state resistivity_unit"))
    return values


def temperatures_c(raw: Vector, where: Where) -> Vector:
    """Temperatures (n,) in °C; NaN stays.

    Raises:
        InputError: potentials cannot be corrected for one; with its address.
    """
    odd = np.flatnonzero((raw < LEAST_C) | (raw > MOST_C))
    if len(odd):
        k = int(odd[0])
        what = f"{raw[k]:g} °C: potentials are corrected from {LEAST_C:g} to {MOST_C:g} °C"
        raise InputError(Problem(what, where(k), "correct the cell, or empty it"))
    return raw


def _refuse_volts(raw: Vector, valid: Mask, stated: bool, where: Where) -> None:
    """Numbers in volts that are taken for millivolts, all of them or some.

    Readings in mV that are only assumed to be such do not all lie within ±``MOST_LIKE_VOLTS``.
    Those near zero are whole, or have no more decimals than the others and, where the unit is only
    assumed, others between ``VOLTS_BELOW`` and ``MILLIVOLTS_ABOVE`` beside them: potentials of one
    surface run on from place to place.
    """
    magnitude = np.where(valid, np.abs(raw), 0.0)
    small = (magnitude > 0) & (magnitude < VOLTS_BELOW) & (raw != np.round(raw))
    large = magnitude > MILLIVOLTS_ABOVE
    if not stated and magnitude.max() <= MOST_LIKE_VOLTS:
        k = int(np.flatnonzero(valid)[0])
        what = f"{raw[k]:g}, like all others within ±{MOST_LIKE_VOLTS:g}, looks like volts"
        hint = "state the unit: --unit V or --unit mV, or potential_unit in the settings"
        raise InputError(Problem(what, where(k), hint))
    if not large.any() or not small.any():
        return
    if stated or (valid & (magnitude > VOLTS_BELOW) & ~large).any():
        big = raw[large]
        fits = (d for d in range(MOST_DECIMALS) if (np.round(big, d) == big).all())
        decimals = next(fits, MOST_DECIMALS)
        small &= raw != np.round(raw, decimals)
        if not small.any():
            return
    odd = small if small.sum() <= large.sum() else large
    k = int(np.flatnonzero(odd)[0])
    of, among = ("V", "mV") if odd is small else ("mV", "V")
    what = f"{raw[k]:g} looks like {of} among readings in {among}"
    raise InputError(
        Problem(what, where(k), "give all potentials in one unit, and state potential_unit")
    )
