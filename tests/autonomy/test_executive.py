"""The executive walks a scripted flight: each mode's end, and an abort from each mode."""

from __future__ import annotations

import numpy as np
import pytest
from script import (
    APPROACH_MPS,
    PRESS_M,
    PRESS_MPS,
    RETREAT_MPS,
    STANDOFF_M,
    TICK_S,
    TIME_LIMIT_S,
    TRANSIT_MPS,
    Script,
)

from inspect_cli.records import InvalidReason, SurfaceEstimate
from inspect_cli.schema.flight_times import PAUSE_S
from inspect_cli.vehicles.fully_actuated.modes import (
    BEFORE_CONTACT_M,
    SAFE_HOVER_S,
    SETTLE_S,
    STAND_S,
    TOUCHDOWN_M,
)

WATCHED = ["takeoff", "transit", "approach", "press", "retreat", "land"]
NEAR = ["approach", "press", "retreat"]
SLACK_S = 2.5 * TICK_S


@pytest.fixture
def script() -> Script:
    return Script()


def test_a_whole_flight(script: Script) -> None:
    script.run_until(lambda: script.executive.finished)
    point = ["transit", "approach", "press", "retreat"]
    assert script.modes == [
        ("idle", -1),
        ("takeoff", -1),
        *[(mode, 0) for mode in point],
        *[(mode, 1) for mode in point],
        ("transit", -1),
        ("land", -1),
        ("landed", -1),
    ]
    assert (script.executive.status, script.executive.reason) == ("completed", "")
    assert [(r.target, r.valid) for r in script.context.readings] == [(0.0, 1.0), (1.0, 1.0)]
    asked = [
        ("approach A{}", -BEFORE_CONTACT_M, APPROACH_MPS),
        ("approach A{}", PRESS_M, PRESS_MPS),
        ("approach A{}", -STANDOFF_M, RETREAT_MPS),
    ]
    fly = ("go_to", 1.0, TRANSIT_MPS)
    expected = [fly]
    for label in (1, 2):
        expected += [fly, *[(what.format(label), *rest) for what, *rest in asked]]
    expected += [fly, ("go_to", 0.2, TRANSIT_MPS), ("go_to", 0.2 - TOUCHDOWN_M, TRANSIT_MPS)]
    assert [call[0] for call in script.guidance.calls] == [call[0] for call in expected]
    np.testing.assert_allclose(
        [call[1:] for call in script.guidance.calls], [call[1:] for call in expected]
    )


def test_it_settles_on_the_ground_with_its_motors_off(script: Script) -> None:
    took = script.run_to("takeoff")
    assert took == pytest.approx(SETTLE_S, abs=SLACK_S)
    idle = Script()
    idle.step()
    assert not idle.executive.armed
    assert script.executive.armed


@pytest.mark.parametrize("mode", ["takeoff", "transit", "retreat", "land"])
def test_a_stretch_ends_a_pause_after_its_arrival(script: Script, mode: str) -> None:
    script.run_to(mode)
    took = script.run_until(lambda: script.mode != mode)
    assert took == pytest.approx(script.guidance.takes_s + PAUSE_S, abs=SLACK_S)


def test_an_arrival_that_is_put_off_starts_the_pause_anew(script: Script) -> None:
    script.run_to("transit")
    script.run_until(lambda: script.guidance.arrived(script.t_s))
    script.run(0.5 * PAUSE_S)
    script.guidance.arrival_s = script.t_s + 3.0  # a correction
    took = script.run_until(lambda: script.mode != "transit")
    assert took == pytest.approx(3.0 + PAUSE_S, abs=SLACK_S + TICK_S)


def test_an_approach_waits_for_a_surface_that_is_seen_from_the_standoff(script: Script) -> None:
    script.surfaces = False
    script.run_to("approach")
    script.run(1.0)
    assert script.guidance.calls[-1][0] == "go_to"  # it has not moved
    assert not script.guidance.tracks_surface
    script.surfaces = True
    script.run(0.1)
    assert script.guidance.calls[-1][0] == "approach A1"
    assert script.guidance.tracks_surface
    took = script.run_to("press")
    assert took == pytest.approx(script.guidance.takes_s + PAUSE_S, abs=0.1 + SLACK_S)


def test_an_invalid_surface_is_not_seen(script: Script) -> None:
    script.surfaces = False
    script.run_to("approach")
    script.run(0.5)
    blind = SurfaceEstimate.create()
    blind.t_s = script.t_s
    script.executive.hear(blind)
    script.run(0.1)
    assert not script.guidance.tracks_surface


