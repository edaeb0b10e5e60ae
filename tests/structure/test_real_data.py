"""Fits of real measurements: a surveyed tank, and a mug on a table."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.scans.clouds import read_cloud
from inspect_cli.schema.geometry import CylinderShape, PlaneShape
from inspect_cli.schema.mission import CropBox, Fit, FitOptions, Mission, SurfaceSource
from inspect_cli.structure.fitting import fit_primitive
from inspect_cli.structure.surfaces import believed_surfaces

pytestmark = pytest.mark.real_data

MissionOn = Callable[..., Mission]


@pytest.mark.parametrize("inlier_m", [0.02, 0.05, 0.1])
@pytest.mark.parametrize("seed", range(3))
def test_tank_survey(inlier_m: float, seed: int, shared_data: Path) -> None:
    cloud = read_cloud(shared_data / "tank" / "survey.csv")
    assert len(cloud.points) == 574
    fit = fit_primitive(cloud.points, "cylinder", inlier_m, np.random.default_rng(seed))
    assert fit.radius_m == pytest.approx(7.583, abs=0.005)
    tilt = np.arccos(abs(fit.direction[2]))
    assert tilt == pytest.approx(1.8e-3, abs=0.3e-3)
    far = np.abs(fit.residuals_m) > 0.05
    assert np.count_nonzero(far) == 35
    if inlier_m <= 0.05:
        assert not np.any(fit.inliers & far)
    assert not np.any(fit.used & far)


@pytest.mark.parametrize("kind", ["cylinder", "auto"])
def test_tank_as_a_planned_surface(kind: Fit, shared_data: Path, mission_on: MissionOn) -> None:
    source = SurfaceSource(cloud="tank/survey.csv", fit=kind, options=FitOptions(inlier_m=0.05))
    (tank,) = believed_surfaces(mission_on(tank=source), shared_data)
    assert isinstance(tank.shape, CylinderShape)
    assert tank.shape.side == "outside"
    assert tank.fit is not None
    assert tank.fit.points - tank.fit.inliers == 35
    assert tank.fit.parameter_sd["radius_m"] < 0.001


def test_mug_on_table(shared_data: Path, mission_on: MissionOn) -> None:
    mission = mission_on(
        table=SurfaceSource(
            cloud="mug_on_table.pcd", fit="plane", options=FitOptions(inlier_m=0.01)
        ),
        mug=SurfaceSource(
            cloud="mug_on_table.pcd",
            fit="cylinder",
            crop=CropBox(min_m=(-0.04, -0.02, 0.60), max_m=(0.15, 0.12, 0.80)),
            options=FitOptions(inlier_m=0.005),
        ),
    )
    table, mug = believed_surfaces(mission, shared_data)
    assert "97920 invalid dropped" in table.source
    assert isinstance(table.shape, PlaneShape)
    assert table.fit is not None
    assert table.fit.inlier_share > 0.5
    assert isinstance(mug.shape, CylinderShape)
    assert mug.shape.radius_m == pytest.approx(0.039, abs=0.002)
    angle = np.degrees(np.arccos(abs(np.dot(mug.shape.axis, table.shape.normal))))
    assert angle < 3.0
