"""A simulated terrestrial laser scanner: how the built-in scans were made.

The scanner stands at one place and measures one range per direction of a regular raster of
azimuth and elevation. The noise of a range is Gaussian along the ray with a stated standard
deviation; directions are exact. Rays that meet nothing leave no point.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.spatial.arrays import Points, Structured
from inspect_cli.spatial.primitives import raycast

MAX_RANGE_M = 60.0


@dataclass(frozen=True)
class Scanner:
    """Where the scanner stands, what it looks at and how well it measures."""

    position_W: tuple[float, float, float]
    looking_at_W: tuple[float, float, float]
    field_of_view_deg: tuple[float, float] = (80.0, 60.0)
    step_deg: float = 1.0
    noise_m: float = 0.001


def scan(scanner: Scanner, surfaces: Structured, rng: np.random.Generator) -> Points:
    """Points (n, 3) in W, m, of the surfaces that the scanner sees."""
    origin = np.array(scanner.position_W)
    ahead = np.array(scanner.looking_at_W) - origin
    azimuth_0 = np.arctan2(ahead[1], ahead[0])
    elevation_0 = np.arctan2(ahead[2], np.hypot(ahead[0], ahead[1]))
    half = 0.5 * np.radians(scanner.field_of_view_deg)
    counts = np.round(np.array(scanner.field_of_view_deg) / scanner.step_deg).astype(int) + 1
    azimuth, elevation = np.meshgrid(
        azimuth_0 + np.linspace(-half[0], half[0], counts[0]),
        elevation_0 + np.linspace(-half[1], half[1], counts[1]),
    )
    rays = np.stack(
        [
            np.cos(elevation) * np.cos(azimuth),
            np.cos(elevation) * np.sin(azimuth),
            np.sin(elevation),
        ],
        axis=-1,
    ).reshape(-1, 3)
    ranges = np.empty(len(rays))
    raycast(surfaces, origin, rays, MAX_RANGE_M, ranges)
    hit = np.isfinite(ranges)
    measured = ranges[hit] + scanner.noise_m * rng.standard_normal(int(hit.sum()))
    points: Points = origin + measured[:, None] * rays[hit]
    return points
