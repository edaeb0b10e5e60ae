"""Every metric of a synthetic flight against the number that it was made with."""

from __future__ import annotations

import math

import numpy as np
import pytest
import synthetic
from modes import Mode
from scipy.spatial.transform import Rotation
from synthetic import SyntheticFlight, nine_points

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.flight import FlightData
from inspect_cli.metrics.readings import channels_of
from inspect_cli.records import (
    Command,
    Estimate,
    InvalidReason,
    Reading,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.schema.result import Result


@pytest.fixture
def flight() -> SyntheticFlight:
    return nine_points()


def value(flight: SyntheticFlight, name: str) -> float:
    metric = evaluate(flight.log()).metrics[name]
    assert metric.value is not None, metric.why
    return metric.value


def why(flight: SyntheticFlight, name: str) -> str:
    metric = evaluate(flight.log()).metrics[name]
    assert metric.value is None
    return metric.why


YAW = Rotation.from_rotvec([0.0, 0.0, synthetic.YAW_ERROR_RAD])
ROLL = Rotation.from_rotvec([synthetic.ESTIMATE_ROLL_ERROR_RAD, 0.0, 0.0])
ARM = YAW.inv().apply([synthetic.TOOL_M, 0.0, 0.0])
TIP_DRIFT_M = np.linalg.norm(synthetic.ESTIMATE_ERROR_M + (YAW * ROLL).apply(ARM) - YAW.apply(ARM))

# The error of the estimate is constant, and the synthetic wall has no force sensor.
UNMEASURED = {"estimation.moving_over_hovering"}
OF_OTHER_FLIGHTS = ("force_sensor.", "estimation.expected_", "drawing.", "slide.")
UNMEASURED |= {name for name in METRICS if name.startswith(OF_OTHER_FLIGHTS)}

# Six rotors with k_m 0.015 m and six with 0.005 m at 4 N, drives of 0.65, 25 W beside them.
FLOWN_WH = (6 * 0.020 * 4.0 * math.sqrt(4.0 / 7.2e-6) / 0.65 + 25.0) * (104.5 - 0.01) / 3600.0
EXPECTED = {
    # The tracking error is the constant (3, −4, 12) mm, of length 13 mm.
    "tracking.position_rmse_x_m": 0.003,
    "tracking.position_rmse_y_m": 0.004,
    "tracking.position_rmse_z_m": 0.012,
    "tracking.position_rmse_max_axis_m": 0.012,
    "tracking.tool_error_p95_m": 0.013,
    "tracking.attitude_rmse_rad": 0.02,
    "tracking.attitude_max_rad": 0.02,
    "estimation.position_rmse_m": 0.003,
    "estimation.attitude_rmse_rad": 0.005,
    "estimation.rmse_x_m": 0.001,
    "estimation.rmse_y_m": 0.002,
    "estimation.rmse_z_m": 0.002,
    **dict.fromkeys(("estimation.rmse_roll_rad", "estimation.true_rmse_roll_rad"), 0.005),
    **dict.fromkeys(("estimation.rmse_pitch_rad", "estimation.true_rmse_pitch_rad"), 0.0),
    **dict.fromkeys(("estimation.rmse_yaw_rad", "estimation.true_rmse_yaw_rad"), 0.0),
    # The tip on the yawed body is turned by the roll as well: 0.55 m · sin(0.02) · 0.005.
    "estimation.drift_at_first_contact_m": TIP_DRIFT_M,
    "contact.oscillation_growth": 0.0,
    "contact.residual_cv": 0.0,
    "estimation.wrench_force_rmse_n": 0.5,
    "estimation.wrench_torque_rmse_nm": 0.05,
    "guidance.normal_error_mean_deg": 2.0,
    "guidance.tool_axis_error_mean_deg": math.degrees(0.02),
    "contact.force_mean_n": 1.8,
    "contact.force_mean_min_n": 1.8,
    "contact.force_mean_max_n": 1.8,
    "contact.force_peak_n": 1.8,
    "contact.force_cv": 0.0,
    "contact.bounce_gaps": 0.0,
    "contact.position_error_max_m": math.hypot(0.004, 0.012),
    "contact.body_force_max_n": 0.0,
    "contact.points_total": 9.0,
    "contact.points_valid": 9.0,
    "contact.valid_share": 1.0,
    "half_cell.false_valid_points": 0.0,
    "half_cell.potential_error_max_v": 0.002,
    "half_cell.resistance_error_rel_max": 0.01,
    "half_cell.potential_min_v": -0.42 - 0.002,
    "half_cell.potential_min_point": 2.0,
    "half_cell.active_points_count": 2.0,
    "half_cell.active_mask": 6.0,
    "half_cell.map_mismatches": 0.0,
    # Take-off 4 s, nine times 10.5 s, home 2 s, land 4 s, at 100 rows per second.
    "flight.duration_s": 104.5 - 0.01,
    "flight.energy_wh_planned": 12.5,
    "flight.energy_wh_flown": FLOWN_WH,
    "flight.energy_planned_over_flown": 12.5 / FLOWN_WH,
    "flight.saturated_share": 0.0,
    "flight.end_speed_mps": 0.0,
    "actuators.thrust_max_n": 4.0,
}

ELSEWHERE = ("pull.", "scoring.", "assessment.")
CALM = {name: spec for name, spec in METRICS.items() if not name.startswith(ELSEWHERE)}
"""Nobody pulls at a rope in this flight, and no raster of the truth lies in its log; for both
``test_pull.py`` and ``test_truth_scoring.py`` have one. ``test_assessed.py`` tells what it says."""


def test_every_metric_has_the_value_that_the_flight_was_made_with(flight: SyntheticFlight) -> None:
    metrics = evaluate(flight.log()).metrics
    assert metrics.keys() == METRICS.keys()
    assert CALM.keys() == EXPECTED.keys() | UNMEASURED
    assert all(metrics[name].value is None for name in UNMEASURED)
    for name, expected in EXPECTED.items():
        assert metrics[name].value == pytest.approx(expected, rel=1e-9, abs=1e-9), name
        assert metrics[name].unit == METRICS[name].unit


def test_names_end_in_their_unit() -> None:
    suffixes = {"m": "_m", "rad": "_rad", "N": "_n", "N·m": "_nm", "°": "_deg", "V": "_v"}
    suffixes |= {"s": "_s", "m/s": "_mps", "m/N": "_per_newton", "rad/(N·m)": "_per_nm"}
    for name, spec in METRICS.items():
        assert name.endswith(suffixes.get(spec.unit, "")), name
        assert spec.meaning


def test_result_survives_json(flight: SyntheticFlight) -> None:
    result = evaluate(flight.log())
    again = Result.model_validate_json(result.model_dump_json(by_alias=True))
    assert again == result
    assert (result.mission, result.platform, result.seed) == ("nine-points", "hexarotor", 1)


@pytest.mark.parametrize("record", [State, Reference, Estimate, Reading, TrueContact, Command])
def test_a_missing_channel_is_not_measured(flight: SyntheticFlight, record: type) -> None:
    del flight.channels[record.topic]
    log = flight.log()
    metrics = evaluate(log).metrics
    for name, spec in CALM.items():
        if record in channels_of(FlightData(log), spec.needs):
            assert metrics[name].value is None
            assert record.topic in metrics[name].why
        elif name in EXPECTED:
            assert metrics[name].value == pytest.approx(EXPECTED[name], rel=1e-9, abs=1e-9), name


def test_a_log_without_rows_or_truth_measures_nothing_of_the_flight(
    flight: SyntheticFlight,
) -> None:
    flight.channels = {topic: rows[:0] for topic, rows in flight.channels.items()}
    metrics = evaluate(flight.log()).metrics
    measured = {name for name, metric in metrics.items() if metric.value is not None}
    counts = {"contact.points_total", "contact.points_valid", "contact.valid_share"}
    assert measured <= counts | {
        "flight.energy_wh_planned",
        "half_cell.active_mask",
        "half_cell.active_points_count",
    }


def test_tracking_leaves_out_contact_and_half_a_second_around_it(flight: SyntheticFlight) -> None:
    state = flight.rows(State)
    edges = np.flatnonzero(np.diff(state["f_normal"] > 0.1))
    times, first, last = state["t_s"], state["t_s"][edges[::2] + 1], state["t_s"][edges[1::2]]
    assert len(first) == len(last) == 9
    apart = np.min([np.maximum(a - times, times - b) for a, b in zip(first, last, strict=True)], 0)
    state["p_WT"][apart <= 0.495] += 1.0
    assert value(flight, "tracking.position_rmse_x_m") == pytest.approx(0.003, rel=1e-9)
    # One row more than half a second away counts; its error of 1 m alone gives 1/√n.
    row = int(np.flatnonzero((apart > 0.505) & (apart < 0.515))[0])
    state["p_WT"][row, 0] += 1.0
    assert value(flight, "tracking.position_rmse_x_m") > 1.0 / math.sqrt(len(state))


def test_standing_on_the_ground_and_safe_hover_are_not_tracking(flight: SyntheticFlight) -> None:
    state, reference = flight.rows(State), flight.rows(Reference)
    landed = reference["mode"] == Mode.LANDED
    state["p_WT"][(reference["mode"] == Mode.IDLE) | landed] += 1.0
    reference["mode"][landed] = Mode.HOVER
    assert value(flight, "tracking.position_rmse_max_axis_m") == pytest.approx(0.012, rel=1e-9)


def test_observer_is_not_blamed_for_the_ground(flight: SyntheticFlight) -> None:
    grounded = np.isin(flight.rows(Reference)["mode"], [Mode.TAKEOFF, Mode.LAND])
    flight.rows(State)["wrench_ext_B"][grounded, 2] += 46.0
    assert value(flight, "estimation.wrench_force_rmse_n") == pytest.approx(0.5, rel=1e-9)


def test_attitude_angle_is_the_same_for_both_signs(flight: SyntheticFlight) -> None:
    flight.rows(State)["q_WB"][::2] *= -1.0
    assert value(flight, "tracking.attitude_max_rad") == pytest.approx(0.02, rel=1e-9)


def test_invalid_and_far_normals_do_not_count(flight: SyntheticFlight) -> None:
    surface, contact = flight.rows(SurfaceEstimate), flight.rows(TrueContact)
    surface["n_W"][::2] = [0.0, 0.0, 1.0]
    surface["valid"][::2] = 0.0
    contact["n_W"][flight.rows(Reference)["mode"] == Mode.TRANSIT] = [0.0, 1.0, 0.0]
    assert value(flight, "guidance.normal_error_mean_deg") == pytest.approx(2.0, rel=1e-9)


def test_normals_are_compared_at_the_nearest_time(flight: SyntheticFlight) -> None:
    """A surface that turns by 1°/s is seen 3 ms late against its 10 ms ticks: no error."""
    contact, surface = flight.rows(TrueContact), flight.rows(SurfaceEstimate)
    angle = np.radians(contact["t_s"])
    contact["n_W"] = np.stack([-np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    angle = np.radians(surface["t_s"])
    surface["n_W"] = np.stack([-np.cos(angle), np.sin(angle), 0 * angle], axis=1)
    assert value(flight, "guidance.normal_error_mean_deg") == pytest.approx(0.003, abs=1e-6)


def test_a_point_that_was_never_pressed_counts_as_no_force(flight: SyntheticFlight) -> None:
    flight.rows(State)["f_normal"][flight.rows(Reference)["target"] == 4] = 0.0
    assert value(flight, "contact.force_mean_min_n") == 0.0
    assert value(flight, "contact.force_mean_n") == pytest.approx(1.8 * 8 / 9)
    assert value(flight, "contact.position_error_max_m") == pytest.approx(math.hypot(0.004, 0.012))


def test_steady_force_is_that_of_the_last_two_seconds(flight: SyntheticFlight) -> None:
    rows = flight.pressing(3)
    force = flight.rows(State)["f_normal"]
    force[rows[:-200]] = 5.0
    assert value(flight, "contact.force_mean_max_n") == pytest.approx(1.8)
    force[rows[-200:-100]] = 2.8
    assert value(flight, "contact.force_mean_max_n") == pytest.approx(2.3)


def test_variation_of_a_square_wave(flight: SyntheticFlight) -> None:
    """1.8 ± 0.45 N in turn has σ / mean = 0.25; the first second may be wild."""
    rows = flight.pressing(6)
    force = flight.rows(State)["f_normal"]
    force[rows] += np.where(np.arange(len(rows)) % 2, 0.45, -0.45)
    force[rows[:100]] = 9.0
    assert value(flight, "contact.force_cv") == pytest.approx(0.25, rel=1e-3)


@pytest.mark.parametrize(("rows_off", "gaps"), [(5, 0), (6, 1), (40, 1)])
def test_gaps_longer_than_50_ms_are_bounces(
    flight: SyntheticFlight, rows_off: int, gaps: int
) -> None:
    rows = flight.pressing(2)
    flight.rows(State)["f_normal"][rows[100 : 100 + rows_off]] = 0.05
    assert value(flight, "contact.bounce_gaps") == gaps


def test_a_point_that_is_lost_before_its_press_ends_has_a_gap(flight: SyntheticFlight) -> None:
    rows = flight.rows(Reference)
    off = (rows["target"] == 2) & (rows["mode"] >= Mode.PRESS)
    off[: flight.pressing(2)[-100]] = False
    flight.rows(State)["f_normal"][off] = 0.0
    assert value(flight, "contact.bounce_gaps") == 1


def test_a_bounce_on_release_counts(flight: SyntheticFlight) -> None:
    state, reference = flight.rows(State), flight.rows(Reference)
    retreat = np.flatnonzero((reference["mode"] == Mode.RETREAT) & (reference["target"] == 2))
    state["f_normal"][retreat[30]] = 0.4
    assert value(flight, "contact.bounce_gaps") == 1


def test_push_away_gives_invalid_readings_and_a_lie_shows(flight: SyntheticFlight) -> None:
    rows = flight.pressing(5)
    flight.rows(State)["f_normal"][rows] = 0.6
    assert value(flight, "half_cell.false_valid_points") == 1
    reading = flight.rows(Reading)[5:6]
    reading["valid"], reading["reason"] = 0.0, InvalidReason.FORCE
    reading["potential"] = reading["resistance"] = np.nan
    assert value(flight, "half_cell.false_valid_points") == 0
    assert value(flight, "contact.points_valid") == 8
    assert value(flight, "half_cell.map_mismatches") == 1
    point = evaluate(flight.log()).points[5]
    assert (point.valid, point.reason) == (False, "force: it did not stay at 1 N for 2 s")
    assert (point.potential_mv, point.astm_class, point.corrosion) == (None, None, None)
    assert point.true_force_n == pytest.approx(0.6)


def test_wrong_verdict_is_a_mismatch(flight: SyntheticFlight) -> None:
    reading = flight.rows(Reading)
    reading["potential"][2] = -0.3
    assert value(flight, "half_cell.map_mismatches") == 1
    assert value(flight, "half_cell.active_mask") == 2
    assert value(flight, "half_cell.potential_error_max_v") == pytest.approx(0.12)


def test_the_minimum_is_of_valid_readings_and_stands_out(flight: SyntheticFlight) -> None:
    reading = flight.rows(Reading)
    reading["potential"][7], reading["valid"][7] = -0.9, 0.0
    assert value(flight, "half_cell.potential_min_point") == 2
    reading["valid"][7] = 1.0
    assert value(flight, "half_cell.potential_min_point") == 8
    assert value(flight, "half_cell.potential_min_v") == pytest.approx(-0.9)
    reading["potential"] = -0.12
    assert "none stands out" in why(flight, "half_cell.potential_min_point")
    assert value(flight, "half_cell.potential_min_v") == pytest.approx(-0.12)
    reading["valid"] = 0.0
    assert "no reading is valid" in why(flight, "half_cell.potential_min_v")


def test_a_point_without_any_verdict_is_a_mismatch(flight: SyntheticFlight) -> None:
    flight.rows(State)["f_normal"][flight.rows(Reference)["target"] == 8] = 0.0
    flight.channels[Reading.topic] = flight.rows(Reading)[:8]
    assert value(flight, "half_cell.map_mismatches") == 1


def test_no_specimen_no_comparison(flight: SyntheticFlight) -> None:
    contact = flight.rows(TrueContact)
    contact["potential"] = contact["resistivity"] = np.nan
    assert "specimen" in why(flight, "half_cell.potential_error_max_v")
    assert "specimen" in why(flight, "half_cell.map_mismatches")
    assert value(flight, "half_cell.active_mask") == 6


def test_missing_wall(flight: SyntheticFlight) -> None:
    """Nothing is touched and nothing read: forces of zero, every point invalid."""
    flight.status = "aborted"
    state, reading = flight.rows(State), flight.rows(Reading)
    state["f_normal"] = 0.0
    flight.channels[Reading.topic] = reading[:1]
    reading["valid"], reading["reason"] = 0.0, InvalidReason.NO_CONTACT
    reading["potential"] = reading["resistance"] = reading["p_WT"] = np.nan
    result = evaluate(flight.log())
    assert value(flight, "contact.force_mean_n") == 0.0
    assert value(flight, "contact.points_valid") == 0.0
    assert "never touched" in why(flight, "guidance.tool_axis_error_mean_deg")
    assert "no reading is valid" in why(flight, "half_cell.potential_error_max_v")
    assert "no point was pressed" in why(flight, "contact.position_error_max_m")
    assert result.points[0].reason == "force: the probe never touched anything"
    assert result.points[0].p_W == pytest.approx(synthetic.planned_point(0))
    assert {p.reason for p in result.points[1:]} == {"the flight ended before it was read"}


def test_completed_flight_without_a_reading_of_a_point(flight: SyntheticFlight) -> None:
    flight.channels[Reading.topic] = flight.rows(Reading)[:8]
    assert evaluate(flight.log()).points[8].reason == "not visited"


def test_unknown_force_never_looks_like_no_bounce(flight: SyntheticFlight) -> None:
    flight.rows(State)["f_normal"][5000] = np.nan
    for name in ("contact.bounce_gaps", "tracking.position_rmse_x_m", "contact.force_peak_n"):
        assert why(flight, name)


def test_diverged_flight_is_evaluated(flight: SyntheticFlight) -> None:
    flight.status = "diverged"
    for rows in flight.channels.values():
        for name in rows.dtype.names or ():
            if name not in ("t_s", "mode", "target"):
                rows[name][len(rows) // 2 :] = np.nan
    result = evaluate(flight.log())
    assert result.metrics["tracking.position_rmse_x_m"].value is None
    assert result.points[0].valid
    assert not result.points[8].valid
    Result.model_validate_json(result.model_dump_json(by_alias=True))


def test_channels_that_do_not_share_ticks_are_refused(flight: SyntheticFlight) -> None:
    flight.channels[Reference.topic] = flight.rows(Reference)[::10]
    assert "share ticks" in why(flight, "tracking.position_rmse_x_m")


def test_nearly_the_same_ticks_are_matched(flight: SyntheticFlight) -> None:
    flight.rows(Reference)["t_s"] += 0.004
    assert value(flight, "tracking.position_rmse_x_m") == pytest.approx(0.003, rel=1e-9)


def test_points_carry_readings_and_truth(flight: SyntheticFlight) -> None:
    points = evaluate(flight.log()).points
    assert [p.corrosion == "active" for p in points] == [k in (1, 2) for k in range(9)]
    assert all(p.corrosion == p.true_corrosion for p in points)
    point = points[1]
    assert (point.label, point.valid, point.reason) == ("wall 2", True, "")
    assert point.potential_mv == pytest.approx(-422.0)
    assert point.true_potential_mv == pytest.approx(-420.0)
    assert point.resistance_ohm == pytest.approx(1.01 * 70.0 / 0.08)
    assert point.resistivity_ohm_m == pytest.approx(70.7)
    assert point.true_resistivity_ohm_m == pytest.approx(70.0)
    assert (point.astm_class, point.probe_force_n) == ("active", 1.8)
    assert point.contact_s == pytest.approx(4.5)
    assert point.true_force_peak_n == pytest.approx(1.8)
    assert point.position_error_m == pytest.approx(math.hypot(0.004, 0.012))


def test_saturation_energy_and_thrust(flight: SyntheticFlight) -> None:
    mode = flight.rows(Reference)["mode"]
    flying = (mode >= Mode.TAKEOFF) & (mode <= Mode.LAND)
    rows = np.flatnonzero(flying)
    flight.rows(Command)["saturated"][rows[: len(rows) // 4]] = 1.0
    flight.rows(State)["rotor_thrust"][77, 5] = 9.5
    flight.rows(State)["v_WB_W"][-50] = [0.0, 0.3, 0.4]
    assert value(flight, "flight.saturated_share") == pytest.approx(0.25, abs=1e-4)
    assert value(flight, "actuators.thrust_max_n") == 9.5
    assert value(flight, "flight.end_speed_mps") == pytest.approx(0.5)
