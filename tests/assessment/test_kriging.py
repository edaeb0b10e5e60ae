"""Kriged maps against kriging solved by hand, known random fields and a real slab left out."""

from __future__ import annotations

import csv
from pathlib import Path

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from inspect_cli.assessment.kriging import KrigedMap, NoMap, krige, kriged_at
from inspect_cli.assessment.supports import Supports
from inspect_cli.assessment.variogram import Variogram

VARIOGRAMS = [
    Variogram("spherical", 0.0, 4e-3, 1.3),
    Variogram("spherical", 2e-4, 4e-3, 0.4),
    Variogram("exponential", 1e-4, 4e-3, 0.9),
    Variogram("power", 5e-5, 3e-3, 0.7, 1.6),
]


def grid(columns: int, rows: int, pitch: float = 0.2) -> np.ndarray:
    u, v = np.meshgrid(np.arange(columns) * pitch, np.arange(rows) * pitch)
    return np.column_stack([u.ravel(), v.ravel()])


def wave(uv: np.ndarray) -> np.ndarray:
    """Two hot spots on a passive ground, V."""
    return -0.3 + 0.1 * np.sin(1.7 * uv[:, 0]) * np.cos(1.1 * uv[:, 1])


def kriged(uv: np.ndarray, potential: np.ndarray, sd: np.ndarray | None = None) -> KrigedMap:
    found = krige(uv, potential, sd)
    assert isinstance(found, KrigedMap)
    return found


def drawn_nodes(found: KrigedMap) -> np.ndarray:
    rows, columns = np.nonzero(np.isfinite(found.potential_v))
    return np.column_stack([found.u_m[columns], found.v_m[rows]])


def by_hand(
    uv: np.ndarray, values: np.ndarray, at: np.ndarray, of: Variogram
) -> tuple[float, float]:
    """The ordinary kriging system written out in covariances, solved densely.

    The models are written anew; the nugget is noise, so it stands on the diagonal alone.
    """

    def g(h: np.ndarray) -> np.ndarray:
        x = h / of.length_m
        if of.model == "power":
            return x**of.exponent
        if of.model == "exponential":
            return 1 - np.exp(-3 * x)
        return np.where(x < 1, x * (3 - x * x) / 2, 1.0)

    n = len(values)
    between = np.linalg.norm(uv[:, None] - uv[None], axis=2)
    far = 10 * of.scale_v2  # Any constant: the weights sum to one.
    system = np.zeros((n + 1, n + 1))
    system[:n, :n] = far - of.scale_v2 * g(between) + of.nugget_v2 * np.eye(n)
    system[:n, n] = system[n, :n] = 1.0
    right = np.append(far - of.scale_v2 * g(np.linalg.norm(uv - at, axis=1)), 1.0)
    solution = np.linalg.solve(system, right)
    return solution[:n] @ values, far + of.nugget_v2 - solution @ right


@pytest.mark.parametrize("of", VARIOGRAMS)
def test_estimate_and_variance_solve_the_kriging_system(of: Variogram) -> None:
    rng = np.random.default_rng(3)
    uv, at = rng.random((25, 2)), rng.random((40, 2))
    held = Supports(uv, wave(uv) + 0.01 * rng.normal(size=25), 0.0)
    estimate, variance = kriged_at(held, of, at)
    expected = np.array([by_hand(uv, held.potential_v, place, of) for place in at])
    np.testing.assert_allclose(estimate, expected[:, 0], rtol=0, atol=1e-11)
    np.testing.assert_allclose(variance, expected[:, 1], rtol=0, atol=1e-12)


def test_of_many_readings_the_nearest_32_are_kriged() -> None:
    rng = np.random.default_rng(4)
    uv, at = rng.random((200, 2)), rng.random((20, 2))
    held = Supports(uv, wave(uv), 0.0)
    estimate, variance = kriged_at(held, VARIOGRAMS[1], at)
    for k, place in enumerate(at):
        near = np.argsort(np.linalg.norm(uv - place, axis=1))[:32]
        expected = by_hand(uv[near], held.potential_v[near], place, VARIOGRAMS[1])
        assert estimate[k] == pytest.approx(expected[0], abs=1e-11)
        assert variance[k] == pytest.approx(expected[1], abs=1e-12)


