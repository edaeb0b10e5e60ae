"""How fast readings lose their likeness with distance: the variogram that kriging weighs by."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import NDArray

Floats = NDArray[np.float64]
VariogramModel = Literal["spherical", "exponential", "power"]

_ANCHORS = 2000
_PARTNERS = 64
_SEED = 876
_BINS = 15
_LENGTHS = 40
_EXPONENTS = np.linspace(1.0, 1.8, 17)
_PAIRS_FOR_A_NUGGET = 60


@dataclass(frozen=True)
class Variogram:
    """γ(h) = nugget + scale · g(h / length) for h > 0, γ(0) = 0.

    spherical      g(x) = 1.5 x − 0.5 x³ for x ≤ 1, else 1
    exponential    g(x) = 1 − exp(−3 x), 95 % of the sill at the length
    power          g(x) = x^exponent, which has no sill

    A power above 1 belongs to fields that are smoother than the other two know: potentials above
    deep cover are, and a spherical variogram would give them errors three times too large.
    """

    model: VariogramModel
    nugget_v2: float
    """Half the mean squared difference of two readings side by side, V²."""
    scale_v2: float
    """What distance adds: the partial sill; of a power the semivariance at the length, V²."""
    length_m: float
    """Distance from which readings are no longer alike (the range); of a power any one, m."""
    exponent: float = 1.0
    """Of a power, 1 to 1.8; no other model has one."""

    def semivariance(self, distance_m: Floats) -> Floats:
        """γ at positive distances, V²; at zero its limit, the nugget."""
        shape = _shape(self.model, distance_m / self.length_m, self.exponent)
        return self.nugget_v2 + self.scale_v2 * shape


@dataclass(frozen=True)
class Semivariances:
    """Half the mean squared difference of pairs of readings, by their distance."""

    lag_m: Floats
    """(bins,) mean distance of the pairs in a bin, m."""
    semivariance_v2: Floats
    """(bins,) V²."""
    pairs: Floats
    """(bins,) number of pairs."""


def semivariances(uv_m: Floats, potential_v: Floats, neighbours: int) -> Semivariances:
    """Experimental semivariances of near readings, in bins of equal width.

    They go as far as a neighbourhood of so many ``neighbours`` reaches in the median. Every
    reading is paired with its 64 nearest, a pair of neighbours thus counts twice; of more than
    2000 readings 2000 are, drawn with a fixed seed. Kriging from the nearest readings asks for
    no other lags, and 100 000 readings have 5·10⁹ pairs.

    Args:
        uv_m: (n, 2) distinct places, m, more than one.
        potential_v: (n,) V.
        neighbours: at most 64; fewer if there are fewer readings.

    Source: Matheron's estimator; Cressie, Statistics for Spatial Data (1993), eq. 2.4.2.
    """
    from scipy.spatial import cKDTree

    count = len(uv_m)
    anchors = np.arange(count)
    if count > _ANCHORS:
        anchors = np.sort(np.random.default_rng(_SEED).choice(count, _ANCHORS, replace=False))
    distance, index = cKDTree(uv_m).query(uv_m[anchors], k=min(count, _PARTNERS + 1))
    farthest = float(np.median(distance[:, min(neighbours, count - 1)])) * (1.0 + 1e-9)
    half_square = 0.5 * (potential_v[index] - potential_v[anchors][:, None]) ** 2
    # The nearest of all is the reading itself.
    lag, half_square = distance[:, 1:].ravel(), half_square[:, 1:].ravel()
    bins = np.minimum(lag / farthest * _BINS, _BINS).astype(int)
    pairs = np.bincount(bins, minlength=_BINS + 1)[:_BINS].astype(float)
    held = pairs > 0
    of_bin = pairs[held]
    return Semivariances(
        lag_m=np.bincount(bins, lag, _BINS + 1)[:_BINS][held] / of_bin,
        semivariance_v2=np.bincount(bins, half_square, _BINS + 1)[:_BINS][held] / of_bin,
        pairs=of_bin,
    )


def fit(found: Semivariances, least_nugget_v2: float) -> Variogram:
    """The model whose semivariances are nearest in weighted least squares.

    The weights are N/h², pairs over lag squared, for it is the near readings that kriging weighs
    by. For a given length or exponent a model is linear in nugget and scale, so each of many has
    its best pair in closed form, and the best of all is found without a starting guess. With
    fewer than 30 pairs at the shortest lag a nugget cannot be told from chance: it is the least.

    Args:
        found: experimental semivariances, at least one bin.
        least_nugget_v2: the nugget is not fitted below this, V².

    Source: weights as in gstat (Pebesma, Computers & Geosciences 30 (2004) 683–691); 30 pairs by
    Journel & Huijbregts, Mining Geostatistics (1978), section III.C.
    """
    weight = found.pairs / found.lag_m**2
    weight = weight / weight.sum()
    free = found.pairs[0] >= _PAIRS_FOR_A_NUGGET
    # Readings that tell nothing of their neighbours are a nugget, not a short range.
    lengths = np.geomspace(2.0 * found.lag_m[0], 4.0 * found.lag_m[-1], _LENGTHS)
    ones = np.ones(_LENGTHS)
    candidates: tuple[tuple[VariogramModel, Floats, Floats], ...] = (
        ("spherical", lengths, ones),
        ("exponential", lengths, ones),
        ("power", np.full(len(_EXPONENTS), found.lag_m[-1]), _EXPONENTS),
    )
    fits: list[tuple[float, Variogram]] = []
    for model, length, exponent in candidates:
        shapes = _shape(model, found.lag_m / length[:, None], exponent[:, None])
        nugget, scale = _nugget_and_scale(
            shapes, found.semivariance_v2, weight, least_nugget_v2, free
        )
        fitted = nugget[:, None] + scale[:, None] * shapes
        misfit = ((fitted - found.semivariance_v2) ** 2) @ weight
        k = int(misfit.argmin())
        best = Variogram(
            model, float(nugget[k]), float(scale[k]), float(length[k]), float(exponent[k])
        )
        fits.append((float(misfit[k]), best))
    return min(fits, key=lambda fitted: fitted[0])[1]


def _nugget_and_scale(
    shapes: Floats, semivariance: Floats, weight: Floats, least: float, free: bool
) -> tuple[Floats, Floats]:
    """Weighted least squares of nugget ≥ ``least`` and scale ≥ 0, for each row of ``shapes``."""
    mean_shape, mean = shapes @ weight, float(semivariance @ weight)
    spread = (shapes**2) @ weight - mean_shape**2
    joint = (shapes * semivariance) @ weight - mean_shape * mean
    scale = np.divide(joint, spread, out=np.zeros_like(joint), where=spread > 1e-12)
    nugget = mean - scale * mean_shape
    # On a bound the other one alone is fitted.
    alone = ((shapes * (semivariance - least)) @ weight) / ((shapes**2) @ weight)
    bound = (nugget < least) | (not free)
    scale = np.where(bound, alone, scale)
    nugget = np.where(bound, least, nugget)
    nugget = np.where(scale <= 0.0, max(mean, least), nugget)
    return nugget, np.maximum(scale, 0.0)


def _shape(model: VariogramModel, x: Floats, exponent: Floats | float) -> Floats:
    if model == "power":
        return np.asarray(x**exponent)
    if model == "exponential":
        return np.asarray(1.0 - np.exp(-3.0 * x))
    capped = np.minimum(x, 1.0)
    return np.asarray(1.5 * capped - 0.5 * capped**3)
