"""The table of failsafes: limits, modes, patience and severity; time is an argument."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.autonomy.failsafe import Failsafe, Watch
from inspect_cli.records import Estimate, Reference
from inspect_cli.vehicles.fully_actuated.context import FlightInputs, tracking_errors
from inspect_cli.vehicles.fully_actuated.failsafes import (
    BACK_OFF,
    FAILSAFES,
    FLYING,
    NEAR_SURFACE,
    STOP,
)
from inspect_cli.vehicles.fully_actuated.modes import MODES, stop

LENGTHS = {"n_rotors": 0, "n_joints": 0, "n_arm": 0}
ROWS = {row.name: row for row in FAILSAFES}
POSE, SURFACE = "pose measurements lost", "surface not seen by the depth camera"
CONTRADICTED = "surface contradicts the plan"
NEAR, PUSHED = "surface nearer than planned on the way", "unexpected force above 12 N"
LOST = "surface lost while sliding"
POSITION, ATTITUDE = "position error above 0.6 m", "attitude error above 0.6 rad"


def inputs(t_s: float = 10.0, **values: float) -> FlightInputs:
    """All is well at ``t_s`` but for what is given."""
    good = FlightInputs(t_s, Estimate.create(), Reference.create(LENGTHS), t_s, t_s, t_s)
    for name, value in values.items():
        setattr(good, name, value)
    return good


def test_the_table_names_what_these_tests_know() -> None:
    assert set(ROWS) == {POSE, SURFACE, LOST, CONTRADICTED, NEAR, PUSHED, POSITION, ATTITUDE}


@pytest.mark.parametrize(
    ("name", "field", "still_good", "bad"),
    [
        (POSE, "pose_heard_s", 9.76, 9.74),
        (SURFACE, "surface_seen_s", 9.51, 9.49),
        (LOST, "surface_seen_s", 9.51, 9.49),
        (CONTRADICTED, "surface_agreed_s", 9.51, 9.49),
        (NEAR, "surface_distance_m", 0.01, -0.01),
        (PUSHED, "force_n", 11.9, 12.1),
        (POSITION, "position_error_m", 0.59, 0.61),
        (ATTITUDE, "attitude_error_rad", 0.59, 0.61),
    ],
)
def test_each_row_has_its_limit_and_takes_nan_for_a_violation(
    name: str, field: str, still_good: float, bad: float
) -> None:
    assert not ROWS[name].violated(inputs())
    assert not ROWS[name].violated(inputs(**{field: still_good}))
    assert ROWS[name].violated(inputs(**{field: bad}))
    assert ROWS[name].violated(inputs(**{field: np.nan}))


@pytest.mark.parametrize("mode", list(MODES))
def test_each_row_watches_its_modes(mode: str) -> None:
    everything_bad = inputs(
        pose_heard_s=0.0,
        surface_seen_s=0.0,
        surface_agreed_s=-9.0,
        surface_distance_m=-1.0,
        force_n=50.0,
        position_error_m=9.0,
        attitude_error_rad=3.0,
    )
    due = set()
    for row in FAILSAFES:
        watch = Watch([row])
        watch.check(mode, 10.0, everything_bad)
        if watch.check(mode, 20.0, everything_bad) is not None:
            due.add(row.name)
    expected = {POSE, POSITION, ATTITUDE} if mode in FLYING else set()
    expected |= {SURFACE, CONTRADICTED} if mode in NEAR_SURFACE else set()
    expected |= {LOST} if mode == "slide" else set()
    expected |= {NEAR} if mode == "transit" else set()
    expected |= {PUSHED} if mode in ("transit", "approach") else set()
    assert due == expected


def test_a_press_may_lie_behind_the_surface() -> None:
    """The reference is ``press_m`` behind what stops the tool; that is no loss of control."""
    assert not ROWS[POSITION].violated(inputs(position_error_m=1.1, press_m=0.6))
    assert ROWS[POSITION].violated(inputs(position_error_m=1.3, press_m=0.6))


def test_a_surface_ahead_must_leave_the_way_to_a_stop() -> None:
    """0.2 s of reaction and braking at 1 m/s²: 0.1 m + 0.125 m from 0.5 m/s; none sideways."""
    ahead = inputs(least_distance_m=0.1, surface_distance_m=0.32)
    ahead.surface_n_W[:] = [-1.0, 0.0, 0.0]
    for velocity, violated in (([0.5, 0.0, 0.0], True), ([0.49, 0.0, 0.0], False),
                               ([0.0, 0.5, 0.0], False), ([-0.5, 0.0, 0.0], False)):  # fmt: skip
        ahead.estimate.v_WB_W[:] = velocity
        ahead.surface_seen_s = 10.0
        ahead.refresh(10.0)
        assert ROWS[NEAR].violated(ahead) == violated


def test_on_the_ground_and_after_an_abort_nothing_is_watched() -> None:
    assert not FLYING & {"idle", "landed", "hover"}


def row(name: str, severity: int, patience_s: float = 0.0, error_m: float = 1.0) -> Failsafe:
    return Failsafe(
        name, FLYING, lambda i: i.position_error_m > error_m, patience_s, severity, (stop,)
    )


def due(watch: Watch, t_s: float, mode: str = "transit", **values: float) -> str:
    """The name of the row that is due."""
    found = watch.check(mode, t_s, inputs(t_s, **values))
    return "" if found is None else found.name


@pytest.mark.parametrize("order", [1, -1])
def test_the_severest_row_wins_wherever_it_stands(order: int) -> None:
    table = [row("mild", BACK_OFF), row("severe", STOP)][::order]
    assert due(Watch(table), 10.0, position_error_m=2.0) == "severe"


def test_of_equals_the_first_gives_the_reason() -> None:
    table = [row("first", BACK_OFF), row("second", BACK_OFF)]
    assert due(Watch(table), 10.0, position_error_m=2.0) == "first"


def test_to_stop_is_severer_than_to_back_off() -> None:
    assert BACK_OFF < STOP
    severities = {row.name: row.severity for row in FAILSAFES}
    assert severities.pop(NEAR) == STOP
    assert set(severities.values()) == {BACK_OFF}


def test_a_violation_must_last() -> None:
    watch = Watch([row("error", STOP, patience_s=0.5)])
    for t_s, expected in ((1.0, ""), (1.48, ""), (1.5, "error"), (1.6, "error")):
        assert due(watch, t_s, position_error_m=2.0) == expected


def test_an_interruption_starts_the_patience_anew() -> None:
    watch = Watch([row("error", STOP, patience_s=0.5)])
    assert due(watch, 1.0, position_error_m=2.0) == ""
    assert due(watch, 1.4) == ""  # well again
    assert due(watch, 1.5, position_error_m=2.0) == ""
    assert due(watch, 1.99, position_error_m=2.0) == ""
    assert due(watch, 2.0, position_error_m=2.0) == "error"


def test_a_mode_that_is_not_watched_starts_the_patience_anew() -> None:
    watch = Watch([Failsafe("near", NEAR_SURFACE, lambda i: True, 0.5, BACK_OFF, (stop,))])
    assert due(watch, 1.0, "press") == ""
    assert due(watch, 1.4, "retreat") == ""
    assert due(watch, 1.6, "approach") == ""
    assert due(watch, 2.1, "approach") == "near"


def test_two_watches_keep_their_own_time() -> None:
    table = [row("error", STOP, patience_s=0.5)]
    first, second = Watch(table), Watch(table)
    assert due(first, 1.0, position_error_m=2.0) == ""
    assert due(first, 1.5, position_error_m=2.0) == "error"
    assert due(second, 1.5, position_error_m=2.0) == ""


def test_tracking_errors_are_distance_and_angle() -> None:
    rng = np.random.default_rng(1)
    for _ in range(20):
        estimate, reference = Estimate.create(), Reference.create(LENGTHS)
        turns = [Rotation.random(rng=rng) for _ in range(2)]
        for record, turn in zip((estimate, reference), turns, strict=True):
            record.p_WB[:] = rng.normal(size=3)
            record.q_WB[:] = turn.as_quat()[[3, 0, 1, 2]] * rng.choice([-1.0, 1.0])
        estimate.wrench_B[:] = rng.normal(size=6)
        estimate.v_WB_W[:], normal = rng.normal(size=(2, 3))
        errors = tracking_errors(estimate.array, reference.array, normal)
        distance, angle, force, closing = errors
        assert closing == pytest.approx(max(-normal @ estimate.v_WB_W, 0.0))
        assert force == pytest.approx(np.linalg.norm(estimate.wrench_B[:3]))
        assert distance == pytest.approx(np.linalg.norm(estimate.p_WB - reference.p_WB))
        assert angle == pytest.approx((turns[0].inv() * turns[1]).magnitude(), abs=1e-6)
    same = inputs()
    same.estimate.q_WB[0] = same.reference.q_WB[0] = 1.0
    same.refresh(12.0)
    assert (same.t_s, same.position_error_m, same.attitude_error_rad) == (12.0, 0.0, 0.0)
