"""Class edges of potential and resistivity, and the combined rule."""

from __future__ import annotations

import math

import pytest

from inspect_cli.assessment.classes import (
    COMBINED_RULE,
    astm_class,
    combined_verdict,
    corrosion_rate,
    corrosion_risk,
    resistivity,
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
    for word in ("−200 mV", "−350 mV", "100 Ω·m", "None:", "Active:", "Possible:"):
        assert word in COMBINED_RULE


def test_resistivity_of_a_disc_electrode() -> None:
    """Spreading resistance of a disc of radius a on a half-space: R = ρ / (4 a), so K = 4 a."""
    rho, radius = 150.0, 0.02
    assert resistivity(rho / (4 * radius), 4 * radius) == pytest.approx(rho)
