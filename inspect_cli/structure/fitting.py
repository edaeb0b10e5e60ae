"""Planes, spheres and cylinders fitted to points with outliers.

1. Candidates through minimal samples are ranked on a random subset by their truncated squared
   distances Σ min(r², τ²) (MSAC: Torr & Zisserman, "MLESAC", CVIU 78 (2000) 138–156).
2. The best few are refined on the subset by least squares, with the threshold τ narrowing down
   to the inlier distance.
3. The winner is refined on all points. A wide band around the surface lets outliers pull at
   it, so τ narrows once more to three standard deviations of the noise, estimated from the
   median absolute residual, as long as that is below the inlier distance.
"""

from __future__ import annotations

from typing import Literal

import numpy as np

from inspect_cli.errors import GeometryError, Problem
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import CYLINDER
from inspect_cli.structure.fit import CODES, Fit, Kind, described, require_determined
from inspect_cli.structure.hypotheses import best_candidates, candidates
from inspect_cli.structure.least_squares import PARAMETERS, minimised, residuals

SUBSET = 2000
KEPT = 6
"""Candidates that are refined."""
COARSE_SHARE = 0.01
"""A cylinder's candidates come from noisy normals: they are ranked, and first refined, with a
threshold of at least this share of the cloud's diameter."""
NARROWING = 0.4
MAD_TO_SIGMA = 1.4826
"""Standard deviation over median absolute deviation of a normal distribution."""
SIGMAS = 3.0
SETTLED = 0.03
"""Relative change of the threshold τ that is not worth another iteration."""
LEAST_SHARE = 0.05
"""Least share of the points that a surface has to explain."""
FLAT_GAIN = 0.10
"""Least relative gain in mean square residual for which ``auto`` takes the richer surface: a
curvature whose sagitta stays below the noise is taken as flat."""


def fit_primitive(
    points: Points, kind: Kind | Literal["auto"], inlier_m: float, rng: np.random.Generator
) -> Fit:
    """Fit a surface to ``points`` (n, 3), m; those within ``inlier_m`` of it support it.

    ``auto`` takes the plane, sphere or cylinder that explains the points best, see
    ``_simplest``. Raises GeometryError where no such surface explains them.
    """
    if kind != "auto":
        return _fitted(points, kind, inlier_m, rng)
    fits: list[Fit] = []
    problems: list[Problem] = []
    for each in CODES:
        try:
            fits.append(_fitted(points, each, inlier_m, rng))
        except GeometryError as error:
            problems.extend(error.problems)
    if not fits:
        raise GeometryError(list(dict.fromkeys(problems)))
    return _simplest(fits)


def _fitted(points: Points, kind: Kind, inlier_m: float, rng: np.random.Generator) -> Fit:
    code = CODES[kind]
    if len(points) <= PARAMETERS[code]:
        raise GeometryError(
            f"{len(points)} points are too few for a {kind}",
            hint=f"it takes more than {PARAMETERS[code]}",
        )
    # Near the origin, so that georeferenced coordinates lose no digits.
    origin = np.median(points[rng.integers(0, len(points), SUBSET)], axis=0)
    local = np.ascontiguousarray(points - origin)
    subset = local
    if len(local) > SUBSET:
        subset = local[rng.choice(len(local), SUBSET, replace=False, shuffle=False)]
    model = _best_candidate(code, subset, inlier_m, rng)
    model, used_m = _settled(code, model, subset, inlier_m, inlier_m)
    _require_spread(subset[np.abs(residuals(code, model, subset)) <= used_m], used_m)
    model, used_m = _settled(code, model, local, used_m, inlier_m)
    distances = residuals(code, model, local)
    support = int(np.count_nonzero(np.abs(distances) <= inlier_m))
    if support < max(LEAST_SHARE * len(points), PARAMETERS[code] + 1):
        raise GeometryError(
            f"no {kind} explains the points: the best one has {support} of {len(points)} "
            f"within {inlier_m:g} m",
            hint="crop to the surface, raise options.inlier_m, or fit another kind",
        )
    fit = described(kind, model, local, distances, origin, inlier_m, used_m)
    require_determined(fit)
    return fit


def _require_spread(points: Points, noise_m: float) -> None:
    """GeometryError unless the points spread beyond their noise in two directions."""
    spread = 0.0
    if len(points) > 2:
        spread = float(np.sqrt(max(np.linalg.eigvalsh(np.cov(points.T))[1], 0.0)))
    if spread < noise_m:
        raise _degenerate("the points lie on a line or in a single spot")


def _degenerate(what: str) -> GeometryError:
    return GeometryError(what, hint="check the cloud, its unit (metres) and its crop")


def _best_candidate(code: int, subset: Points, inlier_m: float, rng: np.random.Generator) -> Vector:
    """The best candidate, refined by least squares."""
    coarse = inlier_m
    if code == CYLINDER:
        diameter = float(np.linalg.norm(np.ptp(subset, axis=0)))
        coarse = max(inlier_m, COARSE_SHARE * diameter)
    models = candidates(code, subset, rng)
    best, least = np.zeros(7), np.inf
    for index in best_candidates(code, models, subset, coarse, KEPT):
        if index < 0:
            continue
        model, threshold = models[index], coarse
        while threshold > inlier_m:
            model, _ = minimised(code, model, subset, threshold, iterations=15)
            threshold *= NARROWING
        model, cost = minimised(code, model, subset, inlier_m, iterations=15)
        if cost < least:
            best, least = model, cost
    if not np.isfinite(least):
        raise _degenerate("no sample of the points spans such a surface")
    return best


def _settled(
    code: int, model: Vector, points: Points, used_m: float, inlier_m: float
) -> tuple[Vector, float]:
    """(model, τ) at the least squares of ``points``, with τ narrowed to their noise."""
    for _ in range(3):
        model, _ = minimised(code, model, points, used_m, iterations=15)
        size = np.abs(residuals(code, model, points))
        size = size[size <= used_m]
        if size.size == 0:
            break
        sigma = MAD_TO_SIGMA * float(np.median(size))
        narrowed = float(np.clip(SIGMAS * sigma, 1e-3 * inlier_m, inlier_m))
        if abs(narrowed - used_m) <= SETTLED * used_m:
            return model, used_m
        used_m = narrowed
    return minimised(code, model, points, used_m, iterations=15)[0], used_m


def _simplest(fits: list[Fit]) -> Fit:
    """The fit with the fewest parameters k that explains the points as well as the best one.

    The best is the one with the least Σ min(r², inlier²). Over the n points that decided on it,
    with its mean square residual s² (at least (inlier/100)², so that noise-free points count
    as flat too), another one with mean square m² is as good where

        n (m² / s² − 1)  ≤  FLAT_GAIN · n + (k_best − k) ln n:

    the Bayesian information criterion, and a share of the noise that a richer surface has to
    explain before it matters to anyone who touches it.
    """
    best = min(fits, key=lambda f: np.sum(np.minimum(np.abs(f.residuals_m), f.inlier_m) ** 2))
    used = best.used
    n = int(np.count_nonzero(used))
    floor = (0.01 * best.inlier_m) ** 2
    s_square = max(best.rms_m**2, floor)
    k_best = len(best.covariance)
    for fit in sorted(fits, key=lambda f: len(f.covariance)):
        m_square = np.mean(np.minimum(np.abs(fit.residuals_m[used]), fit.inlier_m) ** 2)
        allowed = FLAT_GAIN * n + (k_best - len(fit.covariance)) * np.log(n)
        if n * (max(m_square, floor) / s_square - 1.0) <= allowed:
            return fit
    return best
