"""Surveys of whole surfaces: every point visited once or listed with its reason."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from builders import ball, column, mission, wall
from rigid import RigidVehicle
from solver import solver_m, tips_of

from inspect_cli.commands.plan import surveyor_of, vehicle_of
from inspect_cli.errors import InfeasibleError
from inspect_cli.planning.coverage import Surveyor
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.spatial.rotations import quaternion_to_matrix


def surveyor(*, surfaces=None, battery_wh=500.0, cable_m=20.0, vehicle=None, **coverage):
    surfaces = surfaces or {"wall": wall(size=(1.0, 0.75))}
    believed = tuple(PlannedSurface(name=n, shape=s, source="given") for n, s in surfaces.items())
    task = {"coverage": {"on": "wall", "pitch_m": 0.25, **coverage}}
    asked = mission(task, surfaces=surfaces)
    return Surveyor(
        asked, "fake", vehicle or RigidVehicle(), believed, cable_m, {"half_cell": 0.0}, battery_wh
    )


def labels(survey):
    return [target.label for sortie in survey.sorties for target in sortie.plan.targets]


def reasons(survey):
    return {point.label: point.reason for point in survey.skipped}


@pytest.mark.parametrize("shape", [wall(size=(1.0, 0.75)), column(size=(1.0, 0.75)), ball()])
@pytest.mark.parametrize("battery_wh", [500.0, 25.0, 12.0])
def test_every_point_is_visited_once(shape, battery_wh):
    survey = surveyor(surfaces={"wall": shape}, battery_wh=battery_wh).survey()
    assert not survey.skipped
    n = survey.points
    assert sorted(map(int, labels(survey))) == list(range(1, n + 1))
    assert survey.budget_wh == pytest.approx(0.9 * battery_wh)
    assert [sortie.number for sortie in survey.sorties] == list(range(1, len(survey.sorties) + 1))
    for sortie in survey.sorties:
        plan = sortie.plan
        assert plan.energy_wh <= survey.budget_wh
        assert [leg.kind for leg in plan.legs][:: len(plan.legs) - 1] == ["takeoff", "land"]
        assert plan.legs[-1].postures[-1] == plan.start
        assert [leg.target for leg in plan.legs if leg.kind == "press"] == list(
            range(len(plan.targets))
        )
        assert all(a.target == b.target for a, b in pairwise(plan.legs) if b.kind == "retreat")
    assert survey.energy_wh == pytest.approx(sum(s.plan.energy_wh for s in survey.sorties))
    assert CoveragePlan.model_validate_json(survey.model_dump_json(by_alias=True)) == survey


def test_a_smaller_battery_takes_more_sorties_and_the_same_order():
    whole = surveyor().survey()
    parts = surveyor(battery_wh=15.0).survey()
    assert len(whole.sorties) == 1
    assert len(parts.sorties) > 2
    assert labels(parts) == labels(whole)
    assert parts.tour_m == whole.tour_m
    assert parts.energy_wh > whole.energy_wh


def test_points_kept_out():
    survey = surveyor(keep_out=({"at_m": (-0.25, 0.25), "radius_m": 0.13},)).survey()
    assert set(reasons(survey)) == {"1", "2"}
    assert reasons(survey)["1"] == "kept out: 0.125 m from (-0.25, 0.25), radius_m is 0.13"
    assert survey.points == 10


def test_points_hidden_by_another_surface():
    """A board 0.1 m before a corner of the wall, smaller than the tool is long."""
    board = wall(center=(1.9, 0.375, 1.75), normal=(-1.0, 0.0, 0.0), size=(0.1, 0.1))
    survey = surveyor(surfaces={"wall": wall(size=(1.0, 0.75)), "board": board}).survey()
    hidden = [label for label, reason in reasons(survey).items() if reason.startswith("hidden")]
    assert hidden == ["1"]
    assert reasons(survey)["1"] == "hidden: 'board' stands 0.100 m in front of it"


def test_points_out_of_the_cable_s_reach_and_a_second_start():
    """From (0, 0, 0) a cable of 2.6 m reaches the middle of a wall 2 m away, not its ends."""
    surfaces = {"wall": wall(center=(2.0, 0.0, 1.2), size=(4.0, 0.5))}
    one = surveyor(surfaces=surfaces, cable_m=2.6).survey()
    assert one.skipped
    assert all("the cable is 2.60 m long" in reason for reason in reasons(one).values())
    for sortie in one.sorties:
        assert sortie.plan.cable_m <= 2.6
    starts = tuple({"position_m": (0.0, y)} for y in (-1.0, 1.0))
    two = surveyor(surfaces=surfaces, cable_m=2.6, starts=starts).survey()
    assert not two.skipped
    places = {sortie.plan.start.p_WB[1] for sortie in two.sorties}
    assert places == {-1.0, 1.0}
    for sortie in two.sorties:
        clamp = np.array([*sortie.plan.start.p_WB[:2], 0.0])
        far = max(np.linalg.norm(t.p_WC - clamp) for t in sortie.plan.targets)
        assert far <= 2.6
        assert sortie.plan.cable_m == pytest.approx(far)


def test_a_point_that_no_battery_reaches():
    survey = surveyor(battery_wh=5.6, surfaces={"wall": wall(size=(5.0, 0.4))}).survey()
    assert survey.skipped
    assert all("a flight to it alone takes" in reason for reason in reasons(survey).values())
    far = [abs(point.uv_m[0]) for point in survey.skipped]
    near = [abs(t.uv_m[0]) for sortie in survey.sorties for t in sortie.plan.targets]
    assert min(far) > max(near)


def test_no_point_at_all_is_refused_with_the_reasons():
    with pytest.raises(InfeasibleError) as caught:
        surveyor(cable_m=1.0).survey()
    assert "no point can be visited: 1, 4: 2.68 m from the start" in caught.value.problems[0].what
    with pytest.raises(InfeasibleError, match=r"no point of 'wall' is 0\.5 m from its edge"):
        surveyor(edge_m=0.5).survey()
    with pytest.raises(InfeasibleError, match="holds some 750000 points"):
        surveyor(pitch_m=0.001).survey()


def test_added_points_are_planned_like_the_others():
    made = surveyor(keep_out=({"at_m": (0.25, 0.0), "radius_m": 0.05},))
    batch = made.batch([("6-7", (0.0, 0.0)), ("7-8", (0.25, 0.0))])
    assert [target.label for target in batch.plans[0].targets] == ["6-7"]
    assert [point.label for point in batch.skipped] == ["7-8"]
    survey = made.survey()
    more = survey.with_sorties(batch.plans, batch.skipped)
    assert more.sorties[-1].added
    assert more.points == survey.points + 1
    joined = more.joined()
    assert [target.index for target in joined.targets] == list(range(more.points))
    assert [joined.targets[leg.target].label for leg in joined.legs if leg.kind == "press"] == (
        labels(more)
    )


@pytest.fixture(scope="module")
def vault(root):
    loaded = load_mission(root / "missions" / "paper_a" / "vault_coverage.yaml")
    vehicle = vehicle_of(loaded)
    return vehicle.capabilities, surveyor_of(loaded, vehicle).survey()


def test_the_vault_s_points(vault):
    _, survey = vault
    assert survey.points + len(survey.skipped) == 192
    assert survey.points >= 190
    assert len(set(labels(survey)) | set(reasons(survey))) == 192
    assert all(point.reason for point in survey.skipped)


def test_the_vault_s_way_is_as_short_as_a_routing_solver_s(vault):
    """Within 10 %, although the order also saves turns, of which the solver knows nothing."""
    capabilities, survey = vault
    tips, start = tips_of(capabilities, survey)
    path = np.vstack([start, tips])
    assert survey.tour_m == pytest.approx(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())
    assert survey.tour_m <= 1.10 * solver_m(tips, start, 3)


def test_the_vault_is_touched_with_the_body_tilted_the_lesser_way(vault):
    """The arm is 30° off z_B, so of 30° + φ and |30° − φ| the body takes the smaller."""
    _, survey = vault
    for sortie in survey.sorties:
        for target in sortie.plan.targets:
            z_B = quaternion_to_matrix(np.array(target.contact.q_WB))[:, 2]
            tilt_deg = np.degrees(np.arccos(np.clip(z_B[2], -1.0, 1.0)))
            slope_deg = np.degrees(np.arccos(-target.n_W[2]))
            assert tilt_deg <= max(abs(30.0 - slope_deg), 30.0) + 3.0
