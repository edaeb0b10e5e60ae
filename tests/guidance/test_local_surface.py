"""The local surface against analytic planes and NumPy's singular value decomposition."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.guidance.local_surface import LocalSurface
from inspect_cli.records import Estimate, State, SurfaceEstimate
from inspect_cli.schema.vehicle import DepthCameraModel, MountModel
from inspect_cli.sensing.depth_camera import DepthCamera
from inspect_cli.spatial.primitives import cylinder, plane
from inspect_cli.spatial.rotations import (
    matrix_to_quaternion,
    quaternion_to_matrix,
    roll_pitch_yaw_matrix,
)
from inspect_cli.truth.snapshot import Truth
from inspect_cli.truth.solids import Solids

P_BT = np.array([0.55, 0.0, 0.0])
R_BT = np.array([[0.0, 0.0, 1.0], [0.0, 1.0, 0.0], [-1.0, 0.0, 0.0]])
P_BD = np.array([0.16, 0.0, 0.06])
RADIUS = 0.1


def model(noise_floor_m=0.0) -> DepthCameraModel:
    return DepthCameraModel(
        kind="depth_camera",
        rate_hz=10,
        mount=MountModel(frame="body", position_m=tuple(P_BD.tolist()), axes="tool"),
        columns=64,
        rows=48,
        field_of_view_deg=(62.0, 45.0),
        range_m=(0.1, 3.0),
        noise_m=0.0,
        noise_floor_m=noise_floor_m,
        neighbourhood_m=RADIUS,
    )


def poses(p_WB=(0.0, 0.0, 1.0), R_WB=None):
    state = State.create({"n_rotors": 4, "n_joints": 0})
    estimate = Estimate.create()
    R_WB = np.eye(3) if R_WB is None else R_WB
    for record in (state, estimate):
        record.p_WB[:] = p_WB
        record.q_WB[:] = matrix_to_quaternion(R_WB)
    state.q_WT[:] = matrix_to_quaternion(R_WB @ R_BT)
    return state, estimate


def fit(points_D, estimate, out, noise_floor_m=0.004):
    """The local surface seen from where the estimate puts camera and tool."""
    R_WB = quaternion_to_matrix(estimate.q_WB)
    p_WD, p_WT = estimate.p_WB + R_WB @ P_BD, estimate.p_WB + R_WB @ P_BT
    LocalSurface(model(noise_floor_m)).update(points_D, p_WD, p_WT, R_WB @ R_BT, out)


def look(primitives, state, estimate, noise_floor_m=0.0, seed=1):
    camera = DepthCamera(model(noise_floor_m), Solids(primitives), np.random.default_rng(seed))
    camera.sample(Truth(state))
    out = SurfaceEstimate.create()
    fit(camera.points_D, estimate, out, noise_floor_m)
    return out, camera.points_D


def tilted_plane_points(rng, n_points=400, noise=0.004):
    """Random points around the tool's axis in D on a plane with a slope, with noise."""
    p_DT = R_BT.T @ (P_BT - P_BD)
    xy = p_DT[:2] + rng.uniform(-0.15, 0.15, (n_points, 2))
    z = 0.7 + 0.3 * xy[:, 0] - 0.2 * xy[:, 1] + noise * rng.standard_normal(n_points)
    return np.column_stack([xy, z]), p_DT


def test_exact_on_a_tilted_wall():
    n = np.array([-0.95, 0.2, -0.15])
    n /= np.linalg.norm(n)
    on_wall = np.array([0.9, 0.1, 1.2])
    state, estimate = poses((0.05, 0.1, 1.1), roll_pitch_yaw_matrix(0.05, -0.1, 0.08))
    out, _ = look(plane(on_wall, n, [5.0, 5.0]), state, estimate)
    R_WB = quaternion_to_matrix(state.q_WB)
    p_WT = state.p_WB + R_WB @ P_BT
    z_T = R_WB @ R_BT[:, 2]
    assert out.valid == 1.0
    assert np.allclose(out.n_W, n, atol=1e-9)
    assert abs((out.p_WC - on_wall) @ n) < 1e-9
    assert out.distance == pytest.approx((on_wall - p_WT) @ n / (z_T @ n), abs=1e-9)
    # C′_t is a mean over a disc of 0.1 m; it stays near the axis.
    assert np.linalg.norm(np.cross(out.p_WC - p_WT, z_T)) < 0.03


