"""A followed surface whose way, speed, turn and gaps are put in by hand."""

from __future__ import annotations

import math

import numpy as np
import pytest
from modes import Mode
from scipy.spatial.transform import Rotation
from sliding import HZ, LEVEL, MOVE_S, SPEED_MPS, WAY_M, following, moving, rows_of, touched
from synthetic import SyntheticFlight, nine_points

from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import Reference, State, TrueContact
from inspect_cli.schema.result import Metric

TICK_M = SPEED_MPS / HZ


def metric(flight: SyntheticFlight, name: str) -> Metric:
    return evaluate(flight.log()).metrics[f"slide.{name}"]


def value(flight: SyntheticFlight, name: str) -> float:
    found = metric(flight, name)
    assert found.value is not None, found.why
    return found.value


def turn(flight: SyntheticFlight, vector: np.ndarray) -> None:
    """Turn the true tool by ``vector`` (3,) about its own axes, evenly while it moves."""
    state, rows = flight.rows(State), moving(flight, 0)
    share = np.zeros(len(state))
    share[rows] = np.linspace(0.0, 1.0, len(rows))
    share[rows[-1] :] = 1.0
    turned = LEVEL * Rotation.from_rotvec(share[:, None] * vector)
    state["q_WT"] = turned.as_quat(scalar_first=True)


def test_way_and_speed_are_those_of_the_translation() -> None:
    flight = following()
    assert value(flight, "distance_m") == pytest.approx(WAY_M, abs=TICK_M)
    assert value(flight, "chord_m") == pytest.approx(WAY_M, abs=TICK_M)
    # The reference counts as moving from the tick before its way to the one after it.
    assert value(flight, "speed_mean_mps") == pytest.approx(SPEED_MPS, rel=2.0 / (MOVE_S * HZ))
    state, rest = flight.rows(State), rows_of(flight, 0, Mode.SLIDE)[: HZ // 2]
    state["p_WT"][rest, 2] += 0.001 * (np.arange(len(rest)) % 2)  # trembling at rest is no way
    assert value(flight, "distance_m") == pytest.approx(WAY_M, abs=TICK_M)


def test_a_detour_is_a_way_but_no_chord() -> None:
    flight = following()
    state, rows = flight.rows(State), moving(flight, 0)
    phase = np.linspace(0.0, 1.0, len(rows))
    state["p_WT"][rows, 2] += 0.1 * (1.0 - np.abs(2.0 * phase - 1.0))
    state["p_WT"][rows, 0] += 0.02 * np.sin(20.0 * phase)  # along the normal: no way either
    assert value(flight, "distance_m") == pytest.approx(2.0 * math.hypot(0.2, 0.1), rel=0.01)
    assert value(flight, "chord_m") == pytest.approx(WAY_M, rel=0.01)


def test_where_it_does_not_touch_it_goes_no_way() -> None:
    flight = following()
    assert value(flight, "gaps") == 0.0
    lost = moving(flight, 0)[100:150]
    flight.rows(State)["f_normal"][lost] = 0.05
    assert value(flight, "distance_m") == pytest.approx(WAY_M - 51 * TICK_M, abs=1.1 * TICK_M)
    assert value(flight, "gaps") == 1.0
    flight.rows(State)["f_normal"][lost[4:]] = 2.0  # 40 ms are no gap
    assert value(flight, "gaps") == 0.0


def test_the_tool_turns_about_its_own_axes() -> None:
    flight = following()
    turn(flight, np.array([0.03, -0.1, 0.02]))
    assert value(flight, "rotation_xz_max_rad") == pytest.approx(0.03, rel=1e-6)
    assert value(flight, "rotation_y_rad") == pytest.approx(0.1, rel=1e-6)
    turn(flight, np.array([0.03, -0.1, -0.05]))
    assert value(flight, "rotation_xz_max_rad") == pytest.approx(0.05, rel=1e-6)


def test_the_tools_axis_is_held_against_the_true_normal() -> None:
    flight = following()
    turn(flight, np.array([0.03, 0.04, 0.0]))  # z_T leaves the normal by 0.05 rad
    assert value(flight, "axis_error_moving_deg") == pytest.approx(math.degrees(0.025), rel=1e-3)
    rows, after = touched(flight, 0), moving(flight, 0)[-1]
    still = np.count_nonzero(rows > after)
    mean = (0.025 * len(moving(flight, 0)) + 0.05 * still) / len(rows)
    assert value(flight, "axis_error_mean_deg") == pytest.approx(math.degrees(mean), rel=1e-2)
    flight.rows(TrueContact)["surface"] = -1.0
    assert metric(flight, "axis_error_mean_deg").value is None


def test_what_did_not_slide_is_not_measured() -> None:
    assert "no surface to follow" in metric(nine_points(), "distance_m").why
    flight = following()
    flight.rows(Reference)["p_WT"] = [2.1, 0.2, 1.5]
    assert "did not move along" in metric(flight, "distance_m").why
    flight.rows(State)["f_normal"] = 0.0
    assert "never touched" in metric(flight, "gaps").why


@pytest.mark.parametrize(("rows_off", "gaps"), [(5, 0.0), (6, 1.0), (200, 1.0)])
def test_contact_that_is_lost_until_the_end_of_the_slide_is_a_gap(
    rows_off: int, gaps: float
) -> None:
    flight = following()
    last = rows_of(flight, 0, Mode.SLIDE)[-1]
    flight.rows(State)["f_normal"][last + 1 - rows_off :] = 0.0
    assert value(flight, "gaps") == gaps
