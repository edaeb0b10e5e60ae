"""Plan, fly and report with a vehicle that has other rotors and a joint in its arm."""

from __future__ import annotations

import csv
import json
from types import SimpleNamespace

import numpy as np
import pytest
from modes import Mode

from inspect_cli.commands.fly import fly
from inspect_cli.commands.plan import plan
from inspect_cli.commands.report import report
from inspect_cli.errors import InfeasibleError
from inspect_cli.log.reader import read_log
from inspect_cli.records import Command, Reference, State
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import PlanFile
from inspect_cli.spatial.rotations import quaternion_to_matrix

pytestmark = pytest.mark.xdist_group("octorotor")  # one flight for all

DAM_DEG, OVERHANG_DEG = 25.0, -20.0
"""How far the believed walls lean; the wrist lowers the tool by that."""
HIDDEN_DEG = 4.0
"""The true dam leans this much more."""


@pytest.fixture(scope="module")
def planned(mission):
    return plan(mission)


@pytest.fixture(scope="module")
def flown(planned):
    """The outcome of flying the saved plan, with the rows of its log."""
    outcome = fly(planned.file)
    log = read_log(outcome.folder / "flight.mcap")
    rows = {kind: log.rows(kind) for kind in (State, Reference, Command)}
    return SimpleNamespace(outcome=outcome, rows=rows)


def test_the_wrist_takes_the_pitch_and_the_body_stays_level(planned):
    targets = planned.plan.targets
    assert [t.surface for t in targets] == ["dam", "dam", "overhang"]
    for target, lean in zip(targets, [DAM_DEG, DAM_DEG, OVERHANG_DEG], strict=True):
        assert np.degrees(target.contact.arm_angle_rad) == pytest.approx([lean], abs=0.01)
        assert quaternion_to_matrix(np.array(target.contact.q_WB))[2, 2] == pytest.approx(1.0)
        assert target.margins["wrist"].value == pytest.approx(
            np.radians(60.0 - abs(lean)), abs=1e-3
        )
        assert target.expected_force_n == pytest.approx(1.8)  # 0.25 · 72 N/m · 0.10 m
    assert planned.plan.start.arm_angle_rad == (0.0,)


def test_the_plan_is_a_file_that_can_be_flown(planned):
    saved = PlanFile.model_validate_json(planned.file.read_bytes())
    assert saved.targets == planned.plan.targets
    assert saved.legs == planned.plan.legs


def test_the_flight_is_completed_and_accepted(flown):
    result = flown.outcome.result
    assert result.status == "completed"
    assert {check.metric: check.verdict for check in result.checks} == {
        "contact.points_valid": "pass",
        "contact.force_mean_min_n": "pass",
        "contact.force_mean_max_n": "pass",
        "half_cell.map_mismatches": "pass",
        "contact.body_force_max_n": "pass",
    }
    assert result.metrics["guidance.tool_axis_error_mean_deg"].value < 1.0


def test_records_have_the_lengths_of_the_vehicle(flown):
    state, reference, command = flown.rows.values()
    assert state["rotor_thrust"].shape[1:] == command["rotor_thrust"].shape[1:] == (8,)
    assert state["joint_angle"].shape[1:] == command["joint_angle"].shape[1:] == (1,)
    assert reference["arm_angle"].shape[1:] == (1,)


def test_the_wrist_finds_the_lean_that_nobody_planned(flown):
    state, reference, _ = flown.rows.values()
    pressing = reference["mode"] == Mode.PRESS
    for target, lean in enumerate([DAM_DEG + HIDDEN_DEG, DAM_DEG + HIDDEN_DEG, OVERHANG_DEG]):
        held = pressing & (reference["target"] == target)
        assert np.degrees(state["joint_angle"][held].mean()) == pytest.approx(lean, abs=1.0)


def test_the_wrist_follows_its_reference_and_the_body_stays_level(flown):
    state, reference, command = flown.rows.values()
    # Of the ticks of the log, every second is one of the control's; there the two agree.
    controlled = np.rint(1e3 * command["t_s"]).astype(int) % 4 == 0
    assert np.array_equal(command["joint_angle"][controlled], reference["arm_angle"][controlled])
    # A servo lag of 20 ms at no more than 0.7 rad/s, and the sag under the tool's weight.
    assert np.abs(state["joint_angle"] - reference["arm_angle"]).max() < 0.7 * 0.02 + 0.01
    tilt = np.hypot(state["q_WB"][:, 1], state["q_WB"][:, 2])
    assert np.degrees(2.0 * tilt.max()) < 3.0


def test_the_report_tells_of_three_readings(flown):
    [reported] = report([flown.outcome.folder])
    assert reported.result == flown.outcome.result
    assert reported.page.stat().st_size > 100_000
    metrics = json.loads((flown.outcome.folder / "metrics.json").read_text())
    assert metrics["platform"] == "canted_octorotor"
    with (flown.outcome.folder / "readings.csv").open() as file:
        assert [row["valid"] for row in csv.DictReader(file)] == ["true"] * 3


def test_a_lean_beyond_the_wrist_is_refused(mission):
    text = mission.read_text().replace("[-0.9063, 0, 0.4226]", "[-0.4226, 0, 0.9063]")
    steep = mission.with_name("too_steep.yaml")
    steep.write_text(text)
    assert load_mission(steep).platform.kind == "canted_octorotor"
    with pytest.raises(InfeasibleError, match=r"point 1 on 'dam': no posture brings the tool"):
        plan(steep)
    assert not (mission.parent.parent / "reports" / "too-steep").exists()
