"""How sure a point's potential is, and with it the point's class.

Independent contributions are added by their squares (GUM, JCGM 100:2008, section 5). A quantity of
which only bounds ±a are known is taken as evenly distributed: u = a/√3 (4.3.7).

reading          of the measurement itself (``reading_sd_v``): sample noise, drift that the rule for
                 a stable reading lets pass, wetting that is left, the voltmeter's load
repeatability    s/√m of the mean of m readings at a place, s pooled over the places that were read
                 more than once, if these give 10 degrees of freedom; else from ASTM C876's limit
                 for the difference of two readings with one electrode, 10 mV, or with two, 20 mV.
                 A limit r that 95 % of differences keep means s = r/(1.96 √2) (ISO 5725-6). Where
                 the readings of a place themselves scatter by more, s is theirs: two that differ
                 by Δ have a mean that is known to |Δ|/2
conversion       of a reading that was taken with another electrode: the difference of the standard
                 potentials holds to ±5 mV, see ``CONVERSION_HOLDS_V``; the same for all of a survey
temperature      what is known and not corrected: 0.9 mV/°C |T − 22.2 °C|; the whole ±4.95 mV of the
                 negligible band where T is not known; 1 °C of it where it was corrected
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inspect_cli.assessment.classes import (
    ACTIVE_BELOW_V,
    ASTM_CLASSES,
    NO_CLASS,
    PASSIVE_ABOVE_V,
    astm_codes,
    millivolts,
)
from inspect_cli.assessment.electrodes import COEFFICIENT_V_PER_C, CSE, NEGLIGIBLE_C, STANDARD_C
from inspect_cli.assessment.readings import Merged
from inspect_cli.schema.assessment import Basis
from inspect_cli.spatial.arrays import Points, Vector

ONE_ELECTRODE_V: Final = 0.010
TWO_ELECTRODES_V: Final = 0.020
"""Largest differences of two readings at a place that ASTM C876 (precision) lets pass."""
LIMIT_OVER_SD: Final = 1.959963984540054 * math.sqrt(2.0)
ENOUGH_FREEDOM: Final = 10
"""Degrees of freedom with which a survey's own repeatability is known to a fifth (1/√(2ν))."""
KNOWN_TO_C: Final = 1.0
"""A temperature that was stated holds to this."""
CONVERSION_HOLDS_V: Final = 0.005
"""Bound of what is added to have a reading against CSE; the project's own choice. Tables of the
saturated electrodes' potentials, liquid junction included, differ by 2 to 4 mV (SCE 0.241 to
0.2444 V, CSE 0.314 to 0.318 V, Ag/AgCl 0.197 to 0.199 V), and they are for 25 °C, where a CSE's is
2.5 mV from that at 22.2 °C."""
INPUT_OHM: Final = 1e7
"""Least input resistance of the voltmeter (ASTM C876, section 6)."""
SURE: Final = 0.95


@dataclass(frozen=True)
class Budget:
    """Standard uncertainties, V, of m points and where they come from."""

    total_v: Vector
    """(m,); NaN where there is no potential."""
    reading_v: Vector
    """(m,)"""
    repeatability_v: Vector
    """(m,)"""
    conversion_v: float
    """0 for a CSE."""
    temperature_v: float
    single_v: float
    """Standard deviation of a single reading at a place, s, where the place says nothing else."""
    at_place_v: Vector
    """(m,) s of each place: its own readings' where that is larger."""
    single_from: str
    """Where s comes from."""

    @property
    def alone_v(self) -> Vector:
        """(m,) of each reading by itself, s in the place of s/√m; NaN unknown.

        A place that was read several times is surer than each of its readings.
        """
        shared = self.conversion_v**2 + self.temperature_v**2
        return np.asarray(np.sqrt(self.reading_v**2 + self.at_place_v**2 + shared))


def reading_sd_v(
    potential_v: ArrayLike,
    resistance_ohm: ArrayLike,
    *,
    noise_v: float,
    stable_v: float,
    stable_s: float,
    wetting_s: float,
    input_ohm: float = INPUT_OHM,
) -> Vector:
    """Standard uncertainty of accepted readings (n,), V, by how they were taken.

    Noise.     ``noise_v`` of a sample, not divided: samples are not known to be independent.
    Drift.     The rule accepts potentials that stay in a band of ``stable_v`` over ``stable_s``;
               the value, a median within the band, is then off by at most half of it.
    Wetting.   The potential of a contact that wets approaches its end as e^(−t/τ). If it moved by
               d over the last ``stable_s``, d/(e^(stable_s/τ) − 1) is still to come; d ≤ stable_v.
    Force.     A light or dry contact has a high resistance R. With the meter's input R_in it
               divides the potential, E_read = E R_in/(R + R_in): too small by |E_read| R/R_in.

    Args:
        potential_v: (n,); NaN gives NaN.
        resistance_ohm: (n,) between probe and reinforcement; NaN where it is not known, and then
            without a share.
        stable_v: band of the rule, V.
        wetting_s: time constant τ of the wetting.
    """
    potential = np.asarray(potential_v, dtype=np.float64)
    resistance = np.nan_to_num(np.asarray(resistance_ohm, dtype=np.float64), nan=0.0)
    drift = 0.5 * stable_v
    wetting = stable_v / math.expm1(min(stable_s / wetting_s, 700.0))
    load = np.abs(potential) * resistance / input_ohm
    return np.sqrt(noise_v**2 + (drift**2 + wetting**2 + load**2) / 3.0)