def test_a_large_map_in_tiles_is_the_map_in_one_piece() -> None:
    rng = np.random.default_rng(5)
    uv = np.round(grid(28, 25) + 0.06 * rng.random((700, 2)), 6)  # maps know micrometres
    found = kriged(uv, wave(uv))
    assert found.places == 700
    nodes = drawn_nodes(found)[::7]
    drawn = found.potential_v[np.isfinite(found.potential_v)][::7]
    whole, _ = kriged_at(Supports(uv, wave(uv), 0.0), found.variogram, nodes)
    np.testing.assert_allclose(drawn, whole, rtol=0, atol=1e-9)


def test_without_a_nugget_the_readings_are_met() -> None:
    rng = np.random.default_rng(6)
    uv = rng.random((30, 2))
    estimate, variance = kriged_at(Supports(uv, wave(uv), 0.0), VARIOGRAMS[0], uv)
    np.testing.assert_allclose(estimate, wave(uv), rtol=0, atol=1e-12)
    np.testing.assert_allclose(variance, 0.0, rtol=0, atol=1e-12)


def test_standard_error_grows_with_distance() -> None:
    uv = grid(6, 6)
    away = np.column_stack([1.0 + np.linspace(0.0, 1.0, 11), np.full(11, 0.6)])
    _, variance = kriged_at(Supports(uv, wave(uv), 0.0), VARIOGRAMS[2], away)
    assert (np.diff(variance) > 0).all()
    # In a map: least at a reading, most in the middle of four.
    found = kriged(uv, wave(uv))
    error = found.standard_error_v[10:16, 10:16]
    assert error[0, 0] < 1e-3 * np.ptp(wave(uv))
    assert error.max() > 3.0 * error[0, 0]
    assert error[2:4, 2:4].min() > error[0, :].max() * 0.8


def test_map_finds_a_smooth_field() -> None:
    rng = np.random.default_rng(7)
    uv = grid(12, 9)
    found = kriged(uv, wave(uv) + 0.003 * rng.normal(size=len(uv)), np.full(len(uv), 0.003))
    u, v = np.meshgrid(found.u_m, found.v_m)
    truth = wave(np.column_stack([u.ravel(), v.ravel()])).reshape(u.shape)
    # Better than one reading's noise, and as good as it says to within a factor of two.
    rms = np.sqrt(np.mean((found.potential_v - truth) ** 2))
    assert rms < 0.003
    standardised = np.mean(((found.potential_v - truth) / found.standard_error_v) ** 2)
    assert 0.25 < standardised < 2.0


def test_standard_error_is_honest_on_gaussian_random_fields() -> None:
    """Exponential covariance, sill (50 mV)², range 1.5 m, noise 5 mV: errors have variance one."""
    rng = np.random.default_rng(8)
    measured = grid(14, 14)
    asked = 0.1 + grid(13, 13)
    both = np.concatenate([measured, asked])
    h = np.linalg.norm(both[:, None] - both[None], axis=2)
    root = np.linalg.cholesky(2.5e-3 * np.exp(-3 * h / 1.5) + 1e-12 * np.eye(len(both)))
    squares = []
    for _ in range(8):
        field = -0.3 + root @ rng.normal(size=len(both))
        noisy = field[: len(measured)] + 0.005 * rng.normal(size=len(measured))
        found = kriged(measured, noisy, np.full(len(measured), 0.005))
        held = Supports(measured, noisy, 2.5e-5)
        estimate, variance = kriged_at(held, found.variogram, asked)
        error = estimate - field[len(measured) :]
        squares.append(np.mean(error**2 / (variance - 2.5e-5)))
    assert 0.7 < np.mean(squares) < 1.4


