"""Whole plans: what is refused and why, and what holds for every plan."""

from __future__ import annotations

import time

import numpy as np
import pytest
from builders import column, grid, plan, points, wall
from hypothesis import given, settings
from hypothesis import strategies as st
from rigid import ArmVehicle, RigidVehicle

from inspect_cli.errors import InfeasibleError
from inspect_cli.schema.plan import Plan
from inspect_cli.spatial.rotations import quaternion_to_matrix

CEILING = wall(center=(1.0, 0.0, 3.0), normal=(0.0, 0.0, -1.0), size=(2.0, 2.0))
FLOOR = wall(center=(0.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0), size=(6.0, 6.0))


def refusals(vehicle, *tasks, **more):
    with pytest.raises(InfeasibleError) as caught:
        plan(vehicle, *tasks, **more)
    return [problem.what for problem in caught.value.problems]


def test_nine_points_on_a_wall():
    made = plan(RigidVehicle(), grid())
    assert [t.label for t in made.targets] == [str(k) for k in range(1, 10)]
    assert [leg.kind for leg in made.legs] == [
        "takeoff",
        *["transit", "approach", "press", "retreat"] * 9,
        "transit",
        "land",
    ]
    for target in made.targets:
        assert target.expected_force_n == pytest.approx(1.8)
        # Disc of 0.42 m, level, 0.55 m from the wall at contact.
        assert target.clearance_m == pytest.approx(0.13, abs=1e-9)
        # Weight 46.6 N and 1.8 N from the wall, against 120 N in six groups.
        assert target.margins["thrust"].value == pytest.approx((120.0 - np.hypot(46.6, 1.8)) / 6.0)
        assert set(target.margins) == {"thrust"}
    far = max(np.linalg.norm(t.p_WC) for t in made.targets)
    assert made.cable_m == pytest.approx(far)
    assert Plan.model_validate_json(made.model_dump_json(by_alias=True)) == made


def test_every_point_off_or_outside_is_named():
    task = points((1.8, 0.0, 1.5), (2.0, 0.1, 1.5), (2.0, 0.0, 2.6))
    off, outside = refusals(RigidVehicle(), task)
    assert off.startswith("point 1 on 'wall': a point off the surface")
    assert outside.startswith("point 3 on 'wall': outside the patch")


def test_corner_of_two_walls():
    """The body's spheres reach 0.3 m · sin 60° + 0.12 m = 0.380 m to the side."""
    side = wall(center=(1.0, -1.5, 1.5), normal=(0.0, 1.0, 0.0), size=(2.0, 2.0))
    surfaces = {"wall": wall(), "side": side}
    task = points((2.0, -1.2, 1.5), (2.0, -1.0, 1.5), (2.0, -1.08, 1.5))
    into, close = refusals(RigidVehicle(), task, surfaces=surfaces)
    assert into.startswith("point 1 on 'wall': the body overlaps 'side' near (")
    assert into.endswith("by 0.080 m")
    assert close.startswith("point 3 on 'wall': the body comes within 0.040 m of 'side' near")
    assert close.endswith("clearance_m is 0.050")


def test_short_cable():
    (what,) = refusals(RigidVehicle(), grid(columns=1), cable_m=2.4)
    assert what == "point 1 on 'wall': 2.50 m from the start, the cable is 2.40 m long"
    plan(RigidVehicle(), grid(columns=1), cable_m=2.51)


def test_too_little_thrust():
    """At 48 N the vehicle hovers but cannot hold 18 N of contact force besides its weight."""
    weak = RigidVehicle(max_thrust_n=48.0)
    plan(weak, grid(columns=1))
    (what,) = refusals(weak, grid(columns=1, press_m=1.0))
    short_n = (np.hypot(46.6, 18.0) - 48.0) / 6.0
    assert what.startswith("point 1 on 'wall': pressing with 18.00 N asks for")
    assert f"{short_n:.2f} N more" in what


def test_tilt_beyond_its_limit():
    stiff = RigidVehicle(pitch_deg=150.0, max_tilt_deg=20.0)
    (what,) = refusals(stiff, grid(on="ceiling", columns=1), surfaces={"ceiling": CEILING})
    assert "holding still before it asks a joint to turn 10.0° beyond its limit" in what


