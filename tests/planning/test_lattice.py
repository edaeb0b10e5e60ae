"""Lattices on surfaces: pitch along the surface, margins, counts."""

from __future__ import annotations

import numpy as np
import pytest
from builders import ball, column, wall

from inspect_cli.planning.lattice import along_m, between, lattice
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.primitives import point_at


def points_of(prim, places):
    return np.array([point_at(prim, 0, u, v) for u, v in places])


def nearest_m(points):
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    return apart.min(axis=1)


def test_a_vault_of_4_m_by_3_m_at_a_quarter_metre():
    """Half a pitch from the edge: 16 × 12 points, each exactly one pitch from the next."""
    prim = primitive_of(column(radius=2.75, size=(4.0, 3.0), side="inside"))
    places = np.array(lattice(prim, 0.25, 0.125, (0.0, 0.0)))
    assert len(places) == 192
    assert np.abs(places).max(axis=0) == pytest.approx([1.875, 1.375])
    assert np.diff(np.unique(places[:, 0].round(9))) == pytest.approx(0.25)
    assert np.diff(np.unique(places[:, 1].round(9))) == pytest.approx(0.25)
    # A chord is shorter than its arc by s³/24r².
    chord_m = 0.25 - 0.25**3 / (24 * 2.75**2)
    assert nearest_m(points_of(prim, places)) == pytest.approx(chord_m, rel=1e-6)


@pytest.mark.parametrize("shape", [wall(size=(1.0, 0.7)), column(radius=0.6, size=(1.0, 0.7))])
@pytest.mark.parametrize("offset", [(0.0, 0.0), (0.03, -0.08)])
def test_a_developable_lattice_is_full(shape, offset):
    """Nothing is over the margin, and no further row or column would fit."""
    prim = primitive_of(shape)
    u, v = np.array(lattice(prim, 0.15, 0.05, offset)).T
    for x, half in ((u, 0.45), (v, 0.30)):
        assert np.abs(x).max() <= half + 1e-9
        assert x.max() + 0.15 > half
        assert x.min() - 0.15 < -half
    assert len(u) == len(np.unique(u.round(9))) * len(np.unique(v.round(9)))


def test_places_go_row_by_row_from_the_top():
    places = lattice(primitive_of(wall(size=(0.5, 0.5))), 0.2, 0.1, (0.0, 0.0))
    rows = [v for _, v in places]
    assert rows == sorted(rows, reverse=True)
    assert [u for u, _ in places[:2]] == sorted(u for u, _ in places[:2])


def test_a_whole_column_leaves_no_points_too_close_at_its_seam():
    radius_m = 0.5
    prim = primitive_of(column(radius=radius_m, size=(2 * np.pi * radius_m, 0.6)))
    places = lattice(prim, 0.25, 0.125, (0.0, 0.0))
    u = np.unique(np.array(places)[:, 0].round(9))
    assert 0.25 <= 2 * np.pi * radius_m - np.ptp(u) < 0.5


@pytest.mark.parametrize("size", [(1.0, 1.2), (2.0, 2.0), (3.0, 3.0), (2 * np.pi, np.pi)], ids=str)
def test_spheres_have_neighbours_within_the_pitch(size):
    """Never closer than 0.7 pitches, each within √2 pitches of another in a further row."""
    pitch_m = 0.2
    prim = primitive_of(ball(radius=1.0, size=size))
    places = lattice(prim, pitch_m, 0.1, (0.0, 0.0))
    points = points_of(prim, places)
    apart = np.linalg.norm(points[:, None] - points[None], axis=2)
    np.fill_diagonal(apart, np.inf)
    assert apart.min() >= 0.7 * pitch_m
    assert apart.min(axis=1).max() <= 1.42 * pitch_m
    v = np.array(places)[:, 1].round(9)
    for row in np.unique(v)[:-1]:
        above = np.unique(v)[np.searchsorted(np.unique(v), row) + 1]
        assert apart[np.ix_(v == row, v == above)].min() <= 1.42 * pitch_m


def test_a_whole_sphere_is_covered_everywhere():
    """The area per point is near the pitch squared, and nothing is far from every point."""
    prim = primitive_of(ball(radius=1.0, size=(2 * np.pi, np.pi)))
    points = points_of(prim, lattice(prim, 0.2, 0.1, (0.0, 0.0)))
    assert len(points) == pytest.approx(4 * np.pi / 0.2**2, rel=0.05)
    rng = np.random.default_rng(0)
    n = rng.normal(size=(2000, 3))
    anywhere = np.array([2.5, 0.0, 1.5]) + n / np.linalg.norm(n, axis=1)[:, None]
    far = np.linalg.norm(anywhere[:, None] - points[None], axis=2).min(axis=1)
    assert far.max() <= 0.2


def test_nothing_fits_within_the_margin():
    assert lattice(primitive_of(wall(size=(1.0, 0.2))), 0.25, 0.125, (0.0, 0.0)) == []


def test_distances_along_the_surface():
    assert along_m(primitive_of(wall()), (0.0, 0.0), (0.3, 0.4)) == pytest.approx(0.5)
    around = primitive_of(column(radius=0.5, size=(np.pi, 1.0)))
    assert along_m(around, (1.5, 0.0), (-1.5, 0.0)) == pytest.approx(np.pi - 3.0)
    globe = primitive_of(ball(radius=2.0, size=(1.0, 1.0)))
    # Along a meridian the great circle is the meridian itself.
    assert along_m(globe, (0.1, -0.2), (0.1, 0.4)) == pytest.approx(0.6)


def test_places_between():
    prim = primitive_of(wall())
    assert list(between(prim, (0.0, 0.0), (0.25, 0.0), 0.125)) == [(0.125, 0.0)]
    assert list(between(prim, (0.0, 0.0), (0.25, 0.0), 0.3)) == []
    thirds = list(between(prim, (0.0, 0.0), (0.0, 0.3), 0.1))
    assert np.array(thirds) == pytest.approx(np.array([[0.0, 0.1], [0.0, 0.2]]))