def test_a_press_ends_when_the_judge_has_decided_and_not_before(script: Script) -> None:
    script.run_to("press")
    script.judges[-1].takes_s = 7.0
    took = script.run_to("retreat")
    # The dwell begins when the set-point is where it shall be.
    assert took == pytest.approx(script.guidance.takes_s + 7.0, abs=SLACK_S)
    (reading,) = script.context.readings
    assert (reading.target, reading.t_s) == (0.0, pytest.approx(script.t_s, abs=SLACK_S))


def test_the_probe_is_heard_only_while_pressing(script: Script) -> None:
    script.run_to("press")
    script.run_to("retreat")
    (judge,) = script.judges
    assert judge.fed == pytest.approx(judge.takes_s / TICK_S, abs=3)
    fed = judge.fed
    script.run(1.0)
    assert judge.fed == fed


def test_surfaces_steer_only_near_them(script: Script) -> None:
    steered = set()
    while not script.executive.finished:
        script.step()
        if script.guidance.tracks_surface:
            steered.add(script.mode)
    assert steered == {"approach", "press"}


@pytest.mark.parametrize(("aside_m", "deep_m", "counts"), [(0.029, 0.3, True), (0.031, 0.0, False)])
def test_a_reading_off_its_point_does_not_count(
    script: Script, aside_m: float, deep_m: float, counts: bool
) -> None:
    script.run_to("press")
    script.judges[-1].aside_m, script.judges[-1].deep_m = aside_m, deep_m
    script.run_to("retreat")
    (reading,) = script.context.readings
    assert reading.valid == float(counts)
    assert np.isnan(reading.potential) == (not counts)
    reason = InvalidReason.NONE if counts else InvalidReason.OFF_TARGET
    assert reading.reason == float(reason)


def test_it_leans_on_the_ground_before_its_motors_stop(script: Script) -> None:
    script.run_to("landed")
    assert script.executive.armed
    took = script.run_until(lambda: not script.executive.armed)
    assert took == pytest.approx(script.guidance.takes_s + PAUSE_S, abs=SLACK_S)
    took = script.run_until(lambda: script.executive.finished)
    assert took == pytest.approx(STAND_S, abs=SLACK_S)


def test_the_reference_carries_mode_and_target(script: Script) -> None:
    reference = script.stack.reference
    while not script.executive.finished:
        script.step()
        assert reference.mode == float(script.executive.mode.number)
        index = script.context.order.target
        assert reference.target == (-1.0 if index is None else float(index))


def test_every_mode_is_an_event(script: Script) -> None:
    script.run_until(lambda: script.executive.finished)
    texts = [event.text for event in script.context.events]
    assert texts[:3] == ["takeoff", "transit, point A1", "approach, point A1"]
    assert texts[-1] == "landed"
    assert {event.level for event in script.context.events} == {"info"}
    times = [event.t_s for event in script.context.events]
    assert times == sorted(times)


def aborted(script: Script) -> None:
    """What every abort owes."""
    executive = script.executive
    assert executive.status == "aborted"
    assert script.mode == "hover"
    assert script.target == -1
    assert executive.armed
    assert not script.guidance.tracks_surface
    (error,) = [event for event in script.context.events if event.level == "error"]
    assert executive.reason in error.text
    # Every point has exactly one reading, and those not judged before are invalid.
    assert sorted(reading.target for reading in script.context.readings) == [0.0, 1.0]
    for reading in script.context.readings:
        if reading.valid:
            continue
        assert reading.reason == float(InvalidReason.ABORTED)
        assert np.isnan([reading.potential, reading.resistance]).all()
        np.testing.assert_array_equal(reading.p_WT, [2.0, reading.target, 1.0])


@pytest.mark.parametrize("mode", WATCHED)
def test_a_lost_pose_aborts_from_every_mode(script: Script, mode: str) -> None:
    script.run_to(mode)
    if mode == "approach":
        script.run_until(lambda: script.guidance.tracks_surface)
    script.poses = False
    took = script.run_to("hover")
    assert took == pytest.approx(0.25, abs=SLACK_S)
    aborted(script)
    assert "pose" in script.executive.reason
    # Where something is near, dead reckoning is good for the way back off it.
    assert script.guidance.calls[-1][0] == ("approach A1" if mode in NEAR else "hold")


@pytest.mark.parametrize("mode", WATCHED)
def test_a_large_error_retreats_near_the_surface_and_holds_elsewhere(
    script: Script, mode: str
) -> None:
    script.run_to(mode)
    if mode == "approach":
        script.run_until(lambda: script.guidance.tracks_surface)
    # In a press and its retreat the reference may lie behind the surface by as much again.
    allowed_m = 0.6 + (PRESS_M if mode in ("press", "retreat") else 0.0)
    script.estimate.p_WB[:] = [allowed_m + 0.02, 0.0, 0.0]
    took = script.run_to("hover")
    assert took == pytest.approx(0.5, abs=SLACK_S)
    aborted(script)
    what, depth, _ = script.guidance.calls[-1]
    expected = ("approach A1", -STANDOFF_M) if mode in NEAR else ("hold", 0.0)
    assert (what, depth) == expected