def test_nothing_outside_the_readings() -> None:
    rng = np.random.default_rng(9)
    angle = rng.random(400) * 2 * np.pi
    radius = np.sqrt(rng.random(400))
    uv = np.column_stack([radius * np.cos(angle), radius * np.sin(angle)])
    nodes = drawn_nodes(kriged(uv, wave(uv)))
    assert np.linalg.norm(nodes, axis=1).max() <= 1.0
    assert len(nodes) > 1000


def test_an_l_is_not_bridged() -> None:
    everywhere = grid(20, 20)
    uv = everywhere[(everywhere[:, 0] < 0.9) | (everywhere[:, 1] < 0.9)]
    nodes = drawn_nodes(kriged(uv, wave(uv)))
    # The corner is cut by no more than the largest gap; beyond it nothing is drawn.
    beyond = np.maximum(nodes[:, 0] - 0.8, 0) + np.maximum(nodes[:, 1] - 0.8, 0)
    in_notch = (nodes[:, 0] > 0.8 + 1e-9) & (nodes[:, 1] > 0.8 + 1e-9)
    assert beyond[in_notch].max(initial=0.0) < 3.5 * 0.2 * np.sqrt(2)
    for arm in ((3.8, 0.0), (0.0, 3.8), (3.8, 0.8), (0.8, 3.8)):
        assert np.linalg.norm(nodes - arm, axis=1).min() < 1e-6


def test_a_hole_stays_empty_and_one_missing_reading_does_not() -> None:
    uv = grid(30, 30, 0.1)
    centre = np.array([1.5, 1.5])
    holed = uv[np.abs(uv - centre).max(axis=1) > 0.45]
    nodes = drawn_nodes(kriged(holed, wave(holed)))
    assert np.abs(nodes - centre).max(axis=1).min() > 0.2
    missing = uv[np.abs(uv - centre).max(axis=1) > 0.05]
    assert np.isfinite(kriged(missing, wave(missing)).potential_v).all()


def test_a_fine_grid_within_a_coarse_one_leaves_both_drawn() -> None:
    fine = np.array([2.0, 2.0]) + grid(15, 15, 0.15)
    coarse = grid(8, 8, 1.0)
    apart = np.abs(coarse - 3.05).max(axis=1) > 1.06
    uv = np.concatenate([coarse[apart], fine])
    assert np.isfinite(kriged(uv, wave(uv)).potential_v).all()


@pytest.mark.parametrize("strays", [[[9.0, 9.0]], [[9.0, 9.0], [9.0, 9.2]]])
def test_stray_readings_do_not_pull_the_map_out(strays: list[list[float]]) -> None:
    uv = np.concatenate([grid(8, 8), strays])
    assert drawn_nodes(kriged(uv, wave(uv))).max() < 1.5


@pytest.mark.parametrize(
    ("uv", "why"),
    [
        (np.zeros((0, 2)), "no valid readings"),
        (np.zeros((1, 2)), "1 valid reading is too few for a map, which needs 5"),
        (grid(2, 2), "4 places with valid readings are too few"),
        (np.full((7, 2), 3.0), "all 7 valid readings are at one place"),
        (grid(9, 1), "in one line"),
        (np.column_stack([np.arange(9.0), 2 * np.arange(9.0)]), "in one line"),
    ],
)
def test_what_would_be_invented_is_refused(uv: np.ndarray, why: str) -> None:
    found = krige(uv, -0.1 - 0.01 * np.arange(len(uv)), None)
    assert isinstance(found, NoMap)
    assert why in found.why


def test_invalid_readings_are_left_out() -> None:
    uv = grid(5, 5)
    potential = wave(uv)
    potential[[3, 7]] = np.nan
    found = kriged(uv, potential, np.full(25, np.nan))
    assert found.readings == 23
    assert isinstance(krige(uv, np.full(25, np.nan), None), NoMap)


