"""Class edges of potential and resistivity, and the combined rule."""

from __future__ import annotations

import math
from decimal import Decimal

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from inspect_cli.assessment.classes import (
    ASTM_CLASSES,
    COMBINED_RULE,
    CORROSION_RATES,
    CORROSION_RISKS,
    VERDICTS,
    astm_class,
    astm_codes,
    combined_verdict,
    corrosion_rate,
    corrosion_risk,
    millivolts,
    name_of,
    rate_codes,
    resistivity,
    risk_codes,
    verdict_codes,
)


@pytest.mark.parametrize(
    ("millivolts", "expected"),
    [
        (100.0, "passive"),
        (-199.999, "passive"),
        (-200.0, "uncertain"),
        (-275.0, "uncertain"),
        (-350.0, "uncertain"),
        (-350.001, "active"),
        (-900.0, "active"),
    ],
)
def test_astm_c876_classes(millivolts: float, expected: str) -> None:
    assert astm_class(millivolts / 1e3) == expected


@pytest.mark.parametrize(
    ("kohm_cm", "rate"),
    [
        (20.1, "low"),
        (20.0, "low to moderate"),
        (10.1, "low to moderate"),
        (10.0, "high"),
        (5.0, "high"),
        (4.9, "very high"),
    ],
)
def test_langford_and_broomfield(kohm_cm: float, rate: str) -> None:
    assert corrosion_rate(10.0 * kohm_cm) == rate


@pytest.mark.parametrize(
    ("kohm_cm", "risk"),
    [
        (100.0, "negligible"),
        (99.9, "low"),
        (50.0, "low"),
        (49.9, "moderate"),
        (10.1, "moderate"),
        (10.0, "high"),
    ],
)
def test_rilem(kohm_cm: float, risk: str) -> None:
    assert corrosion_risk(10.0 * kohm_cm) == risk


@pytest.mark.parametrize(
    ("potential", "rho", "verdict"),
    [
        (-0.1, 20.0, "none"),
        (-0.1, None, "none"),
        (-0.2, 20.0, "possible"),
        (-0.35, 20.0, "possible"),
        (-0.351, 100.0, "active"),
        (-0.351, 100.1, "possible"),
        (-0.6, None, "possible"),
        (-0.6, math.nan, "possible"),
    ],
)
def test_combined_rule(potential: float, rho: float | None, verdict: str) -> None:
    assert combined_verdict(potential, rho) == verdict


def test_the_rule_in_words_names_its_thresholds_and_verdicts() -> None:
    for word in ("−200 mV", "−350 mV", "100 Ω·m", "Not indicated:", "Active:", "Possible:"):
        assert word in COMBINED_RULE


def test_resistivity_of_a_disc_electrode() -> None:
    """Spreading resistance of a disc of radius a on a half-space: R = ρ / (4 a), so K = 4 a."""
    rho, radius = 150.0, 0.02
    assert resistivity(rho / (4 * radius), 4 * radius) == pytest.approx(rho)


@given(st.integers(-1200 * 10**3, 600 * 10**3))
def test_a_potential_of_a_file_keeps_its_digits_and_its_class(micro: int) -> None:
    """Decimal arithmetic of the file's own number is the oracle, however it was made volts."""
    mv = float(Decimal(micro) / 1000)
    exact = Decimal(micro) / 1000
    expected = "passive" if exact > -200 else "active" if exact < -350 else "uncertain"
    for volts in (mv / 1e3, 1e-3 * mv, mv * 0.001, 0.1 * (0.01 * mv)):
        assert float(millivolts(volts)) == mv
        assert astm_class(volts) == expected


@pytest.mark.parametrize("mv", [-200.0, -350.0])
def test_the_standards_edges_are_uncertain_after_any_conversion(mv: float) -> None:
    for volts in (1e-3 * mv, mv / 1e3, 1e-3 * (mv - 119.0) + 0.119, np.float64(mv) * 1e-3):
        assert astm_class(float(volts)) == "uncertain"


@given(
    st.lists(
        st.tuples(
            st.floats(-1.0, 0.5) | st.sampled_from([-0.2, -0.35, math.nan]),
            st.floats(0.1, 3000.0) | st.sampled_from([50.0, 100.0, 200.0, 500.0, 1e3, math.nan]),
        )
    )
)
def test_arrays_and_single_values_are_classed_alike(points: list[tuple[float, float]]) -> None:
    potential = np.array([p for p, _ in points], dtype=np.float64)
    rho = np.array([r for _, r in points], dtype=np.float64)
    for k, (p, r) in enumerate(points):
        assert name_of(ASTM_CLASSES, astm_codes(potential)[k]) == astm_class(p)
        assert name_of(CORROSION_RATES, rate_codes(rho)[k]) == corrosion_rate(r)
        assert name_of(CORROSION_RISKS, risk_codes(rho)[k]) == corrosion_risk(r)
        assert name_of(VERDICTS, verdict_codes(potential, rho)[k]) == combined_verdict(p, r)


@pytest.mark.parametrize("no_value", [math.nan, math.inf, -math.inf])
def test_no_value_has_no_class(no_value: float) -> None:
    assert astm_class(no_value) is None
    assert corrosion_rate(no_value) is None
    assert corrosion_risk(no_value) is None
    assert combined_verdict(no_value, 50.0) is None


def test_a_resistivity_that_cannot_be_is_not_known() -> None:
    assert corrosion_rate(0.0) is None
    assert corrosion_risk(-5.0) is None
    assert combined_verdict(-0.6, 0.0) == "possible"
