"""Strokes: smooth across knots, pieces and ends; slow in bends; true to a curved surface."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from fake_vehicle import FakeVehicle, target_at

from inspect_cli.guidance.contact_frame import ContactFrame
from inspect_cli.guidance.orientation import contact_orientation
from inspect_cli.guidance.pursuit import Pursuit
from inspect_cli.guidance.stroke import StrokePath, along, corrected
from inspect_cli.interfaces import FramePose, Posture
from inspect_cli.records import SurfaceEstimate
from inspect_cli.schema.plan import Stroke
from inspect_cli.spatial.primitives import cylinder, normal_at, plane, point_at, project
from inspect_cli.spatial.rotations import matrix_to_quaternion, quaternion_to_matrix

PRESS_M = 0.1
HERE = Posture(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0]))
Y_W = np.array([0.0, 1.0, 0.0])
BOARD = plane([2.0, 0.0, 1.5], [-1.0, 0.0, 0.0], [2.0, 2.0])
COLUMN = cylinder([3.0, 0.0, 1.5], [0.0, 0.0, 1.0], 1.0, [-1.0, 0.0, 0.0], [4.0, 2.0])
CIRCLE = np.array([[0.1 * np.cos(a), 0.1 * np.sin(a)] for a in np.linspace(0, 2 * np.pi, 315)])
LINE = np.array([[-0.2, 0.0], [0.2, 0.0]])
SPEED, ACCELERATION = 0.1, 1.0


def posture_on(vehicle, prim):
    def at(u, v):
        n = normal_at(prim, 0, u, v)
        p = point_at(prim, 0, u, v) - PRESS_M * n
        return vehicle.solve({"tool": FramePose(p, contact_orientation(n, Y_W))}, {}, HERE)

    return at


def motions(stretches, per_stretch=16):
    """(times, motions) evenly over every stretch, with both sides of each knot."""
    times, found = [], []
    for stretch in stretches:
        for share in np.linspace(0.0, 1.0, per_stretch):
            times.append(stretch.start_s + share * stretch.duration_s)
            found.append(stretch.motion(times[-1]))
    return np.array(times), found


@pytest.mark.parametrize("prim", [BOARD, COLUMN], ids=["board", "column"])
@pytest.mark.parametrize("points", [LINE, CIRCLE], ids=["line", "circle"])
def test_nothing_jumps_across_knots_and_both_ends_rest(prim, points):
    path = StrokePath(points, SPEED, ACCELERATION)
    stretches = along(3.0, path, posture_on(FakeVehicle(), prim))
    assert stretches[0].start_s == 3.0
    assert stretches[-1].end_s == pytest.approx(3.0 + path.duration_s)
    for before, after in pairwise(stretches):
        assert after.start_s == pytest.approx(before.end_s, abs=1e-12)
        a, b = before.motion(before.end_s), after.motion(after.start_s)
        for name in ("p_WB", "q_WB", "v_WB_W", "w_WB_B", "a_WB_W", "alpha_WB_B"):
            np.testing.assert_allclose(getattr(a, name), getattr(b, name), atol=1e-8)
    for end in (stretches[0].motion(3.0), stretches[-1].motion(stretches[-1].end_s)):
        for name in ("v_WB_W", "w_WB_B", "a_WB_W", "alpha_WB_B"):
            np.testing.assert_allclose(getattr(end, name), 0.0, atol=1e-8)


@pytest.mark.parametrize("prim", [BOARD, COLUMN], ids=["board", "column"])
def test_rates_are_the_derivatives_of_positions(prim):
    path = StrokePath(CIRCLE, SPEED, ACCELERATION)
    stretches = along(0.0, path, posture_on(FakeVehicle(), prim))
    h = 1e-4
    for stretch in stretches[:: max(1, len(stretches) // 20)]:
        t = stretch.start_s + 0.37 * stretch.duration_s
        low, mid, high = (stretch.motion(t + d) for d in (-h, 0.0, h))
        np.testing.assert_allclose((high.p_WB - low.p_WB) / (2 * h), mid.v_WB_W, atol=1e-6)
        np.testing.assert_allclose((high.v_WB_W - low.v_WB_W) / (2 * h), mid.a_WB_W, atol=1e-4)
        np.testing.assert_allclose((high.w_WB_B - low.w_WB_B) / (2 * h), mid.alpha_WB_B, atol=1e-4)
        R = quaternion_to_matrix(low.q_WB).T @ quaternion_to_matrix(high.q_WB)
        turn = 0.5 * np.array([R[2, 1] - R[1, 2], R[0, 2] - R[2, 0], R[1, 0] - R[0, 1]])
        np.testing.assert_allclose(turn / (2 * h), mid.w_WB_B, atol=1e-6)


@pytest.mark.parametrize("points", [LINE, CIRCLE, LINE / 40], ids=["line", "circle", "speck"])
def test_limits_hold_on_a_plane(points):
    """The spline swings a little about the law of progress: 6 % of the speed at the most."""
    path = StrokePath(points, SPEED, ACCELERATION)
    _, found = motions(along(0.0, path, posture_on(FakeVehicle(), BOARD)))
    assert max(np.linalg.norm(m.v_WB_W) for m in found) <= 1.06 * SPEED
    assert max(np.linalg.norm(m.a_WB_W) for m in found) <= 1.05 * ACCELERATION


def test_bends_slow_the_piece_down():
    """On a circle v² / r stays within the limit."""
    path = StrokePath(CIRCLE * 0.1, 1.0, ACCELERATION)
    assert path.progress.speed_mps == pytest.approx(np.sqrt(0.01 * ACCELERATION), rel=0.02)
    assert StrokePath(LINE, 1.0, ACCELERATION).progress.speed_mps == pytest.approx(
        np.sqrt(8 * 0.4 / 15)
    )


def test_a_small_bend_in_a_long_line_is_not_missed():
    """12 m of straight line and a half circle of 10 mm radius at its end, 2 mm apart."""
    a = np.linspace(-np.pi / 2, np.pi / 2, 16)
    straight = np.column_stack([np.arange(0.0, 12.0, 0.002), np.zeros(6000)])
    bend = np.array([12.0, 0.01]) + 0.01 * np.column_stack([np.cos(a), np.sin(a)])
    back = np.column_stack([np.arange(12.0, 11.0, -0.002)[1:], np.full(499, 0.02)])
    path = StrokePath(np.concatenate([straight, bend, back]), 1.0, ACCELERATION)
    # Where line and circle meet the spline swings to up to 1.5 times the curvature.
    assert 0.08 <= path.progress.speed_mps <= np.sqrt(0.01)


@pytest.mark.parametrize("prim", [BOARD, COLUMN], ids=["board", "column"])
def test_the_tool_stays_on_the_line_and_square_to_the_surface(prim):
    vehicle = FakeVehicle()
    path = StrokePath(CIRCLE, SPEED, ACCELERATION)
    times, found = motions(along(0.0, path, posture_on(vehicle, prim)), 5)
    for t, m in zip(times, found, strict=True):
        p_WT, R_WT = vehicle.frame_pose(Posture(m.p_WB, m.q_WB), "tool")
        u, v, w = project(prim, 0, p_WT)
        assert w == pytest.approx(-PRESS_M, abs=1e-4)
        np.testing.assert_allclose([u, v], path.at(t), atol=2e-4)
        assert R_WT[:, 2] @ normal_at(prim, 0, u, v) <= -np.cos(1e-3)


def test_a_surface_seen_elsewhere_carries_the_stroke_with_it():
    """The column stands 5 cm nearer and is turned by 5°: so is the stroke."""
    n = normal_at(COLUMN, 0, 0.0, 0.0)
    planned = ContactFrame(point_at(COLUMN, 0, 0.0, 0.0), n, contact_orientation(n, Y_W), True)
    yaw = np.radians(5.0)
    R = np.array([[np.cos(yaw), -np.sin(yaw), 0], [np.sin(yaw), np.cos(yaw), 0], [0, 0, 1.0]])
    shifted = planned.p_WC + 0.05 * n
    aim_at = corrected(COLUMN, planned, planned.at(shifted, R @ n))
    for uv in [(0.0, 0.0), (0.3, 0.2), (-0.4, 0.1)]:
        aim = aim_at(*uv)
        expected = shifted + R @ (point_at(COLUMN, 0, *uv) - planned.p_WC)
        np.testing.assert_allclose(aim.p_WC, expected, atol=1e-12)
        np.testing.assert_allclose(aim.n_W, R @ normal_at(COLUMN, 0, *uv), atol=1e-12)
        np.testing.assert_allclose(aim.R_WT[:, 2], -aim.n_W, atol=1e-12)


def stroke_target(vehicle, prim, *pieces, speed=SPEED):
    u, v = pieces[0][0]
    n = normal_at(prim, 0, u, v)
    R_WT = contact_orientation(n, Y_W)
    stroke = Stroke(
        pieces_m=tuple(tuple(map(tuple, np.asarray(p).tolist())) for p in pieces), speed_mps=speed
    )
    target = target_at(vehicle, point_at(prim, 0, u, v), n, R_WT)
    return target.model_copy(update={"kind": "stroke", "stroke": stroke, "sensor": None})


def seen_from(prim, p_W) -> SurfaceEstimate:
    surface = SurfaceEstimate.create()
    u, v, _ = project(prim, 0, p_W)
    surface.p_WC[:], surface.n_W[:] = point_at(prim, 0, u, v), normal_at(prim, 0, u, v)
    surface.valid = 1.0
    return surface


def test_a_stroke_far_round_a_column_does_not_turn_the_tool_over():
    """From −75° to 75°: the level y axis of the end points against that of the beginning."""
    vehicle = FakeVehicle()
    turn = np.radians(75.0)
    target = stroke_target(vehicle, COLUMN, [(-turn, 0.0), (turn, 0.0)], speed=0.3)
    pursuit = Pursuit(vehicle, HERE, {"wall": COLUMN})
    pursuit.approach(0.0, target, PRESS_M, 0.5)
    pursuit.write(60.0)
    pursuit.slide(60.0, target)
    t, last = 60.0, None
    while not pursuit.arrived(t):
        pursuit.write(t)
        q = pursuit.reference.q_WB.copy()
        _, R_WT = vehicle.frame_pose(Posture(pursuit.reference.p_WB, q), "tool")
        assert abs(R_WT[2, 1]) < 1e-6
        # 0.3 m/s on 1 m: 0.3 rad/s, so no step of 20 ms turns by more than that.
        assert last is None or abs(q @ last) >= np.cos(0.5 * 0.02 * 0.36)
        last, t = q, t + 0.02
    p_WT, _ = vehicle.frame_pose(Posture(pursuit.reference.p_WB, pursuit.reference.q_WB), "tool")
    np.testing.assert_allclose(project(COLUMN, 0, p_WT)[0], turn, atol=0.01)


def test_a_stroke_is_drawn_on_the_plane_that_was_seen_and_left_where_it_ends():
    """The board is 6 cm nearer than believed; retreat leads off from the stroke's end."""
    vehicle = FakeVehicle()
    true = plane([1.94, 0.0, 1.5], [-1.0, 0.0, 0.0], [2.0, 2.0])
    target = stroke_target(vehicle, BOARD, LINE, [LINE[1], (-0.2, 0.1)])
    pursuit = Pursuit(vehicle, HERE, {"wall": BOARD})
    pursuit.approach(0.0, target, PRESS_M, 0.5)
    for k in range(60):
        pursuit.observe(0.2 * k, seen_from(true, pursuit.reference.p_WT))
        pursuit.write(0.2 * k + 0.2)
    t = 30.0
    pursuit.slide(t, target)
    assert not pursuit.arrived(t)
    while not pursuit.arrived(t):
        pursuit.write(t)
        u, v, w = project(true, 0, pursuit.reference.p_WT)
        assert w == pytest.approx(-PRESS_M, abs=1e-3)
        assert abs(u) <= 0.2 + 1e-4
        assert -1e-4 <= v <= 0.1 + 1e-4
        t += 0.02
    pursuit.approach(t, target, -0.25, 0.5)
    pursuit.write(t + 30.0)
    np.testing.assert_allclose(
        project(true, 0, pursuit.reference.p_WT), [-0.2, 0.1, 0.25], atol=1e-3
    )


def test_a_slide_needs_a_touch_and_a_line():
    vehicle = FakeVehicle()
    pursuit = Pursuit(vehicle, HERE, {"wall": BOARD})
    target = stroke_target(vehicle, BOARD, LINE)
    with pytest.raises(ValueError, match="touched before"):
        pursuit.slide(0.0, target)
    contact = target.model_copy(update={"stroke": None})
    pursuit.approach(0.0, contact, PRESS_M, 0.5)
    with pytest.raises(ValueError, match="no line"):
        pursuit.slide(20.0, contact)


def test_quaternions_of_targets_are_unit():
    """A guard of the helper: the turn that the plan writes is the one that is flown."""
    target = stroke_target(FakeVehicle(), COLUMN, LINE)
    R_WT = contact_orientation(normal_at(COLUMN, 0, *LINE[0]), Y_W)
    np.testing.assert_allclose(target.q_WT, matrix_to_quaternion(np.ascontiguousarray(R_WT)))
