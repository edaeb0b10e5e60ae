"""Pursuit: continuity and limits under random orders, and where approaches end."""

from __future__ import annotations

import numpy as np
import pytest
from fake_vehicle import FakeArm, FakeVehicle, target_at
from scipy.spatial.transform import Rotation

from inspect_cli.guidance.local_surface import LocalSurface
from inspect_cli.guidance.orientation import contact_orientation
from inspect_cli.guidance.pursuit import Pursuit
from inspect_cli.interfaces import Posture
from inspect_cli.records import State, SurfaceEstimate
from inspect_cli.schema.vehicle import DepthCameraModel, MountModel
from inspect_cli.sensing.depth_camera import DepthCamera
from inspect_cli.spatial.primitives import plane
from inspect_cli.spatial.rotations import matrix_to_quaternion, rotate
from inspect_cli.truth.snapshot import Truth
from inspect_cli.truth.solids import Solids

MOTION = ("p_WB", "q_WB", "v_WB_W", "w_WB_B", "a_WB_W", "alpha_WB_B", "p_WT")
Y_NORTH = np.array([0.0, 1.0, 0.0])
START = Posture(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0]))
P_WC = np.array([2.0, 0.3, 1.5])
N_W = np.array([-1.0, 0.0, 0.0])


def turned(n, roll_deg, pitch_deg, yaw_deg):
    return Rotation.from_euler("xyz", [roll_deg, pitch_deg, yaw_deg], degrees=True).apply(n)


def wall_target(vehicle, p_WC=P_WC, n_W=N_W):
    return target_at(vehicle, p_WC, n_W, contact_orientation(n_W, Y_NORTH))


def seen(p_W, n_W) -> SurfaceEstimate:
    surface = SurfaceEstimate.create()
    surface.p_WC[:] = p_W
    surface.n_W[:] = n_W
    surface.valid = 1.0
    return surface


def written(pursuit, t_s):
    pursuit.write(t_s)
    return {name: pursuit.reference.views[name].copy() for name in MOTION}


def tool(vehicle, pursuit):
    return vehicle.frame_pose(Posture(pursuit.reference.p_WB, pursuit.reference.q_WB), "tool")


def give_random_order(rng, pursuit, vehicle, target, t_s):
    order = rng.integers(5)
    if order == 0:
        goals = [
            Posture(rng.uniform(-1.5, 1.5, 3), Rotation.random(random_state=rng).as_quat())
            for _ in range(rng.integers(1, 3))
        ]
        pursuit.go_to(t_s, goals, rng.uniform(0.2, 1.0))
    elif order == 1:
        pursuit.hold(t_s)
    elif order == 2:
        pursuit.approach(t_s, target, rng.uniform(-0.3, 0.1), rng.uniform(0.1, 0.5))
    else:
        n = turned(N_W, *rng.uniform(-8.0, 8.0, 3))
        pursuit.observe(t_s, seen(P_WC + rng.uniform(-0.1, 0.1, 3), n))


@pytest.mark.parametrize("seed", range(8))
def test_reference_is_smooth_and_within_limits_under_random_orders(seed):
    rng = np.random.default_rng(seed)
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    target = wall_target(vehicle)
    dt, next_order = 0.004, 0.5
    last = written(pursuit, 0.0)
    for k in range(1, 5000):
        t = k * dt
        now = written(pursuit, t)
        # Trapezoidal steps miss by the third derivative: jerk · dt³/12, below 1e-6 · jerk.
        middle = 0.5 * dt * (last["v_WB_W"] + now["v_WB_W"])
        assert np.abs(now["p_WB"] - last["p_WB"] - middle).max() < 1e-5
        middle = 0.5 * dt * (last["a_WB_W"] + now["a_WB_W"])
        assert np.abs(now["v_WB_W"] - last["v_WB_W"] - middle).max() < 1e-3
        step = (
            Rotation.from_quat(last["q_WB"], scalar_first=True).inv()
            * Rotation.from_quat(now["q_WB"], scalar_first=True)
        ).as_rotvec()
        assert np.abs(step - 0.5 * dt * (last["w_WB_B"] + now["w_WB_B"])).max() < 1e-5
        assert np.abs(now["q_WB"] - last["q_WB"]).max() < 0.005
        assert np.linalg.norm(now["v_WB_W"]) <= 1.05
        assert np.linalg.norm(now["a_WB_W"]) <= 1.05
        assert np.linalg.norm(now["w_WB_B"]) <= 0.7 * 1.05
        assert np.linalg.norm(now["alpha_WB_B"]) <= 0.7 * 1.05
        last = now
        if t >= next_order:
            give_random_order(rng, pursuit, vehicle, target, t)
            after = written(pursuit, t)
            for name in MOTION:
                assert np.abs(after[name] - now[name]).max() < 1e-9, name
            next_order = t + rng.exponential(1.0)


