"""Uncertainty of points and of their classes."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm
from surveyed import grid, readings

from inspect_cli.assessment.electrodes import basis_of
from inspect_cli.assessment.readings import merged
from inspect_cli.assessment.uncertainty import (
    budget_of,
    class_probabilities,
    doubtful,
    reading_sd_v,
    temperature_sd_v,
)

RULE = {"noise_v": 0.001, "stable_v": 0.005, "stable_s": 1.0, "wetting_s": 0.4}


def test_a_reading_by_its_rule() -> None:
    """1 mV of noise, ±2.5 mV of drift, 5 mV/(e^2.5 − 1) = 0.447 mV of wetting left."""
    found = reading_sd_v([-0.3, np.nan], [np.nan, np.nan], **RULE)
    expected = math.sqrt(1.0 + (2.5**2 + 0.4471275**2) / 3.0)
    assert 1e3 * found[0] == pytest.approx(expected, rel=1e-6)
    assert np.isnan(found[1])


def test_what_is_left_of_the_wetting_is_the_end_of_an_exponential() -> None:
    """Of δ e^(−t/τ), what moved over the last second tells what is still to come."""
    tau, offset, t = 0.7, 0.03, 2.0
    moved = offset * (math.exp(-(t - 1.0) / tau) - math.exp(-t / tau))
    rule = RULE | {"noise_v": 0.0, "stable_v": moved, "wetting_s": tau}
    left = math.sqrt(3.0 * reading_sd_v([0.0], [np.nan], **rule)[0] ** 2 - (0.5 * moved) ** 2)
    assert left == pytest.approx(offset * math.exp(-t / tau))


def test_a_bad_contact_loads_the_voltmeter() -> None:
    good, bad = reading_sd_v([-0.4, -0.4], [2e3, 2e6], **RULE)
    assert good == pytest.approx(reading_sd_v([-0.4], [np.nan], **RULE)[0], rel=1e-3)
    true = -0.4 * (1e7 + 2e6) / 1e7  # of which a meter of 10 MΩ shows −0.4 V behind 2 MΩ
    none = reading_sd_v([0.0], [2e6], **RULE)[0]
    assert bad**2 - none**2 == pytest.approx((true + 0.4) ** 2 / 3.0)


def test_contributions_add_by_their_squares() -> None:
    places = merged(readings(grid(3, 1, 0.2), [-300, -100, np.nan], measurement_sd_v=0.003))
    budget = budget_of(places, basis_of("CSE"))
    limit_sd = 10.0 / (1.959964 * math.sqrt(2.0))
    assert 1e3 * budget.single_v == pytest.approx(limit_sd, rel=1e-6)
    expected = math.sqrt(3.0**2 + limit_sd**2 + (0.9 * 5.5) ** 2 / 3.0)
    np.testing.assert_allclose(1e3 * budget.total_v, [expected, expected, np.nan], rtol=1e-6)


@pytest.mark.parametrize(("electrode", "electrodes"), [("CSE", 2), ("CSE", 7), ("SCE", 2)])
def test_another_electrode_doubles_the_limit(electrode: str, electrodes: int) -> None:
    places = merged(readings(grid(2, 1, 0.2), [-300, -100]))
    one = budget_of(places, basis_of(electrode))
    assert "10 mV" in one.single_from
    two = budget_of(places, basis_of(electrode), electrodes=electrodes)
    assert two.single_v == pytest.approx(2.0 * one.single_v)
    assert "20 mV" in two.single_from


@pytest.mark.parametrize("electrode", ["SCE", "Ag/AgCl sat. KCl"])
def test_one_electrode_of_another_kind_is_still_one(electrode: str) -> None:
    """Its repeats agree as a CSE's do; what the conversion adds is ±5 mV, 2.9 mV."""
    places = merged(readings(grid(2, 1, 0.2), [-300, -100]))
    own, other = (budget_of(places, basis_of(name)) for name in ("CSE", electrode))
    assert other.single_v == own.single_v
    assert (own.conversion_v, 1e3 * other.conversion_v) == (0.0, pytest.approx(5.0 / math.sqrt(3)))
    more = 1e6 * (other.total_v**2 - own.total_v**2)
    np.testing.assert_allclose(more, 25.0 / 3.0)
    np.testing.assert_allclose(1e6 * (other.alone_v**2 - own.alone_v**2), 25.0 / 3.0)