def budget_of(merged: Merged, basis: Basis, *, electrodes: int = 1) -> Budget:
    """The standard uncertainty of each point.

    Args:
        electrodes: 1 if one electrode took all readings, else 2.
    """
    points = merged.readings
    limit_v = ONE_ELECTRODE_V if electrodes == 1 else TWO_ELECTRODES_V
    single_v = limit_v / LIMIT_OVER_SD
    single_from = f"ASTM C876: two readings of a place differ by at most {1e3 * limit_v:g} mV"
    if merged.repeatability_v is not None and merged.degrees_of_freedom >= ENOUGH_FREEDOM:
        single_v = merged.repeatability_v
        single_from = f"repeated readings, {merged.degrees_of_freedom} degrees of freedom"
    at_place = np.fmax(single_v, merged.within_sd_v)  # NaN of a place that was read once
    repeatability = at_place / np.sqrt(np.maximum(merged.counts, 1))
    conversion_v, temperature_v = conversion_sd_v(basis), temperature_sd_v(basis)
    shared = conversion_v**2 + temperature_v**2
    total = np.sqrt(points.measurement_sd_v**2 + repeatability**2 + shared)
    return Budget(
        total_v=np.where(points.valid, total, np.nan),
        reading_v=points.measurement_sd_v,
        repeatability_v=repeatability,
        conversion_v=conversion_v,
        temperature_v=temperature_v,
        single_v=single_v,
        at_place_v=at_place,
        single_from=single_from,
    )


def conversion_sd_v(basis: Basis) -> float:
    """Standard uncertainty by the conversion to CSE, V; zero where a CSE was read with."""
    return 0.0 if basis.electrode == CSE else CONVERSION_HOLDS_V / math.sqrt(3.0)


def temperature_sd_v(basis: Basis) -> float:
    """Standard uncertainty by the temperature, V; zero where each reading carries its own."""
    if basis.own_temperatures_c is not None:
        return 0.0
    half_band_c = 0.5 * (NEGLIGIBLE_C[1] - NEGLIGIBLE_C[0])
    if basis.temperature_c is None:
        bound_c = half_band_c
    elif basis.temperature_correction_mv != 0.0:
        bound_c = KNOWN_TO_C
    else:
        bound_c = abs(basis.temperature_c - STANDARD_C)
    return COEFFICIENT_V_PER_C * bound_c / math.sqrt(3.0)


def class_probabilities(potential_v: Vector, sd_v: Vector) -> Points:
    """Probabilities (n, 3) of the classes in the order of ``ASTM_CLASSES``; rows of NaN for NaN.

    The potential is taken as normal around its value. A standard uncertainty of 0 is certainty.
    """
    from scipy.special import ndtr

    mv, sd_mv = millivolts(potential_v), 1e3 * sd_v
    below = np.full((len(mv), 2), np.nan)
    for k, edge_v in enumerate((PASSIVE_ABOVE_V, ACTIVE_BELOW_V)):
        away = np.divide(millivolts(edge_v) - mv, sd_mv, out=below[:, k], where=sd_mv > 0.0)
        below[:, k] = ndtr(away)
    active = below[:, 1]
    probabilities = np.column_stack([1.0 - below[:, 0], below[:, 0] - active, active])
    codes = astm_codes(potential_v)
    certain = (codes != NO_CLASS) & (sd_v == 0.0)
    probabilities[certain] = np.eye(len(ASTM_CLASSES))[codes[certain]]
    return np.asarray(probabilities)


def doubtful(potential_v: Vector, probabilities: Points) -> NDArray[np.bool_]:
    """(n,) Which points' own class is less than 95 % certain; not those without a potential."""
    codes = astm_codes(potential_v)
    own = probabilities[np.arange(len(codes)), codes]  # −1 is the last column, and left out below
    return np.asarray((codes != NO_CLASS) & (own < SURE))
