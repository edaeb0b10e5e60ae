"""Local metres on the WGS 84 ellipsoid, against radii of curvature and a root finder."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from inspect_cli.exchange.earth import A_M, B_M, E2, earth_centred, geographic, on_earth
from inspect_cli.schema.survey import Georeference

ZURICH = Georeference(longitude_deg=8.5417, latitude_deg=47.3769, height_m=408.0)


def test_the_axes_of_the_ellipsoid() -> None:
    places = np.radians([[0.0, 0.0, 0.0], [90.0, 0.0, 0.0], [0.0, 90.0, 0.0]])
    expected = [[A_M, 0, 0], [0, A_M, 0], [0, 0, B_M]]
    np.testing.assert_allclose(earth_centred(places), expected, atol=1e-8)
    assert pytest.approx(6_356_752.3142, abs=1e-4) == B_M  # as NIMA TR8350.2 prints it


@pytest.mark.parametrize("latitude_deg", [-89.9, -33.0, 0.0, 47.4, 89.9])
@pytest.mark.parametrize("height_m", [-400.0, 0.0, 9000.0])
def test_geographic_inverts_earth_centred(latitude_deg: float, height_m: float) -> None:
    place = np.array([[np.radians(-150.0), np.radians(latitude_deg), height_m]])
    back = geographic(earth_centred(place))[0]
    # 1e-13° is 1e-8 m; rounding of coordinates of 6e6 m is 1e-9 m.
    np.testing.assert_allclose(back, [-150.0, latitude_deg, height_m], rtol=0, atol=1e-8)
    np.testing.assert_allclose(back[:2], [-150.0, latitude_deg], rtol=0, atol=2e-13)


def test_the_origin_stays_and_small_steps_follow_the_radii_of_curvature() -> None:
    """dφ = N / (M + h), dλ = E / ((N + h) cos φ), whose own error at 10 m is below 1e-4 m."""
    phi, h = np.radians(ZURICH.latitude_deg), ZURICH.height_m
    w2 = 1 - E2 * np.sin(phi) ** 2
    meridian, prime = A_M * (1 - E2) / w2**1.5, A_M / np.sqrt(w2)
    found = on_earth(np.array([[0, 0, 0], [10, 0, 0], [0, 10, 0], [0, 0, 10.0]]), ZURICH)
    np.testing.assert_allclose(found[0], [8.5417, 47.3769, 408.0], atol=1e-8)
    metres_e = np.radians(found[:, 0] - 8.5417) * (prime + h) * np.cos(phi)
    metres_n = np.radians(found[:, 1] - 47.3769) * (meridian + h)
    np.testing.assert_allclose(metres_e, [0, 10, 0, 0], atol=1e-4)
    np.testing.assert_allclose(metres_n, [0, 0, 10, 0], atol=1e-4)
    np.testing.assert_allclose(found[:, 2] - h, [0, 0, 0, 10], atol=1e-4)


def test_the_heading_turns_y_clockwise_from_north() -> None:
    turned = ZURICH.model_copy(update={"heading_deg": 90.0})
    y_is_east = on_earth(np.array([[0.0, 100.0, 0.0], [100.0, 0.0, 0.0]]), turned)
    plain = on_earth(np.array([[100.0, 0.0, 0.0], [0.0, -100.0, 0.0]]), ZURICH)
    np.testing.assert_allclose(y_is_east, plain, rtol=0, atol=1e-8)


def test_far_points_against_a_root_finder() -> None:
    p_W = np.array([[20_000.0, -30_000.0, 500.0]])
    reference = ZURICH.model_copy(update={"heading_deg": 30.0})
    found = on_earth(p_W, reference)[0]
    lon, lat = np.radians(ZURICH.longitude_deg), np.radians(ZURICH.latitude_deg)
    origin = earth_centred(np.array([[lon, lat, ZURICH.height_m]]))[0]

    def residual(place: np.ndarray) -> np.ndarray:
        """Where a place lies in east, north, up of the origin, by differences of the position."""
        p = earth_centred(np.array([[place[0], place[1], place[2] * 1e6]]))[0] - origin
        up = np.array([np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)])
        east = np.cross([0, 0, 1.0], up) / np.cos(lat)
        enu = np.array([p @ east, p @ np.cross(up, east), p @ up])
        # A compass bearing of 30° for y: its east is sin 30°, its north cos 30°.
        y = np.array([np.sin(np.pi / 6), np.cos(np.pi / 6), 0])
        x = np.array([np.cos(np.pi / 6), -np.sin(np.pi / 6), 0])
        local = np.array([enu @ x, enu @ y, enu[2]])
        return (local - p_W[0]) / 1e4

    solved = least_squares(residual, [lon, lat, 0.0], xtol=1e-15, ftol=1e-15, gtol=1e-15).x
    np.testing.assert_allclose(found[:2], np.degrees(solved[:2]), rtol=0, atol=1e-10)
    assert found[2] == pytest.approx(solved[2] * 1e6, abs=1e-4)
    # What a flat map would make of 36 km: the Earth falls away by d²/2R, 102 m.
    d2 = 20_000.0**2 + 30_000.0**2
    assert found[2] - 908.0 == pytest.approx(d2 / (2 * 6.38e6), rel=0.01)