def test_the_surveys_own_repeatability_counts_when_it_is_known_well() -> None:
    rng = np.random.default_rng(1)
    uv = np.repeat(grid(6, 2, 0.2), 4, axis=0)
    mv = np.repeat(np.linspace(-500, -100, 12), 4) + rng.normal(0.0, 8.0, 48)
    budget = budget_of(merged(readings(uv, mv)), basis_of("CSE"))
    assert 1e3 * budget.single_v == pytest.approx(8.0, rel=4.0 / math.sqrt(2 * 36))
    own = mv.reshape(12, 4).std(axis=1, ddof=1)
    expected = 1e-3 * np.maximum(own, 1e3 * budget.single_v) / 2.0
    np.testing.assert_allclose(budget.repeatability_v, expected)
    assert budget.single_from == "repeated readings, 36 degrees of freedom"
    few = budget_of(merged(readings(uv[:12], mv[:12])), basis_of("CSE"))
    assert "ASTM" in few.single_from


def test_readings_that_contradict_each_other_make_their_place_unsure() -> None:
    """−156 and −420 mV: the mean of both is known to half their difference; others stay."""
    uv = [[0.0, 0.0], [1.0, 0.0], [1.0, 0.0], [2.0, 0.0], [2.0, 0.0]]
    places = merged(readings(uv, [-150, -156, -420, -160, -162], measurement_sd_v=0.0))
    budget = budget_of(places, basis_of("CSE", 22.2))
    single_mv = 10.0 / (1.959964 * math.sqrt(2.0))
    expected = [single_mv, 132.0, single_mv / math.sqrt(2.0)]
    np.testing.assert_allclose(1e3 * budget.total_v, expected, rtol=1e-6)
    alone = [single_mv, 264.0 / math.sqrt(2.0), single_mv]
    np.testing.assert_allclose(1e3 * budget.alone_v, alone, rtol=1e-6)
    probabilities = class_probabilities(places.readings.potential_v, budget.total_v)
    assert doubtful(places.readings.potential_v, probabilities).tolist() == [False, True, False]
    assert probabilities[1].max() < 0.5


@pytest.mark.parametrize(
    ("electrode", "temperature_c", "bound_mv"),
    [
        ("CSE", None, 4.95),
        ("CSE", 22.2, 0.0),
        ("CSE", 18.2, 3.6),
        ("CSE", 35.0, 0.9),
        ("SCE", 35.0, 11.52),
    ],
)
def test_temperature(electrode: str, temperature_c: float | None, bound_mv: float) -> None:
    found = temperature_sd_v(basis_of(electrode, temperature_c))
    assert 1e3 * found == pytest.approx(bound_mv / math.sqrt(3.0), abs=1e-9)


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(st.floats(-0.9, 0.2) | st.sampled_from([-0.2, -0.35]), st.floats(1e-5, 0.05)),
        min_size=1,
    )
)
def test_class_probabilities_are_scipys(points: list[tuple[float, float]]) -> None:
    potential, sd = np.array(points).T
    found = class_probabilities(potential, sd)
    np.testing.assert_allclose(found[:, 0], norm.sf(-0.2, potential, sd), atol=1e-6)
    np.testing.assert_allclose(found[:, 2], norm.cdf(-0.35, potential, sd), atol=1e-6)
    np.testing.assert_allclose(found.sum(axis=1), 1.0, atol=1e-12)


def test_points_near_a_class_edge_are_doubtful() -> None:
    """With 10 mV, 95 % on one side means 16.45 mV away from the edge."""
    mv = np.array([-183.0, -184.0, -200.0, -217.0, -333.0, -334.0, -350.0, -367.0, np.nan])
    sd = np.full(9, 0.010)
    found = doubtful(1e-3 * mv, class_probabilities(1e-3 * mv, sd))
    np.testing.assert_array_equal(found, [0, 1, 1, 0, 0, 1, 1, 0, 0])


def test_without_uncertainty_the_class_is_certain() -> None:
    potential = np.array([-0.2, -0.35, -0.351, -0.1, np.nan])
    found = class_probabilities(potential, np.zeros(5))
    np.testing.assert_array_equal(found[:4], [[0, 1, 0], [0, 1, 0], [0, 0, 1], [1, 0, 0]])
    assert np.all(np.isnan(found[4]))
    assert not doubtful(potential, found).any()
