"""Readings of one surface as arrays, and repeated readings of a place made one point."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import Any

import numpy as np
from numpy.typing import NDArray

from inspect_cli.schema.result import PointResult
from inspect_cli.spatial.arrays import Points, Vector

SAME_PLACE_DECIMALS = 6
"""Readings whose coordinates agree to the micrometre were taken at the same place."""


@dataclass(frozen=True)
class Readings:
    """Readings on one surface, n of them; n may be 0.

    Raises ValueError when an array has another length, or a place is not finite.
    """

    labels: NDArray[np.str_]
    uv_m: Points
    """(n, 2) along the surface: u to the right, v up."""
    potential_v: Vector
    """(n,) against CSE at the standard's temperature; NaN where there is no valid reading."""
    resistivity_ohm_m: Vector
    """(n,); NaN where it is not known."""
    measurement_sd_v: Vector
    """(n,) standard uncertainty of the reading itself, without that of the electrode."""

    def __post_init__(self) -> None:
        n = len(self.labels)
        if self.uv_m.shape != (n, 2):
            raise ValueError(f"uv_m has shape {self.uv_m.shape}, not ({n}, 2)")
        if not np.all(np.isfinite(self.uv_m)):
            raise ValueError("uv_m has places that are not finite")
        for name in ("potential_v", "resistivity_ohm_m", "measurement_sd_v"):
            shape = getattr(self, name).shape
            if shape != (n,):
                raise ValueError(f"{name} has shape {shape}, not ({n},)")

    def __len__(self) -> int:
        return len(self.labels)

    @property
    def valid(self) -> NDArray[np.bool_]:
        """(n,) Which readings have a potential."""
        return np.asarray(np.isfinite(self.potential_v))

    def taken(self, chosen: NDArray[Any]) -> Readings:
        """Those of the mask or of the indices."""
        return Readings(
            self.labels[chosen],
            self.uv_m[chosen],
            self.potential_v[chosen],
            self.resistivity_ohm_m[chosen],
            self.measurement_sd_v[chosen],
        )


def readings_of(points: Iterable[PointResult], measurement_sd_v: float | Vector) -> Readings:
    """The points of a result as arrays; those without a place on the surface are left out.

    ``measurement_sd_v`` is one number, or (n,) for the points that have a place.
    """
    placed = [p for p in points if p.uv_m is not None]
    potential = [np.nan if p.potential_mv is None else 1e-3 * p.potential_mv for p in placed]
    rho = [np.nan if p.resistivity_ohm_m is None else p.resistivity_ohm_m for p in placed]
    return Readings(
        labels=np.array([p.label for p in placed], dtype=np.str_),
        uv_m=np.array([p.uv_m for p in placed], dtype=np.float64).reshape(-1, 2),
        potential_v=np.array(potential, dtype=np.float64),
        resistivity_ohm_m=np.array(rho, dtype=np.float64),
        measurement_sd_v=np.full(len(placed), measurement_sd_v, dtype=np.float64),
    )


@dataclass(frozen=True)
class Merged:
    """Readings of m different places, and what was merged into them."""

    readings: Readings
    """In the order in which each place was first read, with its first label."""
    given: NDArray[np.str_]
    """(n,) labels of the readings that were given."""
    member: NDArray[np.intp]
    """(n,) the place of each of them."""
    counts: NDArray[np.intp]
    """(m,) valid readings per place."""
    within_sd_v: Vector
    """(m,) standard deviation of the valid readings of a place; NaN with fewer than two."""
    spread_v: Vector
    """(m,) greatest less least of the valid readings of a place; NaN without any."""
    repeatability_v: float | None
    """Pooled standard deviation within the places: √(Σ (E − Ē)² / ν)."""
    degrees_of_freedom: int
    """ν = Σ (count − 1) over the places with a valid reading."""


def merged(readings: Readings) -> Merged:
    """One point for each place.

    Its potential is the mean of its valid readings: the spread of the place over the root of their
    number then is the standard uncertainty for any number of them (GUM, 4.2). Its resistivity is
    their median, as that of five readings around a place is in practice. Its own measurement's
    standard uncertainty is the root mean square of the valid ones', because drift does not average
    out.
    """
    keys = np.round(readings.uv_m, SAME_PLACE_DECIMALS) + 0.0  # −0 is 0
    _, first, member = np.unique(keys, axis=0, return_index=True, return_inverse=True)
    order = np.argsort(first)
    rank = np.empty_like(order)
    rank[order] = np.arange(len(order))
    member, first = rank[member.reshape(-1)], first[order]
    valid = readings.valid
    at, value = member[valid], readings.potential_v[valid]
    counts = np.bincount(at, minlength=len(first))
    points = readings.taken(first)
    if len(first) < len(readings):
        points = Readings(
            labels=points.labels,
            uv_m=points.uv_m,
            potential_v=_means(at, value, counts),
            resistivity_ohm_m=_medians(member, readings.resistivity_ohm_m, len(first)),
            measurement_sd_v=np.sqrt(_means(at, readings.measurement_sd_v[valid] ** 2, counts)),
        )
    low, high = _extremes(at, value, len(first))
    squares = np.bincount(at, (value - points.potential_v[at]) ** 2, len(first))
    freedom = int(np.sum(np.maximum(counts - 1, 0)))
    return Merged(
        readings=points,
        given=readings.labels,
        member=member,
        counts=counts,
        within_sd_v=np.sqrt(_ratio(squares, np.where(counts > 1, counts - 1, 0))),
        spread_v=np.where(counts > 0, high - low, np.nan),
        repeatability_v=float(np.sqrt(np.sum(squares) / freedom)) if freedom else None,
        degrees_of_freedom=freedom,
    )


def _means(at: NDArray[np.intp], values: Vector, counts: NDArray[np.intp]) -> Vector:
    """Mean of the values of each place; a single one is itself, to the last digit."""
    mean = _ratio(np.bincount(at, values, len(counts)), counts)
    # Equal values must stay what they are: the sum of three tenths is not three times a tenth.
    return np.where(counts > 0, np.clip(mean, *_extremes(at, values, len(counts))), np.nan)


def _extremes(at: NDArray[np.intp], values: Vector, n: int) -> tuple[Vector, Vector]:
    """Least and greatest value of each of n places; ±∞ without one."""
    low, high = np.full(n, np.inf), np.full(n, -np.inf)
    np.minimum.at(low, at, values)
    np.maximum.at(high, at, values)
    return low, high


def _medians(at: NDArray[np.intp], values: Vector, n: int) -> Vector:
    """Median of the known values of each place."""
    known = np.isfinite(values)
    at, values = at[known], values[known]
    order = np.lexsort((values, at))
    values, counts = values[order], np.bincount(at, minlength=n)
    median = np.full(n, np.nan)
    some = counts > 0
    start = (np.cumsum(counts) - counts)[some]
    low, high = start + (counts[some] - 1) // 2, start + counts[some] // 2
    median[some] = 0.5 * (values[low] + values[high])
    return median


def _ratio(numerator: NDArray[Any], denominator: NDArray[np.intp]) -> Vector:
    """The quotient; NaN where the denominator is 0."""
    quotient = np.full(len(numerator), np.nan)
    np.divide(numerator, denominator, out=quotient, where=denominator > 0)
    return quotient
