"""Errands of every kind in one mission: legs, targets, refusals that say why, finite numbers."""

from __future__ import annotations

import numpy as np
import pytest
from builders import column, mission, points, wall
from rigid import RigidVehicle

from inspect_cli.errors import InfeasibleError
from inspect_cli.interfaces import Posture
from inspect_cli.planning.planner import make_plan
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.primitives import point_at

POSE = {"hold": {"position_m": (0.0, 0.5, 1.5), "duration_s": 7.0}}
SERVO = {"servo": {"start": {"position_m": (0.3, 0.0, 1.5)}, "slide_m": 0.34, "speed_mps": 0.17}}
LINE = np.array([[-0.3, 0.0], [0.3, 0.0]])
BEND = 0.2 * np.array([[np.cos(a), np.sin(a)] for a in np.linspace(0.0, np.pi, 300)])


def trace(on="wall", **more):
    return {"trace": {"on": on, "polyline_m": ((0.0, 0.0), (0.1, 0.0)), **more}}


def planned(*tasks, vehicle=None, surfaces=None, drawings=None, **more) -> Plan:
    """The plan of tasks; a task that traces draws ``drawings``, a line unless told otherwise."""
    vehicle = vehicle or RigidVehicle()
    surfaces = {"wall": wall()} if surfaces is None else surfaces
    believed = tuple(PlannedSurface(name=n, shape=s, source="given") for n, s in surfaces.items())
    asked = mission(*tasks, surfaces=surfaces, **more)
    strokes = ((LINE,),) if drawings is None else drawings
    places = {place: strokes for place, task in enumerate(asked.tasks) if task.trace is not None}
    return make_plan(asked, "fake", vehicle, believed, 20.0, drawings=places)


def refusal(*tasks, **more) -> str:
    with pytest.raises(InfeasibleError) as caught:
        planned(*tasks, **more)
    assert all(problem.hint for problem in caught.value.problems)
    return "\n".join(problem.what for problem in caught.value.problems)


EVERYTHING = (POSE, points((2.0, 0.2, 1.5)), trace(repeat=2), SERVO, points((2.0, 0.0, 1.5)))


def test_room_about_a_pose():
    """The wall is the plane x = 2: the sphere that reaches farthest along x is nearest to it."""
    for task in (POSE, SERVO):
        (target,) = planned(task, vehicle=RigidVehicle()).targets
        posture = Posture(np.array(target.contact.p_WB), np.array(target.contact.q_WB), np.zeros(0))
        spheres = RigidVehicle().collision_spheres(posture)
        assert target.clearance_m == pytest.approx(2.0 - np.max(spheres[:, 0] + spheres[:, 3]))
        (alone,) = planned(task, surfaces={}).targets
        assert alone.clearance_m is None
        assert alone.margins["thrust"].value == target.margins["thrust"].value > 0.0


def test_all_kinds_in_one_mission():
    plan = planned(*EVERYTHING)
    kinds = ["pose", "contact", "stroke", "stroke", "following", "contact"]
    assert [target.kind for target in plan.targets] == kinds
    assert [target.label for target in plan.targets] == ["1", "2", "3", "4", "5", "6"]
    assert [t.sensor for t in plan.targets] == [None, "half_cell", None, None, None, "half_cell"]
    touch, slide = ["approach", "press", "retreat"], ["approach", "press", "slide", "retreat"]
    legs = {k: [leg.kind for leg in plan.legs if leg.target == k] for k in range(6)}
    assert legs[0] == ["transit", "hold"]
    assert legs[1] == ["transit", *touch]
    # The second trial begins where the first began, in front of the board.
    assert legs[2] == legs[3] == ["transit", *slide]
    assert legs[4] == ["transit", *slide]
    assert legs[5] == ["transit", *touch]
    assert [plan.targets[k].stroke.trial for k in (2, 3)] == [0, 1]
    numbers = [plan.duration_s, plan.energy_wh, plan.path_m, plan.cable_m]
    numbers += [leg.duration_s for leg in plan.legs]
    numbers += [target.clearance_m for target in plan.targets]
    assert np.isfinite(numbers).all()
    assert plan.duration_s == pytest.approx(sum(leg.duration_s for leg in plan.legs))


