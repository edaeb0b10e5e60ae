"""Fits of 100,000 points, 30 % of them outliers, with 3 mm of noise.

The yardstick is Open3D's RANSAC for planes, with 100 drawings of three points, on the same cloud.
Open3D fits no spheres and cylinders, so their limits are ratios to its planes as well.
"""

from __future__ import annotations

from collections.abc import Iterator
from time import process_time

import numpy as np

from inspect_cli.scans.files import open3d
from inspect_cli.structure.fitting import fit_primitive
from inspect_cli.structure.synthetic import bench_surface, noisy_cloud
from tests.bench.rows import Row, ratio

ROUNDS = 5
POINTS, OUTLIER_SHARE, NOISE_M, INLIER_M = 100_000, 0.3, 0.003, 0.02
DRAWINGS = 100
LIMITS = {"plane": 0.17, "sphere": 0.28, "cylinder": 0.6}


def measure() -> Iterator[Row]:
    """The time of each kind over Open3D's, and the worst error of a radius."""
    errors_mm = []
    for kind, limit in LIMITS.items():
        surface = bench_surface(kind)
        clouds = [
            noisy_cloud(surface, POINTS, NOISE_M, OUTLIER_SHARE, np.random.default_rng(seed))
            for seed in range(1 + ROUNDS)
        ]

        def ours_s(k: int, kind=kind, surface=surface, clouds=clouds) -> float:
            begun = process_time()
            fit = fit_primitive(clouds[k], kind, INLIER_M, np.random.default_rng(k))
            took_s = process_time() - begun
            if kind != "plane":
                errors_mm.append(1e3 * abs(fit.radius_m - float(surface["radius"][0])))
            return took_s

        yield ratio(
            f"fit.{kind}_over_open3d",
            limit,
            "Open3D's RANSAC of a plane in the same cloud",
            ours_s,
            lambda k, clouds=clouds: _open3d_s(clouds[k]),
            ROUNDS,
        )
    yield Row("fit.radius_error_mm", max(errors_mm), "mm", 0.5)


def _open3d_s(points: np.ndarray) -> float:
    library = open3d()
    cloud = library.geometry.PointCloud(library.utility.Vector3dVector(points))
    library.utility.random.seed(0)
    begun = process_time()
    # With probability 1 it does not stop early, whatever share of the cloud is a plane.
    cloud.segment_plane(INLIER_M, 3, DRAWINGS, probability=1.0)
    return process_time() - begun