@pytest.mark.parametrize("sd", [None, 0.005])
def test_equal_readings_make_a_flat_map(sd: float | None) -> None:
    uv = grid(6, 5)
    found = kriged(uv, np.full(30, -0.1), None if sd is None else np.full(30, sd))
    assert (found.potential_v == -0.1).all()
    # Of equal noise the mean of all thirty has the variance of one over thirty.
    expected = 0.0 if sd is None else sd / np.sqrt(30)
    np.testing.assert_allclose(found.standard_error_v, expected, rtol=1e-9, atol=1e-12)


def test_a_flat_part_of_a_map_has_the_error_of_the_rest() -> None:
    uv = grid(40, 12)
    potential = np.where(uv[:, 0] < 4.0, -0.1, wave(uv))
    found = kriged(uv, potential)
    rows, columns = found.potential_v.shape
    middle = slice(rows // 2 - 3, rows // 2 + 3)
    left, right = (
        found.standard_error_v[middle, start : start + 10].max() for start in (20, columns - 30)
    )
    assert left == pytest.approx(right, rel=0.05)


def test_repeated_readings_are_averaged() -> None:
    uv = grid(6, 6)
    potential = wave(uv)
    twice = kriged(np.concatenate([uv, uv]), np.concatenate([potential + 0.01, potential - 0.01]))
    once = kriged(uv, potential)
    assert (twice.readings, twice.places) == (72, 36)
    np.testing.assert_allclose(twice.potential_v, once.potential_v, rtol=0, atol=1e-9)
    assert "72 readings, averaged at 36 places," in twice.how


def test_readings_side_by_side_do_not_tear_the_map() -> None:
    """1 µm apart across the border of two cells, 80 mV apart: the mean, no overshoot."""
    uv = grid(6, 6)
    border = 0.2 + 0.5 * (1.0 / 25)
    pair = np.array([[border - 5e-7, 0.2], [border + 5e-7, 0.2]])
    found = kriged(np.concatenate([uv, pair]), np.append(wave(uv), [-0.34, -0.26]))
    assert found.places in (36, 37)
    assert found.potential_v.min() > -0.45
    assert found.potential_v.max() < -0.15


def test_the_measurement_is_the_least_nugget_and_not_in_the_error() -> None:
    uv = grid(10, 10)
    found = kriged(uv, wave(uv), np.full(100, 0.01))
    assert found.variogram.nugget_v2 == pytest.approx(1e-4, rel=1e-9)
    # 100 readings average the noise of one.
    assert np.median(found.standard_error_v) < 0.01


@pytest.mark.parametrize("stretch", [(1.0, 0.01), (0.01, 0.01), (1e3, 1e3)])
@pytest.mark.parametrize("offset", [0.0, 1e5])
def test_scales_and_offsets(stretch: tuple[float, float], offset: float) -> None:
    cells = np.stack(np.meshgrid(np.arange(10.0), np.arange(10.0)), axis=-1).reshape(-1, 2)
    uv = cells * stretch + offset
    found = kriged(uv, -0.3 + 0.02 * cells[:, 0])
    assert np.isfinite(found.potential_v).all()
    assert found.pitch_m == pytest.approx(stretch, rel=1e-4)
    assert (found.u_m[0], found.u_m[-1]) == pytest.approx((uv[0, 0], uv[-1, 0]), abs=1e-9)
    across = found.potential_v[found.potential_v.shape[0] // 2]
    along = np.interp(found.u_m, uv[:10, 0], -0.3 + 0.02 * np.arange(10))
    np.testing.assert_allclose(across, along, rtol=0, atol=5e-3)


def test_a_map_has_at_most_200_by_200_nodes_over_all_readings() -> None:
    uv = grid(150, 100, 0.05)
    found = kriged(uv, wave(uv))
    assert found.potential_v.shape == (200, 200)
    assert np.isfinite(found.potential_v).all()
    assert (found.places, found.readings) == (15000, 15000)
    small = kriged(grid(3, 3), wave(grid(3, 3)))
    assert small.potential_v.shape == (20, 20)


def test_readings_nearer_than_nodes_are_averaged() -> None:
    rng = np.random.default_rng(11)
    uv = grid(420, 420, 0.01)
    found = kriged(uv, wave(uv) + 0.02 * rng.normal(size=len(uv)))
    assert found.readings == 420 * 420
    assert found.places <= 40_000
    assert np.isfinite(found.potential_v).all()
    u, v = np.meshgrid(found.u_m, found.v_m)
    truth = wave(np.column_stack([u.ravel(), v.ravel()])).reshape(u.shape)
    # More readings than a neighbourhood holds have gone into each value.
    assert np.sqrt(np.mean((found.potential_v - truth) ** 2)) < 0.02 / np.sqrt(32)


def test_the_same_readings_make_the_same_bytes() -> None:
    rng = np.random.default_rng(12)
    uv = rng.random((3000, 2)) * 4
    first, again = kriged(uv, wave(uv)), kriged(uv, wave(uv))
    assert first.potential_v.tobytes() == again.potential_v.tobytes()
    assert first.standard_error_v.tobytes() == again.standard_error_v.tobytes()
    assert first.variogram == again.variogram


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(-5, 5, width=32),
            st.floats(-5, 5, width=32),
            st.floats(-1, 0.5, width=32) | st.just(float("nan")) | st.sampled_from([-0.35, -0.2]),
        ),
        max_size=40,
    ),
    st.sampled_from([None, 0.0, 0.01, float("nan")]),
    st.sampled_from([0.0, 1e5]),
    st.booleans(),
)
def test_any_readings_make_a_finite_map_or_none(
    rows: list[tuple[float, float, float]], sd: float | None, offset: float, on_a_lattice: bool
) -> None:
    table = np.array(rows, dtype=float).reshape(-1, 3)
    uv = (np.round(table[:, :2]) if on_a_lattice else table[:, :2]) + offset
    found = krige(uv, table[:, 2], None if sd is None else np.full(len(table), sd))
    if isinstance(found, NoMap):
        assert found.why
        return
    drawn = np.isfinite(found.potential_v)
    assert drawn.any()
    assert (drawn == np.isfinite(found.standard_error_v)).all()
    assert (found.standard_error_v[drawn] >= 0).all()
    values = table[:, 2][np.isfinite(table[:, 2])]
    reach = np.ptp(values) + 1e-9
    assert found.potential_v[drawn].min() >= values.min() - reach
    assert found.potential_v[drawn].max() <= values.max() + reach


