"""The RILEM gradient and the closer spacing of ASTM C876."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from scipy.stats import norm
from surveyed import grid

from inspect_cli.assessment.gradient import (
    MOST_SCATTER_MV,
    Minima,
    Steps,
    minima_of,
    noise_depth_mv,
    scatter_mv,
    steps_of,
)
from inspect_cli.assessment.spacing import Spacing, neighbours, side_by_side, spacing_of


def minima(uv_m: object, mv: object) -> Minima:
    uv, volts, _, pairs = prepared(uv_m, mv)
    return minima_of(uv, volts, pairs)


def steps(uv_m: object, mv: object) -> Steps:
    uv, volts, spacing, pairs = prepared(uv_m, mv)
    return steps_of(uv, volts, pairs, spacing)


def prepared(uv_m: object, mv: object) -> tuple[np.ndarray, np.ndarray, Spacing | None, np.ndarray]:
    uv = np.asarray(uv_m, dtype=np.float64).reshape(-1, 2)
    volts = 1e-3 * np.asarray(mv, dtype=np.float64).reshape(-1)
    spacing = spacing_of(uv)
    valid = np.flatnonzero(np.isfinite(volts))
    pairs = valid[neighbours(uv[valid], spacing)] if spacing else np.zeros((0, 2), np.intp)
    return uv, volts, spacing, pairs


def funnel(depth_mv: float, radius_m: float, background_mv: float = -150.0) -> np.ndarray:
    """On a grid of 21 × 21 points at 0.2 m, around its middle (point 220)."""
    distance = np.linalg.norm(grid(21, 21, 0.2) - 2.0, axis=1)
    return background_mv - depth_mv * np.maximum(0.0, 1.0 - distance / radius_m)


@pytest.mark.parametrize(("depth_mv", "active"), [(200.0, True), (100.0, True), (99.0, False)])
def test_a_funnel_within_a_metre(depth_mv: float, active: bool) -> None:
    found = minima(grid(21, 21, 0.2), funnel(depth_mv, 1.0))
    assert found.index.tolist() == [220]
    assert found.rise_mv[0] == pytest.approx(depth_mv)
    assert found.is_active.tolist() == [active]


def test_a_wide_funnel_is_too_shallow() -> None:
    """400 mV over 4 m: 100 mV per metre is reached exactly, over 4.5 m it is not."""
    assert minima(grid(21, 21, 0.2), funnel(400.0, 4.0)).is_active.tolist() == [True]
    shallow = minima(grid(21, 21, 0.2), funnel(400.0, 4.5))
    assert shallow.is_active.tolist() == [False]
    assert np.isnan(shallow.rise_within_m[0])


def test_where_the_rise_reaches_100_mv() -> None:
    found = minima(grid(21, 21, 0.2), funnel(200.0, 1.0))
    assert found.rise_within_m[0] == pytest.approx(np.hypot(0.4, 0.4))  # 0.5 m lies between nodes


def test_positive_minima_and_shallow_hollows_do_not_count() -> None:
    assert len(minima(grid(21, 21, 0.2), funnel(200.0, 1.0, background_mv=250.0)).index) == 0
    assert len(minima(grid(21, 21, 0.2), funnel(19.0, 1.0)).index) == 0
    assert len(minima(grid(21, 21, 0.2), funnel(0.0, 1.0)).index) == 0


def test_a_dimple_on_a_slope_is_no_minimum() -> None:
    """500 mV per metre down along u, and one reading 15 mV below its neighbour further down."""
    uv = grid(11, 5, 0.1)
    mv = -100.0 - 500.0 * uv[:, 0]
    dimple = 2 * 11 + 5
    mv[dimple] = mv[dimple + 1] - 15.0
    found = minima(uv, mv)
    assert dimple not in found.index
    assert len(found.index) == 1


def test_two_equal_readings_side_by_side_are_one_minimum() -> None:
    found = minima(grid(6, 1, 0.2), [-100, -300, -300, -100, -320, -100])
    assert found.index.tolist() == [4, 1]


def test_a_minimum_at_the_edge_and_beside_a_gap() -> None:
    mv = np.full(25, -100.0)
    mv[0], mv[12] = -400.0, -300.0
    mv[[6, 7, 8, 11, 13, 16, 17, 18]] = np.nan  # all around the middle
    found = minima(grid(5, 5, 0.3), mv)
    assert found.index.tolist() == [0]  # what has no neighbour is not below one


def test_farther_than_a_metre_is_not_judged() -> None:
    found = minima(grid(5, 1, 1.2), [-100, -400, -100, -100, -100])
    assert found.index.tolist() == [1]
    assert np.isnan(found.rise_mv[0])
    assert not found.is_active[0]


@settings(max_examples=60, deadline=None)
@given(st.integers(0, 2**32 - 1), st.booleans())
def test_minima_against_a_flood_by_hand(seed: int, strewn: bool) -> None:
    """Prominence by its definition: the lowest way out of a hollow, by trying every level."""
    rng = np.random.default_rng(seed)
    uv = rng.uniform(0, 2, (36, 2)) if strewn else grid(6, 6, 0.35)
    mv = 10.0 * rng.integers(-50, 3, 36)
    mv[rng.random(36) < 0.1] = np.nan
    uv, volts, _, pairs = prepared(uv, mv)
    found = minima_of(uv, volts, pairs)
    links = [set() for _ in range(36)]
    for a, b in pairs.tolist():
        links[a].add(b)
        links[b].add(a)
    expected = set()
    for i in np.flatnonzero(mv < 0):
        if prominence(i, mv, links) >= found.least_depth_mv:
            expected.add(int(i))
    assert set(found.index.tolist()) == expected
    for i, rise in zip(found.index, found.rise_mv, strict=True):
        near = np.linalg.norm(uv - uv[i], axis=1) <= 1.0 + 1e-9
        near[i] = False
        others = mv[near & np.isfinite(mv)]
        assert np.isnan(rise) if not len(others) else rise == pytest.approx(others.max() - mv[i])


def prominence(i: int, mv: np.ndarray, links: list[set[int]]) -> float:
    """Least rise on the way from i to a reading that is lower, or as low and came first."""
    for level in np.unique(mv[np.isfinite(mv)]):
        if level < mv[i]:
            continue
        reached, front = {i}, [i]
        while front:
            for j in links[front.pop()]:
                if j not in reached and mv[j] <= level:
                    reached.add(j)
                    front.append(j)
        if any(mv[j] < mv[i] or (mv[j] == mv[i] and j < i) for j in reached):
            return float(level - mv[i])
    return float(max(mv[j] for j in reached) - mv[i])


def test_scatter_alone_is_no_corrosion() -> None:
    """Of 200 surveys of nothing but scatter, 5 % at most have an active minimum."""
    rng = np.random.default_rng(3)
    wrong = 0
    for k in range(200):
        columns, rows = rng.integers(10, 21, 2)
        uv = grid(columns, rows, (0.25, 0.5)[k % 2])
        mv = -400.0 + rng.normal(0.0, rng.uniform(15.0, 40.0), len(uv))
        wrong += bool(np.any(minima(uv, mv).is_active))
    assert wrong <= 10


def test_few_readings_of_scatter_alone() -> None:
    """Even of 30 readings, whose scatter is known to a fifth, hardly more than 5 % (±3 σ)."""
    rng = np.random.default_rng(4)
    uv = grid(6, 5, 0.5)
    surveys = [minima(uv, -400.0 + rng.normal(0.0, 35.0, 30)) for _ in range(200)]
    assert sum(bool(np.any(found.is_active)) for found in surveys) <= 20


def test_a_small_hollow_in_scatter_is_found() -> None:
    """−250 mV e^(−(r/0.4 m)²) wherever it lies, in 15 mV of scatter: 95 % of 200 at least."""
    rng = np.random.default_rng(5)
    right = 0
    for _ in range(200):
        uv = grid(13, 13, 0.25)
        centre = rng.uniform(0.5, 2.5, 2)
        square = np.sum((uv - centre) ** 2, axis=1)
        mv = -150.0 - 250.0 * np.exp(-square / 0.4**2) + rng.normal(0.0, 15.0, len(uv))
        found = minima(uv, mv)
        near = np.linalg.norm(uv[found.index] - centre, axis=1) < 0.4
        right += bool(np.any(near & found.is_active))
    assert right >= 190


def test_the_scatter_is_told_from_neighbours_whatever_the_slope() -> None:
    """σ of 900 readings to a tenth; a slope of 300 mV per metre adds nothing within the grid."""
    rng = np.random.default_rng(6)
    uv = grid(30, 30, 0.25)
    noise = rng.normal(0.0, 20.0, 900)
    _, _, _, pairs = prepared(uv, noise)
    for slope in (0.0, 300.0):
        assert scatter_mv(noise + slope * uv[:, 0], pairs) == pytest.approx(20.0, rel=0.1)


def test_few_neighbours_tell_no_scatter() -> None:
    """Then the rule is the two electrodes' 20 mV alone; with 20 readings it is the scatter's."""
    rng = np.random.default_rng(7)
    few = minima(grid(21, 1, 0.5), rng.normal(-300.0, 30.0, 21))  # the two ends have one each
    assert (few.scatter_mv, few.least_depth_mv) == (None, 20.0)
    assert len(few.index)
    more = minima(grid(22, 1, 0.5), rng.normal(-300.0, 30.0, 22))
    assert more.scatter_mv is not None
    assert more.least_depth_mv == noise_depth_mv(more.scatter_mv, 22)


def test_what_is_too_much_for_scatter_is_not_passed_over() -> None:
    """Corroding places as far apart as the readings: neighbours say nothing of each other."""
    uv = grid(6, 4, 0.25)
    mv = np.array(
        [
            [-293, -359, -254, -227, -413, -125],
            [-394, -497, -334, -195, -233, -165],
            [-299, -364, -261, -218, -423, -344],
            [-167, -186, -375, -181, -362, -300],
        ]
    )
    found = minima(uv, mv)
    assert found.scatter_mv is not None
    assert found.scatter_mv > MOST_SCATTER_MV
    assert (found.least_depth_mv, int(np.count_nonzero(found.is_active))) == (20.0, 3)


def test_how_deep_scatter_goes() -> None:
    """Against ranges of normal samples themselves, and the quantile of the normal by scipy."""
    for n in (20, 100, 400):
        ranges = np.ptp(np.random.default_rng(8).normal(size=(5000, n)), axis=1)
        assert np.mean(ranges > noise_depth_mv(1.0, n)) < 0.05
        assert np.mean(ranges) < 2.0 * np.sqrt(2.0 * np.log(n)) < noise_depth_mv(1.0, n)
        assert noise_depth_mv(3.0, n) == pytest.approx(6.0 * norm.isf(0.025 / n))


def test_neighbours_that_differ_by_more_than_150_mv() -> None:
    uv = grid(4, 2, 0.25, 0.5)
    mv = [[-100, -250, -250, -500], [-100, -251, -250, -250]]
    found = steps(uv, mv)
    assert found.pairs.tolist() == [[2, 3], [3, 7], [4, 5]]
    np.testing.assert_allclose(found.difference_mv, [250, 250, 151])
    np.testing.assert_allclose(found.midpoint_m, [[0.625, 0], [0.75, 0.25], [0.125, 0.5]])


def test_neither_diagonals_nor_gaps_are_neighbours() -> None:
    mv = np.full((3, 3), np.nan)
    mv[0, 0], mv[1, 1], mv[0, 2] = -100.0, -600.0, -600.0
    assert len(steps(grid(3, 3, 0.5), mv).pairs) == 0


@pytest.mark.parametrize("n", [0, 1, 2, 3, 5])
def test_few_points_on_any_line(n: int) -> None:
    uv = np.outer(np.arange(n), [0.3, 0.4])
    mv = -100.0 - 200.0 * (np.arange(n) % 2)
    found = steps(uv, mv)
    assert found.pairs.tolist() == [[k, k + 1] for k in range(n - 1)]
    assert minima(uv, mv).index.tolist() == [k for k in range(n) if k % 2]


def test_neighbours_of_a_grid_are_counted() -> None:
    uv = grid(7, 5, 0.1016, 0.3)
    spacing = spacing_of(uv)
    assert spacing == Spacing(0.1016, 0.3, True)
    pairs = neighbours(uv, spacing)
    assert len(pairs) == 6 * 5 + 7 * 4 + 2 * 6 * 4
    assert len(side_by_side(pairs, uv, spacing)) == 6 * 5 + 7 * 4


def test_readings_that_crowd_in_a_corner_of_a_grid() -> None:
    """Then each has the few that are really beside it, not all that are near."""
    uv = np.vstack([grid(30, 20, 0.5), np.random.default_rng(2).uniform(0, 0.4, (500, 2))])
    spacing = spacing_of(uv)
    assert spacing == Spacing(0.5, 0.5, True)
    assert len(neighbours(uv, spacing)) < 3 * len(uv)
