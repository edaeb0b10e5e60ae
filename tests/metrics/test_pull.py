"""Pulls at a rope whose every metric is known in closed form, made without a simulator.

The body yields in proportion to the cord's force f: 0.05 m/N along it, 0.004 m/N upwards, and it
yaws by 0.01 rad/N. The cord is 3° to the right of x_B when a pull begins and keeps its direction.
"""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
import pytest
from synthetic import LENGTHS, SyntheticFlight, nine_points

from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import Reference, State, TrueDisturbance
from inspect_cli.schema.result import Metric

ARM_M = 0.55
HEADING = 0.7
ASIDE = math.radians(3.0)
ALONG, UPWARDS, YAW = 0.05, 0.004, 0.01
PEAKS = (4.0, 6.0, 5.0)
STARTS = (2.0, 12.0, 18.0)
RISE_S, HOLD_S = 1.0, 2.0
END_S = RISE_S + HOLD_S + RISE_S


def rows_at(times: np.ndarray, first_s: float, last_s: float) -> np.ndarray:
    return (times > first_s - 1e-9) & (times < last_s - 1e-9)


def pulled(peaks: Sequence[float] = PEAKS, starts: Sequence[float] = STARTS) -> SyntheticFlight:
    """A hold of 30 s with pulls of 4 s."""
    times = np.arange(3000) / 100.0
    felt = np.zeros(len(times), TrueDisturbance.dtype())
    felt["t_s"] = times
    strength = np.zeros(len(times))
    for k, (peak, start_s) in enumerate(zip(peaks, starts, strict=True), start=1):
        rows = rows_at(times, start_s, start_s + END_S)
        since = times[rows] - start_s
        ramp = np.minimum(since, END_S - since) / RISE_S
        strength[rows] = peak * np.clip(ramp, 0.0, 1.0)
        felt["pull"][rows] = k
    towards = HEADING - ASIDE
    felt["f_rope_W"] = strength[:, None] * [math.cos(towards), math.sin(towards), 0.0]
    state = np.zeros(len(times), State.dtype(LENGTHS))
    reference = np.zeros(len(times), Reference.dtype())
    state["t_s"] = reference["t_s"] = times
    reference["p_WB"] = [1.0, 2.0, 1.5]
    reference["q_WB"] = [math.cos(HEADING / 2), 0.0, 0.0, math.sin(HEADING / 2)]
    state["p_WB"] = [1.01, 1.98, 1.503]  # it does not hold exactly where it should
    state["p_WB"] += ALONG * felt["f_rope_W"]
    state["p_WB"][:, 2] += UPWARDS * strength
    yaw = HEADING + YAW * strength
    state["q_WB"] = np.column_stack([np.cos(yaw / 2), 0 * yaw, 0 * yaw, np.sin(yaw / 2)])
    ahead = np.column_stack([np.cos(yaw), np.sin(yaw), 0 * yaw])
    state["p_WT"] = state["p_WB"] + ARM_M * ahead
    flight = nine_points()
    channels = {State.topic: state, Reference.topic: reference, TrueDisturbance.topic: felt}
    return SyntheticFlight(channels, flight.mission, flight.plan, flight.platform)


def torque(peak: float) -> float:
    """About z_B when the body has yawed to the left of the cord."""
    return ARM_M * peak * math.sin(ASIDE + YAW * peak)


EXPECTED = {
    "pull.force_peak_n": 6.0,
    "pull.angle_to_x_B_deg": 3.0 + math.degrees(YAW * 6.0),
    "pull.displacement_max_m": 6.0 * math.hypot(ALONG, UPWARDS),
    "pull.displacement_along_m": 4.0 * ALONG,
    "pull.displacement_z_m": 6.0 * UPWARDS,
    "pull.attitude_motion_m": 6.0 * YAW * ARM_M,
    "pull.along_over_z": ALONG / UPWARDS,
    "pull.along_over_attitude": ALONG / (YAW * ARM_M),
    "pull.metres_per_newton": ALONG,
    "pull.torque_peak_nm": torque(6.0),
    "pull.yaw_max_rad": 6.0 * YAW,
    "pull.yaw_per_nm": sum(YAW * peak / torque(peak) for peak in PEAKS) / 3.0,
}


def measured(flight: SyntheticFlight) -> dict[str, Metric]:
    metrics = evaluate(flight.log()).metrics
    return {name: metric for name, metric in metrics.items() if name.startswith("pull.")}


def value(flight: SyntheticFlight, name: str) -> float:
    metric = measured(flight)[name]
    assert metric.value is not None, metric.why
    return metric.value


