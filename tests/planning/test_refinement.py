"""Where the refinement rule asks for points, and where it does not."""

from __future__ import annotations

from builders import wall

from inspect_cli.planning.refinement import Measured, places_between
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.tasks.coverage import Coverage, Refinement

PRIM = primitive_of(wall(size=(2.0, 2.0)))
COVERAGE = Coverage(on="wall", pitch_m=0.25)


def lattice(*rows):
    """Readings by label, row by row from the top, a quarter of a metre apart."""
    places = [(0.25 * i, -0.25 * j, mv) for j, row in enumerate(rows) for i, mv in enumerate(row)]
    return {str(k): Measured((u, v), mv) for k, (u, v, mv) in enumerate(places, 1)}


def test_between_neighbours_that_differ_by_more_than_150_mv():
    found = places_between(PRIM, COVERAGE, Refinement(), lattice([-100, -250, -401]))
    assert found == {"2-3": (0.375, 0.0)}


def test_not_across_a_diagonal():
    """Only 4 differs; its neighbours are 2 and 3, and 1 lies across."""
    found = places_between(PRIM, COVERAGE, Refinement(), lattice([-100, -100], [-100, -400]))
    assert set(found) == {"2-4", "3-4"}


def test_the_greatest_differences_first():
    readings = lattice([-100, -300, -800, -100])
    found = places_between(PRIM, COVERAGE, Refinement(max_points=2), readings)
    assert list(found) == ["3-4", "2-3"]


def test_a_finer_pitch_gives_more_points_between():
    rule = Refinement(pitch_m=0.1, difference_mv=200)
    found = places_between(PRIM, COVERAGE, rule, lattice([-100, -350]))
    assert list(found) == ["1-2.1", "1-2.2"]


def test_a_tiny_pitch_stops_at_the_most_points():
    rule = Refinement(pitch_m=1e-12, difference_mv=200, max_points=3)
    found = places_between(PRIM, COVERAGE, rule, lattice([-100, -350]))
    assert list(found) == ["1-2.1", "1-2.2", "1-2.3"]


def test_a_missing_reading_has_no_neighbours():
    readings = lattice([-100, -400, -100])
    del readings["2"]
    assert places_between(PRIM, COVERAGE, Refinement(), readings) == {}
