"""Two populations: against scipy's densities, known samples, asymptotics and resampling."""

from __future__ import annotations

import math

import numpy as np
import pytest
from scipy.optimize import brentq, minimize
from scipy.stats import norm

from inspect_cli.assessment.findings import mixture_findings
from inspect_cli.assessment.mixture import Mixture, fitted, resolution_of
from inspect_cli.assessment.mixture_errors import score

ACTIVE, PASSIVE = (-420.0, 45.0), (-150.0, 40.0)


def sample(n: int, share: float, seed: int, active: tuple[float, float] = ACTIVE) -> np.ndarray:
    """Potentials in V, to the millivolt."""
    rng = np.random.default_rng(seed)
    count = round(n * share)
    mv = np.concatenate([rng.normal(*active, count), rng.normal(*PASSIVE, n - count)])
    return 1e-3 * np.rint(mv)


def fit(potential_v: np.ndarray) -> Mixture:
    found = fitted(potential_v)
    assert isinstance(found, Mixture)
    return found


def log_likelihood(theta: np.ndarray, mv: np.ndarray) -> float:
    w, mean_a, sd_a, mean_p, sd_p = theta
    density = w * norm.pdf(mv, mean_a, sd_a) + (1 - w) * norm.pdf(mv, mean_p, sd_p)
    return float(np.sum(np.log(density)))


def theta_of(m: Mixture) -> np.ndarray:
    return np.array([m.weight, m.mean_mv[0], m.sd_mv[0], m.mean_mv[1], m.sd_mv[1]])


def test_likelihoods_and_bic_are_scipys() -> None:
    volts = sample(300, 0.4, 1)
    mv = np.rint(1e3 * volts)
    found = fit(volts)
    assert found.log_likelihood == pytest.approx(log_likelihood(theta_of(found), mv), abs=1e-6)
    one = float(np.sum(norm.logpdf(mv, mv.mean(), mv.std())))
    assert found.one_log_likelihood == pytest.approx(one, abs=1e-6)
    assert found.bic == pytest.approx(5 * math.log(300) - 2 * found.log_likelihood)
    assert found.one_bic == pytest.approx(2 * math.log(300) - 2 * one)


@pytest.mark.parametrize("seed", range(5))
def test_no_other_optimiser_finds_a_likelier_pair(seed: int) -> None:
    volts = sample(200, 0.35, seed, active=(-300.0, 60.0))
    mv = np.rint(1e3 * volts)
    found = fit(volts)

    def loss(x: np.ndarray) -> float:
        w = 1 / (1 + math.exp(-x[0]))
        return -log_likelihood(
            np.array([w, x[1], max(math.exp(x[2]), 1.0), x[3], max(math.exp(x[4]), 1.0)]), mv
        )

    start = np.array([-0.6, -300.0, math.log(60.0), -150.0, math.log(40.0)])
    other = minimize(loss, start, method="Nelder-Mead", options={"maxiter": 4000, "xatol": 1e-6})
    assert found.log_likelihood >= -other.fun - 1e-3


def test_the_score_is_the_gradient_of_the_likelihood() -> None:
    mv = np.rint(1e3 * sample(100, 0.4, 2))
    theta = np.array([0.3, -400.0, 55.0, -160.0, 35.0])
    found = score(mv, np.ones(len(mv)), theta)
    for k in range(5):
        step = np.zeros(5)
        step[k] = 1e-5 * max(1.0, abs(theta[k]))
        central = (log_likelihood(theta + step, mv) - log_likelihood(theta - step, mv)) / 2
        assert found[k] == pytest.approx(central / step[k], rel=1e-5, abs=1e-6)
    assert np.abs(score(mv, np.ones(len(mv)), theta_of(fit(1e-3 * mv)))[1:]).max() < 1e-3


def test_known_populations_are_found() -> None:
    found = fit(sample(4000, 0.3, 3))
    assert found.is_supported
    errors = found.standard_errors
    assert errors is not None
    truth = (0.3, *ACTIVE, *PASSIVE)
    for value, error, true in zip(theta_of(found), errors, truth, strict=True):
        assert abs(value - true) < 4.0 * error
    assert found.passive_limit_mv == pytest.approx(norm.ppf(0.05, *PASSIVE), abs=5.0)
    assert found.active_limit_mv == pytest.approx(norm.ppf(0.95, *ACTIVE), abs=8.0)


def test_standard_errors_of_populations_far_apart_are_the_textbooks() -> None:
    """Then membership is known: σ/√n_k, σ/√(2 n_k) and √(w (1 − w)/n)."""
    found = fit(sample(1000, 0.4, 4, active=(-900.0, 45.0)))
    errors = found.standard_errors
    assert errors is not None
    (sd_a, sd_p), n_a, n_p = found.sd_mv, 400, 600
    expected = (
        math.sqrt(0.24 / 1000),
        sd_a / math.sqrt(n_a),
        sd_a / math.sqrt(2 * n_a),
        sd_p / math.sqrt(n_p),
        sd_p / math.sqrt(2 * n_p),
    )
    np.testing.assert_allclose(errors, expected, rtol=1e-3)


