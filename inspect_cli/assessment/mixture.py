"""Actively corroding and passive steel as two overlapping populations of potentials.

    p(x; θ) = w N(x; μ_a, σ_a) + (1 − w) N(x; μ_p, σ_p),   θ = (w, μ_a, σ_a, μ_p, σ_p),  μ_a < μ_p

is fitted by maximum likelihood (expectation and maximisation, Dempster, Laird & Rubin, J. R. Stat.
Soc. B 39 (1977) 1–38) from starts that depend on the readings alone. Readings are grouped to their
resolution, and no population is narrower than that: a likelihood that grows without bound around
equal readings says nothing of concrete.

Two populations are called for when their BIC is lower than that of a single normal population by
more than 10, "very strong" evidence (Kass & Raftery, J. Am. Stat. Assoc. 90 (1995) 773–795); the
three further parameters alone cost 3 ln n. And both must be populations: a mean and a spread are of
a handful of readings, so the smaller one must hold at least 5 by expectation, n w or n (1 − w).
Fewer are outliers. It is a number and no share, because a small active part of a large survey has
as much to tell them from as a large part of a small one. Nor may the smaller one be as narrow as
the resolution beside a wider one: that is a value that repeats. Which population is the active one
follows from their order only: whether the structure has active steel at all, the potentials' shape
cannot tell.

Standard errors are those of the observed information, the inverse of −∂² log L/∂θ², and of the
threshold by implicit differentiation.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Final

import numpy as np

from inspect_cli.assessment import mixture_errors
from inspect_cli.assessment.classes import millivolts
from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Vector

MIN_READINGS: Final = 20
"""Fewer do not tell the shape of their distribution."""
STARTS: Final = (0.1, 0.25, 0.5, 0.75, 0.9)
"""Shares of the readings, the most negative first, that the active population starts with."""
RESOLUTIONS_MV: Final = (20.0, 10.0, 5.0, 2.0, 1.0)
"""To which potentials are recorded; ASTM C876 asks for a meter that can be read to 20 mV."""
SUPPORTED_BIC: Final = 10.0
LEAST_HELD: Final = 5.0
"""Readings of the smaller population; the least expected number of a class, by Cochran's rule."""
PARAMETERS: Final = (2, 5)
"""Of one population and of two."""
MAX_STEPS: Final = 2000
SETTLED: Final = 1e-12
"""Growth of the mean log likelihood per step at which the fit has converged."""
ONE_SIDED_95: Final = 1.6448536269514722


@dataclass(frozen=True)
class Mixture:
    """Two populations; potentials in mV."""

    weight: float
    """Share w of the active population, of the readings."""
    mean_mv: tuple[float, float]
    """Active, passive."""
    sd_mv: tuple[float, float]
    standard_errors: tuple[float, float, float, float, float] | None
    """Standard errors of θ = (w, μ_a, σ_a, μ_p, σ_p); None where ``errors_why`` says so."""
    errors_why: str
    threshold_mv: float | None
    """Between the means, where a reading belongs to either with probability one half."""
    threshold_error_mv: float | None
    threshold_why: str
    log_likelihood: float
    one_log_likelihood: float
    """Of a single normal population."""
    bic: float
    one_bic: float
    readings: int
    least_sd_mv: float
    """The readings' resolution; no population is narrower."""

    @property
    def is_supported(self) -> bool:
        """Whether there is a second population."""
        return not self.why_one

    @property
    def why_one(self) -> str:
        """Why there is no second population; empty where there is."""
        if self.one_bic - self.bic <= SUPPORTED_BIC:
            return "a second population does not lower the BIC by more than 10"
        smaller = 0 if self.weight < 0.5 else 1
        held = self.readings * (self.weight if smaller == 0 else 1.0 - self.weight)
        if held < LEAST_HELD:
            return _outliers(held)
        if self.sd_mv[smaller] <= self.least_sd_mv < self.sd_mv[1 - smaller]:
            return (
                "the second would be as narrow as the readings' resolution: that is a value that "
                "repeats, not a population"
            )
        return ""

    @property
    def passive_limit_mv(self) -> float:
        """μ_p − 1.645 σ_p: 95 % of the passive population lie above."""
        return self.mean_mv[1] - ONE_SIDED_95 * self.sd_mv[1]

    @property
    def active_limit_mv(self) -> float:
        """μ_a + 1.645 σ_a: 95 % of the active population lie below."""
        return self.mean_mv[0] + ONE_SIDED_95 * self.sd_mv[0]


