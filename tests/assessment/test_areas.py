"""What each reading stands for: against arithmetic, and against shapely's own diagrams."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from hypothesis.extra.numpy import arrays
from surveyed import grid

from inspect_cli.assessment.areas import Cells, cells_of
from inspect_cli.assessment.spacing import spacing_of, spacing_of_cells


def cells(uv_m: object, pitch_m: float | None = None, region: object = None) -> Cells:
    uv = np.asarray(uv_m, dtype=np.float64).reshape(-1, 2)
    if pitch_m is None:
        found = cells_of(uv, spacing_of(uv), region)
    else:
        stated = np.full(uv.shape, pitch_m)
        found = cells_of(uv, spacing_of_cells(stated), region, stated)
    assert found is not None
    return found


@settings(deadline=None)
@given(
    st.integers(1, 12),
    st.integers(1, 12),
    st.sampled_from([0.05, 0.1016, 0.25, 1 / 3]),
    st.sampled_from([0.05, 0.1524, 0.5]),
    st.floats(-100, 100),
)
def test_each_reading_of_a_full_grid_stands_for_its_pitches(
    columns: int, rows: int, pitch_u: float, pitch_v: float, offset: float
) -> None:
    if columns == rows == 1:
        return
    uv = grid(columns, rows, pitch_u, pitch_v) + offset
    if min(columns, rows) == 1:  # of a single row the other pitch is taken to be the same
        pitch_u = pitch_v = pitch_u if rows == 1 else pitch_v
    found = cells(uv)
    np.testing.assert_allclose(found.area_m2, pitch_u * pitch_v, rtol=1e-7)
    np.testing.assert_array_equal(found.count, 4)


def test_a_missing_reading_leaves_its_share_unmeasured() -> None:
    uv = grid(5, 5, 0.2)
    found = cells(np.delete(uv, [6, 12, 13, 24], axis=0))
    assert found.area_m2.sum() == pytest.approx(21 * 0.04)
    np.testing.assert_allclose(found.area_m2, 0.04)


def test_a_point_between_shares_with_its_neighbours() -> None:
    """A point in the middle of a grid's square takes a diamond of half the square."""
    uv = np.vstack([grid(4, 4, 1.0), [[1.5, 1.5]]])
    found = cells(uv)
    assert found.area_m2[-1] == pytest.approx(0.5)
    assert found.area_m2.sum() == pytest.approx(16.0)
    np.testing.assert_allclose(found.area_m2[[5, 6, 9, 10]], 1.0 - 0.125)


def test_a_single_reading_needs_a_pitch() -> None:
    one = np.zeros((1, 2))
    assert cells_of(one, spacing_of(one)) is None
    assert cells(one, 0.3).area_m2[0] == pytest.approx(0.09)
    none = np.zeros((0, 2))
    assert cells_of(none, spacing_of(none)) is None


def test_readings_on_a_slanted_line() -> None:
    """Inner cells are the strips between bisectors, cut by the hull of squares around the ends."""
    steps = np.array([0.0, 1.0, 2.0, 3.0, 4.0])
    found = cells(np.outer(steps, [0.6, 0.8]))
    assert found.spacing.u_m == pytest.approx(1.0)
    # A band swept by a unit square that moves along (0.6, 0.8) is 0.6 + 0.8 wide.
    np.testing.assert_allclose(found.area_m2[1:-1], 1.4, rtol=1e-9)
    assert found.area_m2.sum() == pytest.approx(4 * 1.4 + 1.0)


def test_an_isolated_reading_does_not_claim_the_world() -> None:
    rng = np.random.default_rng(3)
    uv = np.vstack([rng.uniform(0, 5, (200, 2)), [[60.0, 60.0]]])
    found = cells(uv)
    assert found.area_m2[-1] <= (3 * found.spacing.u_m) ** 2
    assert found.area_m2.max() < 5.0


def test_a_reading_in_the_middle_of_a_ring_has_as_many_corners() -> None:
    angles = 2 * np.pi * np.arange(100) / 100
    ring = np.column_stack([np.cos(angles), np.sin(angles)])
    uv = np.vstack([[[0.0, 0.0]], ring])
    found = cells(uv, 2.0)
    # The bisectors are tangents to the circle of radius ½: a regular polygon around it.
    assert found.count[0] == 100
    assert found.area_m2[0] == pytest.approx(100 * 0.25 * np.tan(np.pi / 100))


@settings(deadline=None)
@given(arrays(np.float64, (12, 2), elements=st.integers(0, 400).map(lambda k: 0.01 * k)))
def test_cells_are_those_of_shapelys_diagram(places: np.ndarray) -> None:
    """Each is shapely's Voronoi cell, the rectangle of reach and the region, by intersection."""
    uv = np.unique(places, axis=0)
    if len(uv) < 2:
        return
    found = cells(uv)
    scale = np.array([found.spacing.u_m, found.spacing.v_m])
    reach = (0.5 if found.spacing.is_grid else 1.5) * scale
    lower, upper = uv - 0.5 * scale, uv + 0.5 * scale
    hull = shapely.convex_hull(
        shapely.union_all(shapely.box(lower[:, 0], lower[:, 1], upper[:, 0], upper[:, 1]))
    )
    world = shapely.box(-2000, -2000, 2000, 2000)
    diagram = shapely.voronoi_polygons(shapely.multipoints(uv), extend_to=world)
    for k, place in enumerate(uv):
        point = shapely.Point(place)
        cell = next(part for part in diagram.geoms if part.intersects(point))
        box = shapely.box(*(place - reach), *(place + reach))
        expected = cell.intersection(box).intersection(hull).area
        assert found.area_m2[k] == pytest.approx(expected, rel=1e-6, abs=1e-9)
        corners = shapely.Polygon(found.corners_of(k))
        assert corners.area == pytest.approx(found.area_m2[k], rel=1e-9)
        assert corners.covers(point)


@settings(deadline=None)
@given(arrays(np.float64, (9, 2), elements=st.floats(-3, 3)))
def test_cells_do_not_overlap_whatever_the_places(places: np.ndarray) -> None:
    uv = np.unique(np.round(places, 6), axis=0)
    if len(uv) < 2:
        return
    found = cells(uv)
    for k, place in enumerate(uv):
        # A convex cell whose corners are nearest to its own place lies in its Voronoi cell.
        corners = found.corners_of(k)
        own = np.linalg.norm(corners - place, axis=1)
        others = np.linalg.norm(corners[:, np.newaxis] - uv, axis=2)
        assert np.all(own <= others.min(axis=1) + 1e-9)
    assert np.all(found.area_m2 > 0.0)


def test_a_region_cuts_the_cells() -> None:
    """A wall of 2 by 1.5 m with a window, read on a grid whose edge is 0.25 m in."""
    uv = grid(4, 3, 0.5) + 0.25
    window = shapely.box(0.9, 0.4, 1.3, 0.8)
    wall = shapely.box(0, 0, 2, 1.5) - window
    found = cells(uv, None, wall)
    assert found.area_m2.sum() == pytest.approx(3.0 - 0.16)
    narrow = cells(uv, None, shapely.box(0, 0, 1.25, 1.5))
    np.testing.assert_allclose(narrow.area_m2.reshape(3, 4), [[0.25, 0.25, 0.125, 0.0]] * 3)


def test_a_full_grid_of_strewn_points_covers_its_region() -> None:
    """Of strewn points cells leave little of the hull open: the real gaps."""
    uv = np.random.default_rng(4).uniform(0, 10, (2000, 2))
    assert 0.97 * 100.0 < cells(uv).area_m2.sum() < 1.03 * 100.0
