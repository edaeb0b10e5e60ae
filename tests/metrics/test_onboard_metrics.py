"""Pose errors by axis, drift, the force sensor's comparison and settling, on synthetic flights."""

from __future__ import annotations

import numpy as np
import pytest
from modes import Mode
from scipy.spatial.transform import Rotation
from synthetic import SyntheticFlight, nine_points

from inspect_cli.commands.study_force import lag_contact_rmse
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.flight import FlightData
from inspect_cli.metrics.force_sensor import low_pass
from inspect_cli.metrics.geometry import rotation_vectors, turned_back_by, turned_by
from inspect_cli.metrics.pose_error import turned_frames
from inspect_cli.records import Estimate, Reference, State, WallForce

RATE = 800.0
MISALIGNMENT = (0.06, -0.05, 0.01)


@pytest.fixture
def flight() -> SyntheticFlight:
    return nine_points()


def value(flight: SyntheticFlight, name: str) -> float:
    metric = evaluate(flight.log()).metrics[name]
    assert metric.value is not None, metric.why
    return metric.value


def test_many_rotations_are_those_of_scipy() -> None:
    rng = np.random.default_rng(1)
    q_a, q_b = rng.normal(size=(2, 50, 4))
    x = rng.normal(size=(50, 3))
    a, b = (Rotation.from_quat(q, scalar_first=True) for q in (q_a, q_b))
    np.testing.assert_allclose(rotation_vectors(q_a, q_b), (a.inv() * b).as_rotvec(), atol=1e-12)
    np.testing.assert_allclose(rotation_vectors(q_a, q_a), 0.0, atol=1e-12)
    np.testing.assert_allclose(turned_by(q_a, x), a.apply(x), atol=1e-12)
    np.testing.assert_allclose(turned_back_by(q_a, x), a.inv().apply(x), atol=1e-12)
    turn = np.array([0.3, -0.4, 0.8])
    turned = Rotation.from_quat(turned_frames(q_a, turn), scalar_first=True)
    np.testing.assert_allclose(
        (a * Rotation.from_rotvec(turn)).as_matrix(), turned.as_matrix(), atol=1e-12
    )


def test_the_misalignment_of_the_tracker_counts_against_its_frame_alone(
    flight: SyntheticFlight,
) -> None:
    sensors = flight.platform.sensors
    pose = sensors["pose"].model_copy(update={"body_misalignment_rad": MISALIGNMENT})
    flight.platform = flight.platform.model_copy(update={"sensors": sensors | {"pose": pose}})
    roll = Rotation.from_rotvec([0.005, 0.0, 0.0])
    off = (Rotation.from_rotvec(MISALIGNMENT).inv() * roll).as_rotvec()
    for axis, name in enumerate(("roll", "pitch", "yaw")):
        assert value(flight, f"estimation.rmse_{name}_rad") == pytest.approx(abs(off[axis]))
    assert value(flight, "estimation.true_rmse_roll_rad") == pytest.approx(0.005)
    assert value(flight, "estimation.true_rmse_pitch_rad") == pytest.approx(0.0, abs=1e-12)


def test_growth_in_motion_over_growth_in_hover(flight: SyntheticFlight) -> None:
    """The error grows by 10 mm/s along the transits and by 1 mm/s where the body stands still.

    Windows of a second that straddle the two, at 0.3 m/s with at least a third of motion, dilute.
    """
    state, estimate = flight.rows(State), flight.rows(Estimate)
    mode = flight.rows(Reference)["mode"]
    moving = mode == Mode.TRANSIT
    state["p_WB"] = 0.0
    state["p_WB"][:, 0] = np.cumsum(0.01 * np.where(moving, 0.3, 0.0))
    estimate["p_WB"] = state["p_WB"]
    estimate["p_WB"][:, 1] += np.cumsum(0.01 * np.where(moving, 0.010, 0.001))
    found = value(flight, "estimation.moving_over_hovering")
    assert 0.5 * 10.0 < found < 10.0
    estimate["p_WB"][:, 1] = 0.005 * flight.rows(State)["t_s"]
    assert value(flight, "estimation.moving_over_hovering") == pytest.approx(1.0)


