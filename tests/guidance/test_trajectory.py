"""Quintic stretches against finite differences, closed forms and their limits."""

from __future__ import annotations

import numpy as np
import pytest
from fake_vehicle import FakeVehicle
from scipy.spatial.transform import Rotation

from inspect_cli.guidance.motion import Motion, MotionLimits
from inspect_cli.guidance.quintic import body_rates
from inspect_cli.guidance.trajectory import Stretch, Trajectory, through, to_goal, to_stop
from inspect_cli.interfaces import Posture

LIMITS = MotionLimits.of(FakeVehicle())


def rotation(q):
    return Rotation.from_quat(q, scalar_first=True)


def moving(rng, speed=0.5, turn=0.3, joints=2) -> Motion:
    arm = rng.uniform(-0.3, 0.3, (3, joints))
    return Motion(
        rng.uniform(-1.0, 1.0, 3),
        Rotation.random(random_state=rng).as_quat(scalar_first=True),
        speed * rng.uniform(-1.0, 1.0, 3),
        turn * rng.uniform(-1.0, 1.0, 3),
        rng.uniform(-0.5, 0.5, 3),
        rng.uniform(-0.3, 0.3, 3),
        arm,
    )


def posture(rng, joints=2, way=2.0) -> Posture:
    q = Rotation.random(random_state=rng).as_quat(scalar_first=True)
    return Posture(rng.uniform(-way, way, 3), q, rng.uniform(-1.0, 1.0, joints))


def same(a: Motion, b: Motion, atol=1e-9) -> bool:
    return all(np.allclose(getattr(a, name), value, atol=atol) for name, value in vars(b).items())


@pytest.mark.parametrize("angle", [0.0, 1e-8, 1e-3, 0.0499, 0.0501, 1.0, 3.1, 5.0])
def test_body_rates_against_finite_differences_of_the_rotation(angle):
    rng = np.random.default_rng(int(1e4 * angle))
    axis = rng.standard_normal(3)
    phi_0 = angle * axis / np.linalg.norm(axis)
    phi_1, phi_2 = rng.standard_normal((2, 3))
    w, alpha = np.empty(3), np.empty(3)
    body_rates(phi_0, phi_1, phi_2, w, alpha)

    def attitude(t):
        return Rotation.from_rotvec(phi_0 + phi_1 * t + 0.5 * phi_2 * t * t)

    def rate(t, h=1e-4):
        return (attitude(t - h).inv() * attitude(t + h)).as_rotvec() / (2 * h)

    # Central differences: errors of order h², times third derivatives of order ten.
    assert np.allclose(w, rate(0.0), atol=1e-6)
    h = 1e-3
    assert np.allclose(alpha, (rate(h) - rate(-h)) / (2 * h), atol=1e-4)


def test_series_and_closed_form_meet():
    phi_1, phi_2 = np.array([0.3, -0.5, 0.7]), np.array([-1.0, 0.4, 0.2])
    axis = np.array([0.6, -0.48, 0.64])
    out = np.empty((2, 2, 3))
    for i, angle in enumerate((0.05 - 1e-10, 0.05 + 1e-10)):
        body_rates(angle * axis, phi_1, phi_2, out[i, 0], out[i, 1])
    assert np.abs(out[0] - out[1]).max() < 1e-8


