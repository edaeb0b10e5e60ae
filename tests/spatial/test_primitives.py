"""Primitives against finite differences, hand-computed hits and brute-force sampling."""

from __future__ import annotations

import time

import numpy as np
import pytest

from inspect_cli.errors import GeometryError
from inspect_cli.schema.geometry import CylinderShape, Displacement, PlaneShape, SphereShape
from inspect_cli.schema.primitives import displaced, primitive_of, primitives_of
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.primitives import (
    PRIMITIVE,
    cylinder,
    level_axes,
    normal_at,
    patch_distance,
    plane,
    point_at,
    project,
    raycast,
    sphere,
)

CASES = {
    "wall": plane([2.0, 0.3, 1.0], [-1.0, 0.2, 0.1], [1.6, 0.9]),
    "floor": plane([2.0, 0.3, 1.0], [0.01, 0.02, 1.0], [1.6, 0.9]),
    "sphere": sphere([0.2, -1.0, 2.0], 0.8, [1.0, 0.5, 0.3], [1.2, 1.0]),
    "wide sphere": sphere([0.2, -1.0, 2.0], 0.8, [1.0, 0.5, -0.3], [4.2, 2.2], -1.0),
    "cylinder": cylinder([0.2, -1.0, 2.0], [0.1, 0.2, 1.0], 0.7, [-1.0, 0.3, 0.5], [1.1, 1.5]),
    "inside": cylinder([0.2, -1.0, 2.0], [1.0, 0.2, 0.1], 2.5, [0.0, 0.3, -0.5], [3.1, 1.5], -1.0),
    "pipe": cylinder([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.3, [1.0, 0.0, 0.0], [9.9, 1.0]),
}


@pytest.fixture(params=list(CASES), ids=list(CASES))
def prim(request: pytest.FixtureRequest) -> Structured:
    return CASES[request.param]


def sample_uv(prim: Structured, count: int) -> Vector:
    rng = np.random.default_rng(4)
    return rng.uniform(-1.0, 1.0, (count, 2)) * prim["half_size"][0]


def test_frame_is_a_rotation(prim: Structured) -> None:
    R_WS = prim["R_WS"][0]
    np.testing.assert_allclose(R_WS @ R_WS.T, np.eye(3), atol=1e-14)
    assert np.linalg.det(R_WS) == pytest.approx(1.0)


def test_wall_seen_from_outside_has_u_right_and_v_up() -> None:
    # Looking along +x at a wall that faces us, right is −y.
    np.testing.assert_allclose(
        level_axes([-1.0, 0.0, 0.0]), np.column_stack([[0, -1, 0], [0, 0, 1], [-1, 0, 0]])
    )


def test_floor_and_ceiling_take_u_from_the_world() -> None:
    np.testing.assert_allclose(level_axes([0.0, 0.0, 1.0]), np.eye(3))
    np.testing.assert_allclose(level_axes([0.0, 0.0, -2.0]), np.diag([1.0, -1.0, -1.0]))
    # A floor's normal with noise keeps its coordinates.
    tilted = level_axes([-0.003, 0.004, 1.0])
    np.testing.assert_allclose(tilted[:, 0], [1.0, 0.0, 0.0], atol=0.006)


def test_cylinder_on_the_wall_has_u_right_and_v_up() -> None:
    prim = cylinder([5.0, 0.0, 1.0], [0.0, 0.0, 1.0], 1.0, [-1.0, 0.0, 0.7], [1.0, 1.0])
    np.testing.assert_allclose(point_at(prim, 0, 0.0, 0.0), [4.0, 0.0, 1.0], atol=1e-15)
    right = point_at(prim, 0, 0.5 * np.pi, 0.25)
    np.testing.assert_allclose(right, [5.0, -1.0, 1.25], atol=1e-15)


def test_normal_is_the_cross_product_of_finite_differences(prim: Structured) -> None:
    step = 1e-5
    for u, v in sample_uv(prim, 20):
        along_u = point_at(prim, 0, u + step, v) - point_at(prim, 0, u - step, v)
        along_v = point_at(prim, 0, u, v + step) - point_at(prim, 0, u, v - step)
        expected = np.cross(along_u, along_v)
        expected *= prim["side"][0] / np.linalg.norm(expected)
        np.testing.assert_allclose(normal_at(prim, 0, u, v), expected, atol=1e-8)


def test_u_is_arc_length_on_the_middle_line(prim: Structured) -> None:
    step = 1e-5
    u = 0.3 * prim["half_size"][0, 0]
    moved = point_at(prim, 0, u + step, 0.0) - point_at(prim, 0, u - step, 0.0)
    assert np.linalg.norm(moved) == pytest.approx(2.0 * step, rel=1e-8)


def test_project_undoes_point_at(prim: Structured) -> None:
    for u, v in sample_uv(prim, 50):
        uvw = project(prim, 0, point_at(prim, 0, u, v))
        np.testing.assert_allclose(uvw, [u, v, 0.0], atol=1e-12)


def test_project_gives_the_height_over_the_free_side(prim: Structured) -> None:
    for u, v in sample_uv(prim, 20):
        raised = point_at(prim, 0, u, v) + 0.13 * normal_at(prim, 0, u, v)
        np.testing.assert_allclose(project(prim, 0, raised), [u, v, 0.13], atol=1e-12)


def test_patch_distance_against_brute_force(prim: Structured) -> None:
    rng = np.random.default_rng(7)
    count = 260
    half_u, half_v = prim["half_size"][0]
    grid = np.array(
        [
            point_at(prim, 0, u, v)
            for u in np.linspace(-half_u, half_u, count)
            for v in np.linspace(-half_v, half_v, count)
        ]
    )
    spacing = 2.0 * max(half_u, half_v) / (count - 1)
    for p in prim["p_WS"][0] + rng.uniform(-2.5, 2.5, (60, 3)):
        brute = np.min(np.linalg.norm(grid - p, axis=1))
        distance = abs(patch_distance(prim, 0, p))
        # The true foot is within half a cell's diagonal of a node of the grid.
        assert distance <= brute + 1e-9
        assert brute <= distance + 0.71 * spacing


def test_patch_distance_is_signed_only_within_the_bounds() -> None:
    wall = plane([1.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [1.0, 1.0])
    assert patch_distance(wall, 0, np.array([1.2, 0.0, 1.0])) == pytest.approx(-0.2)
    assert patch_distance(wall, 0, np.array([0.8, 0.0, 1.0])) == pytest.approx(0.2)
    assert patch_distance(wall, 0, np.array([1.3, 0.9, 1.0])) == pytest.approx(0.5)
    tank = cylinder([0.0, 0.0, 1.0], [0, 0, 1], 2.0, [1, 0, 0], [1.0, 1.0], -1.0)
    assert patch_distance(tank, 0, np.array([1.5, 0.0, 1.0])) == pytest.approx(0.5)
    assert patch_distance(tank, 0, np.array([2.5, 0.0, 1.0])) == pytest.approx(-0.5)


def cast(prims: Structured, origin: list[float], *directions: list[float]) -> Vector:
    rays = np.array(directions, dtype=np.float64)
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    ranges = np.empty(len(rays))
    raycast(prims, np.array(origin, dtype=np.float64), rays, 10.0, ranges)
    return ranges


def test_rays_on_a_wall() -> None:
    wall = plane([2.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [2.0, 1.0])
    ranges = cast(wall, [0, 0, 1], [1, 0, 0], [2, 0.9, 0], [2, 0, 0.6], [-1, 0, 0], [0, 1, 0])
    np.testing.assert_allclose(ranges, [2.0, np.hypot(2.0, 0.9), np.nan, np.nan, np.nan])
    assert cast(wall, [4, 0, 1], [-1, 0, 0])[0] == pytest.approx(2.0)
    assert np.isnan(cast(wall, [-9, 0, 1], [1, 0, 0])[0])


def test_rays_on_a_sphere() -> None:
    ball = sphere([3.0, 0.0, 0.0], 1.0, [-1.0, 0.0, 0.0], [99.0, 99.0])
    off_axis = 3.0 - np.sqrt(1.0 - 0.6**2)
    np.testing.assert_allclose(cast(ball, [0, 0, 0], [1, 0, 0], [0, 0, 1]), [2.0, np.nan])
    np.testing.assert_allclose(cast(ball, [0, 0.6, 0], [1, 0, 0])[0], off_axis)
    np.testing.assert_allclose(cast(ball, [3, 0, 0], [1, 0, 0], [0, 0.6, 0.8]), [1.0, 1.0])
    # Only the far side is there: the ray passes the missing near side.
    bowl = sphere([3.0, 0.0, 0.0], 1.0, [1.0, 0.0, 0.0], [1.0, 1.0], -1.0)
    np.testing.assert_allclose(cast(bowl, [0, 0, 0], [1, 0, 0])[0], 4.0)
    # u = 0.5 m at r = 1 m is 0.5 rad, as is v.
    for angle, hit in ((0.49, True), (0.51, False)):
        level = [np.cos(angle), np.sin(angle), 0.0]
        up = [np.cos(angle), 0.0, -np.sin(angle)]
        assert list(np.isfinite(cast(bowl, [3, 0, 0], level, up))) == [hit, hit]


def test_rays_on_a_cylinder() -> None:
    pipe = cylinder([3.0, 0.0, 1.0], [0.0, 0.0, 1.0], 0.5, [-1.0, 0.0, 0.0], [99.0, 2.0])
    rays = cast(pipe, [0, 0, 1], [1, 0, 0], [1, 0, 1], [2.5, 0, 0.9], [0, 0, 1])
    # The second and third hit at z = 1 + 2.5 and 1 + 0.9; the length ends at z = 2.
    np.testing.assert_allclose(rays, [2.5, np.nan, np.hypot(2.5, 0.9), np.nan])
    np.testing.assert_allclose(cast(pipe, [3, 0, 1], [1, 0, 0], [0, -1, 0]), [0.5, 0.5])
    assert np.isnan(cast(pipe, [3, 0, 0], [0, 0, 1])[0])
    half = cylinder([0.0, 0.0, 1.0], [0.0, 0.0, 1.0], 2.0, [1.0, 0.0, 0.0], [2 * np.pi, 1.0], -1.0)
    np.testing.assert_allclose(cast(half, [0, 0, 1], [1, 0, 0], [-1, 0, 0]), [2.0, np.nan])
    np.testing.assert_allclose(cast(half, [-5, 0, 1], [1, 0, 0])[0], 7.0)


def test_hits_lie_on_the_patch_and_the_nearest_wins(prim: Structured) -> None:
    origin = prim["p_WS"][0] + np.array([0.21, -0.17, 0.13])
    rng = np.random.default_rng(3)
    rays = rng.normal(size=(500, 3))
    rays /= np.linalg.norm(rays, axis=1)[:, None]
    alone, together = np.empty(500), np.empty(500)
    raycast(prim, origin, rays, 50.0, alone)
    assert np.isfinite(alone).sum() > 10
    for ray, distance in zip(rays, alone, strict=True):
        if np.isfinite(distance):
            assert abs(patch_distance(prim, 0, origin + distance * ray)) < 1e-9
    near = sphere(origin, 0.05, [1.0, 0.0, 0.0], [0.1, 0.1])
    ranges = np.empty(500)
    raycast(near, origin, rays, 50.0, ranges)
    raycast(np.concatenate([near, prim]), origin, rays, 50.0, together)
    np.testing.assert_array_equal(together, np.fmin(ranges, alone))


def test_a_camera_frame_is_cast_quickly() -> None:
    # 64 × 48 rays at 10 Hz; 60 µs of budget, three times that here for a busy machine.
    wall = plane([2.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [2.0, 2.0])
    rays = np.random.default_rng(0).normal([1.0, 0.0, 0.0], 0.3, (3072, 3))
    ranges = np.empty(3072)
    origin = np.array([0.0, 0.0, 1.0])
    raycast(wall, origin, rays, 10.0, ranges)
    times = []
    for _ in range(20):
        begin = time.perf_counter()
        raycast(wall, origin, rays, 10.0, ranges)
        times.append(time.perf_counter() - begin)
    assert min(times) < 180e-6


def test_facing_along_the_axis_is_refused() -> None:
    with pytest.raises(GeometryError, match="facing runs along its axis"):
        cylinder([0, 0, 0], [0, 0, 1], 1.0, [0, 0, -2], [1.0, 1.0])


SHAPES = (
    PlaneShape(center_m=(1.0, 2.0, 3.0), normal=(-1.0, 0.4, 0.2), size_m=(1.0, 2.0)),
    SphereShape(center_m=(1.0, 2.0, 3.0), radius_m=0.5, facing=(0.0, 1.0, 0.4), size_m=(1.0, 0.5)),
    CylinderShape(
        center_m=(1.0, 2.0, 3.0),
        axis=(0.0, 0.1, 1.0),
        radius_m=0.5,
        facing=(1.0, 0.0, 0.0),
        size_m=(1.0, 0.5),
        side="inside",
    ),
)


def test_shapes_become_primitives_in_order() -> None:
    prims = primitives_of(SHAPES)
    assert prims.dtype == PRIMITIVE
    assert list(prims["kind"]) == [0, 1, 2]
    assert list(prims["side"]) == [1.0, 1.0, -1.0]
    assert primitives_of(()).shape == (0,)


@pytest.mark.parametrize("shape", SHAPES, ids=lambda s: s.kind)
def test_displaced_shape_is_the_shape_seen_from_a_moved_frame(
    shape: PlaneShape | SphereShape | CylinderShape,
) -> None:
    motion = Displacement(
        rotate_deg=(0.0, 0.0, 90.0), about_m=(1.0, 0.0, 0.0), translate_m=(0.0, 0.0, 5.0)
    )
    prim, moved = primitive_of(shape), primitive_of(displaced(shape, motion))
    for x, y, z in np.random.default_rng(2).uniform(0.0, 4.0, (20, 3)):
        # 90° about the vertical through (1, 0): (x, y) → (1 − y, x − 1).
        there = np.array([1.0 - y, x - 1.0, z + 5.0])
        expected = patch_distance(prim, 0, np.array([x, y, z]))
        assert patch_distance(moved, 0, there) == pytest.approx(expected, abs=1e-12)


def test_no_displacement_changes_nothing() -> None:
    assert displaced(SHAPES[0], Displacement()) is SHAPES[0]
