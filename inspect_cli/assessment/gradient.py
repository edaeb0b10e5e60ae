"""What differences between readings say: corroding minima, and where to read more closely.

Absolute potentials mean different things on different structures; a steep rise around a negative
minimum indicates active corrosion on all of them. The criterion of RILEM TC 154-EMC, about 100 mV
within 1 m, is made definite here:

    minimum   a valid, negative reading that no neighbour undercuts, at the bottom of a hollow
              deep enough: so much has to be climbed from it to reach a lower reading, or there is
              none. Of equal readings side by side, the first stands for all.
    enough    20 mV, since less can be two electrodes' disagreement (ASTM C876), and more than
              scatter alone makes, see below.
    rise      the highest valid reading within 1 m, less the minimum. At an edge or a gap only
              what was read counts; a minimum with no other reading within 1 m is not judged.
    active    rise ≥ 100 mV.

Readings that only scatter have hollows too, the deepest of them as deep as their whole range. Of n
independent normal readings with standard deviation σ that is expected to be 2 √(2 ln n) σ at most
(Boucheron, Lugosi & Massart, Concentration Inequalities (2013), section 2.5), but σ is not known:
told from the readings (``scatter_mv``) it is too small often enough that 7 to 11 % of surveys of
100 to 400 readings have a deeper one. A range above 2 z σ takes a reading more than z σ from the
middle, above or below it, so that whatever n

    P(range > 2 z σ) ≤ 2 n (1 − Φ(z)) = 5 %    with    z = Φ⁻¹(1 − 0.05/(2 n))

(Bonferroni). This depth, ``noise_depth_mv``, is 7 σ among a hundred readings and 7.7 σ among four
hundred. The bound is wide enough for the error of σ: 1 to 3 % of such surveys have a deeper hollow,
of surveys of 20 readings 6 %.
What changes from one reading to the next and not beyond counts as scatter, whether the voltmeter
or the concrete made it, up to ``MOST_SCATTER_MV``: more is steel that so coarse a spacing does not
resolve, of which the readings cannot tell how deep its hollows are. They then count as where the
scatter is not known, since a corroding place that is passed over costs more than one looked at.

Source: Elsener and others, RILEM TC 154-EMC, Materials and Structures 36 (2003) 461–471.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from statistics import NormalDist
from typing import Final

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.classes import millivolts
from inspect_cli.assessment.spacing import Spacing, side_by_side
from inspect_cli.assessment.uncertainty import LIMIT_OVER_SD
from inspect_cli.compiled import kernel
from inspect_cli.schema.tasks.coverage import CLOSER_SPACING_MV
from inspect_cli.spatial.arrays import Points, Vector

RISE_MV: Final = 100.0
WITHIN_M: Final = 1.0
LEAST_DEPTH_MV: Final = 20.0
"""Two electrodes may differ by as much at the same place (ASTM C876)."""
BY_SCATTER: Final = 0.05
"""Surveys of scatter alone that may have a hollow deep enough, at most."""
MIN_DIFFERENCES: Final = 20
"""Readings with two neighbours or more that tell the scatter; fewer do not."""
MOST_SCATTER_MV: Final = CLOSER_SPACING_MV / LIMIT_OVER_SD
"""54 mV: with more, over 5 % of neighbours differ by the 150 mV at which ASTM C876 asks for a
closer spacing, so that the standard takes it for the structure's."""
MAD_TO_SD: Final = 1.4826
"""Of a normal population, its standard deviation over the median distance from its middle."""
REACH_M: Final = WITHIN_M + 1e-9
"""For round-off: ten steps of a tenth are a metre."""


@dataclass(frozen=True)
class Minima:
    """Minima of a surface's potential, the steepest first; k of them."""

    index: NDArray[np.intp]
    """(k,) which point."""
    rise_mv: Vector
    """(k,) to the highest reading within 1 m; NaN where there is no other."""
    rise_within_m: Vector
    """(k,) distance of the nearest reading at least 100 mV higher; NaN without one in 1 m."""
    least_depth_mv: float
    """How deep a hollow had to be."""
    scatter_mv: float | None
    """Standard deviation of a single reading around its neighbours; None where it is not known."""

    @property
    def is_active(self) -> NDArray[np.bool_]:
        """(k,) Which the criterion calls actively corroding."""
        return np.asarray(self.rise_mv >= RISE_MV)