@pytest.mark.parametrize("mode", ["approach", "press"])
def test_a_surface_that_contradicts_the_plan_near_it_retreats(script: Script, mode: str) -> None:
    script.run_to(mode)
    script.guidance.contradicted = True
    script.guidance.takes_s = 9.0
    for judge in script.judges:
        judge.takes_s = 9.0
    took = script.run_to("hover")
    # Half a second until the last agreement is stale, half a second of patience.
    assert took == pytest.approx(1.0, abs=SLACK_S)
    aborted(script)
    assert "contradicts" in script.executive.reason


def test_an_approach_waits_for_a_surface_that_agrees(script: Script) -> None:
    script.guidance.contradicted = True
    script.run_to("approach")
    script.run(0.4)
    assert not script.guidance.tracks_surface
    script.guidance.contradicted = False
    script.run(0.1)
    assert script.guidance.tracks_surface


@pytest.mark.parametrize("mode", ["approach", "press"])
def test_a_surface_out_of_sight_near_it_retreats(script: Script, mode: str) -> None:
    script.run_to(mode)
    script.guidance.takes_s = 9.0
    for judge in script.judges:
        judge.takes_s = 9.0
    script.surfaces = False
    took = script.run_to("hover")
    assert took == pytest.approx(0.5 + 1.5, abs=SLACK_S)
    aborted(script)
    speed = APPROACH_MPS if mode == "approach" else PRESS_MPS
    assert script.guidance.calls[-1] == ("approach A1", -STANDOFF_M, speed)


def test_in_transit_the_surface_may_be_out_of_sight(script: Script) -> None:
    script.run_to("transit")
    script.guidance.arrival_s = script.t_s + 10.0
    script.surfaces = False
    script.run(9.0)
    assert script.mode == "transit"


def test_a_missing_surface_is_given_up_at_the_standoff(script: Script) -> None:
    script.surfaces = False
    script.run_to("hover")
    aborted(script)
    assert script.modes[-2] == ("approach", 0)
    went = [call for call in script.guidance.calls if call[0].startswith("approach")]
    assert went == [("approach A1", -STANDOFF_M, APPROACH_MPS)]


def test_a_reading_that_was_made_survives_the_abort(script: Script) -> None:
    script.run_to("transit", 1)
    script.poses = False
    script.run_to("hover")
    aborted(script)
    assert [(r.target, r.valid) for r in script.context.readings] == [(0.0, 1.0), (1.0, 0.0)]


def test_after_an_abort_it_hovers_at_rest_and_ends(script: Script) -> None:
    script.run_to("press")
    script.guidance.takes_s = 5.0  # the way back to the standoff
    script.estimate.p_WB[:] = [0.8, 0.0, 0.0]
    script.run_to("hover")
    took = script.run_until(lambda: script.executive.finished)
    assert took == pytest.approx(5.0 + SAFE_HOVER_S, abs=SLACK_S)
    assert script.modes[-1] == ("hover", -1)


def test_a_second_failure_does_not_abort_again(script: Script) -> None:
    script.run_to("press")
    script.poses = False
    script.run_to("hover")
    script.estimate.p_WB[:] = np.nan
    script.run(2.0)
    aborted(script)


def test_a_nan_estimate_aborts(script: Script) -> None:
    script.run_to("transit")
    script.estimate.p_WB[:] = np.nan
    script.run_to("hover")
    aborted(script)


def test_a_flight_that_takes_far_too_long_is_given_up(script: Script) -> None:
    script.run_to("transit")
    script.guidance.arrival_s = 1e9
    script.run_to("hover")
    assert script.t_s == pytest.approx(TIME_LIMIT_S, abs=SLACK_S)
    aborted(script)
    assert "longer" in script.executive.reason
    assert script.guidance.calls[-1][0] == "hold"


def test_on_the_ground_there_is_no_overtime(script: Script) -> None:
    script.run_to("landed")
    script.guidance.arrival_s = TIME_LIMIT_S + 5.0
    script.run_until(lambda: script.executive.finished)
    assert script.executive.status == "completed"


def test_somebody_outside_may_end_the_run(script: Script) -> None:
    script.run_to("press")
    script.executive.give_up("diverged", "the physics")
    assert script.executive.finished
    assert (script.executive.status, script.executive.reason) == ("diverged", "the physics")