def test_every_metric_has_the_value_that_the_pulls_were_made_with() -> None:
    metrics = measured(pulled())
    assert metrics.keys() == EXPECTED.keys()
    for name, expected in EXPECTED.items():
        assert metrics[name].value == pytest.approx(expected, rel=1e-9), name
        assert metrics[name].unit == METRICS[name].unit


def test_pulling_backwards_is_the_same_axis() -> None:
    flight = pulled()
    flight.rows(TrueDisturbance)["f_rope_W"] *= -1.0
    assert value(flight, "pull.angle_to_x_B_deg") == pytest.approx(
        EXPECTED["pull.angle_to_x_B_deg"]
    )
    # And the body then moved against the cord.
    assert value(flight, "pull.displacement_along_m") == pytest.approx(0.0, abs=1e-9)


def test_the_direction_counts_while_the_pull_is_strong() -> None:
    flight = pulled()
    felt = flight.rows(TrueDisturbance)
    weak = np.linalg.norm(felt["f_rope_W"], axis=1) < 1.99  # below half of each peak
    felt["f_rope_W"][weak] = felt["f_rope_W"][weak][:, [1, 0, 2]] * [-1.0, 1.0, 1.0]
    assert value(flight, "pull.angle_to_x_B_deg") == pytest.approx(
        EXPECTED["pull.angle_to_x_B_deg"]
    )


@pytest.mark.parametrize(("moment_s", "counts"), [(8.9, True), (9.1, False), (1.9, False)])
def test_a_pull_is_watched_until_three_seconds_after_its_end(moment_s: float, counts: bool) -> None:
    """The first one lasts from 2 s to 6 s."""
    flight = pulled()
    state = flight.rows(State)
    state["p_WB"][int(np.argmin(np.abs(state["t_s"] - moment_s))), 2] += 0.5
    assert (value(flight, "pull.displacement_z_m") > 0.4) == counts


def test_the_next_pull_ends_the_watch_and_starts_where_the_body_then_is() -> None:
    """Second from 12 s to 16 s, third from 18 s on: what happens at 18 s is the third's."""
    flight = pulled()
    state = flight.rows(State)
    later = state["t_s"] > 17.995
    for name in ("p_WB", "p_WT"):
        state[name][later] += [0.0, 0.0, 0.3]
    assert value(flight, "pull.displacement_z_m") == pytest.approx(6.0 * UPWARDS)


def test_a_planned_motion_is_not_the_pulls_doing() -> None:
    flight = pulled()
    state, reference = flight.rows(State), flight.rows(Reference)
    way = 0.1 * state["t_s"][:, None] * [1.0, -1.0, 0.5]
    for rows, names in ((state, ("p_WB", "p_WT")), (reference, ("p_WB",))):
        for name in names:
            rows[name] += way
    for name, expected in EXPECTED.items():
        assert value(flight, name) == pytest.approx(expected, rel=1e-9), name


def test_the_least_favourable_pull_counts() -> None:
    flight = pulled()
    state = flight.rows(State)
    third = rows_at(state["t_s"], 18.0, 22.0)
    strength = np.linalg.norm(flight.rows(TrueDisturbance)["f_rope_W"], axis=1)
    state["p_WB"][third, 2] += 0.016 * strength[third]
    assert value(flight, "pull.along_over_z") == pytest.approx(ALONG / (UPWARDS + 0.016))


def test_a_pull_in_the_first_row_is_one() -> None:
    flight = pulled((5.0,), (0.0,))
    assert value(flight, "pull.force_peak_n") == pytest.approx(5.0)
    flight.rows(TrueDisturbance)["pull"] = 1.0
    assert value(flight, "pull.force_peak_n") == pytest.approx(5.0)


def test_without_a_pull_nothing_is_measured() -> None:
    for metric in measured(pulled((), ())).values():
        assert metric.value is None
        assert metric.why == "nobody pulled at a rope during the flight"


def test_a_cord_that_stays_slack_compares_with_nothing() -> None:
    metrics = measured(pulled((0.0,), (3.0,)))
    assert metrics["pull.displacement_max_m"].value == 0.0
    assert metrics["pull.metres_per_newton"].why == "the cord of a pull was never taut"
    assert "torque about z_B" in metrics["pull.yaw_per_nm"].why


def test_without_the_channel_it_is_not_measured() -> None:
    flight = pulled()
    del flight.channels[TrueDisturbance.topic]
    for metric in measured(flight).values():
        assert metric.value is None
        assert TrueDisturbance.topic in metric.why
