"""From potential and resistance to a corrosion verdict. Every threshold stands here, once.

Potentials are volts against the copper sulphate electrode (CSE), resistivities Ω·m
(1 kΩ·cm = 10 Ω·m). Each rule is one function of arrays that numbers the classes, and a thin one
that names the class of a single value. A number is the place in the rule's tuple of names;
``NO_CLASS`` stands where there is no value: NaN, infinite, or a resistivity that is not positive.

Potentials are compared in millivolts to the nearest nanovolt: −350 mV of a file is
−0.35000000000000003 V after a conversion, and the last binary digit must not move a class.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final, Literal, TypeAlias, TypeVar, get_args

import numpy as np
from numpy.typing import ArrayLike, NDArray

from inspect_cli.schema.assessment import AstmClass
from inspect_cli.schema.result import Corrosion
from inspect_cli.spatial.arrays import Vector

PASSIVE_ABOVE_V = -0.200
ACTIVE_BELOW_V = -0.350
SUSTAINS_CORROSION_OHM_M = 100.0

CorrosionRate = Literal["low", "low to moderate", "high", "very high"]
CorrosionRisk = Literal["negligible", "low", "moderate", "high"]
Codes: TypeAlias = NDArray[np.int8]
C = TypeVar("C", bound=str)

ASTM_CLASSES: Final[tuple[AstmClass, ...]] = get_args(AstmClass)
CORROSION_RATES: Final[tuple[CorrosionRate, ...]] = get_args(CorrosionRate)
CORROSION_RISKS: Final[tuple[CorrosionRisk, ...]] = get_args(CorrosionRisk)
VERDICTS: Final[tuple[Corrosion, ...]] = get_args(Corrosion)
NO_CLASS: Final = -1
MV_DECIMALS: Final = 6

COMBINED_RULE = (
    "This rule is the project's own, not a standard's: the potential says how probable corrosion "
    "is, the resistivity how fast it can be. "
    "Not indicated: the potential is above −200 mV (CSE), ASTM C876's passive class. "
    "Active: the potential is below −350 mV, ASTM C876's active class, and the resistivity is "
    "at most 100 Ω·m, where Langford & Broomfield expect a high corrosion rate and RILEM "
    "TC 154-EMC a high corrosion risk. "
    "Possible: everything between, that is an uncertain potential, or an active one in concrete "
    "that is too resistive, or of unknown resistivity, for fast corrosion."
)


def millivolts(potential_v: ArrayLike) -> Vector:
    """Potentials in mV to the nearest nanovolt.

    A potential that was written in mV with at most six decimals, and was made volts by any
    product or quotient, comes back as exactly the number that was written: k / 10⁶ of an
    integer k is rounded as a decimal literal is.
    """
    return np.round(1e3 * np.asarray(potential_v, dtype=np.float64), MV_DECIMALS)


def name_of(classes: Sequence[C], codes: Codes) -> C | None:
    """The name of a single number of ``classes``; None for ``NO_CLASS``."""
    code = int(codes)
    return None if code == NO_CLASS else classes[code]


def astm_codes(potential_v: ArrayLike) -> Codes:
    """The classes of half-cell potentials by ASTM C876, as numbers of ``ASTM_CLASSES``.

    passive    E > −200 mV           > 90 % probability that no corrosion goes on
    uncertain  −200 ≥ E ≥ −350 mV    the potential does not tell
    active     E < −350 mV           > 90 % probability of active corrosion

    Args:
        potential_v: potentials of the reinforcement against CSE, V, of any shape.

    Source: ASTM C876, appendix X1 (numeric magnitude technique).
    """
    mv = millivolts(potential_v)
    below_passive = (mv <= millivolts(PASSIVE_ABOVE_V)).astype(np.int8)
    return _known(below_passive + (mv < millivolts(ACTIVE_BELOW_V)), np.isfinite(mv))


def astm_class(potential_v: float) -> AstmClass | None:
    """The class by ``astm_codes`` of a single potential, V; None for NaN."""
    return name_of(ASTM_CLASSES, astm_codes(potential_v))


def rate_codes(resistivity_ohm_m: ArrayLike) -> Codes:
    """How fast depassivated steel corrodes, as numbers of ``CORROSION_RATES``.

    > 200 Ω·m low, 100 to 200 low to moderate, 50 to 100 high, < 50 very high.

    Source: Langford & Broomfield, "Monitoring the corrosion of reinforcing steel", Construction
    Repair 1 (2), 1987. The edges belong to the faster class.
    """
    rho = np.asarray(resistivity_ohm_m, dtype=np.float64)
    steps = (rho <= 200.0).astype(np.int8) + (rho <= 100.0) + (rho < 50.0)
    return _known(steps, is_resistivity(rho))


def corrosion_rate(resistivity_ohm_m: float) -> CorrosionRate | None:
    """The rate by ``rate_codes`` of a single resistivity, Ω·m; None where it is none."""
    return name_of(CORROSION_RATES, rate_codes(resistivity_ohm_m))


def risk_codes(resistivity_ohm_m: ArrayLike) -> Codes:
    """Corrosion risk by the resistivity of Portland cement concrete at 20 °C.

    ≥ 1000 Ω·m negligible, 500 to 1000 low, 100 to 500 moderate, ≤ 100 high; numbers of
    ``CORROSION_RISKS``.

    Source: Polder, "Test methods for on site measurement of resistivity of concrete", RILEM
    TC 154-EMC technical recommendation, Materials and Structures 33 (2000) 603–611.
    """
    rho = np.asarray(resistivity_ohm_m, dtype=np.float64)
    steps = (rho < 1000.0).astype(np.int8) + (rho < 500.0) + (rho <= 100.0)
    return _known(steps, is_resistivity(rho))


def corrosion_risk(resistivity_ohm_m: float) -> CorrosionRisk | None:
    """The risk by ``risk_codes`` of a single resistivity, Ω·m; None where it is none."""
    return name_of(CORROSION_RISKS, risk_codes(resistivity_ohm_m))


def resistivity(resistance_ohm: float, cell_constant_m: float) -> float:
    """ρ = R K, in Ω·m, from the resistance R (Ω) and the probe's cell constant K (m)."""
    return resistance_ohm * cell_constant_m


