"""Fitted variograms against those that the semivariances were made from."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.variogram import Semivariances, Variogram, fit, semivariances


def made(of: Variogram, pairs: float = 500.0) -> Semivariances:
    lag = np.linspace(0.1, 1.5, 15)
    return Semivariances(lag, of.semivariance(lag), np.full(15, pairs))


@pytest.mark.parametrize(
    "of",
    [
        Variogram("spherical", 1e-4, 4e-3, 0.9),
        Variogram("exponential", 1e-4, 4e-3, 1.2),
        Variogram("power", 1e-4, 4e-3, 1.5, 1.55),
    ],
)
def test_the_model_is_found_again(of: Variogram) -> None:
    found = fit(made(of), 0.0)
    assert found.model == of.model
    # The lengths that are tried are 15 % apart.
    assert found.length_m == pytest.approx(of.length_m, rel=0.12)
    assert found.exponent == pytest.approx(of.exponent)
    lag = np.linspace(0.1, 1.5, 50)
    np.testing.assert_allclose(found.semivariance(lag), of.semivariance(lag), rtol=0.05)


def test_the_nugget_is_at_least_the_measurement() -> None:
    found = fit(made(Variogram("spherical", 1e-4, 4e-3, 0.9)), 5e-4)
    assert found.nugget_v2 == 5e-4


def test_few_pairs_cannot_tell_a_nugget() -> None:
    of = Variogram("spherical", 1e-3, 1e-3, 0.9)
    assert fit(made(of), 0.0).nugget_v2 == pytest.approx(1e-3, rel=0.1)
    assert fit(made(of, pairs=20.0), 1e-6).nugget_v2 == 1e-6
    # Each pair counts from both its ends: 30 of them are 60.
    assert fit(made(of, pairs=59.0), 1e-6).nugget_v2 == 1e-6
    assert fit(made(of, pairs=60.0), 1e-6).nugget_v2 == pytest.approx(1e-3, rel=0.1)


def test_near_lags_and_many_pairs_weigh_most() -> None:
    """No model fits two bins' step: the fit goes by N/h², against a search by brute force.

    With scale and nugget fitted for each of the lengths that are tried, the weighted misfit of
    what was found may be no more than that of any on a grid of 60 × 60 × 200.
    """
    rng = np.random.default_rng(4)
    lag = np.linspace(0.1, 1.5, 15)
    found = Semivariances(lag, 1e-3 * (1.0 + rng.random(15)), np.round(60 + 900 * rng.random(15)))
    best = fit(found, 0.0)
    weight = found.pairs / lag**2
    misfit = weight @ (best.semivariance(lag) - found.semivariance_v2) ** 2
    nugget, scale = np.meshgrid(np.linspace(0, 2e-3, 60), np.linspace(0, 2e-3, 60))
    for length in np.geomspace(0.2, 6.0, 200):
        x = np.minimum(lag / length, 1.0)
        shape = 1.5 * x - 0.5 * x**3
        trial = nugget[..., None] + scale[..., None] * shape
        least = float((((trial - found.semivariance_v2) ** 2) @ weight).min())
        assert misfit <= 1.01 * least


def test_unlike_neighbours_are_all_nugget() -> None:
    lag = np.linspace(0.1, 1.5, 15)
    found = fit(Semivariances(lag, np.full(15, 2e-3), np.full(15, 500.0)), 0.0)
    assert found.nugget_v2 == pytest.approx(2e-3)
    assert found.semivariance(lag) == pytest.approx(2e-3)


def test_semivariances_of_a_line_are_half_the_squared_difference() -> None:
    """E = 0.1 u on a row: γ(h) = ½ (0.1 h)²; each pair from both its ends."""
    u = 0.2 * np.arange(12)
    found = semivariances(np.column_stack([u, 0.0 * u]), 0.1 * u, 32)
    np.testing.assert_allclose(found.semivariance_v2, 0.5 * (0.1 * found.lag_m) ** 2, rtol=0.02)
    assert found.pairs[0] == 22


def test_white_noise_has_its_variance_at_all_distances() -> None:
    rng = np.random.default_rng(1)
    uv = rng.random((5000, 2))
    found = semivariances(uv, 0.02 * rng.normal(size=5000), 32)
    assert found.pairs.sum() > 50_000
    average = np.average(found.semivariance_v2, weights=found.pairs)
    assert average == pytest.approx(4e-4, rel=0.05)
