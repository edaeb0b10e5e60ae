"""Contour levels and lines of kriged maps."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.classes import ACTIVE_BELOW_V, PASSIVE_ABOVE_V
from inspect_cli.assessment.contours import contour_levels, contour_lines
from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.assessment.variogram import Variogram


def tilted() -> KrigedMap:
    """E = −0.1 − 0.1 u over 4 m × 1 m, without a corner."""
    u, v = np.linspace(0, 4, 41), np.linspace(0, 1, 11)
    potential = np.tile(-0.1 - 0.1 * u, (11, 1))
    potential[:6, 30:] = np.nan
    flat = Variogram("spherical", 0.0, 0.0, 1.0)
    return KrigedMap(u, v, potential, 0.0 * potential, flat, 9, 9, (0.5, 0.5), "")


@pytest.mark.parametrize(
    ("lowest", "highest"), [(-0.6, 0.05), (-0.36, -0.19), (-0.352, -0.348), (-0.201, -0.199)]
)
def test_class_edges_in_between_are_levels(lowest: float, highest: float) -> None:
    levels = contour_levels(lowest, highest)
    for edge in (PASSIVE_ABOVE_V, ACTIVE_BELOW_V):
        assert (edge in levels) == (lowest <= edge <= highest)
    assert list(levels) == sorted(set(levels))
    assert all(lowest <= level <= highest for level in levels)


@pytest.mark.parametrize(
    ("lowest", "highest", "step"),
    [(-0.9, 0.1, 0.05), (-0.33, -0.15, 0.05), (-0.3, -0.21, 0.025), (-0.24, -0.21, 0.01)],
)
def test_the_interval_follows_the_range(lowest: float, highest: float, step: float) -> None:
    levels = contour_levels(lowest, highest)
    assert len(levels) >= 4 or step == 0.05
    assert np.diff(levels) == pytest.approx(step)


def test_a_flat_map_has_no_levels() -> None:
    assert contour_levels(-0.1234, -0.1231) == ()


def test_lines_stand_where_the_potential_is_theirs() -> None:
    lines = contour_lines(tilted())
    # The extremes touch the border alone.
    inner = [line for line in lines if -0.49 < line.level_v < -0.11]
    assert [round(1e3 * line.level_v) for line in inner] == list(range(-450, -149, 50))
    for line in inner:
        np.testing.assert_allclose(line.uv_m[:, 0], -10 * (line.level_v + 0.1), atol=1e-9)
        # Where there is no map there is no line: right of 3 m its lower half is missing.
        assert line.uv_m[:, 1].min() == pytest.approx(0.6 if line.level_v < -0.391 else 0.0)
