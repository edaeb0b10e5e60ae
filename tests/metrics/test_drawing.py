"""Drawings whose every error is put in by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from modes import Mode
from sliding import HZ, WAY_M, moving, rows_of, strokes, touched
from synthetic import SyntheticFlight, nine_points

from inspect_cli.metrics.drawing import repeats
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.flight import FlightData
from inspect_cli.records import Reference, State, TrueContact
from inspect_cli.schema.result import Metric


def metric(flight: SyntheticFlight, name: str) -> Metric:
    return evaluate(flight.log()).metrics[name]


def value(flight: SyntheticFlight, name: str) -> float:
    found = metric(flight, name)
    assert found.value is not None, found.why
    return found.value


def shift(flight: SyntheticFlight, target: int, by_m: object) -> None:
    flight.rows(State)["p_WT"][rows_of(flight, target, Mode.SLIDE)] += by_m


def test_two_trials_are_apart_in_the_plane_alone() -> None:
    flight = strokes()
    shift(flight, 0, [0.0005, 0.003, 0.0])
    shift(flight, 1, [-0.0005, 0.0, -0.004])
    assert value(flight, "drawing.repeat_rms_m") == pytest.approx(0.005, rel=1e-9)
    assert value(flight, "drawing.tracking_rms_m") == pytest.approx(math.sqrt(12.5e-6), rel=1e-9)
    del flight.channels[TrueContact.topic]  # then the planned normal has to do
    assert value(flight, "drawing.repeat_rms_m") == pytest.approx(0.005, rel=1e-9)


def test_a_lag_in_time_counts_as_the_way_gone_meanwhile() -> None:
    flight = strokes()
    state, rows = flight.rows(State), rows_of(flight, 1, Mode.SLIDE)
    late = np.maximum(np.arange(len(rows)) - 10, 0)  # 0.1 s at 0.1 m/s: 10 mm while it moves
    state["p_WT"][rows] = state["p_WT"][rows][late]
    repeat = repeats(FlightData(flight.log()))[0]
    on_the_way = (repeat.arc_m > 0.02) & (repeat.arc_m < WAY_M - 1e-9)
    assert repeat.apart_m[on_the_way] == pytest.approx(0.010, rel=1e-6)
    assert repeat.arc_m[-1] == pytest.approx(WAY_M, rel=1e-9)
    assert np.all(np.diff(repeat.arc_m) >= 0.0)


def test_a_trial_that_begins_later_draws_the_same() -> None:
    flight = strokes()
    rows = rows_of(flight, 1, Mode.SLIDE)
    late = np.maximum(np.arange(len(rows)) - 8, 0)
    for record in (State, Reference):
        places = flight.rows(record)["p_WT"]
        places[rows] = places[rows][late]
    shift(flight, 1, [0.0, 0.0, 0.002])
    assert value(flight, "drawing.repeat_rms_m") == pytest.approx(0.002, abs=2e-6)


def test_the_worst_pair_of_the_worst_part_counts() -> None:
    flight = strokes(trials=3, parts=2)  # targets: trial 0 parts 0, 1; trial 1 ...
    shift(flight, 1, [0.0, 0.001, 0.0])
    shift(flight, 3, [0.0, -0.003, 0.0])
    assert len(repeats(FlightData(flight.log()))) == 6
    assert value(flight, "drawing.repeat_rms_m") == pytest.approx(0.004, rel=1e-9)


def test_the_attitude_counts_from_touch_to_release() -> None:
    flight = strokes()
    state, contact = flight.rows(State), touched(flight, 0)

    def yaw(row: int, angle: float) -> None:
        state["q_WB"][row] = [math.cos(angle / 2), 0.0, 0.0, math.sin(angle / 2)]

    yaw(contact[0] - 1, 0.5)
    yaw(contact[-1] + 1, 0.5)
    yaw(contact[0], 0.03)
    assert value(flight, "drawing.attitude_error_max_rad") == pytest.approx(0.03, rel=1e-6)
    yaw(contact[-1], 0.04)
    assert value(flight, "drawing.attitude_error_max_rad") == pytest.approx(0.04, rel=1e-6)


def test_what_was_not_drawn_is_not_measured() -> None:
    assert "no stroke is drawn twice" in metric(strokes(trials=1), "drawing.repeat_rms_m").why
    assert "no stroke to draw" in metric(nine_points(), "drawing.repeat_rms_m").why
    flight = strokes()
    rows = rows_of(flight, 1, Mode.SLIDE)
    flight.rows(Reference)["mode"][rows[300:]] = Mode.HOVER
    assert "not equally long" in metric(flight, "drawing.repeat_rms_m").why
    flight.rows(Reference)["mode"][rows] = Mode.HOVER
    assert "never slid along" in metric(flight, "drawing.tracking_rms_m").why


def test_the_force_of_a_stroke_counts_to_its_release() -> None:
    flight = strokes(trials=1)
    force, contact = flight.rows(State)["f_normal"], touched(flight, 0)
    force[contact] = np.where(np.arange(len(contact)) % 2, 1.8, 2.2)
    force[contact[:HZ]] = 15.0  # the first second is for settling
    assert value(flight, "contact.force_cv") == pytest.approx(0.1, rel=1e-2)
    slid = moving(flight, 0)
    force[slid[: len(slid) // 2]] = 4.0
    assert value(flight, "contact.force_cv") > 0.3


def test_at_rest_two_trials_are_compared_moment_by_moment() -> None:
    """Both tips creep alike while their reference rests: the same drawing."""
    flight = strokes()
    creep = np.minimum(np.arange(len(rows_of(flight, 0, Mode.SLIDE))) / HZ, 1.0)[:, None]
    for target in (0, 1):
        shift(flight, target, creep * [0.0, 0.0, 0.02])
    assert value(flight, "drawing.repeat_rms_m") < 1e-9


def test_a_stroke_that_loses_the_board_for_good_has_a_gap() -> None:
    flight = strokes()
    assert value(flight, "contact.bounce_gaps") == 0.0
    after = np.arange(moving(flight, 1)[len(moving(flight, 1)) // 2], touched(flight, 1)[-1] + 1)
    flight.rows(State)["f_normal"][after] = 0.05
    assert value(flight, "contact.bounce_gaps") == 1.0


def test_a_trial_in_the_air_is_no_drawing() -> None:
    flight = strokes()
    flight.rows(State)["f_normal"][touched(flight, 1)] = 0.0
    for name in ("contact.force_cv", "contact.bounce_gaps", "drawing.attitude_error_max_rad"):
        assert metric(flight, name).value is None
        assert metric(flight, name).why == "target 2 was never touched"
