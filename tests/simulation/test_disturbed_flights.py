"""Whole flights with a rope, a wind and a cable: what the log says of them, and that it is so."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from modes import Mode
from scenarios import Array, Flown, Scenario
from scipy.spatial.transform import Rotation

from inspect_cli.records import TrueDisturbance

Fly = Callable[[Scenario], Flown]
pytestmark = pytest.mark.xdist_group("flights")

AREA = np.array([0.1, 0.15, 0.2])
TRUTH = """
disturbances:
  - {kind: wind, mean_mps: [1, 2, 0], gust: {w20_mps: 2}, drag_area_m2: [0.1, 0.15, 0.2]}
  - {kind: rope, direction: [0, 1, 0.5], pulls: [{start_s: 6, hold_s: 1, force_n: 3}]}
  - {kind: cable, length_m: 12, mass_kgpm: 0.03, attached: body}
  - {force_n: [0.3, 0, 0], start_s: 5}
"""
DISTURBED = Scenario("disturbed", TRUTH)


def channel(flight: Flown) -> Array:
    return flight.log.channels[TrueDisturbance.topic]


def test_a_calm_flight_has_no_channel_for_what_there_is_not(flown: Fly) -> None:
    flight = flown(Scenario("short"))
    assert TrueDisturbance.topic not in flight.log.channels
    assert TrueDisturbance.topic in flight.outcome.result.metrics["pull.force_peak_n"].why


def test_constant_loads_alone_need_no_channel(flown: Fly) -> None:
    pull = "disturbances: [{kind: constant, frame: world, force_n: [-3, 0, 0], start_s: 4}]\n"
    assert TrueDisturbance.topic not in flown(Scenario("pulled", pull)).log.channels


def test_the_channel_shares_the_ticks_of_the_state(flown: Fly) -> None:
    flight = flown(DISTURBED)
    assert flight.outcome.result.status == "completed"
    felt = channel(flight)
    np.testing.assert_array_equal(felt["t_s"], flight.state["t_s"])
    pulling = felt["pull"] == 1.0
    assert felt["t_s"][pulling][[0, -1]] == pytest.approx([6.0, 8.99], abs=0.011)
    assert not felt["f_rope_W"][~pulling].any()
    assert 2.0 < np.linalg.norm(felt["f_rope_W"], axis=1).max() < 3.0


def test_what_it_says_is_the_wrench_that_acts(flown: Fly) -> None:
    """In free air State's external wrench is rope, cable, drag and the constant 0.3 N.

    It is that of the step before and the row's is that of the step after: 4 ms and a gust apart,
    and at the row in which the hand lets go, whatever it still held.
    """
    flight = flown(DISTURBED)
    felt, state = channel(flight), flight.state
    free = (flight.mode == Mode.TRANSIT) & (state["f_normal"] == 0.0) & (state["t_s"] > 6.0)
    free &= np.diff(felt["pull"], prepend=0.0) == 0.0
    turn = Rotation.from_quat(np.roll(state["q_WB"][free], -1, axis=1))
    relative_B = turn.inv().apply(felt["wind_W"][free] - state["v_WB_W"][free])
    speed = np.linalg.norm(relative_B, axis=1)[:, None]
    drag_W = turn.apply(0.5 * 1.225 * speed * AREA * relative_B)
    force_W = felt["f_rope_W"][free] + felt["f_cable_W"][free] + drag_W + [0.3, 0.0, 0.0]
    found_W = turn.apply(state["wrench_ext_B"][free, :3])
    assert np.abs(found_W - force_W).max() < 0.05
    assert np.linalg.norm(felt["f_rope_W"][free], axis=1).max() > 2.0  # it was pulled meanwhile
    arm_W = state["p_WT"][free] - state["p_WB"][free]
    torque_B = turn.inv().apply(np.cross(arm_W, felt["f_rope_W"][free]))
    assert np.abs(state["wrench_ext_B"][free, 3:] - torque_B).max() < 0.03


def test_the_cable_weighs_what_it_lifts(flown: Fly) -> None:
    flight = flown(DISTURBED)
    weight = -0.03 * 9.81 * flight.state["p_WB"][:, 2]
    np.testing.assert_allclose(channel(flight)["f_cable_W"][:, 2], weight, atol=2e-3)


def test_the_observer_finds_the_wind_through_the_sensors_alone(flown: Fly) -> None:
    """The constant part of what acts, seen with a lag of 1 s: within 0.3 N of the mean."""
    flight = flown(DISTURBED)
    state, estimate = flight.state, flight.log.channels["/estimate"]
    rows = (flight.mode == Mode.TRANSIT) & (state["t_s"] > 12.0)
    seen, true = estimate["wrench_B"][rows, :3], state["wrench_ext_B"][rows, :3]
    assert np.linalg.norm(true.mean(axis=0)) > 0.4
    np.testing.assert_allclose(seen.mean(axis=0), true.mean(axis=0), atol=0.3)