@pytest.mark.parametrize("seed", range(5))
def test_stretch_joins_both_ends_and_its_rates_are_derivatives(seed):
    rng = np.random.default_rng(seed)
    start, goal = moving(rng), posture(rng)
    phi = (rotation(start.q_WB).inv() * rotation(goal.q_WB)).as_rotvec()
    stretch = Stretch.to_rest(2.0, start, goal.p_WB, phi, goal.joint_angle, 5.0, 5.0)
    end = stretch.motion(7.0)
    assert same(stretch.motion(2.0), start)
    assert np.allclose(end.p_WB, goal.p_WB)
    assert (rotation(end.q_WB).inv() * rotation(goal.q_WB)).magnitude() < 1e-7
    assert np.allclose(end.arm, [goal.joint_angle, [0.0] * 2, [0.0] * 2])
    for name in ("v_WB_W", "a_WB_W", "w_WB_B", "alpha_WB_B"):
        assert np.allclose(getattr(end, name), 0.0, atol=1e-12)
    h = 1e-4
    for t in rng.uniform(2.1, 6.9, 20):
        before, now, after = (stretch.motion(t + k * h) for k in (-1, 0, 1))
        assert np.allclose(now.v_WB_W, (after.p_WB - before.p_WB) / (2 * h), atol=1e-6)
        assert np.allclose(now.a_WB_W, (after.v_WB_W - before.v_WB_W) / (2 * h), atol=1e-6)
        turned = (rotation(before.q_WB).inv() * rotation(after.q_WB)).as_rotvec() / (2 * h)
        assert np.allclose(now.w_WB_B, turned, atol=1e-6)
        slope = (after.w_WB_B - before.w_WB_B) / (2 * h)
        assert np.allclose(now.alpha_WB_B, slope, atol=1e-6)
        assert np.allclose(now.arm[1:], (after.arm - before.arm)[:2] / (2 * h), atol=1e-6)


def peaks(trajectory, start_s=0.0):
    motions = [trajectory.motion(t) for t in np.linspace(start_s, trajectory.end_s, 2000)]
    return {
        name: max(float(np.linalg.norm(getattr(m, name))) for m in motions)
        for name in ("v_WB_W", "a_WB_W", "w_WB_B", "alpha_WB_B")
    }


@pytest.mark.parametrize("way", [0.02, 0.5, 4.0])
def test_rest_to_rest_takes_no_longer_than_the_limits_ask_for(way):
    start = Motion.at_rest(Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])))
    goal = Posture(way * np.array([0.6, 0.0, 0.8]), start.q_WB)
    (stretch,) = to_goal(0.0, start, goal, LIMITS)
    expected = max(15 * way / 8, np.sqrt(10 * way / np.sqrt(3)))
    assert stretch.duration_s == pytest.approx(expected)
    peak = peaks(Trajectory([stretch]))
    # At least one of the two limits is used up and none is passed.
    assert max(peak["v_WB_W"], peak["a_WB_W"]) == pytest.approx(1.0, rel=1e-3)


@pytest.mark.parametrize("turn", [0.05, 1.5, 3.1])
def test_turn_on_the_spot_obeys_the_angular_limits(turn):
    start = Motion.at_rest(Posture(np.ones(3), np.array([0.0, 0.6, 0.0, 0.8])))
    q_goal = (rotation(start.q_WB) * Rotation.from_rotvec([0.0, turn, 0.0])).as_quat(
        scalar_first=True
    )
    trajectory = Trajectory(to_goal(0.0, start, Posture(np.ones(3), q_goal), LIMITS))
    peak = peaks(trajectory)
    shares = peak["w_WB_B"] / 0.7, peak["alpha_WB_B"] / 0.7
    assert max(shares) == pytest.approx(1.0, rel=1e-3)


def test_from_rest_the_path_is_straight_and_the_turn_about_one_axis():
    rng = np.random.default_rng(4)
    start, goal = Motion.at_rest(posture(rng, 0)), posture(rng, 0)
    (stretch,) = to_goal(0.0, start, goal, LIMITS)
    line = goal.p_WB - start.p_WB
    turn = (rotation(start.q_WB).inv() * rotation(goal.q_WB)).as_rotvec()
    for share in (0.1, 0.4, 0.8):
        now = stretch.motion(share * stretch.duration_s)
        done = 10 * share**3 - 15 * share**4 + 6 * share**5
        assert np.allclose(now.p_WB, start.p_WB + done * line)
        turned = (rotation(start.q_WB).inv() * rotation(now.q_WB)).as_rotvec()
        assert np.allclose(turned, done * turn)


def test_waypoints_are_passed_at_rest_in_their_order():
    rng = np.random.default_rng(7)
    start = Motion.at_rest(posture(rng, 1))
    goals = [posture(rng, 1) for _ in range(3)]
    stretches = through(1.0, start, goals, LIMITS)
    trajectory = Trajectory(stretches)
    for goal, stretch in zip(goals, stretches, strict=True):
        now = trajectory.motion(stretch.end_s)
        assert np.allclose(now.p_WB, goal.p_WB)
        assert np.allclose(now.arm[0], goal.joint_angle)
        assert np.allclose([now.v_WB_W, now.w_WB_B], 0.0, atol=1e-9)
    assert np.allclose(trajectory.motion(trajectory.end_s + 9.0).p_WB, goals[-1].p_WB)