def test_the_plan_survives_its_file():
    plan = planned(*EVERYTHING)
    assert Plan.model_validate_json(plan.model_dump_json(by_alias=True)) == plan


def test_nothing_but_a_pose_needs_no_structure():
    plan = planned(POSE, surfaces={})
    assert plan.surfaces == ()
    assert plan.cable_m == 0.0
    (hold,) = [leg for leg in plan.legs if leg.kind == "hold"]
    assert hold.duration_s == pytest.approx(7.1)  # and the shortest stretch
    # 500 W in level hover
    assert plan.energy_wh == pytest.approx(500.0 * plan.duration_s / 3600.0)


def test_two_holds_at_one_place_are_joined_by_no_way():
    plan = planned(POSE, POSE, surfaces={})
    assert [leg.kind for leg in plan.legs] == [
        "takeoff", "transit", "hold", "hold", "transit", "land",
    ]  # fmt: skip


def test_times_of_a_stroke_and_a_following():
    """ℓ/v + 15/8 v/a of a line from rest to rest, a pause; ℓ/v and a following's settling."""
    plan = planned(trace(speed_mps=0.1, settle_s=3.0), SERVO)
    (stroke, following) = [leg for leg in plan.legs if leg.kind == "slide"]
    assert stroke.duration_s == pytest.approx(0.6 / 0.1 + 1.875 * 0.1 + 0.2)
    assert stroke.speed_mps == 0.1
    assert following.duration_s == pytest.approx(0.34 / 0.17 + 2.0)
    assert plan.targets[0].dwell_s == 3.0


def test_a_servo_of_no_way_only_touches():
    task = {"servo": {**SERVO["servo"], "slide_m": 0.0}}
    assert "slide" not in [leg.kind for leg in planned(task).legs]


def test_a_servo_leads_back_to_its_start():
    plan = planned(SERVO)
    retreat = next(k for k, leg in enumerate(plan.legs) if leg.kind == "retreat")
    back = plan.legs[retreat + 1]
    assert (back.kind, back.target) == ("transit", None)
    assert back.postures[-1].p_WB == (0.3, 0.0, 1.5)


@pytest.mark.parametrize(
    ("task", "words"),
    [
        (trace(), "stroke 1 on 'wall': outside the patch: it lies at u 1.000 m"),
        ({"hold": {"position_m": (2.0, 0.0, 1.5), "duration_s": 1.0}}, "pose 1: the body overlaps"),
        ({"hold": {"position_m": (0.0, 0.0, 0.0), "duration_s": 1.0}}, "below the ground"),
        ({"servo": {"start": {"position_m": (1.9, 0.0, 1.5)}}}, "servo 1: the body overlaps"),
    ],
)
def test_a_refusal_says_why(task, words):
    drawings = ((np.array([[0.0, 0.0], [1.0, 0.0]]),),)
    small = {"wall": wall(size=(1.0, 1.0))}
    assert words in refusal(task, drawings=drawings, surfaces=small)


def test_a_bulge_beyond_the_patch_is_refused_though_its_ends_are_on_it():
    """A closed loop of 6 cm circumference, less than the places at which postures are checked."""
    loop = 0.01 * np.array([[np.cos(a), np.sin(a)] for a in np.linspace(0, 2 * np.pi, 31)])
    edge = loop - loop[0] + [0.495, 0.0]
    beyond = -(loop - loop[0]) + [0.495, 0.0]
    surfaces = {"wall": wall(size=(1.0, 1.0))}
    assert planned(trace(), surfaces=surfaces, drawings=((edge,),)).targets
    assert "outside the patch" in refusal(trace(), surfaces=surfaces, drawings=((beyond,),))


