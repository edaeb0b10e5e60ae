"""What each point of a plan stands for."""

from __future__ import annotations

import pytest
from builders import grid, plan, points
from rigid import RigidVehicle

SINGLES = ((2.0, 0.0, 1.5), (2.0, 0.3, 1.5), (2.0, 0.0, 1.9), (2.0, 0.3, 1.9))


def cells(*tasks):
    return [target.cell_m for target in plan(RigidVehicle(), *tasks).targets]


def test_a_grids_points_stand_for_its_pitch_each():
    found = cells(grid(rows=1, columns=2, pitch_m=0.25), grid(rows=1, columns=3, pitch_m=0.05))
    assert found == [(0.25, 0.25)] * 2 + [(0.05, 0.05)] * 3


def test_single_points_stand_for_their_typical_spacing():
    """Given as a grid, along u and v; as a list, the distance to the second nearest."""
    assert cells(points(*SINGLES)) == [pytest.approx((0.3, 0.4))] * 4
    strewn = ((2.0, 0.0, 1.5), (2.0, 0.3, 1.52), (2.0, 0.05, 1.91))
    # Their sides are 0.301, 0.413 and 0.463 m; two points have the longest as their second.
    assert cells(points(*strewn)) == [pytest.approx((0.463, 0.463), abs=5e-4)] * 3


def test_single_points_are_seen_with_what_else_is_read_on_their_surface():
    one, other = points(*SINGLES[:2]), points(*SINGLES[2:])
    assert cells(one, other) == [pytest.approx((0.3, 0.4))] * 4
    silent = other | {"sensor": "none"}
    assert cells(one, silent) == [pytest.approx((0.3, 0.3))] * 4
    alone = points((2.0, 0.1, 1.5))
    assert cells(alone) == [None]
    found = cells(alone, grid(rows=3, columns=3, pitch_m=0.2, offset_m=(0.1, 0.0)))
    assert found[0] == pytest.approx((0.2, 0.2))


def test_what_touches_nothing_stands_for_nothing():
    hold = {"hold": {"position_m": (0.0, 0.0, 1.5), "duration_s": 1.0}}
    assert cells(hold) == [None]
