"""Readings that were taken at different temperatures, each corrected by its own."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.assessment.electrodes import basis_of
from inspect_cli.assessment.uncertainty import temperature_sd_v
from inspect_cli.schema.assessment import Basis
from inspect_cli.spatial.arrays import Vector


def standardised(
    potential_v: ArrayLike, electrode: str, temperature_c: ArrayLike
) -> tuple[Vector, Basis, Vector]:
    """Potentials (n,) as read, V, at temperatures (n,), °C, NaN where one is not known.

    Returns:
        potentials against CSE at 22.2 °C, what they rest on, and each one's standard uncertainty
        by its temperature, V. That is zero where one temperature holds for all, because the basis
        then stands for it (``temperature_sd_v``).
    """
    potential = np.asarray(potential_v, dtype=np.float64)
    temperature = np.asarray(temperature_c, dtype=np.float64)
    known = np.isfinite(temperature)
    # NaN comes last, and once.
    different, which = np.unique(temperature, return_inverse=True, equal_nan=True)
    bases = [basis_of(electrode, None if np.isnan(t) else float(t)) for t in different]
    if len(bases) < 2:
        basis = bases[0] if bases else basis_of(electrode)
        shift_mv = basis.conversion_mv + basis.temperature_correction_mv
        return potential + 1e-3 * shift_mv, basis, np.zeros(len(potential))
    corrections = np.array([basis.temperature_correction_mv for basis in bases])
    deviations = np.array([temperature_sd_v(basis) for basis in bases])
    stated = different[np.isfinite(different)]
    basis = bases[0].model_copy(
        update={
            "temperature_c": None,
            "temperature_correction_mv": 0.0,
            "own_temperatures_c": (float(stated[0]), float(stated[-1])),
            "own_corrections_mv": (float(corrections.min()), float(corrections.max())),
            "without_temperature": int(np.count_nonzero(~known)),
        }
    )
    shifts_mv = basis.conversion_mv + corrections[which]
    return potential + 1e-3 * shifts_mv, basis, deviations[which]