def test_starts_at_rest_where_it_is_put():
    pursuit = Pursuit(FakeVehicle(), START)
    now = written(pursuit, 3.0)
    assert np.allclose(now["p_WB"], START.p_WB)
    assert np.allclose(now["q_WB"], START.q_WB)
    assert np.allclose(now["p_WT"], [0.55, 0.0, 1.02])
    assert np.allclose([now["v_WB_W"], now["w_WB_B"]], 0.0)
    assert pursuit.arrived(3.0)
    assert pursuit.reference.t_s == 3.0


def test_goes_through_waypoints_at_its_speed_and_arrives():
    pursuit = Pursuit(FakeVehicle(), START)
    q = np.array([np.cos(0.4), 0.0, 0.0, np.sin(0.4)])
    pursuit.go_to(1.0, [Posture(np.array([1.0, 0.0, 1.0]), q), START], 0.4)
    # 15/8 · 1 m / (0.4 m/s) for each way
    assert not pursuit.arrived(1.0 + 2 * 4.6875 - 0.01)
    assert pursuit.arrived(1.0 + 2 * 4.6875 + 0.01)
    speeds = [np.linalg.norm(written(pursuit, t)["v_WB_W"]) for t in np.arange(1.0, 10.5, 0.02)]
    assert max(speeds) == pytest.approx(0.4, rel=0.01)
    assert np.allclose(written(pursuit, 10.5)["p_WB"], START.p_WB)


@pytest.mark.parametrize("depth", [-0.25, 0.1])
def test_approach_without_a_seen_surface_follows_the_plan(depth):
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    pursuit.approach(0.0, wall_target(vehicle), depth, 0.5)
    assert not pursuit.arrived(1.0)
    written(pursuit, 20.0)
    p_WT, R_WT = tool(vehicle, pursuit)
    assert pursuit.arrived(20.0)
    assert np.allclose(p_WT, P_WC - depth * N_W)
    assert np.allclose(pursuit.reference.p_WT, p_WT)
    assert np.allclose(R_WT[:, 2], -N_W)


def fly_approach(pursuit, surface, t_s=0.0, longest_s=30.0, rng=None, noise_rad=0.0):
    """Observe at 5 Hz and write at 50 Hz until arrived; returns the time."""
    while not pursuit.arrived(t_s) and t_s < longest_s:
        noisy = surface
        if rng is not None:
            n = Rotation.from_rotvec(noise_rad * rng.standard_normal(3)).apply(surface.n_W)
            noisy = seen(surface.p_WC, n)
        pursuit.observe(t_s, noisy)
        for k in range(10):
            pursuit.write(t_s + 0.02 * k)
        t_s += 0.2
    pursuit.write(t_s)
    return t_s


