"""A surface's assessment as a whole: sums, edges and gaps."""

from __future__ import annotations

import numpy as np
import pytest
import shapely
from hypothesis import given, settings
from hypothesis import strategies as st
from surveyed import grid, readings

from inspect_cli.assessment.assess import Assessed, assess
from inspect_cli.assessment.classes import ASTM_CLASSES, VERDICTS, astm_class, combined_verdict
from inspect_cli.assessment.electrodes import basis_of, to_standard
from inspect_cli.assessment.findings import MAX_LISTED
from inspect_cli.schema.assessment import SurfaceAssessment


def counts(shares: object) -> dict[str, int]:
    return {share.name: share.count for share in shares}


def consistent(found: Assessed) -> None:
    """What holds of any survey."""
    s = found.summary
    assert SurfaceAssessment.model_validate_json(s.model_dump_json()) == s
    assert s.valid + s.invalid == s.points == len(found.readings)
    assert s.readings == s.points + s.basis.merged_readings
    assert sum(c.count for c in s.astm) == s.valid == sum(c.count for c in s.verdicts)
    assert sum(c.count for c in s.rates) == s.resistivity_known == sum(c.count for c in s.risks)
    assert sum(c.count for c in s.astm_by_rate) == s.valid == sum(c.count for c in s.astm_by_risk)
    for shares in (s.astm, s.verdicts):
        assert sum(c.share for c in shares) == pytest.approx(1.0 if s.valid else 0.0)
    assert (s.area_m2 is None) == bool(s.area_why)
    if s.area_m2 is not None and s.invalid_area_m2 is not None:
        for shares in (s.astm, s.verdicts):
            judged = sum(c.area_m2 or 0.0 for c in shares)
            assert judged + s.invalid_area_m2 == pytest.approx(s.area_m2)
    assert (s.potential is None) == bool(s.potential_why)
    assert s.mixture.verdict == "two populations" or s.mixture.why
    assert s.refinement.total >= len(s.refinement.greatest)
    assert s.gradient.minima >= s.gradient.active + s.gradient.not_judged


@settings(deadline=None, max_examples=150)
@given(
    st.lists(
        st.tuples(
            st.integers(0, 5),
            st.integers(0, 5),
            st.integers(-900, 200).map(float) | st.just(np.nan),
            st.floats(1.0, 2000.0) | st.just(np.nan),
        ),
        max_size=40,
    ),
    st.sampled_from([0.2, 0.3, 1.5]),
    st.sampled_from([0.0, 0.37]),
)
def test_any_survey_is_consistent(
    rows: list[tuple[int, int, float, float]], pitch_m: float, skew: float
) -> None:
    """Gaps, repeated readings, lines, single places: whatever the list."""
    uv = [[pitch_m * (a + skew * b), pitch_m * b] for a, b, _, _ in rows]
    given_readings = readings(uv, [r[2] for r in rows], [r[3] for r in rows])
    found = assess("deck", given_readings)
    consistent(found)
    for k, (e, rho) in enumerate(
        zip(found.readings.potential_v, found.readings.resistivity_ohm_m, strict=True)
    ):
        astm = None if found.astm[k] < 0 else ASTM_CLASSES[found.astm[k]]
        verdict = None if found.verdict[k] < 0 else VERDICTS[found.verdict[k]]
        assert astm == astm_class(e)
        assert verdict == combined_verdict(e, rho)


@settings(deadline=None)
@given(st.lists(st.integers(-12000, 6000).map(lambda k: k / 10), min_size=1, max_size=60))
def test_statistics_are_numpys_of_the_files_own_numbers(mv: list[float]) -> None:
    uv = np.column_stack([0.25 * np.arange(len(mv)), np.zeros(len(mv))])
    s = assess("deck", readings(uv, mv)).summary.potential
    assert s is not None
    file = np.array(mv)
    assert (s.min_mv, s.median_mv, s.max_mv) == (np.min(file), np.median(file), np.max(file))
    assert s.mean_mv == np.mean(file)
    for p in (5, 10, 25, 50, 75, 90, 95):
        assert getattr(s, f"p{p}_mv") == np.percentile(file, p, method="linear")


def test_statistics_after_a_conversion_are_exact_too() -> None:
    file = np.array([-301.0, -150.5, -444.0, -75.0])
    basis = basis_of("Ag/AgCl sat. KCl", 20.0)
    given_readings = readings(grid(4, 1, 0.2), 1e3 * to_standard(1e-3 * file, basis))
    s = assess("deck", given_readings, basis=basis).summary
    assert s.potential is not None
    assert s.potential.min_mv == -563.0
    assert s.potential.p25_mv == np.percentile(file - 119.0, 25)
    assert s.basis.electrode == "Ag/AgCl sat. KCl"


