"""The pitch and the hull of surveys whose pitch and outline are known."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.hull import measured_hull, typical_pitch


def grid(columns: int, rows: int, pitch_u: float, pitch_v: float) -> np.ndarray:
    u, v = np.meshgrid(np.arange(columns) * pitch_u, np.arange(rows) * pitch_v)
    return np.column_stack([u.ravel(), v.ravel()])


@pytest.mark.parametrize(
    ("columns", "rows", "pitch_u", "pitch_v"),
    [(9, 29, 0.1, 0.1), (2, 12, 0.5, 0.2), (3, 3, 1.0, 1.0), (10, 10, 1.1, 0.011), (90, 80, 1, 2)],
)
def test_a_grid_has_its_pitches(columns: int, rows: int, pitch_u: float, pitch_v: float) -> None:
    pitch = typical_pitch(grid(columns, rows, pitch_u, pitch_v))
    assert pitch == pytest.approx([pitch_u, pitch_v], rel=1e-9)


def test_places_that_scatter_about_a_grid_keep_its_pitches() -> None:
    rng = np.random.default_rng(2)
    uv = grid(12, 12, 0.3, 0.3)
    assert typical_pitch(uv + 0.02 * rng.normal(size=uv.shape)) == pytest.approx(0.3, rel=0.15)


def test_scattered_places_have_one_pitch_whatever_their_outline() -> None:
    uv = np.random.default_rng(3).random((8000, 2)) * [40.0, 5.0]
    along, across = typical_pitch(uv)
    # The windows are as elongated as the survey, and edges along their borders are long.
    assert along == pytest.approx(across, rel=0.4)
    # 40 readings per m²: their mean nearest distance is 0.08 m, their spacing 0.16 m.
    assert 0.08 < along < 0.24


def test_borders_and_corners_of_the_hull_are_inside() -> None:
    """A square ring: nodes at every quarter of a pitch, the borders' included."""
    uv = grid(13, 13, 1.0, 1.0)
    ring = uv[np.abs(uv - 6.0).max(axis=1) > 3.5]
    hull = measured_hull(ring, ring, np.ones(2))
    nodes = np.stack(np.meshgrid(np.arange(-4, 53), np.arange(-4, 53)), axis=-1).reshape(-1, 2) / 4
    inside = hull.contains(nodes, np.zeros(len(nodes), dtype=bool))
    distance = np.abs(nodes - 6.0).max(axis=1)
    assert inside[(distance <= 6.0) & (distance >= 4.0)].all()
    assert not inside[distance > 6.0].any()
    assert not inside[distance < 2.0].any()


def test_crowded_nodes_are_inside_up_to_the_outermost_reading() -> None:
    uv = grid(5, 5, 1.0, 1.0)
    readings = np.concatenate([uv - 0.25, uv + 0.25])
    hull = measured_hull(uv, readings, np.ones(2))
    nodes = np.array([[-0.2, -0.2], [-0.3, -0.3]])
    assert hull.contains(nodes, np.array([True, True])).tolist() == [True, False]
    assert hull.contains(nodes, np.array([False, False])).tolist() == [False, False]
