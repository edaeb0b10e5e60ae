"""Typical potentials by RILEM TC 154-EMC."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.conditions import CONDITIONS, Condition, compatible, rilem_conditions


@pytest.mark.parametrize(
    ("mv", "typical_of"),
    [
        (-1000.0, {"water-saturated, without oxygen"}),
        (-900.0, {"water-saturated, without oxygen"}),
        (-899.0, set()),
        (-600.0, {"moist, chloride-contaminated"}),
        (-400.0, {"moist, chloride-contaminated", "moist, carbonated"}),
        (-401.0, {"moist, chloride-contaminated"}),
        (-399.0, {"moist, carbonated"}),
        (-201.0, {"moist, carbonated"}),
        (-200.0, {"moist, chloride-free", "moist, carbonated"}),
        (
            0.0,
            {
                "moist, chloride-free",
                "moist, carbonated",
                "dry, carbonated",
                "dry, non-carbonated",
            },
        ),
        (101.0, {"dry, carbonated", "dry, non-carbonated"}),
        (201.0, set()),
        (np.nan, set()),
    ],
)
def test_conditions(mv: float, typical_of: set[str]) -> None:
    assert set(rilem_conditions(1e-3 * mv)) == typical_of


@pytest.mark.parametrize("condition", CONDITIONS)
def test_both_ends_of_a_range_belong_to_it(condition: Condition) -> None:
    for end_mv, beyond_mv in ((condition.low_mv, -0.001), (condition.high_mv, 0.001)):
        assert condition.name in rilem_conditions(1e-3 * end_mv)
        assert condition.name not in rilem_conditions(1e-3 * (end_mv + beyond_mv))


def test_the_ranges_are_those_of_the_recommendation() -> None:
    """As published, mV CSE, in the order of the recommendation's table."""
    ends = [(c.low_mv, c.high_mv) for c in CONDITIONS]
    assert ends == [(-1000, -900), (-600, -400), (-200, 100), (-400, 100), (0, 200), (0, 200)]


def test_arrays_agree_with_single_potentials() -> None:
    mv = np.array([[-950.0, -500.0, -300.0], [50.0, 150.0, np.nan]])
    table = compatible(1e-3 * mv)
    assert table.shape == (2, 3, len(CONDITIONS))
    for at in np.ndindex(mv.shape):
        names = tuple(c.name for c, yes in zip(CONDITIONS, table[at], strict=True) if yes)
        assert names == rilem_conditions(float(1e-3 * mv[at]))