def slab(folder: Path, number: int) -> tuple[np.ndarray, np.ndarray]:
    """Places (m) and potentials (V) of a real slab, 29 × 9 readings 101.6 mm apart."""
    with (folder / "half_cell" / f"slab{number}.csv").open() as file:
        rows = list(csv.reader(file))[1:]
    potential = 1e-3 * np.array([[float(cell) for cell in row[1:]] for row in rows])
    return grid(potential.shape[1], potential.shape[0], 0.1016), potential.ravel()


@pytest.mark.real_data
@pytest.mark.parametrize("number", [1, 2, 3, 4])
def test_real_slabs_left_out_one_by_one(shared_data: Path, number: int) -> None:
    """Each reading from all others: within 10 mV, the standard's repeatability of an electrode."""
    uv, potential = slab(shared_data, number)
    assert len(potential) == 261
    found = kriged(uv, potential)
    error, variance = np.empty(261), np.empty(261)
    for k in range(261):
        rest = np.arange(261) != k
        near = Supports(uv[rest], potential[rest], 0.0)
        estimate, variance[k : k + 1] = kriged_at(near, found.variogram, uv[k : k + 1])
        error[k] = potential[k] - estimate[0]
    assert np.sqrt(np.mean(error**2)) < 0.010
    standardised = error / np.sqrt(variance)
    assert abs(standardised.mean()) < 0.1
    assert 0.5 < np.mean(standardised**2) < 1.5
