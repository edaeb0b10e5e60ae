"""Repeated readings of a place become one point."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from surveyed import grid, readings

from inspect_cli.assessment.findings import disagreement, repeatability_findings
from inspect_cli.assessment.readings import Readings, merged, readings_of
from inspect_cli.schema.result import PointResult


def test_different_places_stay_as_they_are() -> None:
    given_readings = readings(grid(4, 3, 0.1016), np.linspace(-500.3, -100.1, 12))
    places = merged(given_readings)
    np.testing.assert_array_equal(places.readings.potential_v, given_readings.potential_v)
    np.testing.assert_array_equal(places.member, np.arange(12))
    assert places.repeatability_v is None
    assert places.degrees_of_freedom == 0


def test_a_place_has_the_mean_of_its_valid_readings_and_their_spread() -> None:
    uv = [[1, 0], [0, 0], [1, 0], [1, 0], [0, 0], [2, 0], [2, 0]]
    mv = [-300, -100, -310, -290, np.nan, np.nan, np.nan]
    rho = [100, 50, 300, 120, 70, np.nan, np.nan]
    places = merged(readings(uv, mv, rho))
    np.testing.assert_allclose(1e3 * places.readings.potential_v, [-300, -100, np.nan])
    np.testing.assert_allclose(places.readings.resistivity_ohm_m, [120, 60, np.nan])
    np.testing.assert_array_equal(places.counts, [3, 1, 0])
    np.testing.assert_array_equal(places.member, [0, 1, 0, 0, 1, 2, 2])
    np.testing.assert_array_equal(places.readings.labels, ["1", "2", "6"])
    np.testing.assert_allclose(1e3 * places.within_sd_v, [10.0, np.nan, np.nan])


@settings(deadline=None)
@given(
    st.lists(
        st.tuples(st.integers(0, 3), st.floats(-900, 100) | st.just(np.nan)),
        min_size=1,
        max_size=30,
    )
)
def test_pooled_repeatability(rows: list[tuple[int, float]]) -> None:
    """Against a loop over the places."""
    places = merged(readings([[u, 0.0] for u, _ in rows], [mv for _, mv in rows]))
    squares, freedom = 0.0, 0
    for at in {u for u, _ in rows}:
        values = np.array([mv for u, mv in rows if u == at and np.isfinite(mv)])
        point = places.readings.potential_v[places.readings.uv_m[:, 0] == at]
        assert len(point) == 1
        if len(values):
            assert 1e3 * point[0] == pytest.approx(values.mean(), abs=1e-9)
            squares += float(np.sum((values - values.mean()) ** 2))
            freedom += len(values) - 1
        else:
            assert np.isnan(point[0])
    assert places.degrees_of_freedom == freedom
    if freedom:
        assert places.repeatability_v == pytest.approx(1e-3 * np.sqrt(squares / freedom), abs=1e-9)


def test_readings_that_contradict_each_other_are_named() -> None:
    """More than 20 mV, whatever of it is rounding; invalid readings say nothing."""
    uv = [[u, 0.0] for u in (0, 0, 1, 1, 1, 2, 2, 3, 3, 4)]
    mv = [-300, -320, -100, -364, -150, -200, -221, -100, np.nan, -500]
    places = merged(readings(uv, mv))
    np.testing.assert_allclose(1e3 * places.spread_v, [20, 264, 21, 0, 0], atol=1e-9)
    found = repeatability_findings(places)
    assert (found.disagreeing, found.worst) == (2, "3")
    assert found.worst_spread_mv == pytest.approx(264.0)
    assert disagreement(found) == (
        "At 2 places the readings differ by more than 20 mV, most at the place of point 3, by "
        "264 mV; repeated readings should agree within 10 mV (ASTM C876).",
    )
    one = repeatability_findings(merged(readings(uv[2:5], mv[2:5])))
    assert disagreement(one)[0].startswith("The readings at the place of point 1 differ by 264 mV")
    assert disagreement(repeatability_findings(merged(readings(uv[:2], mv[:2])))) == ()


def test_equal_readings_of_a_place_keep_their_digits() -> None:
    places = merged(readings([[0.1, 0.2]] * 3, [-350.0] * 3))
    assert places.readings.potential_v[0] == 1e-3 * -350.0
    assert places.repeatability_v == 0.0


def test_no_readings() -> None:
    places = merged(readings(np.zeros((0, 2)), []))
    assert len(places.readings) == 0
    assert places.repeatability_v is None


def test_arrays_that_do_not_belong_together_are_refused() -> None:
    two = readings([[0, 0], [1, 0]], [-100, -200])
    with pytest.raises(ValueError, match=r"potential_v has shape \(1,\), not \(2,\)"):
        Readings(
            two.labels, two.uv_m, two.potential_v[:1], two.resistivity_ohm_m, two.measurement_sd_v
        )
    with pytest.raises(ValueError, match="not finite"):
        readings([[0, np.nan]], [-100])


def point(label: str, uv_m: tuple[float, float] | None, mv: float | None) -> PointResult:
    return PointResult(
        index=0,
        label=label,
        valid=mv is not None,
        reason="",
        p_W=(0.0, 0.0, 0.0),
        uv_m=uv_m,
        potential_mv=mv,
        resistance_ohm=None,
        resistivity_ohm_m=None,
        probe_force_n=None,
        contact_s=0.0,
        astm_class=None,
        corrosion=None,
    )


def test_points_of_a_result() -> None:
    points = [point("a", (0.0, 1.0), -350.0), point("b", None, -1.0), point("c", (1.0, 1.0), None)]
    found = readings_of(points, 0.003)
    assert found.labels.tolist() == ["a", "c"]
    np.testing.assert_array_equal(found.valid, [True, False])
    np.testing.assert_array_equal(found.measurement_sd_v, [0.003, 0.003])
    assert len(readings_of([], 0.003)) == 0