@dataclass(frozen=True)
class Steps:
    """Neighbours that differ by more than the closer spacing's rule, the greatest first; k."""

    pairs: NDArray[np.intp]
    """(k, 2) the two points."""
    difference_mv: Vector
    """(k,)"""
    midpoint_m: Points
    """(k, 2) where to read more, (u, v)."""


def minima_of(uv_m: Points, potential_v: Vector, pairs: NDArray[np.intp]) -> Minima:
    """The minima of n different places.

    Args:
        uv_m: (n, 2)
        potential_v: (n,) against CSE; NaN where there is no reading.
        pairs: (k, 2) ``neighbours`` of those that have one.
    """
    mv = millivolts(potential_v)
    valid = np.flatnonzero(np.isfinite(mv))
    depth = hollow_depths(mv, valid[np.argsort(mv[valid], kind="stable")], pairs)
    scatter = scatter_mv(mv, pairs)
    least = LEAST_DEPTH_MV
    if scatter is not None and scatter <= MOST_SCATTER_MV:
        least = max(least, noise_depth_mv(scatter, len(valid)))
    lowest = np.flatnonzero((depth >= least) & (mv < 0.0))
    by_u = valid[np.argsort(uv_m[valid, 0], kind="stable")]
    first = np.searchsorted(uv_m[by_u, 0], uv_m[lowest, 0] - REACH_M)
    rise, within = rises(uv_m[by_u], mv[by_u], uv_m[lowest], mv[lowest], first)
    steepest = np.lexsort((mv[lowest], -np.nan_to_num(rise, nan=-1.0)))
    return Minima(lowest[steepest], rise[steepest], within[steepest], least, scatter)


def scatter_mv(mv: Vector, pairs: NDArray[np.intp]) -> float | None:
    """Standard deviation, mV, of a single reading around what its neighbours say of its place.

        r_i = E_i − mean of its k_i neighbours        σ = 1.4826 median |r_i| / √(1 + 1/k_i)

    A slope cancels where neighbours lie around a reading, and hollows do not count as long as most
    readings lie outside of their bends. Of independent normal readings r_i has the variance
    σ² (1 + 1/k_i). None with fewer than 20 readings that have two neighbours.

    Args:
        mv: (n,)
        pairs: (k, 2) neighbours, each pair once, none of them NaN.

    Source: the median is Hampel's, J. Am. Stat. Assoc. 69 (1974) 383–393.
    """
    ends, others = np.concatenate([pairs, pairs[:, ::-1]]).T
    around = np.bincount(ends, minlength=len(mv))
    total = np.bincount(ends, mv[others], len(mv))
    told = np.flatnonzero(around >= 2)
    if len(told) < MIN_DIFFERENCES:
        return None
    k = around[told]
    differences = np.abs(mv[told] - total[told] / k) / np.sqrt(1.0 + 1.0 / k)
    return MAD_TO_SD * float(np.median(differences))


def noise_depth_mv(scatter_mv: float, n: int) -> float:
    """2 z σ, mV: the depth that in 19 of 20 surveys no hollow among n > 0 readings has by scatter.

    Equation and source stand above.
    """
    return 2.0 * NormalDist().inv_cdf(1.0 - BY_SCATTER / (2.0 * n)) * scatter_mv