def test_arm_joints_obey_the_angular_limits():
    start = Motion.at_rest(Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(2)))
    goal = Posture(np.zeros(3), start.q_WB, np.array([2.0, -0.1]))
    (stretch,) = to_goal(0.0, start, goal, LIMITS)
    times = np.linspace(0.0, stretch.end_s, 500)
    arm = np.array([stretch.arm_motion(t) for t in times])
    shares = np.abs(arm[:, 1]).max() / 0.7, np.abs(arm[:, 2]).max() / 0.7
    assert max(shares) == pytest.approx(1.0, rel=1e-3)


def in_flight(rng) -> Motion:
    """A motion in the midst of a stretch that keeps the limits."""
    stretches = to_goal(0.0, Motion.at_rest(posture(rng, 1)), posture(rng, 1), LIMITS)
    return stretches[0].motion(rng.uniform(0.0, stretches[0].duration_s))


@pytest.mark.parametrize("seed", range(20))
def test_limits_hold_from_any_motion_to_any_goal(seed):
    rng = np.random.default_rng(seed)
    start, goal = in_flight(rng), posture(rng, 1)
    trajectory = Trajectory(to_goal(0.0, start, goal, LIMITS))
    assert same(trajectory.motion(0.0), start)
    peak = peaks(trajectory)
    assert peak["v_WB_W"] <= 1.05
    assert peak["a_WB_W"] <= 1.05
    assert peak["w_WB_B"] <= 0.7 * 1.05
    assert peak["alpha_WB_B"] <= 0.7 * 1.05
    assert np.allclose(trajectory.motion(trajectory.end_s).p_WB, goal.p_WB)


@pytest.mark.parametrize("seed", range(20))
def test_stop_is_short_and_within_limits(seed):
    rng = np.random.default_rng(seed)
    start = in_flight(rng)
    stop = to_stop(0.0, start, LIMITS)
    peak = peaks(Trajectory([stop]))
    assert same(stop.motion(0.0), start)
    assert peak["a_WB_W"] <= 1.05
    assert peak["alpha_WB_B"] <= 0.7 * 1.05
    end = stop.motion(stop.end_s)
    assert np.allclose([end.v_WB_W, end.w_WB_B], 0.0, atol=1e-9)
    # An abrupt stop at the limit takes v/a; this one may take three times that.
    shortest = max(np.linalg.norm(start.v_WB_W) / 1.0, np.linalg.norm(start.w_WB_B) / 0.7)
    assert stop.duration_s <= 3.0 * shortest + 0.5


def test_a_fast_vehicle_told_to_creep_brakes_first_and_never_overshoots():
    start = Motion.at_rest(Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0])))
    start.v_WB_W[0] = 0.8
    goal = Posture(np.array([1.0, 0.0, 0.0]), start.q_WB)
    slow = MotionLimits(0.1, 1.0, 0.7, 0.7)
    trajectory = Trajectory(to_goal(0.0, start, goal, slow))
    motions = [trajectory.motion(t) for t in np.linspace(0.0, trajectory.end_s, 3000)]
    x = np.array([m.p_WB[0] for m in motions])
    v = np.array([m.v_WB_W[0] for m in motions])
    assert x.max() <= 1.0 + 1e-9
    assert v.min() >= -1e-9
    # Braking from 0.8 m/s at 1 m/s² with a cubic takes 1.2 s; afterwards it creeps.
    assert np.linspace(0.0, trajectory.end_s, 3000)[v > 0.1 * 1.05].max() < 1.5


def test_an_arm_of_another_vehicle_is_refused():
    start = Motion.at_rest(Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(2)))
    with pytest.raises(ValueError, match="2 joints"):
        to_goal(0.0, start, Posture(np.ones(3), start.q_WB, np.zeros(1)), LIMITS)
