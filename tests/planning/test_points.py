"""Where the points of a task lie."""

from __future__ import annotations

import numpy as np
import pytest
from builders import ball, column, grid, points, wall

from inspect_cli.planning.points import points_of_task
from inspect_cli.schema.mission import Task
from inspect_cli.schema.primitives import primitive_of


def touch_points(task, shape, first=1, cell_m=None):
    return points_of_task(
        Task.model_validate(task), primitive_of(shape), first, "contact_ndt", cell_m
    )


def test_grid_on_a_wall_runs_left_to_right_and_downwards():
    # Seen from −x, where the vehicle is, right is −y.
    found = touch_points(grid(rows=2, columns=3, pitch_m=0.2, offset_m=(0.1, 0.3)), wall())
    assert [p.label for p in found] == ["1", "2", "3", "4", "5", "6"]
    y, z = 0.0 - 0.1, 1.5 + 0.3
    expected = [(2.0, y - (c - 1) * 0.2, z + (0.5 - r) * 0.2) for r in range(2) for c in range(3)]
    np.testing.assert_allclose([p.p_WC for p in found], expected, atol=1e-12)
    assert not any(p.fault for p in found)


def test_grid_on_a_column_is_spaced_by_arc_length():
    radius, pitch = 0.5, 0.1
    found = touch_points(grid(columns=5, pitch_m=pitch), column(radius=radius))
    p = np.array([point.p_WC for point in found])
    np.testing.assert_allclose(np.hypot(p[:, 0] - 2.0, p[:, 1]), radius, atol=1e-12)
    chord = 2.0 * radius * np.sin(pitch / radius / 2.0)
    np.testing.assert_allclose(np.linalg.norm(np.diff(p, axis=0), axis=1), chord, atol=1e-12)


def test_numbers_go_on_from_the_task_before():
    assert [p.label for p in touch_points(grid(columns=2), wall(), first=10)] == ["10", "11"]


def test_given_points_are_projected():
    # 4 cm in front of a ball of 1 m around (2.5, 0, 1.5)
    toward = np.array([-0.9, 0.1, 0.2])
    toward /= np.linalg.norm(toward)
    given = tuple(float(x) for x in np.array([2.5, 0.0, 1.5]) + 1.04 * toward)
    (point,) = touch_points(points(given), ball())
    np.testing.assert_allclose(point.p_WC, np.array([2.5, 0.0, 1.5]) + toward, atol=1e-12)
    np.testing.assert_allclose(point.n_W, toward, atol=1e-12)
    assert point.fault == ""


@pytest.mark.parametrize(
    ("at_m", "words"),
    [
        ((1.8, 0.0, 1.5), ["a point off the surface", "0.200 m", "0.050"]),
        ((2.2, 0.0, 1.5), ["a point off the surface", "0.200 m"]),
        ((2.0, 0.0, 2.6), ["outside the patch", "v 1.100 m", "±1.000 m"]),
        ((2.0, -1.7, 1.5), ["outside the patch", "u 1.700 m", "±1.500 m"]),
    ],
)
def test_points_that_cannot_be_touched_say_why(at_m, words):
    (point,) = touch_points(points(at_m), wall())
    for word in words:
        assert word in point.fault


def test_grid_that_just_fits_has_no_fault():
    found = touch_points(grid(rows=3, columns=4, pitch_m=1.0), wall())
    assert not any(p.fault for p in found)
    too_wide = touch_points(grid(columns=4, pitch_m=1.01), wall())
    assert [bool(p.fault) for p in too_wide] == [True, False, False, True]
