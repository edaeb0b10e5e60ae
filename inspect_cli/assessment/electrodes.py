"""Reference electrodes: from what a voltmeter showed to the potential that the standard means.

A reading is the potential of the steel less that of the reference electrode. The standard's scale
is a copper sulphate electrode (CSE) at 22.2 °C:

    E_CSE      = E_ref + (E°_ref − E°_CSE)                    another electrode, at 25 °C
    E(22.2 °C) = E_CSE + 0.9 mV/°C (T − 22.2 °C)              a CSE at T

The second follows from the first: a CSE's own potential grows by 0.9 mV/°C, so a warm one makes
the steel look more negative, and the correction of a warm reading is positive.
"""

from __future__ import annotations

from typing import Final

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.errors import InputError
from inspect_cli.schema.assessment import Basis
from inspect_cli.spatial.arrays import Vector

CSE: Final = "CSE"
ELECTRODES: Final[dict[str, float]] = {
    CSE: 0.316,
    "SCE": 0.241,
    "Ag/AgCl sat. KCl": 0.197,
    "Ag/AgCl 1 M KCl": 0.236,
    "Ag/AgCl 0.1 M KCl": 0.2895,
}
"""Potential against the standard hydrogen electrode at 25 °C, V. Saturated copper sulphate,
saturated calomel, and silver chloride in saturated, 1 mol/l and 0.1 mol/l potassium chloride."""

STANDARD_C: Final = 22.2
NEGLIGIBLE_C: Final = (16.7, 27.7)
"""22.2 ± 5.5 °C; both ends belong to the band."""
POSSIBLE_C: Final = (0.0, 49.0)
COEFFICIENT_V_PER_C: Final = 0.9e-3


def electrode_name(given: str) -> str:
    """The name in ``ELECTRODES`` that was meant; upper and lower case and spaces do not matter.

    Raises:
        InputError: there is no such electrode, or a silver chloride electrode without its filling,
            on which its potential depends by 93 mV.
    """
    meant = _squeezed(given)
    for name in ELECTRODES:
        if meant in (_squeezed(name), _squeezed(name.removesuffix(" KCl"))):
            return name
    choices = "choices: " + ", ".join(ELECTRODES)
    if meant.startswith("ag/agcl"):
        raise InputError(
            f"'{given}' does not say how it is filled, and its potential depends on that",
            hint=choices,
        )
    raise InputError(f"there is no reference electrode '{given}'", hint=choices)


def conversion_v(electrode: str) -> float:
    """What is added to a reading against ``electrode`` to have it against CSE, V."""
    shift = ELECTRODES[electrode_name(electrode)] - ELECTRODES[CSE]
    return round(shift, 9)


def to_cse(potential_v: ArrayLike, electrode: str) -> Vector:
    """E_CSE = E_ref + (E°_ref − E°_CSE), V, of potentials of any shape; for 25 °C.

    Against SCE −75 mV, Ag/AgCl in saturated KCl −119 mV, 1 M −80 mV, 0.1 M −26.5 mV.
    """
    return np.asarray(potential_v, dtype=np.float64) + conversion_v(electrode)


def temperature_correction_v(temperature_c: float) -> float:
    """What is added to a reading of a CSE at ``temperature_c`` °C, V.

    Nothing from 16.7 to 27.7 °C inclusive, where the standard calls the effect negligible; beyond,
    the whole of 0.9 mV/°C (T − 22.2 °C), which therefore starts at ±4.95 mV.

    Raises:
        InputError: the temperature is outside 0 to 49 °C, where the coefficient does not hold.

    Source: ASTM C876, section 5.1.1 (22.2 ± 5.5 °C, 0.9 mV/°C over 0 to 49 °C).
    """
    low, high = POSSIBLE_C
    if not low <= temperature_c <= high:
        raise InputError(
            f"a temperature of {temperature_c:g} °C: ASTM C876 corrects from {low:g} to {high:g} °C"
        )
    if NEGLIGIBLE_C[0] <= temperature_c <= NEGLIGIBLE_C[1]:
        return 0.0
    return COEFFICIENT_V_PER_C * (temperature_c - STANDARD_C)


def electrode_shift_v(electrode: str, temperature_c: float = STANDARD_C) -> float:
    """What is added to what a CSE reads to have what ``electrode`` reads at the same place, V.

    A CSE in concrete at T reads 0.9 mV/°C (T − 22.2 °C) less than at 22.2 °C. Another electrode
    reads less by the same amount not at all, its own coefficient being neglected (``basis_of``):

        E_ref = E_CSE(T) + 0.9 mV/°C (T − 22.2 °C) − (E°_ref − E°_CSE)
    """
    name = electrode_name(electrode)
    if name == CSE:
        return 0.0
    return COEFFICIENT_V_PER_C * (temperature_c - STANDARD_C) - conversion_v(name)


def as_evaluated(potential_v: ArrayLike, basis: Basis) -> Vector:
    """What perfect readings come to where a CSE would read ``potential_v``, V, of any shape.

    They are evaluated as readings are: with the basis's electrode and its stated temperature.
    """
    temperature_c = STANDARD_C if basis.temperature_c is None else basis.temperature_c
    shift_v = electrode_shift_v(basis.electrode, temperature_c)
    return to_standard(np.asarray(potential_v, dtype=np.float64) + shift_v, basis)


def basis_of(electrode: str, temperature_c: float | None = None) -> Basis:
    """What readings against ``electrode`` at ``temperature_c`` °C (None: not known) rest on.

    The standard's coefficient is a CSE's. Other electrodes have others (the saturated calomel and
    silver chloride electrodes change by 0.2 mV/°C or less), so that the standard's would do
    more harm than good by them: they are not corrected, which ``temperature_why`` says.
    """
    name = electrode_name(electrode)
    correction_v = 0.0 if temperature_c is None else temperature_correction_v(temperature_c)
    why = ""
    if temperature_c is None:
        why = "the temperature is not known; it is taken to be within 22.2 ± 5.5 °C"
    elif correction_v == 0.0:
        why = "within 22.2 ± 5.5 °C its effect is negligible (ASTM C876)"
    elif name != CSE:
        correction_v = 0.0
        why = f"0.9 mV/°C is the coefficient of a CSE, not of {name}: nothing is corrected"
    return Basis(
        electrode=name,
        conversion_mv=round(1e3 * conversion_v(name), 6),
        temperature_c=temperature_c,
        temperature_correction_mv=round(1e3 * correction_v, 6),
        temperature_why=why,
    )


def to_standard(potential_v: ArrayLike, basis: Basis) -> Vector:
    """Potentials as read, V, on the standard's scale: against CSE at 22.2 °C."""
    shift_mv = basis.conversion_mv + basis.temperature_correction_mv
    return np.asarray(potential_v, dtype=np.float64) + 1e-3 * shift_mv


def _squeezed(name: str) -> str:
    return "".join(name.split()).casefold()