def is_resistivity(resistivity_ohm_m: ArrayLike) -> NDArray[np.bool_]:
    """Which numbers, Ω·m, can be a resistivity: finite and positive."""
    rho = np.asarray(resistivity_ohm_m, dtype=np.float64)
    return np.asarray(np.isfinite(rho) & (rho > 0.0))


def sustains_corrosion(resistivity_ohm_m: ArrayLike) -> NDArray[np.bool_]:
    """Where ``COMBINED_RULE`` can say active: a known ρ, Ω·m, of at most 100 Ω·m.

    Elsewhere it says possible at the most, however negative the potential.
    """
    rho = np.asarray(resistivity_ohm_m, dtype=np.float64)
    return np.asarray(is_resistivity(rho) & (rho <= SUSTAINS_CORROSION_OHM_M))


def verdict_codes(potential_v: ArrayLike, resistivity_ohm_m: ArrayLike) -> Codes:
    """``COMBINED_RULE``, as numbers of ``VERDICTS``.

    Args:
        potential_v: potentials against CSE, V.
        resistivity_ohm_m: Ω·m, of the same shape; NaN where it is not known.
    """
    astm = astm_codes(potential_v)
    is_active = (astm == ASTM_CLASSES.index("active")) & sustains_corrosion(resistivity_ohm_m)
    steps = (astm != ASTM_CLASSES.index("passive")).astype(np.int8) + is_active
    return _known(steps, astm != NO_CLASS)


def combined_verdict(potential_v: float, resistivity_ohm_m: float | None) -> Corrosion | None:
    """The verdict by ``verdict_codes`` of a single point; None without a potential.

    Args:
        potential_v: potential against CSE, V.
        resistivity_ohm_m: Ω·m; None or NaN when it is not known.
    """
    rho = np.nan if resistivity_ohm_m is None else resistivity_ohm_m
    return name_of(VERDICTS, verdict_codes(potential_v, rho))


def _known(codes: NDArray[np.integer], known: NDArray[np.bool_]) -> Codes:
    return np.asarray(np.where(known, codes, NO_CLASS), dtype=np.int8)
