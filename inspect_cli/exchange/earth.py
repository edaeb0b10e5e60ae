"""From local metres to longitude, latitude and height on WGS 84.

A point (x, y, z) is turned into east, north and up at the georeference's origin,

    E = x cos h + y sin h,     N = −x sin h + y cos h,     U = z,

with h the heading of the y axis, clockwise from north; moved into the Earth-centred frame,

    p = p₀ + E e_E + N e_N + U e_U;

and back to longitude λ = atan2(p_y, p_x), latitude φ and height by Bowring's iteration
(B. R. Bowring, "Transformation from spatial to geographical coordinates", Survey Review 23
(1976) 323–327). No plane is laid tangent to the Earth, so the error does not grow with the
distance: below 1e-8 m within a thousand kilometres and as many metres of height. Ellipsoid:
a = 6 378 137 m, 1/f = 298.257 223 563 (NIMA TR8350.2).
"""

from __future__ import annotations

import numpy as np

from inspect_cli.schema.survey import Georeference
from inspect_cli.spatial.arrays import Points

A_M = 6_378_137.0
FLATTENING = 1.0 / 298.257223563
B_M = A_M * (1.0 - FLATTENING)
E2 = FLATTENING * (2.0 - FLATTENING)
E2_SECOND = E2 / (1.0 - E2)
ITERATIONS = 3


def on_earth(p_W: Points, reference: Georeference) -> Points:
    """(n, 3) longitude in degrees, latitude in degrees, height above the ellipsoid in m.

    Args:
        p_W: (n, 3), m, z up at the origin.
        reference: where the origin lies.
    """
    lon, lat = np.radians(reference.longitude_deg), np.radians(reference.latitude_deg)
    h = np.radians(reference.heading_deg)
    east = p_W[:, 0] * np.cos(h) + p_W[:, 1] * np.sin(h)
    north = -p_W[:, 0] * np.sin(h) + p_W[:, 1] * np.cos(h)
    axes = np.array(
        [
            [-np.sin(lon), np.cos(lon), 0.0],
            [-np.sin(lat) * np.cos(lon), -np.sin(lat) * np.sin(lon), np.cos(lat)],
            [np.cos(lat) * np.cos(lon), np.cos(lat) * np.sin(lon), np.sin(lat)],
        ]
    )
    centre = earth_centred(np.array([[lon, lat, reference.height_m]]))
    return geographic(centre + np.column_stack([east, north, p_W[:, 2]]) @ axes)


def earth_centred(places: Points) -> Points:
    """(n, 3), m, Earth-centred, of (n, 3) longitude and latitude in rad, height in m."""
    lon, lat, height = places.T
    curvature = A_M / np.sqrt(1.0 - E2 * np.sin(lat) ** 2)
    across = (curvature + height) * np.cos(lat)
    up = ((1.0 - E2) * curvature + height) * np.sin(lat)
    return np.column_stack([across * np.cos(lon), across * np.sin(lon), up])


def geographic(p: Points) -> Points:
    """(n, 3) longitude and latitude in degrees, height in m, of Earth-centred points in m."""
    across = np.hypot(p[:, 0], p[:, 1])
    beta = np.arctan2(p[:, 2] * A_M, across * B_M)  # the parametric latitude
    lat = beta
    for _ in range(ITERATIONS):
        lat = np.arctan2(
            p[:, 2] + E2_SECOND * B_M * np.sin(beta) ** 3,
            across - E2 * A_M * np.cos(beta) ** 3,
        )
        beta = np.arctan2((1.0 - FLATTENING) * np.sin(lat), np.cos(lat))
    # Along the normal, so that it holds at the poles as well as at the equator.
    root = np.sqrt(1.0 - E2 * np.sin(lat) ** 2)
    height = across * np.cos(lat) + p[:, 2] * np.sin(lat) - A_M * root
    return np.column_stack([np.degrees(np.arctan2(p[:, 1], p[:, 0])), np.degrees(lat), height])