def test_body_below_the_ground():
    """Level at 0.1 m the body's sphere of 0.2 m is 0.1 m in the ground."""
    (what,) = refusals(
        RigidVehicle(),
        points((2.0, 0.0, 0.1)),
        surfaces={"wall": wall(center=(2.0, 0.0, 1.0))},
    )
    assert what == "point 1 on 'wall': the body reaches 0.100 m below the ground"


def test_force_below_what_the_instrument_needs():
    (what,) = refusals(RigidVehicle(), grid(columns=1, press_m=0.05), min_force_n=1.0)
    assert what == ("point 1 on 'wall': press_m 0.050 gives 0.90 N, the instrument needs 1.00 N")


def test_out_of_the_arm_s_reach():
    """The arm reaches to 20° from the vertical; a level ceiling is beyond that."""
    (what,) = refusals(ArmVehicle(), grid("ceiling", columns=1), surfaces={"ceiling": CEILING})
    assert "no posture brings the tool to (1.00, 0.00, 3.00) along (0.00, 0.00, 1.00)" in what


def test_shut_in():
    """Four walls closer than the vehicle can pass: the outside of one cannot be reached."""
    room = {
        name: wall(center=center, normal=normal, size=(2.4, 40.0))
        for name, center, normal in (
            ("east", (1.2, 0.0, 0.0), (-1.0, 0.0, 0.0)),
            ("west", (-1.2, 0.0, 0.0), (1.0, 0.0, 0.0)),
            ("north", (0.0, 1.2, 0.0), (0.0, -1.0, 0.0)),
            ("south", (0.0, -1.2, 0.0), (0.0, 1.0, 0.0)),
        )
    }
    roof = wall(center=(0.0, 0.0, 3.0), normal=(0.0, 0.0, -1.0), size=(2.4, 2.4))
    outside = wall(center=(1.4, 0.0, 1.5), normal=(1.0, 0.0, 0.0), size=(2.0, 2.0))
    surfaces = {**room, "roof": roof, "outside": outside}
    (what,) = refusals(RigidVehicle(), grid("outside", columns=1), surfaces=surfaces)
    assert "no way from (0.00, 0.00, 1.00) keeps 0.050 m" in what


@pytest.mark.parametrize(
    ("start", "words"),
    [
        ({"takeoff_height_m": 0.2}, "takeoff_height_m 0.200 is not above"),
        ({"position_m": (1.65, 0.0)}, "start: the body overlaps 'wall' near"),
    ],
)
def test_impossible_start(start, words):
    (what,) = refusals(RigidVehicle(), grid(), start=start)
    assert words in what


def test_deck_that_the_vehicle_stands_on():
    """The floor carries the vehicle and is touched from above: no obstacle to take-off."""
    down = RigidVehicle(pitch_deg=0.0)
    made = plan(down, grid("floor", rows=2, columns=2, pitch_m=0.5), surfaces={"floor": FLOOR})
    assert len(made.targets) == 4
    assert made.targets[0].contact.p_WB[2] == pytest.approx(0.55)


def test_second_way_when_the_first_does_not_fit():
    """Under a ceiling a 30° arm lifts the body's front edge; a beam there turns it round."""
    arm = RigidVehicle(pitch_deg=150.0)
    beam = wall(center=(1.3, 0.0, 2.775), normal=(-1.0, 0.0, 0.0), size=(0.4, 0.45))
    task = points((1.0, 0.0, 3.0), on="ceiling")
    for surfaces, y_B in (
        ({"ceiling": CEILING}, [0.0, 1.0, 0.0]),
        ({"ceiling": CEILING, "beam": beam}, [0.0, -1.0, 0.0]),
    ):
        made = plan(arm, task, surfaces=surfaces)
        R_WB = quaternion_to_matrix(np.array(made.targets[0].contact.q_WB))
        np.testing.assert_allclose(R_WB[:, 1], y_B, atol=1e-12)


def test_legs_hold_their_speeds():
    made = plan(RigidVehicle(max_speed_mps=0.3), grid(columns=2))
    for leg in made.legs:
        slow = leg.kind in ("approach", "press", "retreat")
        assert leg.speed_mps == (0.1 if slow else 0.3)
    assert made.duration_s == pytest.approx(sum(leg.duration_s for leg in made.legs))


