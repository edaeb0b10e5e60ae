"""Surveys in coordinates of a national grid, and some that reach absurdly far."""

from __future__ import annotations

from typing import Any

import numpy as np
import pytest
from surveyed import grid, readings

from inspect_cli.assessment.assess import assess
from inspect_cli.assessment.kriging import KrigedMap, krige
from inspect_cli.spatial.arrays import Points, Vector

EASTING_NORTHING = np.array([500_000.0, 5_200_000.0])
"""Whose doubles are a nanometre apart."""
STREWN = np.round(np.random.default_rng(5).uniform(0.0, [2.0, 1.4], (250, 2)), 4)
PLACES = {
    "grid": grid(21, 14, 0.1016),
    "decimal grid": grid(21, 14, 0.1),
    "L": np.array([p for p in grid(21, 14, 0.1) if p[0] < 0.95 or p[1] < 0.55]),
    "strewn": STREWN,
    "many strewn": np.round(np.random.default_rng(6).uniform(0.0, [20.0, 14.0], (2500, 2)), 4),
    "line aslant": np.column_stack([np.linspace(0, 2, 15), np.linspace(0, 1, 15)]),
}


def potential_mv(uv_m: Points) -> Vector:
    bell = np.exp(-((uv_m[:, 0] - 1.0) ** 2 + (uv_m[:, 1] - 0.7) ** 2) / 0.3)
    return -200.0 - 250.0 * bell + 20.0 * np.sin(7.0 * uv_m[:, 0]) * np.cos(5.0 * uv_m[:, 1])


def numbers(value: Any) -> list[Any]:
    """All that a summary holds, but for places."""
    if isinstance(value, dict):
        kept = {k: v for k, v in value.items() if k not in ("uv_m", "midpoint_m")}
        return [leaf for item in kept.values() for leaf in numbers(item)]
    if isinstance(value, list | tuple):
        return [leaf for item in value for leaf in numbers(item)]
    return [value]


@pytest.mark.parametrize("name", PLACES)
def test_findings_do_not_depend_on_where_the_coordinates_begin(name: str) -> None:
    uv = PLACES[name]
    near = assess("s", readings(uv, potential_mv(uv)))
    far = assess("s", readings(uv + EASTING_NORTHING, potential_mv(uv)))
    here, there = numbers(near.summary.model_dump()), numbers(far.summary.model_dump())
    assert len(here) == len(there) > 50
    for a, b in zip(here, there, strict=True):
        assert b == (pytest.approx(a, rel=1e-6) if isinstance(a, float) else a)
    assert near.cells is not None
    assert far.cells is not None
    np.testing.assert_allclose(far.cells.area_m2, near.cells.area_m2, rtol=1e-6)
    for k in range(len(uv)):
        moved = far.cells.corners_of(k) - EASTING_NORTHING
        for extreme in (np.min, np.max):
            wanted = extreme(near.cells.corners_of(k), axis=0)
            np.testing.assert_allclose(extreme(moved, axis=0), wanted, atol=1e-6)


@pytest.mark.parametrize("name", [name for name in PLACES if name != "line aslant"])
def test_maps_do_not_depend_on_where_the_coordinates_begin(name: str) -> None:
    uv = PLACES[name]
    near = krige(uv, 1e-3 * potential_mv(uv), None)
    far = krige(uv + EASTING_NORTHING, 1e-3 * potential_mv(uv), None)
    assert isinstance(near, KrigedMap)
    assert isinstance(far, KrigedMap)
    np.testing.assert_allclose(far.u_m - EASTING_NORTHING[0], near.u_m, atol=1e-6)
    np.testing.assert_allclose(far.v_m - EASTING_NORTHING[1], near.v_m, atol=1e-6)
    np.testing.assert_allclose(far.potential_v, near.potential_v, rtol=1e-6)
    np.testing.assert_allclose(far.standard_error_v, near.standard_error_v, rtol=1e-6)


@pytest.mark.parametrize("apart_m", [1e4, 1e7, 2e8])
def test_two_surveys_far_apart_in_one_list(apart_m: float) -> None:
    """Seen from so far, either is a point, and all that is asked for is an answer."""
    uv = np.concatenate([STREWN, STREWN + np.array([apart_m, 0.0])])
    found = assess("s", readings(uv, potential_mv(np.concatenate([STREWN, STREWN]))))
    assert found.summary.points == found.summary.valid == 500
    assert found.area_m2 is not None
    assert np.isfinite(found.area_m2).all()
    assert found.area_m2.sum() < 500.0  # nothing of what lies between them
    drawn = krige(uv, found.readings.potential_v, None)
    if isinstance(drawn, KrigedMap):
        assert np.ptp(drawn.u_m) > 0.99 * apart_m
