"""From potential and resistance to a corrosion verdict. Every threshold stands here, once.

Potentials are volts against the copper sulphate electrode (CSE), resistivities Ω·m
(1 kΩ·cm = 10 Ω·m).
"""

from __future__ import annotations

import math
from typing import Literal

from inspect_cli.schema.result import AstmClass, Corrosion

PASSIVE_ABOVE_V = -0.200
ACTIVE_BELOW_V = -0.350
SUSTAINS_CORROSION_OHM_M = 100.0

CorrosionRate = Literal["low", "low to moderate", "high", "very high"]
CorrosionRisk = Literal["negligible", "low", "moderate", "high"]

COMBINED_RULE = (
    "The potential says whether the reinforcement corrodes, the resistivity how fast it can. "
    "None: the potential is above −200 mV (CSE), ASTM C876's passive class. "
    "Active: the potential is below −350 mV, ASTM C876's active class, and the resistivity is "
    "at most 100 Ω·m, where both Langford & Broomfield and RILEM TC 154-EMC expect a high "
    "corrosion rate. "
    "Possible: everything between, that is an uncertain potential, or an active one in concrete "
    "that is too resistive, or of unknown resistivity, for fast corrosion."
)


def astm_class(potential_v: float) -> AstmClass:
    """The class of a half-cell potential by ASTM C876.

    passive    E > −200 mV           > 90 % probability that no corrosion goes on
    uncertain  −200 ≥ E ≥ −350 mV    the potential does not tell
    active     E < −350 mV           > 90 % probability of active corrosion

    Args:
        potential_v: potential of the reinforcement against CSE, V.

    Source: ASTM C876, appendix X1 (numeric magnitude technique).
    """
    if potential_v > PASSIVE_ABOVE_V:
        return "passive"
    if potential_v < ACTIVE_BELOW_V:
        return "active"
    return "uncertain"


def corrosion_rate(resistivity_ohm_m: float) -> CorrosionRate:
    """How fast depassivated steel is likely to corrode in concrete of this resistivity.

    > 200 Ω·m low, 100 to 200 low to moderate, 50 to 100 high, < 50 very high.

    Source: Langford & Broomfield, "Monitoring the corrosion of reinforcing steel", Construction
    Repair 1 (2), 1987. The edges belong to the faster class.
    """
    if resistivity_ohm_m > 200.0:
        return "low"
    if resistivity_ohm_m > 100.0:
        return "low to moderate"
    if resistivity_ohm_m >= 50.0:
        return "high"
    return "very high"


def corrosion_risk(resistivity_ohm_m: float) -> CorrosionRisk:
    """Corrosion risk by the resistivity of Portland cement concrete at 20 °C.

    ≥ 1000 Ω·m negligible, 500 to 1000 low, 100 to 500 moderate, ≤ 100 high.

    Source: Polder, "Test methods for on site measurement of resistivity of concrete", RILEM
    TC 154-EMC technical recommendation, Materials and Structures 33 (2000) 603–611.
    """
    if resistivity_ohm_m >= 1000.0:
        return "negligible"
    if resistivity_ohm_m >= 500.0:
        return "low"
    if resistivity_ohm_m > 100.0:
        return "moderate"
    return "high"


def resistivity(resistance_ohm: float, cell_constant_m: float) -> float:
    """ρ = R K, in Ω·m, from the resistance R (Ω) and the probe's cell constant K (m)."""
    return resistance_ohm * cell_constant_m


def combined_verdict(potential_v: float, resistivity_ohm_m: float | None) -> Corrosion:
    """``COMBINED_RULE``, as a function.

    Args:
        potential_v: potential against CSE, V.
        resistivity_ohm_m: Ω·m; None or NaN when it is not known.
    """
    potential_class = astm_class(potential_v)
    if potential_class == "passive":
        return "none"
    if resistivity_ohm_m is None or math.isnan(resistivity_ohm_m):
        return "possible"
    if potential_class == "active" and resistivity_ohm_m <= SUSTAINS_CORROSION_OHM_M:
        return "active"
    return "possible"
