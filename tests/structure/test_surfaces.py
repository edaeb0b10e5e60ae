"""From a mission's structure to bounded surfaces: placing, cropping, sides and refusals."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from inspect_cli.errors import GeometryError, InputError
from inspect_cli.schema.geometry import (
    CylinderShape,
    Displacement,
    PlaneShape,
    Side,
    SphereShape,
)
from inspect_cli.schema.mission import CropBox, FitOptions, Mission, SurfaceSource
from inspect_cli.schema.primitives import displaced, primitive_of
from inspect_cli.spatial.arrays import Points, Structured
from inspect_cli.spatial.primitives import cylinder, plane, project, sphere
from inspect_cli.structure.patches import shortest_arc, shortest_span
from inspect_cli.structure.surfaces import believed_surfaces
from inspect_cli.structure.synthetic import noisy_cloud

MissionOn = Callable[..., Mission]

WALL = plane([2.0, 0.4, 1.2], [-1.0, 0.1, 0.0], [1.6, 1.2])


def save(path: Path, surface: Structured, noise_m: float = 0.002, count: int = 6000) -> Points:
    cloud = noisy_cloud(surface, count, noise_m, 0.1, np.random.default_rng(0))
    np.savetxt(path, cloud, fmt="%.6f", delimiter=",")
    return cloud


def test_scanned_wall(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "wall.csv", WALL)
    (believed,) = believed_surfaces(mission_on(wall=SurfaceSource(cloud="wall.csv")), tmp_path)
    shape = believed.shape
    assert isinstance(shape, PlaneShape)
    n = WALL["R_WS"][0][:, 2]
    assert np.degrees(np.arccos(np.dot(shape.normal, n))) < 0.05
    # The patch holds 99 % of the points of each coordinate: 1 % smaller, give or take.
    np.testing.assert_allclose(shape.size_m, [1.6, 1.2], rtol=0.03)
    np.testing.assert_allclose(shape.center_m, [2.0, 0.4, 1.2], atol=0.02)
    assert believed.fit is not None
    assert believed.fit.points == 6000
    assert believed.fit.inlier_share == pytest.approx(0.9, abs=0.03)
    assert believed.fit.rms_m == pytest.approx(0.002, rel=0.1)
    assert believed.source == "cloud wall.csv: 6000 points"


def test_plan_of_the_same_mission_is_the_same(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "wall.csv", WALL)
    alone = mission_on(wall=SurfaceSource(cloud="wall.csv"))
    second = mission_on(
        other=SurfaceSource(cloud="wall.csv", fit="plane"), wall=SurfaceSource(cloud="wall.csv")
    )
    believed = believed_surfaces(alone, tmp_path)[0]
    assert believed == believed_surfaces(alone, tmp_path)[0]
    assert believed == believed_surfaces(second, tmp_path)[1]


@pytest.mark.parametrize(("start", "sign"), [((0.0, 0.0), -1.0), ((5.0, 0.0), 1.0)])
def test_wall_faces_the_start(
    start: tuple[float, float], sign: float, tmp_path: Path, mission_on: MissionOn
) -> None:
    save(tmp_path / "wall.csv", WALL)
    mission = mission_on(wall=SurfaceSource(cloud="wall.csv"), start=start)
    shape = believed_surfaces(mission, tmp_path)[0].shape
    assert isinstance(shape, PlaneShape)
    assert np.sign(shape.normal[0]) == sign


@pytest.mark.parametrize(
    ("start", "given", "side"),
    [
        ((0.0, 0.0), None, "inside"),
        ((9.0, 0.0), None, "outside"),
        ((0.0, 0.0), "outside", "outside"),
    ],
)
def test_tank_is_touched_from_the_side_of_the_start(
    start: tuple[float, float],
    given: Side | None,
    side: Side,
    tmp_path: Path,
    mission_on: MissionOn,
) -> None:
    tank = cylinder([0.3, 0.0, 2.0], [0, 0.01, 1], 3.0, [1, 1, 0], [6.0, 2.4])
    save(tmp_path / "tank.csv", tank)
    source = SurfaceSource(cloud="tank.csv", fit="cylinder", options=FitOptions(side=given))
    shape = believed_surfaces(mission_on(tank=source, start=start), tmp_path)[0].shape
    assert isinstance(shape, CylinderShape)
    assert shape.side == side
    assert shape.radius_m == pytest.approx(3.0, abs=0.002)
    assert shape.axis[2] > 0.99
    np.testing.assert_allclose(shape.size_m, [6.0, 2.4], rtol=0.03)
    np.testing.assert_allclose(shape.center_m, [0.3, 0.0, 2.0], atol=0.03)
    np.testing.assert_allclose(shape.facing, [np.sqrt(0.5), np.sqrt(0.5), 0.0], atol=0.02)


def test_whole_pipe_faces_the_start(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "pipe.csv", cylinder([2, 0, 1], [0, 1, 0], 0.4, [1, 0, 0], [9.0, 2.0]))
    shape = believed_surfaces(mission_on(pipe=SurfaceSource(cloud="pipe.csv")), tmp_path)[0].shape
    assert isinstance(shape, CylinderShape)
    assert shape.size_m[0] == pytest.approx(2.0 * np.pi * shape.radius_m)
    np.testing.assert_allclose(shape.facing, [-1.0, 0.0, 0.0], atol=0.01)
    np.testing.assert_allclose(shape.axis, [0.0, 1.0, 0.0], atol=0.01)


@pytest.mark.parametrize("size", [(1.2, 0.8), (2.5, 2.0)])
def test_dome(size: tuple[float, float], tmp_path: Path, mission_on: MissionOn) -> None:
    dome = sphere([3.0, 0.0, 1.0], 1.5, [-1.0, 0.2, 0.5], size)
    save(tmp_path / "dome.csv", dome)
    shape = believed_surfaces(mission_on(dome=SurfaceSource(cloud="dome.csv")), tmp_path)[0].shape
    assert isinstance(shape, SphereShape)
    assert shape.radius_m == pytest.approx(1.5, abs=0.005)
    np.testing.assert_allclose(shape.size_m, size, rtol=0.05)
    np.testing.assert_allclose(shape.facing, dome["R_WS"][0][:, 2], atol=0.02)


def test_whole_ball(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "ball.csv", sphere([3.0, 0.0, 1.0], 0.5, [1, 0, 0], [9.0, 9.0]))
    shape = believed_surfaces(mission_on(ball=SurfaceSource(cloud="ball.csv")), tmp_path)[0].shape
    assert isinstance(shape, SphereShape)
    assert shape.size_m[0] == pytest.approx(2.0 * np.pi * shape.radius_m)
    assert shape.size_m[1] > 0.85 * 0.5 * np.pi


def test_shape_passes_through_displaced(tmp_path: Path, mission_on: MissionOn) -> None:
    shape = PlaneShape(center_m=(2.0, 0.0, 1.0), normal=(-1.0, 0.0, 0.0), size_m=(1.0, 1.0))
    placed = Displacement(rotate_deg=(0.0, 0.0, 20.0), translate_m=(0.1, 0.0, 0.3))
    (believed,) = believed_surfaces(
        mission_on(wall=SurfaceSource(shape=shape, placed=placed)), tmp_path
    )
    assert believed.shape == displaced(shape, placed)
    assert believed.fit is None


def test_placed_scan_is_the_placed_wall(tmp_path: Path, mission_on: MissionOn) -> None:
    placed = Displacement(
        rotate_deg=(0.0, 0.0, 20.0), about_m=(2.0, 0.0, 0.0), translate_m=(0.3, 0.0, 0.0)
    )
    save(tmp_path / "wall.csv", WALL)
    plain = believed_surfaces(mission_on(wall=SurfaceSource(cloud="wall.csv")), tmp_path)[0]
    moved = believed_surfaces(
        mission_on(wall=SurfaceSource(cloud="wall.csv", placed=placed)), tmp_path
    )[0]
    expected = displaced(plain.shape, placed)
    assert isinstance(moved.shape, PlaneShape)
    assert isinstance(expected, PlaneShape)
    np.testing.assert_allclose(moved.shape.normal, expected.normal, atol=1e-4)
    np.testing.assert_allclose(moved.shape.center_m, expected.center_m, atol=1e-3)


def test_crop_is_in_the_world_after_placing(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "wall.csv", WALL)
    source = SurfaceSource(
        cloud="wall.csv",
        placed=Displacement(translate_m=(10.0, 0.0, 0.0)),
        crop=CropBox(min_m=(11.0, -5.0, 1.2), max_m=(13.0, 5.0, 5.0)),
        options=FitOptions(voxel_m=0.02),
    )
    (believed,) = believed_surfaces(mission_on(wall=source), tmp_path)
    assert isinstance(believed.shape, PlaneShape)
    assert believed.shape.center_m[0] == pytest.approx(12.0, abs=0.02)
    # The lower half is cut off: half as high, and its middle a quarter higher.
    assert believed.shape.size_m[1] == pytest.approx(0.6, rel=0.05)
    assert believed.shape.center_m[2] == pytest.approx(1.5, abs=0.02)
    assert "in the crop" in believed.source
    assert "voxels of 0.02 m" in believed.source


def test_mesh(tmp_path: Path, mission_on: MissionOn) -> None:
    corners = [(2, -1, 0), (2, 1, 0), (2, 1, 2), (2, -1, 2)]
    text = "".join(f"v {x} {y} {z}\n" for x, y, z in corners) + "f 1 2 3\nf 1 3 4\n"
    (tmp_path / "wall.obj").write_text(text)
    (believed,) = believed_surfaces(mission_on(wall=SurfaceSource(mesh="wall.obj")), tmp_path)
    assert isinstance(believed.shape, PlaneShape)
    np.testing.assert_allclose(believed.shape.normal, [-1.0, 0.0, 0.0], atol=1e-9)
    np.testing.assert_allclose(believed.shape.size_m, [2.0, 2.0], rtol=0.02)
    np.testing.assert_allclose(believed.shape.center_m, [2.0, 0.0, 1.0], atol=0.02)


def test_patch_holds_its_points(tmp_path: Path, mission_on: MissionOn) -> None:
    cloud = save(tmp_path / "wall.csv", WALL, noise_m=0.0)
    believed = believed_surfaces(mission_on(wall=SurfaceSource(cloud="wall.csv")), tmp_path)[0]
    prim = primitive_of(believed.shape)
    uvw = np.array([project(prim, 0, p) for p in cloud])
    on_it = np.abs(uvw[:, 2]) < 0.001
    inside = np.all(np.abs(uvw[on_it, :2]) <= prim["half_size"][0], axis=1)
    assert 0.97 < inside.mean() < 1.0


def test_crop_that_leaves_nothing_tells_where_the_points_are(
    tmp_path: Path, mission_on: MissionOn
) -> None:
    save(tmp_path / "wall.csv", WALL)
    source = SurfaceSource(cloud="wall.csv", crop=CropBox(min_m=(50, 50, 50), max_m=(51, 51, 51)))
    with pytest.raises(GeometryError, match=r"wall\.csv.*leaves none of the 6000 points") as caught:
        believed_surfaces(mission_on(wall=source), tmp_path)
    assert "in the world they reach from [1.9" in str(caught.value)


def test_every_bad_surface_is_told_at_once(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "wall.csv", WALL)
    (tmp_path / "empty.ply").write_bytes(b"")
    mission = mission_on(
        wall=SurfaceSource(cloud="wall.csv"),
        floor=SurfaceSource(cloud="empty.ply"),
        roof=SurfaceSource(mesh="roof.stl"),
        tank=SurfaceSource(cloud="wall.csv", fit="cylinder"),
    )
    with pytest.raises(GeometryError) as caught:
        believed_surfaces(mission, tmp_path)
    places = [str(p.where) for p in caught.value.problems]
    assert len(places) == 3
    assert "empty.ply: structure 'floor'" in places[0]
    assert "roof.stl: structure 'roof'" in places[1]
    assert "wall.csv: structure 'tank'" in places[2]
    assert all(p.hint for p in caught.value.problems)


@pytest.mark.parametrize("file", ["../wall.csv", "/etc/hostname", "scans/../../wall.csv"])
def test_path_out_of_the_campaign_is_refused(
    file: str, tmp_path: Path, mission_on: MissionOn
) -> None:
    root = tmp_path / "campaign"
    root.mkdir()
    save(tmp_path / "wall.csv", WALL, count=500)
    with pytest.raises(InputError, match="outside of the campaign folder"):
        believed_surfaces(mission_on(wall=SurfaceSource(cloud=file)), root)


def test_link_out_of_the_campaign_is_refused(tmp_path: Path, mission_on: MissionOn) -> None:
    root = tmp_path / "campaign"
    root.mkdir()
    save(tmp_path / "wall.csv", WALL, count=500)
    (root / "wall.csv").symlink_to(tmp_path / "wall.csv")
    with pytest.raises(InputError, match="outside of the campaign folder"):
        believed_surfaces(mission_on(wall=SurfaceSource(cloud="wall.csv")), root)


def test_spans_by_hand() -> None:
    values = np.concatenate([np.linspace(0.0, 1.0, 99), [50.0]])
    assert shortest_span(values, 0.99) == (0.0, 1.0)
    # 340° … 20° across the cut at 0°, and a stray at 180°.
    angles = np.radians(np.concatenate([np.linspace(-20.0, 20.0, 199), [180.0]]))
    middle, width = shortest_arc(angles, 0.99)
    assert width == pytest.approx(np.radians(40.0), rel=0.01)
    assert np.cos(middle) == pytest.approx(1.0, abs=1e-4)
    assert shortest_arc(np.linspace(0.0, 6.28, 500), 0.99)[1] == pytest.approx(2.0 * np.pi)


def test_a_voxel_too_small_for_the_cloud_is_refused(tmp_path: Path, mission_on: MissionOn) -> None:
    save(tmp_path / "wall.csv", WALL)
    given = SurfaceSource(cloud="wall.csv", options=FitOptions(voxel_m=1.0e-9))
    with pytest.raises(GeometryError, match=r"structure 'wall'.*voxel_m 1e-09 is too small"):
        believed_surfaces(mission_on(wall=given), tmp_path)


def test_a_geo_referenced_scan_is_refused_until_it_is_placed(
    tmp_path: Path, mission_on: MissionOn
) -> None:
    away = np.array([465_000.0, 5_247_000.0, 400.0])
    cloud = noisy_cloud(WALL, 6000, 0.002, 0.1, np.random.default_rng(0))
    np.savetxt(tmp_path / "wall.csv", cloud + away, fmt="%.6f", delimiter=",")
    with pytest.raises(GeometryError, match=r"km from the start") as caught:
        believed_surfaces(mission_on(wall=SurfaceSource(cloud="wall.csv")), tmp_path)
    assert "placed: {translate_m: [-465002.0, -5247000.0, -401.0]}" in str(caught.value)
    back = Displacement(translate_m=(-away[0], -away[1], -away[2]))
    given = SurfaceSource(cloud="wall.csv", placed=back)
    (believed,) = believed_surfaces(mission_on(wall=given), tmp_path)
    np.testing.assert_allclose(believed.shape.center_m, [2.0, 0.4, 1.2], atol=0.02)