def fitted(potential_v: Vector) -> Mixture | str:
    """The best two populations of potentials (n,), V, or in words why there are none.

    NaN counts for nothing.
    """
    mv = millivolts(potential_v[np.isfinite(potential_v)])
    if len(mv) < MIN_READINGS:
        return f"valid readings: {len(mv)}; two populations ask for at least {MIN_READINGS}"
    least_mv = resolution_of(mv)
    steps, inverse = np.unique(np.rint((mv - mv[0]) / least_mv), return_inverse=True)
    values = mv[0] + least_mv * steps
    counts = np.bincount(inverse.reshape(-1)).astype(np.float64)
    if len(values) < 2:
        return "all readings are equal to their resolution"
    best, best_likelihood = np.zeros(5), -math.inf
    for share in STARTS:
        theta = start_of(values, counts, share, least_mv)
        likelihood = fit(values, counts, least_mv, theta)
        if likelihood > best_likelihood:
            best, best_likelihood = theta, likelihood
    if best[1] > best[3]:
        best = np.array([1.0 - best[0], best[3], best[4], best[1], best[2]])
    return _described(values, counts, least_mv, best, best_likelihood)


def _outliers(held: float) -> str:
    if held < 1.5:
        return "the second would hold 1 reading: that is an outlier, not a population"
    return (
        f"the second would hold {held:.1f} readings by expectation, fewer than {LEAST_HELD:.0f}: "
        "those are outliers, not a population"
    )


def resolution_of(mv: Vector) -> float:
    """The largest step, mV, of which all readings (n,) are a whole number apart; 1 mV at least."""
    away = np.abs(mv - mv[0])
    for step in RESOLUTIONS_MV:
        if np.all(np.abs(away - step * np.rint(away / step)) < 1e-5):
            return step
    return RESOLUTIONS_MV[-1]


def start_of(values: Vector, counts: Vector, share: float, least_sd: float) -> Vector:
    """θ of the most negative ``share`` of the readings and of the rest, at least one value each."""
    below = np.cumsum(counts) <= share * counts.sum()
    below[0], below[-1] = True, False
    means, sds = [], []
    for part in (below, ~below):
        mean = np.average(values[part], weights=counts[part])
        variance = np.average((values[part] - mean) ** 2, weights=counts[part])
        means.append(mean)
        sds.append(max(math.sqrt(variance), least_sd))
    weight = counts[below].sum() / counts.sum()
    return np.array([weight, means[0], sds[0], means[1], sds[1]])