def test_a_servo_needs_thrust_to_spare_for_its_press():
    """46.6 N of weight of 47 N: 0.1 · 18 N more across it is √(46.6² + 1.8²) = 46.63 N."""
    weak = RigidVehicle(max_thrust_n=46.62)
    message = refusal(SERVO, vehicle=weak)
    assert "servo 1: pressing with 1.80 N asks for" in message
    assert planned(SERVO, vehicle=RigidVehicle(max_thrust_n=46.65)).targets


def test_a_surface_in_the_way_of_a_stroke_is_found():
    """A pillar beside the board where the stroke ends: 0.42 m of body come too near."""
    surfaces = {"wall": wall(), "pillar": wall((1.5, -1.0, 1.5), (0.0, 1.0, 0.0), (1.5, 2.0))}
    drawings = ((np.array([[-0.2, 0.0], [0.7, 0.0]]),),)
    message = refusal(trace(), surfaces=surfaces, drawings=drawings)
    assert "stroke 1 on 'wall'" in message
    assert "'pillar'" in message


def test_the_clearance_of_a_stroke_is_its_least():
    surfaces = {"wall": wall(), "pillar": wall((1.5, -1.0, 1.5), (0.0, 1.0, 0.0), (1.5, 2.0))}
    gaps = []
    for end in (0.0, 0.5, 0.52):
        drawings = ((np.array([[-0.5, 0.0], [end, 0.0]]),),)
        gaps.append(planned(trace(), surfaces=surfaces, drawings=drawings).targets[0].clearance_m)
    # The wall is 0.13 m away all along; u grows towards the pillar, which is nearer at the end:
    # the rotors reach 0.3 sin 60° + 0.12 to the side.
    reach = 0.3 * np.sin(np.radians(60.0)) + 0.12
    np.testing.assert_allclose(gaps, [0.13, 0.5 - reach, 0.48 - reach], atol=1e-6)


@pytest.mark.parametrize("radius_m", [0.5, 1.0])
def test_round_a_column_the_body_keeps_its_limits(radius_m):
    """The tool turns by 1/R per metre, the body goes (R + lever)/R as far."""
    vehicle = RigidVehicle(max_speed_mps=0.8, max_angular_rate_radps=0.3)
    shape = column((3.0, 0.0, 1.5), radius_m)
    line = np.array([[-0.5, 0.0], [0.5, 0.0]])
    plan = planned(
        trace(speed_mps=5.0), vehicle=vehicle, surfaces={"wall": shape}, drawings=((line,),)
    )
    (slide,) = [leg for leg in plan.legs if leg.kind == "slide"]
    assert plan.targets[0].stroke.speed_mps == pytest.approx(0.3 * radius_m, rel=0.01)
    assert slide.speed_mps == plan.targets[0].stroke.speed_mps
    flat = planned(trace(speed_mps=5.0), vehicle=vehicle)
    assert flat.targets[0].stroke.speed_mps == pytest.approx(0.8)


def test_the_postures_of_a_stroke_lie_behind_its_line():
    vehicle = RigidVehicle()
    shape = column((3.0, 0.0, 1.5), 1.0)
    plan = planned(trace(), surfaces={"wall": shape}, drawings=((BEND,),))
    (slide,) = [leg for leg in plan.legs if leg.kind == "slide"]
    prim = primitive_of(shape)
    end = point_at(prim, 0, *BEND[-1])
    tip = np.array(slide.postures[-1].p_WB)
    axis = end[:2] - [3.0, 0.0]
    # Behind the surface by 0.1 m, with the body 0.55 m before the tip: 0.45 m before the surface.
    expected = end + 0.45 * np.array([*axis, 0.0]) / np.linalg.norm(axis)
    np.testing.assert_allclose(tip, expected, atol=1e-6)
    assert vehicle.length_m == 0.55
    tips = [plan.targets[0].p_WC]
    np.testing.assert_allclose(tips[0], point_at(prim, 0, *BEND[0]), atol=1e-12)


def test_profiles_are_the_tasks_or_the_missions():
    plan = planned({**POSE, "impedance": "rope_pull_1"}, trace())
    assert [target.impedance for target in plan.targets] == ["rope_pull_1", "contact_ndt"]
    assert plan.impedance == "contact_ndt"
