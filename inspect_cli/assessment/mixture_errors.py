"""Standard errors of two populations (``mixture``); θ = (w, μ_a, σ_a, μ_p, σ_p), mV."""

from __future__ import annotations

import math

import numpy as np

from inspect_cli.spatial.arrays import Matrix, Vector


def score(values: Vector, counts: Vector, theta: Vector) -> Vector:
    """∂ log L/∂θ (5,)."""
    w, mean_a, sd_a, mean_p, sd_p = theta
    za, zp = (values - mean_a) / sd_a, (values - mean_p) / sd_p
    log_odds = math.log(w / (1.0 - w)) - 0.5 * (za**2 - zp**2) + math.log(sd_p / sd_a)
    r = 0.5 * (1.0 + np.tanh(0.5 * log_odds))
    terms = (
        r / w - (1.0 - r) / (1.0 - w),
        r * za / sd_a,
        r * (za**2 - 1.0) / sd_a,
        (1.0 - r) * zp / sd_p,
        (1.0 - r) * (zp**2 - 1.0) / sd_p,
    )
    return np.array([counts @ term for term in terms])


def covariance(values: Vector, counts: Vector, least_sd: float, theta: Vector) -> Matrix | str:
    """Of θ (5, 5), the inverse of the observed information; or in words why there is none.

    The information is that of central differences of the score.
    """
    w, _, sd_a, _, sd_p = theta.tolist()
    if not 1e-6 < w < 1.0 - 1e-6:
        return "one population has no readings"
    if min(sd_a, sd_p) <= least_sd:
        return "a population is as narrow as the readings' resolution"
    scale = np.array([w * (1.0 - w), sd_a, sd_a, sd_p, sd_p])
    hessian = np.zeros((5, 5))
    for k in range(5):
        step = np.zeros(5)
        step[k] = 1e-4 * scale[k]
        change = score(values, counts, theta + step) - score(values, counts, theta - step)
        hessian[k] = change / (2.0 * step[k])
    information = -0.5 * (hessian + hessian.T) * np.outer(scale, scale)
    if np.linalg.eigvalsh(information)[0] <= 1e-9 * counts.sum():
        return "the likelihood is flat in one direction: the populations cannot be told apart"
    return np.asarray(np.linalg.inv(information) * np.outer(scale, scale))


def threshold_error(theta: Vector, x: float, covariance: Matrix) -> float:
    """Of the threshold x, mV, by implicit differentiation.

    √(gᵀ C g) with g = −(∂f/∂θ) / (∂f/∂x) of f = ln [w N_a(x)] − ln [(1 − w) N_p(x)].
    """
    w, mean_a, sd_a, mean_p, sd_p = theta
    za, zp = (x - mean_a) / sd_a, (x - mean_p) / sd_p
    along_x = -za / sd_a + zp / sd_p
    by_theta = np.array(
        [
            1.0 / (w * (1.0 - w)),
            za / sd_a,
            (za**2 - 1.0) / sd_a,
            -zp / sd_p,
            -(zp**2 - 1.0) / sd_p,
        ]
    )
    gradient = -by_theta / along_x
    return float(np.sqrt(gradient @ covariance @ gradient))