def test_drift_is_that_of_the_tip_at_the_first_touch(flight: SyntheticFlight) -> None:
    state, estimate = flight.rows(State), flight.rows(Estimate)
    first = int(np.argmax(state["f_normal"] > 0.1))
    estimate["p_WB"] = state["p_WB"]
    estimate["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    state["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    estimate["q_WB"][first] = [np.cos(0.02), 0.0, 0.0, np.sin(0.02)]
    # 0.55 m of arm turned by 0.04 rad, along the chord.
    assert value(flight, "estimation.drift_at_first_contact_m") == pytest.approx(
        2.0 * 0.55 * np.sin(0.02)
    )


def wall_of(force_S: np.ndarray, torque_S: np.ndarray, end_s: float) -> np.ndarray:
    """Blocks of constant samples (3,) from a wall at x = 2 m: x_S = −y_W, y_S = z_W, z_S = −x_W."""
    n = int(end_s * RATE) // 80
    rows = np.zeros(n, WallForce.dtype())
    rows["t_s"] = (80 * np.arange(1, n + 1) - 1) / RATE
    rows["period"] = 1.0 / RATE
    rows["p_WS"] = [2.0, 0.0, 1.25]
    axes = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    rows["q_WS"] = Rotation.from_matrix(axes).as_quat(scalar_first=True)
    for name, samples in (("f_S", force_S), ("t_S", torque_S)):
        rows[name] = samples
    return rows


def sensed(flight: SyntheticFlight) -> None:
    """A constant (5, −2, 1) N in W on the tip; attitudes are true and level.

    The observer is off by (0.3, 0.4, 0) N and by (0, 0.03, 0.04) N·m about the tip.
    """
    state, estimate = flight.rows(State), flight.rows(Estimate)
    on_vehicle = np.array([5.0, -2.0, 1.0])
    state["q_WB"] = estimate["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    state["p_WT"] = [1.9, 0.1, 1.4]
    state["p_WB"] = [1.35, 0.1, 1.4]
    observed = on_vehicle + np.array([0.3, 0.4, 0.0])
    estimate["wrench_B"][:, :3] = observed
    estimate["wrench_B"][:, 3:] = np.cross([0.55, 0.0, 0.0], observed) + np.array([0.0, 0.03, 0.04])
    axes = np.array([[0.0, 0.0, -1.0], [-1.0, 0.0, 0.0], [0.0, 1.0, 0.0]])
    on_wall = -on_vehicle
    torque = np.cross(np.array([1.9, 0.1, 1.4]) - [2.0, 0.0, 1.25], on_wall)
    end_s = float(state["t_s"][-1])
    flight.channels[WallForce.topic] = wall_of(axes.T @ on_wall, axes.T @ torque, end_s)


def test_force_and_torque_are_compared_where_they_act(flight: SyntheticFlight) -> None:
    sensed(flight)
    for kind in ("rmse", "contact_rmse"):
        for axis, force, torque in (("x", 0.3, 0.0), ("y", 0.4, 0.03), ("z", 0.0, 0.04)):
            found = value(flight, f"force_sensor.{kind}_f{axis}_n")
            assert found == pytest.approx(force, abs=1e-6)
            found = value(flight, f"force_sensor.{kind}_t{axis}_nm")
            assert found == pytest.approx(torque, abs=1e-6)
    for axis, force in (("x", 0.4), ("y", 0.0), ("z", 0.3)):
        assert value(flight, f"force_sensor.rmse_s{axis}_n") == pytest.approx(force, abs=1e-6)
    # z_S is −x_W: what pulls the vehicle along +x_W is a press of −5 N.
    assert value(flight, "force_sensor.peak_n") == pytest.approx(-5.0, abs=1e-6)
    assert value(flight, "force_sensor.noise_n") == pytest.approx(0.0, abs=1e-6)


def test_the_lag_alone_errs_by_what_decays(flight: SyntheticFlight) -> None:
    """5 N from the log's first tick on leave 5 e^(−K t), whatever the observer made of them."""
    sensed(flight)
    gain = 0.05  # slow enough for a good part to be left at the last of the nine touches
    control = flight.platform.control.model_copy(update={"observer_gain": (gain,) * 3})
    flight.platform = flight.platform.model_copy(update={"control": control})
    times, touching = flight.rows(State)["t_s"], flight.rows(State)["f_normal"] > 0.1
    left = 5.0 * np.exp(-gain * (times - times[0]))[touching]
    expected = float(np.sqrt(np.mean(left**2)))
    assert expected > 0.5
    assert lag_contact_rmse(FlightData(flight.log())) == pytest.approx(expected, rel=1e-6)


def test_the_estimated_attitude_turns_the_estimated_force(flight: SyntheticFlight) -> None:
    sensed(flight)
    yaw = 0.05
    flight.rows(Estimate)["q_WB"] = [np.cos(yaw / 2), 0.0, 0.0, np.sin(yaw / 2)]
    turned = Rotation.from_rotvec([0.0, 0.0, yaw]).apply([5.3, -1.6, 1.0])
    for axis, name in enumerate("xy"):
        expected = abs(turned[axis] - [5.0, -2.0][axis])
        assert value(flight, f"force_sensor.rmse_f{name}_n") == pytest.approx(expected, abs=1e-6)


def test_lost_samples_are_not_papered_over(flight: SyntheticFlight) -> None:
    sensed(flight)
    rows = flight.channels[WallForce.topic]
    flight.channels[WallForce.topic] = np.delete(rows, 100)
    metric = evaluate(flight.log()).metrics["force_sensor.rmse_fx_n"]
    assert metric.value is None
    assert "missing" in metric.why


def test_raw_noise_is_what_the_filter_takes_away(flight: SyntheticFlight) -> None:
    sensed(flight)
    rows = flight.channels[WallForce.topic]
    rows["f_S"] += np.random.default_rng(2).normal(scale=0.5, size=rows["f_S"].shape)
    # 5 of 400 Hz of white noise pass: 0.6 % of the amplitude.
    assert value(flight, "force_sensor.noise_n") == pytest.approx(0.5, rel=0.02)


def test_the_filter_is_the_papers_twice_and_without_a_lag() -> None:
    """A sine of 2 Hz stays in place, one of 5 Hz is halved: twice −3 dB of five poles."""
    times = np.arange(8000) / RATE
    for hz in (1.0, 2.0, 5.0, 10.0):
        wave = np.sin(2.0 * np.pi * hz * times)
        passed = low_pass(wave[:, None], RATE)[:, 0]
        # |H|² of an analogue Butterworth; the bilinear warp at 10 of 800 Hz is 0.05 %.
        gain = 1.0 / (1.0 + (hz / 5.0) ** 10)
        middle = slice(2000, 6000)
        np.testing.assert_allclose(passed[middle], gain * wave[middle], atol=0.005)


def dwell_force(flight: SyntheticFlight, shape: np.ndarray) -> None:
    """Give every dwell the force of a shape (n,), sampled at 100 Hz from its first touch on."""
    force = flight.rows(State)["f_normal"]
    for k in range(9):
        rows = flight.pressing(k)
        force[rows] = shape[: len(rows)]


@pytest.mark.parametrize(("rate", "grows"), [(-0.8, False), (0.0, False), (0.6, True)])
def test_an_oscillation_that_grows_is_told_from_one_that_dies(
    flight: SyntheticFlight, rate: float, grows: bool
) -> None:
    times = np.arange(460) / 100.0
    dwell_force(flight, 5.0 + 0.5 * np.exp(rate * times) * np.sin(2.0 * np.pi * 3.0 * times))
    found = value(flight, "contact.oscillation_growth")
    # The moving mean takes half a second at both ends; middles of the halves are 1.24 s apart.
    assert found == pytest.approx(np.exp(rate * 1.24), rel=0.05)
    assert (found > 1.1) == grows


def test_a_slow_ramp_and_small_noise_are_no_oscillation(flight: SyntheticFlight) -> None:
    noise = np.random.default_rng(3).normal(scale=0.01, size=460)
    dwell_force(flight, np.linspace(2.0, 8.0, 460) + noise)
    assert value(flight, "contact.oscillation_growth") < 0.3


def test_residual_variation_is_that_of_the_last_two_seconds(flight: SyntheticFlight) -> None:
    wave = 5.0 + np.where(np.arange(460) < 240, 2.0, 0.1) * (-1.0) ** np.arange(460)
    dwell_force(flight, wave)
    assert value(flight, "contact.residual_cv") == pytest.approx(0.02, rel=0.01)


def test_a_contact_that_never_came_leaves_no_verdict_to_the_others(flight: SyntheticFlight) -> None:
    flight.rows(State)["f_normal"][flight.pressing(4)] = 0.0
    retreat = flight.rows(Reference)["target"] == 4
    flight.rows(State)["f_normal"][retreat] = 0.0
    for name in ("contact.oscillation_growth", "contact.residual_cv"):
        metric = evaluate(flight.log()).metrics[name]
        assert metric.value is None
        assert metric.why == "never pressed: wall 5"


def test_in_contact_means_in_contact(flight: SyntheticFlight) -> None:
    """The observer is off by 1 N more, and 0.1 N·m more, wherever the tool does not touch."""
    sensed(flight)
    free = flight.rows(State)["f_normal"] <= 0.1
    flight.rows(Estimate)["wrench_B"][free, 0] += 1.0
    flight.rows(Estimate)["wrench_B"][free, 3] += 0.1
    assert value(flight, "force_sensor.contact_rmse_fx_n") == pytest.approx(0.3, abs=1e-6)
    assert value(flight, "force_sensor.contact_rmse_tx_nm") == pytest.approx(0.0, abs=1e-6)
    assert value(flight, "force_sensor.rmse_fx_n") > 0.5
    assert value(flight, "force_sensor.rmse_tx_nm") > 0.05


def test_samples_are_dated_by_the_last_of_their_block(flight: SyntheticFlight) -> None:
    """20 N at 0.5 Hz rise by up to 63 N/s: one sample late would add 0.056 N RMS to the 0.3 N."""
    sensed(flight)
    rows = flight.channels[WallForce.topic]
    times = rows["t_s"][:, None] - np.arange(79, -1, -1) / RATE
    # z_S is −x_W and the vehicle feels the opposite: along x_W it is pushed by what f_S has on z.
    rows["f_S"][:, :, 2] += 20.0 * np.sin(np.pi * times)
    flight.rows(Estimate)["wrench_B"][:, 0] += 20.0 * np.sin(np.pi * flight.rows(State)["t_s"])
    assert value(flight, "force_sensor.rmse_fx_n") == pytest.approx(0.3, abs=1e-3)