def steps_of(
    uv_m: Points,
    potential_v: Vector,
    pairs: NDArray[np.intp],
    spacing: Spacing | None,
    difference_mv: float = CLOSER_SPACING_MV,
) -> Steps:
    """Where ASTM C876 asks for a closer spacing: neighbours that differ by more than 150 mV.

    Neighbours are not across a diagonal. Arguments as of ``minima_of``.
    """
    if spacing is not None:
        pairs = side_by_side(pairs, uv_m, spacing)
    mv = millivolts(potential_v)
    difference = np.abs(mv[pairs[:, 0]] - mv[pairs[:, 1]])
    steep = np.flatnonzero(difference > difference_mv)
    steep = steep[np.argsort(-difference[steep], kind="stable")]
    pairs = pairs[steep]
    return Steps(pairs, difference[steep], 0.5 * (uv_m[pairs[:, 0]] + uv_m[pairs[:, 1]]))


@kernel
def hollow_depths(height: Vector, order: NDArray[np.intp], pairs: NDArray[np.intp]) -> Vector:
    """How deep the hollow is at whose bottom each point lies (its topographic prominence).

    The hollows are flooded in order of height; where two meet, the shallower one's depth is known:
    the height of the meeting point less that of its bottom. The deepest of a connected part is
    counted to the part's highest point. A point that is no bottom has depth 0; of a part of equal
    heights the first point has depth 0 as well.

    Args:
        height: (n,)
        order: indices by ascending height; those that are not among them are left out.
        pairs: (k, 2) neighbours, each pair once.
    """
    n = len(height)
    begin = np.zeros(n + 1, np.int64)
    for k in range(len(pairs)):
        begin[pairs[k, 0] + 1] += 1
        begin[pairs[k, 1] + 1] += 1
    for i in range(n):
        begin[i + 1] += begin[i]
    around, filled = np.zeros(2 * len(pairs), np.int64), begin[:-1].copy()
    for k in range(len(pairs)):
        a, b = pairs[k, 0], pairs[k, 1]
        around[filled[a]], around[filled[b]] = b, a
        filled[a] += 1
        filled[b] += 1
    bottom = np.full(n, -1, np.int64)  # the tree that leads to the bottom of each flooded hollow
    depth = np.zeros(n)
    highest = np.zeros(n)
    for i in order:
        bottom[i] = i
        highest[i] = height[i]
        for m in range(begin[i], begin[i + 1]):
            j = around[m]
            if bottom[j] < 0:
                continue
            a, b = bottom_of(bottom, i), bottom_of(bottom, j)
            if a == b:
                continue
            if height[b] < height[a] or (height[b] == height[a] and b < a):
                a, b = b, a
            depth[b] = height[i] - height[b]
            bottom[b] = a
            highest[a] = height[i]
    for i in range(n):
        if bottom[i] == i:
            depth[i] = highest[i] - height[i]
    return depth


@kernel
def bottom_of(bottom: NDArray[np.int64], i: int) -> int:
    """Follow the tree from i to the bottom of its hollow, and shorten it on the way."""
    while bottom[i] != i:
        bottom[i] = bottom[bottom[i]]
        i = bottom[i]
    return i


@kernel
def rises(
    uv: Points, mv: Vector, low_uv: Points, low_mv: Vector, first: NDArray[np.intp]
) -> tuple[Vector, Vector]:
    """The rise (k,), mV, within 1 m of each minimum, and the distance (k,), m, of 100 mV more.

    Args:
        uv: places (n, 2), m, by ascending u.
        mv: their potentials (n,).
        low_uv: minima (k, 2), m; ``low_mv`` (k,) theirs.
        first: the first place within reach along u of each (k,).
    """
    rise, within = np.full(len(low_mv), np.nan), np.full(len(low_mv), np.nan)
    u = uv[:, 0]
    for k in range(len(low_mv)):
        for j in range(first[k], len(mv)):
            if u[j] > low_uv[k, 0] + REACH_M:
                break
            du, dv = u[j] - low_uv[k, 0], uv[j, 1] - low_uv[k, 1]
            square = du * du + dv * dv
            if square > REACH_M * REACH_M or square == 0.0:
                continue
            more = mv[j] - low_mv[k]
            if not rise[k] >= more:
                rise[k] = more
            if more >= RISE_MV and not within[k] <= math.sqrt(square):
                within[k] = math.sqrt(square)
    return rise, within