def test_standard_errors_by_resampling() -> None:
    """The spread of 150 surveys of the same structure is what the errors claim (±20 %)."""
    fits = [fit(sample(600, 0.35, 100 + k)) for k in range(150)]
    spread = np.std([theta_of(m) for m in fits], axis=0, ddof=1)
    claimed = np.median([m.standard_errors for m in fits], axis=0)
    # The sample has a fixed number of active readings, so w varies less than it is claimed to.
    np.testing.assert_allclose(claimed[1:], spread[1:], rtol=0.2)
    thresholds = [m.threshold_mv for m in fits]
    errors = [m.threshold_error_mv for m in fits]
    assert np.median(errors) == pytest.approx(np.std(thresholds, ddof=1), rel=0.25)


def test_the_threshold_is_where_the_posterior_is_one_half() -> None:
    found = fit(sample(500, 0.4, 5))
    w, mean_a, sd_a, mean_p, sd_p = theta_of(found)

    def odds(x: float) -> float:
        return float(w * norm.pdf(x, mean_a, sd_a) - (1 - w) * norm.pdf(x, mean_p, sd_p))

    assert found.threshold_mv == pytest.approx(brentq(odds, mean_a, mean_p), abs=1e-6)


def test_a_normal_sample_is_one_population() -> None:
    """Of 100 surveys of one population, fewer than five may be called two."""
    wrong = sum(fit(sample(n, 0.0, seed)).is_supported for seed in range(50) for n in (40, 400))
    assert wrong < 5


@pytest.mark.parametrize("outliers", [[-800], [-250], [-800, -760, -840], [300, 310]])
def test_outliers_are_no_population(outliers: list[int]) -> None:
    volts = np.append(sample(69, 0.0, 8), 1e-3 * np.array(outliers))
    found = fit(volts)
    one = "1 reading: that is an outlier"
    assert not found.is_supported
    if min(abs(mv + 150) for mv in outliers) > 300:  # it is far enough off for the BIC
        assert found.one_bic - found.bic > 10.0
        assert (one if len(outliers) == 1 else "those are outliers") in found.why_one
        assert mixture_findings(found).why == found.why_one


@pytest.mark.parametrize(("held", "verdict"), [(4, False), (6, True)])
def test_a_handful_is_a_population(held: int, verdict: bool) -> None:
    """Of 500 readings as well: it is their number that counts, not their share."""
    volts = np.append(sample(500, 0.0, 9), np.linspace(-0.62, -0.68, held))
    assert fit(volts).is_supported is verdict


def test_a_value_that_repeats_is_no_population() -> None:
    found = fit(np.append(sample(100, 0.0, 10), [-0.5] * 8))
    assert not found.is_supported
    assert "a value that repeats" in found.why_one


def test_readings_to_ten_millivolts_do_not_make_a_population_of_a_step() -> None:
    volts = np.round(sample(2000, 0.0, 6), 2)
    found = fit(volts)
    assert not found.is_supported
    assert min(found.sd_mv) >= 10.0


@pytest.mark.parametrize(
    ("mv", "step"),
    [([-130, -150, -119], 1), ([-130, -150], 20), ([-119, -129, -209], 10), ([-1.5, -2.7], 1)],
)
def test_resolution(mv: list[float], step: float) -> None:
    assert resolution_of(np.array(mv, dtype=np.float64)) == step


def test_order_and_gaps_do_not_matter() -> None:
    volts = sample(200, 0.4, 7)
    shuffled = np.random.default_rng(0).permutation(np.append(volts, [np.nan] * 30))
    a, b = fit(volts), fit(shuffled)
    np.testing.assert_allclose(theta_of(a), theta_of(b), rtol=1e-9)


def test_too_few_or_equal_readings_have_no_answer() -> None:
    assert fitted(np.zeros(0)) == "valid readings: 0; two populations ask for at least 20"
    assert fitted(np.append(np.linspace(-0.5, -0.1, 19), np.nan)) == (
        "valid readings: 19; two populations ask for at least 20"
    )
    assert fitted(np.full(50, -0.3)) == "all readings are equal to their resolution"


def test_two_values_are_two_populations_without_an_error() -> None:
    found = fit(np.repeat([-0.5, -0.1], 15))
    assert found.is_supported
    assert found.mean_mv == pytest.approx((-500.0, -100.0))
    assert found.standard_errors is None
    assert "resolution" in found.errors_why
    assert found.threshold_mv == pytest.approx(-300.0)
    assert found.threshold_error_mv is None