def rest_to_rest(a, b, speed, vehicle):
    d = np.linalg.norm(np.array(b.p_WB) - a.p_WB)
    turn = 2.0 * np.arccos(min(1.0, abs(np.dot(a.q_WB, b.q_WB))))
    joints = np.abs(np.array(b.arm_angle_rad) - a.arm_angle_rad).max(initial=0.0)
    angle = max(turn, joints)
    # Angular acceleration: the largest rate in the time that the largest speed takes.
    rise_s = vehicle.max_speed_mps / vehicle.max_acceleration_mps2
    return max(
        1.875 * d / speed,
        np.sqrt(10.0 / np.sqrt(3.0) * d / vehicle.max_acceleration_mps2),
        1.875 * angle / vehicle.max_angular_rate_radps,
        np.sqrt(10.0 / np.sqrt(3.0) * angle / vehicle.max_angular_rate_radps * rise_s),
    )


@settings(max_examples=60, deadline=None)
@given(
    vehicle=st.sampled_from([RigidVehicle(), RigidVehicle(pitch_deg=120.0), ArmVehicle()]),
    round_shape=st.booleans(),
    lean=st.floats(-0.3, 0.3),
    rows=st.integers(1, 3),
    columns=st.integers(1, 4),
    pitch_m=st.floats(0.05, 0.2),
    order=st.sampled_from(["boustrophedon", "rows", "shortest"]),
    heading_deg=st.floats(-180.0, 180.0),
    twice=st.booleans(),
)
def test_every_plan_is_whole(
    vehicle, round_shape, lean, rows, columns, pitch_m, order, heading_deg, twice
):
    if round_shape:
        shape = column(center=(2.5, 0.0, 2.0), radius=1.0, axis=(lean, 0.1, 1.0))
    else:
        shape = wall(center=(2.5, 0.0, 2.0), normal=(-1.0, 0.1, lean))
    task = grid(rows=rows, columns=columns, pitch_m=pitch_m, order=order)
    tasks = [task, task] if twice else [task]
    made = plan(vehicle, *tasks, surfaces={"wall": shape}, start={"heading_deg": heading_deg})

    n = rows * columns * len(tasks)
    assert sorted(int(t.label) for t in made.targets) == list(range(1, n + 1))
    assert [t.index for t in made.targets] == list(range(n))
    presses = [leg.target for leg in made.legs if leg.kind == "press"]
    assert presses == list(range(n))

    end = made.start
    for leg in made.legs:
        time_s = 0.0
        for posture in leg.postures:
            time_s += rest_to_rest(end, posture, leg.speed_mps, vehicle)
            end = posture
        target = None if leg.target is None else made.targets[leg.target]
        # The executive rests for 0.2 s where a leg ends, but where it dwells; before an approach it
        # waits as long for the surface, and for the next image of the camera.
        if leg.kind == "press":
            time_s += target.dwell_s
        else:
            time_s += 0.5 if leg.kind == "approach" else 0.2
        # arccos of the quaternions' product is good to 1e-7 rad near no turn at all
        assert leg.duration_s == pytest.approx(time_s, abs=1e-6)
        if leg.kind == "approach":
            assert end == target.contact
        if target is not None and leg.kind in ("transit", "retreat"):
            assert end == target.standoff
    assert end == made.start
    assert made.duration_s == pytest.approx(sum(leg.duration_s for leg in made.legs))
    assert min(t.clearance_m for t in made.targets) >= 0.05


@pytest.mark.parametrize(
    ("task", "limit_s"),
    [
        (grid(), 0.3),
        (grid(rows=10, columns=20), 2.0),
        (grid(rows=10, columns=20, order="shortest"), 2.0),
    ],
    ids=["nine", "two hundred", "two hundred, shortest"],
)
def test_planning_is_fast(task, limit_s):
    plan(RigidVehicle(), grid(columns=1))  # compiles
    began = time.perf_counter()
    plan(RigidVehicle(), task)
    assert time.perf_counter() - began < limit_s