def test_nothing_was_read() -> None:
    found = assess("deck", readings(np.zeros((0, 2)), []))
    consistent(found)
    s = found.summary
    assert (s.points, s.area_m2, s.potential, s.spacing_m) == (0, None, None, None)
    assert s.area_why == "nothing was read"
    assert s.potential_why == "no reading is valid"
    assert counts(s.astm) == {"passive": 0, "uncertain": 0, "active": 0}


def test_a_single_reading() -> None:
    found = assess("deck", readings([[1.0, 2.0]], [-420.0], [80.0]))
    consistent(found)
    s = found.summary
    assert s.area_why == "a single place has no spacing; state the pitch"
    assert s.potential is not None
    assert (s.potential.p5_mv, s.potential.sd_mv) == (-420.0, None)
    assert "no neighbours" in s.gradient.why
    with_pitch = assess(
        "deck", readings([[1.0, 2.0]], [-420.0], [80.0]), cell_m=np.array([[0.5, 0.5]])
    ).summary
    assert with_pitch.area_m2 == pytest.approx(0.25)
    assert counts(with_pitch.verdicts)["active"] == 1


def test_only_invalid_readings_keep_their_area() -> None:
    found = assess("deck", readings(grid(4, 2, 0.5), [np.nan] * 8))
    consistent(found)
    assert found.summary.area_m2 == pytest.approx(2.0) == found.summary.invalid_area_m2
    assert found.summary.uncertainty.why == "no reading is valid"


def test_readings_farther_apart_than_the_gradient_reaches() -> None:
    s = assess("deck", readings(grid(3, 3, 1.2), np.linspace(-500, -100, 9))).summary
    assert "1.2 m apart" in s.gradient.why


def test_areas_and_tables_of_a_small_deck() -> None:
    mv = [[-100, -200, -351], [-350, -360, np.nan]]
    rho = [[50, np.nan, 40], [100, 150, 60]]
    found = assess("deck", readings(grid(3, 2, 0.5, 0.4), mv, rho))
    consistent(found)
    s = found.summary
    assert {c.name: (c.count, c.area_m2) for c in s.astm} == {
        "passive": (1, pytest.approx(0.2)),
        "uncertain": (2, pytest.approx(0.4)),
        "active": (2, pytest.approx(0.4)),
    }
    assert {c.name: c.count for c in s.verdicts} == {"none": 1, "possible": 3, "active": 1}
    assert s.area_m2 == pytest.approx(1.2)
    assert s.invalid_area_m2 == pytest.approx(0.2)
    table = {(c.astm_class, c.resistivity_class): c.count for c in s.astm_by_rate if c.count}
    assert table == {
        ("passive", "high"): 1,
        ("uncertain", None): 1,
        ("uncertain", "high"): 1,
        ("active", "very high"): 1,
        ("active", "low to moderate"): 1,
    }
    assert len(s.astm_by_rate) == 3 * 5


def test_a_region_bounds_what_is_measured() -> None:
    found = assess(
        "deck", readings(grid(4, 4, 0.5), [-100] * 16), region=shapely.box(0, 0, 1.5, 1.5)
    )
    consistent(found)
    assert found.summary.area_m2 == pytest.approx(2.25)


def test_repeated_readings_are_merged_and_told() -> None:
    uv = np.repeat(grid(3, 1, 0.2), 2, axis=0)
    found = assess("deck", readings(uv, [-300, -310, -100, -100, -200, np.nan]))
    consistent(found)
    s = found.summary
    assert (s.readings, s.points, s.basis.merged_readings) == (6, 3, 3)
    assert (s.repeatability.places, s.repeatability.degrees_of_freedom) == (2, 2)
    assert s.repeatability.sd_mv == pytest.approx(5.0)
    assert s.repeatability.greatest_sd_mv == pytest.approx(np.sqrt(50.0))
    assert s.potential is not None
    assert s.potential.min_mv == -305.0
    np.testing.assert_array_equal(found.merged.member, [0, 0, 1, 1, 2, 2])


def test_long_lists_are_cut_and_counted() -> None:
    mv = -100.0 - 300.0 * (np.indices((20, 20)).sum(axis=0) % 2)
    s = assess("deck", readings(grid(20, 20, 0.3), mv)).summary
    assert s.refinement.total == 2 * 20 * 19
    assert len(s.refinement.greatest) == MAX_LISTED
    assert s.mixture.verdict == "two populations"


def test_a_corroding_spot_is_named() -> None:
    uv = grid(11, 11, 0.25)
    spot = 5 * 11 + 5
    distance = np.linalg.norm(uv - uv[spot], axis=1)
    s = assess("deck", readings(uv, np.rint(-150 - 350 * np.exp(-(distance**2) / 0.18)))).summary
    (minimum,) = s.gradient.steepest
    assert (minimum.label, minimum.active, minimum.potential_mv) == (str(spot + 1), True, -500.0)
    assert minimum.rise_mv == pytest.approx(350.0, abs=3.0)
    assert s.refinement.greatest[0].difference_mv > 150.0
