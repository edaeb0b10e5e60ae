"""Contact poses against the geometry that defines them."""

from __future__ import annotations

import numpy as np
import pytest
from builders import ball, column, grid, plan, wall
from rigid import ArmVehicle, RigidVehicle

from inspect_cli.errors import InfeasibleError
from inspect_cli.interfaces import TOOL, DepthLaw, Posture, Shortfall
from inspect_cli.planning.contact_poses import tool_attitudes, touches
from inspect_cli.planning.points import points_of_task
from inspect_cli.schema.mission import Task
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.rotations import quaternion_to_matrix, roll_pitch_yaw_matrix

EXACT = 1e-12
LEVEL = np.array([1.0, 0.0, 0.0, 0.0])


def radial(shape, p):
    """Outward normal from the shape's definition, not from the kernels."""
    if shape.kind == "plane":
        return np.array(shape.normal)
    away = p - np.array(shape.center_m)
    if shape.kind == "cylinder":
        axis = np.array(shape.axis)
        away = away - (away @ axis) * axis
    away /= np.linalg.norm(away)
    return away if shape.side == "outside" else -away


def tilted(direction, roll, pitch, yaw):
    return tuple(roll_pitch_yaw_matrix(*np.radians([roll, pitch, yaw])) @ direction)


SHAPES = {
    "wall": wall(),
    "leaning wall": wall(normal=(-0.9, 0.2, -0.4)),
    "sloping wall": wall(normal=tilted((-1.0, 0.0, 0.0), 0.0, 25.0, 40.0)),
    "column": column(),
    "leaning column": column(axis=(0.2, 0.1, 1.0), facing=(-1.0, 0.2, 0.0)),
    "lying pipe": column(axis=(0.0, 1.0, 0.0), facing=(-1.0, 0.0, 0.3), center=(2.0, 0.0, 2.0)),
    "ball": ball(),
    "turned ball": ball(facing=(-1.0, 0.5, -0.3), size=(0.8, 0.8)),
    "tank from inside": ball(
        center=(0.0, 0.0, 2.5), radius=2.2, facing=(1.0, 0.0, 0.0), side="inside"
    ),
}


@pytest.mark.parametrize("vehicle", [RigidVehicle(), ArmVehicle()], ids=["rigid", "arm"])
@pytest.mark.parametrize("name", SHAPES)
def test_tool_meets_the_surface_head_on_and_level(name, vehicle):
    shape = SHAPES[name]
    made = plan(vehicle, grid(rows=3, columns=3, pitch_m=0.2), surfaces={"wall": shape})
    press = {leg.target: leg.postures[-1] for leg in made.legs if leg.kind == "press"}
    assert len(made.targets) == 9
    for target in made.targets:
        p_WC = np.array(target.p_WC)
        n = radial(shape, p_WC)
        np.testing.assert_allclose(target.n_W, n, atol=1e-9)
        for posture, distance in (
            (target.standoff, target.standoff_m),
            (target.contact, 0.0),
            (press[target.index], -target.press_m),
        ):
            p_WT, R_WT = vehicle.frame_pose(posture.posture, TOOL)
            np.testing.assert_allclose(p_WT, p_WC + distance * n, atol=1e-9)
            np.testing.assert_allclose(R_WT[:, 2], -n, atol=1e-9)
            assert abs(R_WT[2, 1]) < EXACT
            np.testing.assert_allclose(R_WT, quaternion_to_matrix(np.array(target.q_WT)), atol=1e-9)
            assert quaternion_to_matrix(np.array(posture.q_WB))[2, 2] > 0.0


def test_attitudes_are_rotations_with_the_nearer_heading_first():
    rng = np.random.default_rng(3)
    for _ in range(200):
        n = rng.normal(size=3)
        n /= np.linalg.norm(n)
        y_near = rng.normal(size=3)
        first, second = tool_attitudes(n, y_near)
        for R in (first, second):
            np.testing.assert_allclose(R.T @ R, np.eye(3), atol=EXACT)
            assert np.linalg.det(R) == pytest.approx(1.0)
        np.testing.assert_allclose(first[:, 1], -second[:, 1], atol=EXACT)
        assert first[:2, 1] @ y_near[:2] >= -1e-9


def _touch_ceiling(slope_deg, previous, vehicle):
    """Touch a ceiling whose normal leans ``slope_deg`` from straight down towards x_W."""
    slope = np.radians(slope_deg)
    shape = wall(center=(0.0, 0.0, 3.0), normal=(np.sin(slope), 0.0, -np.cos(slope)))
    task = Task.model_validate({"contact_grid": grid(columns=1)["contact_grid"]})
    point = points_of_task(task, primitive_of(shape), 1, "contact_ndt", None)[0]
    return touches(vehicle, point, DepthLaw(0.1, "contact_ndt", 1.8), previous)[0]


