"""The simulated scanner: its geometry and noise, and the built-in scans made again."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from inspect_cli.scans.clouds import read_cloud
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.primitives import primitives_of
from inspect_cli.simulation.scanner import Scanner, scan
from inspect_cli.spatial.primitives import plane, sphere

AHEAD = {"position_W": (0.0, 0.0, 1.25), "looking_at_W": (2.0, 0.0, 1.25)}


@pytest.mark.parametrize(("name", "noise_m"), [("wall.ply", 0.001), ("wall_noisy.ply", 0.003)])
def test_the_built_in_scans_are_what_they_say(root: Path, name: str, noise_m: float) -> None:
    truth = load_mission(root / "missions" / "nine_point_half_cell.yaml").truth
    wall = truth.structure["wall"].geometry
    assert wall is not None
    scanner = Scanner(**AHEAD, field_of_view_deg=(76, 66), step_deg=1.4, noise_m=noise_m)
    made = scan(scanner, primitives_of([wall]), np.random.default_rng(7))
    kept = read_cloud(root / "missions" / "scans" / name).points
    # The file keeps single precision: 2⁻²⁴ of 3 m, and rays may differ in the last digit.
    np.testing.assert_allclose(kept, made, rtol=0, atol=5e-7)


def test_noise_is_along_the_ray_and_as_large_as_stated() -> None:
    ball = sphere([0.0, 0.0, 0.0], 2.0, [1.0, 0.0, 0.0], [6.0, 6.0], side=-1.0)
    inside = Scanner((0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (60.0, 40.0), 0.5, noise_m=0.01)
    points = scan(inside, ball, np.random.default_rng(1))
    noise = np.linalg.norm(points, axis=1) - 2.0
    n = len(points)
    assert n == 121 * 81
    # 4.5 standard deviations of a mean and of a standard deviation over n samples.
    assert abs(noise.mean()) < 4.5 * 0.01 / np.sqrt(n)
    assert abs(noise.std() / 0.01 - 1.0) < 4.5 / np.sqrt(2 * n)


def test_rays_that_meet_nothing_leave_no_point() -> None:
    small = plane([2.0, 0.0, 0.0], [-1.0, 0.0, 0.0], [0.2, 0.2])
    points = scan(
        Scanner((0.0, 0.0, 0.0), (2.0, 0.0, 0.0), (40.0, 40.0), 1.0, 0.0),
        small,
        np.random.default_rng(0),
    )
    assert np.abs(points[:, 1:]).max() <= 0.1 + 1e-12
    # atan(0.1/2) = 2.86°: five raster lines each way.
    assert len(points) == 25