@pytest.mark.parametrize("n_planned", [N_W, np.array([0.0, 0.0, 1.0]), np.array([0.6, 0.0, -0.8])])
def test_approach_corrects_a_wall_that_is_turned_by_5_deg_and_moved_by_5_cm(n_planned):
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    target = wall_target(vehicle, n_W=n_planned)
    pursuit.go_to(0.0, [Posture(np.array(target.standoff.p_WB), np.array(target.standoff.q_WB))], 1)
    n_true = turned(n_planned, 3.0, -2.5, 3.0)
    p_true = P_WC + 0.05 * n_planned
    pursuit.approach(20.0, target, -0.1, 0.1)
    planned_s = 15 / 8 * 0.15 / 0.1
    t = fly_approach(pursuit, seen(p_true, n_true), 20.0, 60.0)
    p_WT, R_WT = tool(vehicle, pursuit)
    assert pursuit.implausible == 0
    assert t - 20.0 < 2.0 * planned_s
    # The reference follows with CORRECTION_S; arrival allows 5 mm, then it goes on to converge.
    assert abs((p_WT - p_true) @ n_true - 0.1) < 0.005
    assert np.arccos(min(1.0, -R_WT[:, 2] @ n_true)) < np.radians(0.1)
    # Contact point: the planned one moved along the true normal, so no way along the surface.
    contact = P_WC + ((p_true - P_WC) @ n_true) * n_true
    pursuit.write(t + 5.0)
    p_WT, R_WT = tool(vehicle, pursuit)
    assert np.allclose(p_WT, contact + 0.1 * n_true, atol=1e-6)
    # 5° of normal turn a level y axis by 5° / sin(angle of n to the vertical), here at most 8.3°.
    planned_y = contact_orientation(n_planned, Y_NORTH)[:, 1]
    assert R_WT[:, 1] @ planned_y > np.cos(np.radians(9.0))


def test_camera_and_pursuit_together_find_a_wall_that_is_not_where_it_was_planned():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    n_true = turned(N_W, 0.0, 3.0, 4.0)
    p_true = P_WC + np.array([0.05, 0.0, 0.0])
    model = DepthCameraModel(
        kind="depth_camera",
        rate_hz=10,
        mount=MountModel(frame="body", position_m=(0.16, 0.0, 0.06), axes="tool"),
        columns=64,
        rows=48,
        field_of_view_deg=(62.0, 45.0),
        range_m=(0.1, 3.0),
        noise_m=0.002,
        noise_floor_m=0.004,
        neighbourhood_m=0.1,
    )
    camera = DepthCamera(model, Solids(plane(p_true, n_true, [4, 4])), np.random.default_rng(2))
    local = LocalSurface(model)
    state = State.create(vehicle.lengths)
    surface = SurfaceEstimate.create()
    pursuit.approach(0.0, wall_target(vehicle), 0.0, 0.2)
    t = 0.0
    while t < 20.0:
        pursuit.write(t)
        p_WT, R_WT = tool(vehicle, pursuit)
        state.p_WB[:] = pursuit.reference.p_WB
        state.q_WB[:] = pursuit.reference.q_WB
        state.q_WT[:] = matrix_to_quaternion(R_WT)
        camera.sample(Truth(state))
        p_WD = state.p_WB + rotate(state.q_WB, np.array(model.mount.position_m))
        local.update(camera.points_D, p_WD, p_WT, R_WT, surface)
        pursuit.observe(t, surface)
        t += 0.2
    p_WT, R_WT = tool(vehicle, pursuit)
    assert pursuit.implausible == 0
    assert pursuit.arrived(t)
    # Noise: 0.2° of the normals, 0.2 mm of the distance, each smoothed by the corrections.
    assert abs((p_WT - p_true) @ n_true) < 0.003
    assert np.arccos(min(1.0, -R_WT[:, 2] @ n_true)) < np.radians(0.6)


def test_press_keeps_the_surface_seen_in_the_approach_and_another_target_does_not():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    target = wall_target(vehicle)
    p_true = P_WC + 0.04 * N_W
    pursuit.approach(0.0, target, -0.1, 0.5)
    t = fly_approach(pursuit, seen(p_true, N_W))
    pursuit.approach(t, target, 0.1, 0.1)
    pursuit.write(t + 20.0)
    assert np.allclose(tool(vehicle, pursuit)[0], p_true - 0.1 * N_W)
    pursuit.approach(t + 20.0, target.model_copy(update={"index": 1}), 0.1, 0.1)
    pursuit.write(t + 40.0)
    assert np.allclose(tool(vehicle, pursuit)[0], P_WC - 0.1 * N_W)


