"""The depth camera against analytic scenes."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.records import State
from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.schema.vehicle import DepthCameraModel, MountModel
from inspect_cli.sensing.depth_camera import DepthCamera
from inspect_cli.spatial.primitives import PRIMITIVE, plane, sphere
from inspect_cli.spatial.rotations import (
    matrix_to_quaternion,
    quaternion_to_matrix,
    roll_pitch_yaw_matrix,
)
from inspect_cli.truth.heights import mesh_relief
from inspect_cli.truth.snapshot import Truth
from inspect_cli.truth.solids import Solids, foot_on

LENGTHS = {"n_rotors": 4, "n_joints": 0}
R_BT = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
P_BD = np.array([0.16, 0.0, 0.06])


def model(noise_floor_m=0.0, noise_m=0.0) -> DepthCameraModel:
    return DepthCameraModel(
        kind="depth_camera",
        rate_hz=10,
        mount=MountModel(frame="body", position_m=tuple(P_BD.tolist()), axes="tool"),
        columns=64,
        rows=48,
        field_of_view_deg=(62.0, 45.0),
        range_m=(0.1, 3.0),
        noise_m=noise_m,
        noise_floor_m=noise_floor_m,
        neighbourhood_m=0.1,
    )


def state_at(p_WB, R_WB=None) -> State:
    state = State.create(LENGTHS)
    state.p_WB[:] = p_WB
    R_WB = np.eye(3) if R_WB is None else R_WB
    state.q_WB[:] = matrix_to_quaternion(R_WB)
    state.q_WT[:] = matrix_to_quaternion(R_WB @ R_BT)
    return state


def camera(primitives, seed=1, **noise) -> DepthCamera:
    return DepthCamera(model(**noise), Solids(primitives), np.random.default_rng(seed))


def in_world(points_D, state):
    R_WB = quaternion_to_matrix(state.q_WB)
    return state.p_WB + (P_BD + points_D @ R_BT.T) @ R_WB.T


def test_every_pixel_lies_on_a_tilted_wall_seen_from_a_tilted_body():
    n = np.array([-0.9, 0.3, 0.2])
    n /= np.linalg.norm(n)
    wall = plane([1.5, 0.0, 1.0], n, [20.0, 20.0])
    state = state_at([0.1, -0.2, 1.1], roll_pitch_yaw_matrix(0.1, -0.15, 0.2))
    cam = camera(wall)
    cam.sample(Truth(state))
    points = in_world(cam.points_D, state)
    seen = np.isfinite(points).all(axis=1)
    assert seen.sum() > 2500
    assert np.abs((points[seen] - [1.5, 0.0, 1.0]) @ n).max() < 1e-9


def test_field_of_view_is_the_angle_between_the_outer_pixels_edges():
    cam = camera(plane([1.66, 0.0, 0.06], [-1.0, 0.0, 0.0], [9.0, 9.0]))
    cam.sample(Truth(state_at([0.0, 0.0, 0.0])))
    image = cam.points_D.reshape(48, 64, 3)
    # At 1.5 m before the camera the outermost pixel's middle is half a pixel inside the edge.
    assert image[0, 0, 1] == pytest.approx(1.5 * np.tan(np.radians(31.0)) * 63 / 64, rel=1e-9)
    assert image[-1, 0, 0] == pytest.approx(1.5 * np.tan(np.radians(22.5)) * 47 / 48, rel=1e-9)


@pytest.mark.parametrize(
    ("offset_W", "rows", "columns"),
    [
        ([0.0, 0.0, 0.25], slice(0, 24), slice(0, 64)),
        ([0.0, -0.3, 0.0], slice(0, 48), slice(32, 64)),
    ],
    ids=["what is above is in the upper half", "what is to the right is in the right half"],
)
def test_image_is_upright(offset_W, rows, columns):
    patch = plane(np.array([1.16, 0.0, 0.06]) + offset_W, [-1.0, 0.0, 0.0], [0.1, 0.1])
    cam = camera(patch)
    cam.sample(Truth(state_at([0.0, 0.0, 0.0])))
    seen = np.isfinite(cam.points_D[:, 0]).reshape(48, 64)
    assert seen.sum() > 10
    assert seen[rows, columns].sum() == seen.sum()


@pytest.mark.parametrize("distance", [0.05, 3.2])
def test_nothing_returns_from_out_of_range(distance):
    wall = plane([0.16 + distance, 0.0, 0.06], [-1.0, 0.0, 0.0], [0.03, 0.03])
    cam = camera(wall, noise_floor_m=0.005)
    cam.sample(Truth(state_at([0.0, 0.0, 0.0])))
    assert np.isnan(cam.points_D).all()


def test_empty_world_returns_nothing():
    cam = camera(np.zeros(0, PRIMITIVE))
    cam.sample(Truth(state_at([0.0, 0.0, 0.0])))
    assert np.isnan(cam.points_D).all()


def test_nearest_of_several_surfaces_is_seen():
    wall = plane([2.0, 0.0, 0.06], [-1.0, 0.0, 0.0], [9.0, 9.0])
    ball = sphere([1.5, 0.0, 0.06], 0.3, [-1.0, 0.0, 0.0], [9.0, 9.0])
    cam = camera(np.concatenate([wall, ball]))
    state = state_at([0.0, 0.0, 0.0])
    cam.sample(Truth(state))
    points = in_world(cam.points_D, state)
    on_ball = np.abs(np.linalg.norm(points - [1.5, 0.0, 0.06], axis=1) - 0.3) < 1e-9
    on_wall = np.abs(points[:, 0] - 2.0) < 1e-9
    assert (on_ball | on_wall).all()
    # The ball's cone: sin(half angle) = r / d, and pixels subtend equal areas at z = 1.
    half = np.tan(np.arcsin(0.3 / 1.34))
    pixel = 4.0 * np.tan(np.radians(31.0)) * np.tan(np.radians(22.5)) / (64 * 48)
    assert on_ball.sum() == pytest.approx(np.pi * half**2 / pixel, rel=0.05)


@pytest.mark.parametrize("depth", [0.5, 2.0])
def test_noise_is_along_the_ray_and_grows_with_the_square_of_the_range(depth):
    wall = plane([0.16 + depth, 0.0, 0.06], [-1.0, 0.0, 0.0], [9.0, 9.0])
    state = state_at([0.0, 0.0, 0.0])
    clean, noisy = camera(wall), camera(wall, noise_floor_m=0.003, noise_m=0.004)
    clean.sample(Truth(state))
    true_range = np.linalg.norm(clean.points_D, axis=1)
    rays = clean.points_D / true_range[:, None]
    scores = []
    for _ in range(10):
        noisy.sample(Truth(state))
        measured = np.sum(noisy.points_D * rays, axis=1)
        assert np.abs(noisy.points_D - measured[:, None] * rays).max() < 1e-12
        scores.append((measured - true_range) / (0.003 + 0.004 * true_range**2))
    # 30,720 standard normal numbers: the deviation's own is 0.4 %, the mean's 0.6 %.
    assert np.std(scores) == pytest.approx(1.0, abs=0.02)
    assert np.mean(scores) == pytest.approx(0.0, abs=0.03)


def test_same_seed_gives_the_same_image_and_another_seed_another():
    wall = plane([1.5, 0.0, 0.06], [-1.0, 0.0, 0.0], [9.0, 9.0])
    images = []
    for seed in (5, 5, 6):
        cam = camera(wall, seed=seed, noise_floor_m=0.005)
        cam.sample(Truth(state_at([0.0, 0.0, 0.0])))
        images.append(cam.points_D)
    assert np.array_equal(images[0], images[1])
    assert not np.array_equal(images[0], images[2])


def test_a_vault_is_seen_as_its_heights_say(root):
    shape = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))
    relief = mesh_relief(shape, Displacement(), root)
    solids = Solids(np.zeros(0, PRIMITIVE), relief.row, relief.nodes)
    cam = DepthCamera(model(), solids, np.random.default_rng(1))
    state = state_at([0.4, 0.2, 2.2], roll_pitch_yaw_matrix(0.1, -1.2, 0.3))
    cam.sample(Truth(state))
    points = in_world(cam.points_D, state)
    seen = np.isfinite(points).all(axis=1)
    assert seen.sum() > 2500
    away = [abs(foot_on(solids, 0, p)[2]) for p in points[seen][::7]]
    assert max(away) < 2e-6


def near(points, p, axis, radius):
    """The points whose distance from a line is within the radius."""
    off = points - p
    across = off - np.outer(off @ axis, axis)
    return points[np.linalg.norm(across, axis=1) <= radius]


@pytest.mark.parametrize("scene", ["wall", "ball", "vault"])
def test_what_lies_near_a_line_is_what_the_whole_image_shows_there(scene, request):
    """Every point near twelve random lines, to the bit and in the order of the image."""
    if scene == "vault":
        shape = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))
        relief = mesh_relief(shape, Displacement(), request.config.rootpath)
        solids = Solids(np.zeros(0, PRIMITIVE), relief.row, relief.nodes)
        state = state_at([0.0, 0.0, 3.0], roll_pitch_yaw_matrix(0.0, -1.4, 0.0))
    else:
        seen = plane([1.0, 0.0, 1.0], [-0.9, 0.3, 0.3], [20.0, 20.0])
        prims = (
            seen if scene == "wall" else sphere([1.2, 0.0, 1.0], 0.4, [-1.0, 0.0, 0.0], [9.0, 9.0])
        )
        solids, state = Solids(prims), state_at([0.0, 0.0, 1.0])
    cam = DepthCamera(model(0.004, 0.002), solids, np.random.default_rng(1))
    rng = np.random.default_rng(2)
    found = 0
    for _ in range(12):
        image = cam.sample(Truth(state))
        p, axis = rng.normal(scale=0.1, size=3), np.append(rng.normal(scale=0.2, size=2), 1.0)
        axis /= np.linalg.norm(axis)
        first = near(image.pixels.near(p, axis, 0.1).copy(), p, axis, 0.1)
        whole = near(image.points_D, p, axis, 0.1)
        assert np.array_equal(first, whole)
        assert np.array_equal(near(image.pixels.near(p, axis, 0.1), p, axis, 0.1), whole)
        found += len(whole)
    assert found > 200


def test_an_image_hands_out_points_and_nothing_true():
    """Surfaces and the camera's pose are the simulator's; a stack is handed two functions."""
    image = camera(plane([1.5, 0.0, 1.0], [-1.0, 0.0, 0.0], [20.0, 20.0])).measurement
    assert set(vars(image)) == {"t_s", "pixels"}
    assert set(vars(image.pixels)) == {"all", "near"}
