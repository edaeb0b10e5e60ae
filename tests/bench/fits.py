"""Fits of 100,000 points, 30 % of them outliers, with 3 mm of noise.

The limits are the times of a widely used library of point cloud algorithms on such a machine; its
cylinder's radius was off by 4.5 mm.
"""

from __future__ import annotations

from collections.abc import Iterator
from statistics import median
from time import perf_counter

import numpy as np

from inspect_cli.structure.fitting import fit_primitive
from inspect_cli.structure.synthetic import bench_surface, noisy_cloud
from tests.bench.rows import Row

SEEDS = range(1, 6)
POINTS, OUTLIER_SHARE, NOISE_M, INLIER_M = 100_000, 0.3, 0.003, 0.02
LIMITS_MS = {"plane": 25.0, "sphere": 39.0, "cylinder": 1080.0}


def measure() -> Iterator[Row]:
    """The median time of each kind, and the worst radius of all."""
    worst_mm = 0.0
    for kind, limit_ms in LIMITS_MS.items():
        surface = bench_surface(kind)
        _fit(kind, surface, 0)  # compiles
        fits = [_fit(kind, surface, seed) for seed in SEEDS]
        yield Row(f"fit.{kind}_ms", median(took_ms for took_ms, _ in fits), "ms", limit_ms)
        if kind != "plane":
            radius_m = float(surface["radius"][0])
            errors_mm = [1e3 * abs(fitted_m - radius_m) for _, fitted_m in fits]
            worst_mm = max(worst_mm, *errors_mm)
    yield Row("fit.radius_error_mm", worst_mm, "mm", 0.5)


def _fit(kind, surface, seed: int) -> tuple[float, float]:
    """(ms, radius in m) of one fit."""
    cloud = noisy_cloud(surface, POINTS, NOISE_M, OUTLIER_SHARE, np.random.default_rng(seed))
    begun = perf_counter()
    fit = fit_primitive(cloud, kind, INLIER_M, np.random.default_rng(seed))
    return 1e3 * (perf_counter() - begun), fit.radius_m