@pytest.mark.parametrize("heading_deg", [0.0, 35.0, 120.0, -150.0])
def test_vertical_tool_keeps_the_heading(heading_deg):
    vehicle = RigidVehicle(pitch_deg=150.0)
    half = np.radians(heading_deg) / 2.0
    previous = Posture(np.zeros(3), np.array([np.cos(half), 0.0, 0.0, np.sin(half)]))
    touch = _touch_ceiling(0.0, previous, vehicle)
    R_WB = quaternion_to_matrix(touch.contact.q_WB)
    heading = np.degrees(np.arctan2(-R_WB[0, 1], R_WB[1, 1]))
    assert heading == pytest.approx(heading_deg, abs=1e-9)
    np.testing.assert_allclose(touch.R_WT[:, 2], [0.0, 0.0, 1.0], atol=EXACT)
    # The arm is 30° off z_B, so the body leans by 30° to bring it upright.
    assert np.degrees(np.arccos(R_WB[2, 2])) == pytest.approx(30.0, abs=1e-9)


def test_heading_goes_on_while_the_tool_passes_the_vertical():
    """Sliding along a vault the attitude turns about y_T alone: no flip where z_T is vertical."""
    vehicle = RigidVehicle(pitch_deg=150.0)
    previous = Posture(np.zeros(3), LEVEL)
    step_deg = 0.25
    before = None
    for slope_deg in np.arange(-20.0, 20.0 + step_deg / 2.0, step_deg):
        touch = _touch_ceiling(slope_deg, previous, vehicle)
        np.testing.assert_allclose(touch.R_WT[:, 1], [0.0, 1.0, 0.0], atol=1e-9)
        if before is not None:
            turn = before.T @ touch.R_WT
            angle_deg = np.degrees(np.arccos((np.trace(turn) - 1.0) / 2.0))
            assert angle_deg == pytest.approx(step_deg, abs=1e-5)
        before, previous = touch.R_WT, touch.contact


def test_upright_goes_before_heading():
    """A wall in the back asks a 30° arm to turn round rather than to hang head down."""
    vehicle = RigidVehicle(pitch_deg=150.0)
    made = plan(
        vehicle,
        grid(columns=1),
        surfaces={"wall": wall(center=(-2.0, 0.0, 2.0), normal=(1.0, 0.0, 0.0))},
    )
    R_WB = quaternion_to_matrix(np.array(made.targets[0].contact.q_WB))
    assert R_WB[2, 2] == pytest.approx(0.5, abs=1e-12)
    np.testing.assert_allclose(R_WB[:, 1], [0.0, -1.0, 0.0], atol=1e-12)


class Recorder(RigidVehicle):
    """Remembers where its tool was wanted, and under which loads."""

    def solve(self, goals, loads, near):
        self.asked.append((goals[TOOL].p.copy(), {k: v.copy() for k, v in loads.items()}))
        return super().solve(goals, loads, near)

    @property
    def asked(self):
        return self.__dict__.setdefault("_asked", [])


def test_the_vehicle_hears_the_load_of_the_contact_and_none_at_the_standoff():
    vehicle = Recorder()
    point = points_of_task(
        Task.model_validate(grid(columns=1)), primitive_of(wall()), 1, "contact_ndt", None
    )[0]
    touches(vehicle, point, DepthLaw(0.1, "contact_ndt", 1.8), Posture(np.zeros(3), LEVEL))
    pushed = np.array([-1.8, 0.0, 0.0, 0.0, 0.0, 0.0])
    for k, (p, loads) in enumerate(vehicle.asked):
        if k % 3 == 0:
            assert p[0] == pytest.approx(2.0 - 0.25)
            assert loads == {}
        else:
            assert p[0] == pytest.approx(2.0 + (0.0, 0.10)[k % 3 - 1])
            assert set(loads) == {TOOL}
            np.testing.assert_allclose(loads[TOOL], pushed, atol=1e-12)
    assert len(vehicle.asked) == 6


class Unable(RigidVehicle):
    def solve(self, goals, loads, near):
        return Shortfall("its arm is off", "switch it on")


def test_why_no_posture_does_it_is_in_the_vehicles_words():
    with pytest.raises(InfeasibleError) as refusal:
        plan(Unable(), grid(columns=1))
    (problem,) = refusal.value.problems
    assert "no posture brings the tool to (2.00, 0.00, 1.50)" in problem.what
    assert problem.what.endswith(": its arm is off")
    assert problem.hint == "switch it on"