def test_agrees_with_singular_value_decomposition():
    points_D, p_DT = tilted_plane_points(np.random.default_rng(3))
    out = SurfaceEstimate.create()
    _, estimate = poses((1.0, 2.0, 3.0), roll_pitch_yaw_matrix(0.3, 0.2, -1.0))
    fit(points_D, estimate, out)
    near = points_D[np.linalg.norm((points_D - p_DT)[:, :2], axis=1) <= RADIUS]
    mean = near.mean(axis=0)
    _, singular, axes = np.linalg.svd(near - mean)
    n_D = axes[2] * -np.sign(axes[2, 2])
    R_WD = quaternion_to_matrix(estimate.q_WB) @ R_BT
    p_WD = estimate.p_WB + quaternion_to_matrix(estimate.q_WB) @ P_BD
    assert out.n_points == len(near)
    assert np.allclose(out.n_W, R_WD @ n_D, atol=1e-10)
    assert np.allclose(out.p_WC, p_WD + R_WD @ mean, atol=1e-10)
    assert out.rms == pytest.approx(singular[2] / np.sqrt(len(near)), rel=1e-8)
    assert out.distance == pytest.approx((mean - p_DT) @ n_D / n_D[2], abs=1e-10)
    assert out.valid == 1.0


def test_distance_is_negative_behind_the_surface():
    state, estimate = poses((0.0, 0.0, 1.0))
    out, _ = look(plane([0.5, 0.0, 1.0], [-1.0, 0.0, 0.0], [4.0, 4.0]), state, estimate)
    assert out.distance == pytest.approx(-0.05, abs=1e-9)


def test_normal_accuracy_with_5_mm_of_noise():
    wall = plane([0.8, 0.0, 1.0], [-1.0, 0.0, 0.0], [5.0, 5.0])
    state, estimate = poses()
    angles, distances = [], []
    for seed in range(200):
        out, _ = look(wall, state, estimate, noise_floor_m=0.005, seed=seed)
        assert out.valid == 1.0
        angles.append(np.arccos(min(1.0, -out.n_W[0])))
        distances.append(out.distance)
    # Slopes over a disc of radius r have the deviation σ / (√n r/2) about each of two axes.
    expected = np.sqrt(2.0) * 0.005 / (np.sqrt(out.n_points) * 0.5 * RADIUS)
    assert np.sqrt(np.mean(np.square(angles))) == pytest.approx(expected, rel=0.15)
    assert np.degrees(expected) < 0.6
    assert np.std(distances) < 0.001


def test_pose_is_taken_from_the_estimate():
    state, estimate = poses()
    estimate.p_WB[:] += [0.0, 0.3, -0.2]
    out, _ = look(plane([0.8, 0.0, 1.0], [-1.0, 0.0, 0.0], [4.0, 4.0]), state, estimate)
    assert out.valid == 1.0
    assert out.p_WC[1] == pytest.approx(0.3, abs=0.02)


def test_a_pipe_passes():
    pipe = cylinder([0.95, 0.0, 1.0], [0.0, 0.0, 1.0], 0.15, [-1.0, 0.0, 0.0], [9.0, 2.0])
    state, estimate = poses()
    out, _ = look(pipe, state, estimate, noise_floor_m=0.004)
    assert out.valid == 1.0
    assert np.arccos(-out.n_W[0]) < np.radians(2.0)


def edge_before_a_far_wall():
    near = plane([0.8, 0.0, 0.0], [-1.0, 0.0, 0.0], [4.0, 2.0])
    far = plane([1.2, 0.0, 1.0], [-1.0, 0.0, 0.0], [4.0, 4.0])
    return np.concatenate([near, far])


@pytest.mark.parametrize(
    "primitives",
    [
        plane([9.0, 0.0, 1.0], [-1.0, 0.0, 0.0], [4.0, 4.0]),
        plane([0.8, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.3, 0.025]),
        plane([0.8, 0.0, 1.0], [-1.0, 0.0, 0.0], [0.04, 0.04]),
        edge_before_a_far_wall(),
        plane([0.8, 0.0, 1.0], [-0.17, 0.98, 0.0], [4.0, 4.0]),
    ],
    ids=["out of range", "a bar", "too few points", "an edge", "seen from its side"],
)
def test_refuses(primitives):
    state, estimate = poses()
    out, _ = look(primitives, state, estimate, noise_floor_m=0.004)
    assert out.valid == 0.0


def test_half_a_disc_at_the_edge_of_a_wall_is_enough():
    wall = plane([0.8, 0.0, 0.0], [-1.0, 0.0, 0.0], [4.0, 2.0])
    state, estimate = poses()
    out, _ = look(wall, state, estimate, noise_floor_m=0.004)
    assert out.valid == 1.0
    assert np.arccos(-out.n_W[0]) < np.radians(3.0)


def test_not_a_number_anywhere_is_not_valid():
    points_D, _ = tilted_plane_points(np.random.default_rng(3))
    out = SurfaceEstimate.create()
    _, estimate = poses()
    fit(np.full_like(points_D, np.nan), estimate, out)
    assert (out.valid, out.n_points) == (0.0, 0.0)
    estimate.p_WB[2] = np.nan
    fit(points_D, estimate, out)
    assert out.valid == 0.0
    _, estimate = poses()
    estimate.q_WB[0] = np.nan
    fit(points_D, estimate, out)
    assert out.valid == 0.0
    _, estimate = poses()
    points_D[200] = [np.nan, np.nan, 0.7]
    fit(points_D, estimate, out)
    assert out.valid == 1.0