@kernel
def fit(values: Vector, counts: Vector, least_sd: float, theta: Vector) -> float:
    """Improve θ until the likelihood settles; the log likelihood of the θ that is left.

    Each step takes the responsibilities r of the active population for the values, and then
    w = Σ c r / n,  μ = Σ c r x / Σ c r,  σ² = Σ c r (x − μ)² / Σ c r, and at least ``least_sd``².
    The passive population takes 1 − r.

    Args:
        values: different values (m,), mV, that ``counts`` (m,) readings have.
        least_sd: mV.
        theta: (5,), written to.
    """
    n = counts.sum()
    r = np.zeros(len(values))
    last = -np.inf
    for step in range(MAX_STEPS + 1):
        total = 0.0
        for k in range(len(values)):
            a, p = log_densities(theta, values[k])
            top = max(a, p)
            both = top + math.log(math.exp(a - top) + math.exp(p - top))
            r[k] = math.exp(a - both)
            total += counts[k] * both
        if total - last <= SETTLED * n or step == MAX_STEPS:
            return total
        last = total
        for part in range(2):
            weight, mean, square = 0.0, 0.0, 0.0
            for k in range(len(values)):
                share = counts[k] * (r[k] if part == 0 else 1.0 - r[k])
                weight += share
                mean += share * values[k]
            if weight <= 1e-9:  # nothing is left of it
                return total
            mean /= weight
            for k in range(len(values)):
                share = counts[k] * (r[k] if part == 0 else 1.0 - r[k])
                square += share * (values[k] - mean) ** 2
            theta[1 + 2 * part] = mean
            theta[2 + 2 * part] = max(math.sqrt(square / weight), least_sd)
            if part == 0:
                theta[0] = weight / n
    return last


@kernel
def log_densities(theta: Vector, x: float) -> tuple[float, float]:
    """ln [w N(x; μ_a, σ_a)] and ln [(1 − w) N(x; μ_p, σ_p)]."""
    half_log_2pi = 0.9189385332046727
    za, zp = (x - theta[1]) / theta[2], (x - theta[3]) / theta[4]
    active = math.log(max(theta[0], 1e-300)) - 0.5 * za * za - math.log(theta[2])
    passive = math.log(max(1.0 - theta[0], 1e-300)) - 0.5 * zp * zp - math.log(theta[4])
    return active - half_log_2pi, passive - half_log_2pi


def _described(
    values: Vector, counts: Vector, least_sd: float, theta: Vector, likelihood: float
) -> Mixture:
    n = counts.sum()
    mean = np.average(values, weights=counts)
    sd = max(math.sqrt(np.average((values - mean) ** 2, weights=counts)), least_sd)
    alone = np.array([1.0, mean, sd, mean, sd])
    one = sum(c * log_densities(alone, x)[0] for x, c in zip(values, counts, strict=True))
    covariance = mixture_errors.covariance(values, counts, least_sd, theta)
    errors = None if isinstance(covariance, str) else np.sqrt(np.diag(covariance))
    threshold = _threshold(theta)
    threshold_error = None
    if threshold is not None and not isinstance(covariance, str):
        threshold_error = mixture_errors.threshold_error(theta, threshold, covariance)
    w, mean_a, sd_a, mean_p, sd_p = theta.tolist()
    return Mixture(
        weight=w,
        mean_mv=(mean_a, mean_p),
        sd_mv=(sd_a, sd_p),
        standard_errors=None if errors is None else tuple(errors.tolist()),
        errors_why=covariance if isinstance(covariance, str) else "",
        threshold_mv=threshold,
        threshold_error_mv=threshold_error,
        threshold_why="" if threshold is not None else "one population prevails between the means",
        log_likelihood=likelihood,
        one_log_likelihood=float(one),
        bic=PARAMETERS[1] * math.log(n) - 2.0 * likelihood,
        one_bic=PARAMETERS[0] * math.log(n) - 2.0 * float(one),
        readings=int(n),
        least_sd_mv=least_sd,
    )


def _threshold(theta: Vector) -> float | None:
    """The root between the means of ln [w N_a] = ln [(1 − w) N_p]; None without one.

    The quadratic's two roots are both real where one lies between the means.
    """
    low, high = float(theta[1]), float(theta[3])
    a, p = log_densities(theta, low)
    if a < p or low == high:
        return None
    a, p = log_densities(theta, high)
    if a > p:
        return None
    for _ in range(200):  # halving: certain, and to the last digit
        middle = 0.5 * (low + high)
        if middle in (low, high):
            break
        a, p = log_densities(theta, middle)
        if a > p:
            low = middle
        else:
            high = middle
    return 0.5 * (low + high)
