"""Maps of surveys: a few nodes left out, a few points between the lines."""

from __future__ import annotations

from types import SimpleNamespace

import pytest

from inspect_cli.reporting.figures_map import potential_grid
from inspect_cli.reporting.points import ReadPoint


def lattice(columns=4, rows=3, without=(), more=()):
    """Points of a lattice at 0.25 m with their potentials, −(100 u + 10 v) mV."""
    places = [(0.25 * i, 0.25 * j) for j in range(rows) for i in range(columns)]
    kept = [place for k, place in enumerate(places) if k not in without]
    return [
        ReadPoint(SimpleNamespace(uv_m=(u, v), potential_mv=-(100 * u + 10 * v)), None)
        for u, v in (*kept, *more)
    ]


def test_a_node_that_was_left_out_is_a_hole():
    u, v, table = potential_grid(lattice(without=[5]))
    assert (u, v) == (pytest.approx([0.0, 0.25, 0.5, 0.75]), pytest.approx([0.0, 0.25, 0.5]))
    assert table[1][1] is None
    assert table[1][2] == pytest.approx(-52.5)
    assert sum(mv is None for row in table for mv in row) == 1


def test_too_many_holes_are_no_grid():
    assert potential_grid(lattice(without=[0, 5])) is None


def test_points_between_the_lines_change_nothing():
    refined = lattice(more=[(0.125, 0.25), (0.5, 0.375)])
    assert potential_grid(refined) == potential_grid(lattice())