def test_noise_of_the_normals_neither_delays_nor_shakes_the_reference():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    rng = np.random.default_rng(3)
    noise = np.radians(0.3)
    pursuit.approach(0.0, wall_target(vehicle), 0.1, 0.3)
    planned_s = pursuit._trajectory.end_s
    t = fly_approach(pursuit, seen(P_WC, N_W), rng=rng, noise_rad=noise)
    assert t < planned_s + 1.5
    angles, accelerations = [], []
    for k in range(200):
        n = Rotation.from_rotvec(noise * rng.standard_normal(3)).apply(N_W)
        pursuit.observe(t + 0.2 * k, seen(P_WC, n))
        for j in range(4):
            now = written(pursuit, t + 0.2 * k + 0.05 * j)
            accelerations.append(np.linalg.norm(now["a_WB_W"]))
        angles.append(np.arccos(min(1.0, -tool(vehicle, pursuit)[1][:, 2] @ N_W)))
    assert np.sqrt(np.mean(np.square(angles))) < 0.75 * np.sqrt(2.0) * noise
    assert max(accelerations) < 0.15
    assert pursuit.arrived(t + 40.0)


@pytest.mark.parametrize(
    "surface",
    [
        seen(P_WC, turned(N_W, 0.0, 0.0, 35.0)),
        seen(P_WC, -N_W),
        seen(P_WC + 0.5 * N_W, N_W),
        seen(P_WC, np.full(3, np.nan)),
    ],
    ids=["turned too far", "turned over", "too far away", "not a number"],
)
def test_implausible_surfaces_are_counted_and_not_followed(surface):
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    pursuit.approach(0.0, wall_target(vehicle), -0.1, 0.5)
    for k in range(5):
        pursuit.observe(0.2 * k, surface)
    pursuit.write(20.0)
    assert pursuit.implausible == 5
    assert np.allclose(tool(vehicle, pursuit)[0], P_WC + 0.1 * N_W)


def test_invalid_estimates_and_estimates_without_an_approach_change_nothing():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    surface = seen(P_WC + 0.1 * N_W, N_W)
    pursuit.observe(0.0, surface)
    pursuit.approach(0.0, wall_target(vehicle), -0.1, 0.5)
    surface.valid = 0.0
    pursuit.observe(0.2, surface)
    pursuit.write(20.0)
    assert pursuit.implausible == 0
    assert np.allclose(tool(vehicle, pursuit)[0], P_WC + 0.1 * N_W)


def test_what_cannot_be_reached_is_refused_or_ignored():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    target = wall_target(vehicle)
    pursuit.approach(0.0, target, -0.1, 0.5)
    vehicle.reach = False
    pursuit.observe(0.2, seen(P_WC + 0.05 * N_W, N_W))
    assert pursuit.implausible == 1
    with pytest.raises(ValueError, match="A1"):
        pursuit.approach(0.4, target, 0.1, 0.5)


def test_hold_stops_soon_and_stays():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, START)
    pursuit.go_to(0.0, [Posture(np.array([4.0, 0.0, 1.0]), START.q_WB)], 1.0)
    before = written(pursuit, 3.0)
    pursuit.hold(3.0)
    assert not pursuit.arrived(3.0)
    stopped = written(pursuit, 5.0)
    assert pursuit.arrived(5.0)
    assert np.allclose(stopped["v_WB_W"], 0.0, atol=1e-12)
    speed = np.linalg.norm(before["v_WB_W"])
    assert np.linalg.norm(stopped["p_WB"] - before["p_WB"]) < speed**2
    assert np.allclose(written(pursuit, 50.0)["p_WB"], stopped["p_WB"])


def test_an_arm_is_interpolated_and_carries_the_tip():
    vehicle = FakeArm()
    start = Posture(START.p_WB, START.q_WB, np.zeros(2))
    pursuit = Pursuit(vehicle, start)
    goal = Posture(START.p_WB, START.q_WB, np.array([1.0, 0.5]))
    pursuit.go_to(0.0, [goal], 0.5)
    end = max(15 / 8 / 0.7, np.sqrt(10 / np.sqrt(3) / 0.7))
    pursuit.write(0.5 * end)
    assert np.allclose(pursuit.reference.arm_angle, [0.5, 0.25])
    assert np.allclose(pursuit.reference.p_WT, [0.55 + 0.075, 0.0, 1.02])
    pursuit.write(end + 1.0)
    assert pursuit.arrived(end + 1.0)
    assert np.allclose(pursuit.reference.arm_angle, goal.joint_angle)
