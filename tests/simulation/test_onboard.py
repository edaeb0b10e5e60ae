"""Whole flights on odometry alone, and before a wall that measures the force."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from modes import Mode
from scenarios import ONE_POINT, TWO_POINTS, Array, Flown, Scenario

from inspect_cli.errors import SchemaError
from inspect_cli.estimation.observer_lag import first_order_response
from inspect_cli.metrics.force_sensor import low_pass
from inspect_cli.records import Pose
from inspect_cli.vehicles.fully_actuated.impedance_control import ImpedanceControl

Fly = Callable[[Scenario], Flown]
pytestmark = pytest.mark.xdist_group("flights")

ONBOARD = "estimation: onboard\n"
BLIND = Scenario("onboard", tasks=ONBOARD + TWO_POINTS)
FORCE_PLATFORM = "platform: tilt_rotor_hexarotor_force_evaluation\n"
SENSED = "structure: {wall: {force_sensor: {noise_n: 0.5, torque_noise_nm: 0.01}}}\n"
WALL = Scenario("sensed", SENSED, ONBOARD + FORCE_PLATFORM + TWO_POINTS)


def metric(flight: Flown, name: str) -> float:
    found = flight.outcome.result.metrics[name]
    assert found.value is not None, found.why
    return found.value


def test_it_touches_both_points_and_drifts(flown: Fly) -> None:
    flight = flown(BLIND)
    assert flight.outcome.result.status == "completed"
    assert flight.reasons == ["", ""]
    assert flight.state["f_body"].max() == 0.0
    odometry = flight.log.channels["/sensor/odometry"]
    assert "/sensor/pose" not in flight.log.channels
    times = odometry["t_s"]
    assert np.abs(np.diff(times[1:]) - 1 / 30).max() < 1.1e-3
    assert metric(flight, "estimation.moving_over_hovering") > 2.0
    # Before the first touch it has flown some metres; noise alone would be half a millimetre.
    assert metric(flight, "estimation.drift_at_first_contact_m") > 0.001
    # The bias of the paper's ground truth is there, and the vehicle does not have it.
    assert metric(flight, "estimation.rmse_roll_rad") == pytest.approx(0.0575, abs=0.008)
    assert metric(flight, "estimation.true_rmse_roll_rad") < 0.008


def test_no_pose_is_refused_in_a_normal_flight(flown: Fly, monkeypatch: pytest.MonkeyPatch) -> None:
    accepted: list[bool] = []
    on_pose = ImpedanceControl.correct

    def watched(stack: ImpedanceControl, pose: Pose) -> bool:
        accepted.append(on_pose(stack, pose))
        return accepted[-1]

    monkeypatch.setattr(ImpedanceControl, "correct", watched)
    flown(Scenario("onboard-watched", tasks=ONBOARD + ONE_POINT, seed=2))
    assert len(accepted) > 1000
    assert all(accepted)


@pytest.mark.parametrize("kind", ["off", "nan"])
def test_lost_odometry_ends_in_a_hover(flown: Fly, kind: str) -> None:
    flight = flown(BLIND)
    start_s = 0.6 + float(flight.state["t_s"][np.argmax(flight.mode == float(Mode.TRANSIT))])
    fault = f"faults: [{{sensor: odometry, fault: {kind}, start_s: {start_s:.3f}}}]\n"
    lost = flown(Scenario(f"odometry-{kind}", fault, ONBOARD + TWO_POINTS))
    assert lost.outcome.result.status == "aborted"
    assert "pose measurements lost" in lost.outcome.result.status_reason
    # Up to a thirtieth of a second since the last pose, then a quarter of a second of patience.
    assert 0.2 < lost.abort_s() - start_s < 0.35
    assert lost.mode[-1] == float(Mode.HOVER)
    assert lost.state["f_body"].max() == 0.0


@pytest.mark.parametrize(
    ("sensor", "tasks", "flies_on"),
    [("pose", ONBOARD + TWO_POINTS, "odometry"), ("odometry", TWO_POINTS, "pose")],
)
def test_a_fault_of_a_sensor_that_is_not_flown_on_is_refused(
    campaign: Path, sensor: str, tasks: str, flies_on: str
) -> None:
    scenario = Scenario("idle", f"faults: [{{sensor: {sensor}}}]\n", tasks)
    with pytest.raises(SchemaError, match=f"flies on {flies_on}") as caught:
        scenario.fly(campaign)
    (problem,) = caught.value.problems
    assert problem.where is not None
    assert problem.where.path == "truth.faults[0].sensor"
    assert problem.where.line


def test_the_wall_records_every_sample(flown: Fly) -> None:
    flight = flown(WALL)
    assert flight.outcome.result.status == "completed"
    blocks = flight.log.channels["/sensor/wall_force"]
    assert blocks["f_S"].shape[1:] == (80, 3)
    np.testing.assert_allclose(np.diff(blocks["t_s"]), 0.1, atol=1e-9)
    assert flight.state["t_s"][-1] - blocks["t_s"][-1] < 0.1
    assert metric(flight, "force_sensor.noise_n") == pytest.approx(0.5, rel=0.05)
    # In contact the sensor's mean is that of the true force.
    pressed = flight.state["f_normal"] > 0.5
    samples = -blocks["f_S"][..., 2].ravel()
    times = (blocks["t_s"][:, None] - np.arange(79, -1, -1) / 800.0).ravel()
    true = np.interp(times, flight.state["t_s"], flight.state["f_normal"])
    steady = np.interp(times, flight.state["t_s"], pressed) == 1.0
    assert samples[steady].mean() == pytest.approx(true[steady].mean(), abs=0.05)
    assert metric(flight, "contact.oscillation_growth") < 1.2


def test_without_such_a_sensor_nothing_is_recorded(flown: Fly) -> None:
    assert "/sensor/wall_force" not in flown(BLIND).log.channels
    assert flown(BLIND).outcome.result.metrics["force_sensor.rmse_fx_n"].value is None


def test_the_observers_error_is_its_lag(flown: Fly, campaign: Path) -> None:
    """The RMSE in contact against the first-order response to the true force, for two gains and
    two speeds. Beyond the lag there are near surfaces and the tilt error: 0.15 N together."""
    for gain in (1.0, 3.0):
        name = f"gain_{gain:g}"
        (campaign / "platforms" / f"{name}.yaml").write_text(
            f"schema: 1\nextends: tilt_rotor_hexarotor_force_evaluation.yaml\nname: {name}\n"
            f"control: {{observer_gain: [{gain}, {gain}, {gain}]}}\n"
        )
    errors: dict[tuple[float, float], float] = {}
    for gain in (1.0, 3.0):
        for speed in (0.05, 0.2):
            tasks = f"platform: gain_{gain:g}\nflight: {{approach_speed_mps: {speed}}}\n"
            name = f"lag-{gain:g}-{100 * speed:g}"
            flight = flown(Scenario(name, SENSED, ONBOARD + tasks + ONE_POINT))
            flown_rmse = metric(flight, "force_sensor.contact_rmse_fx_n")
            assert flown_rmse == pytest.approx(_lag_rmse(flight, gain), abs=0.15), name
            errors[gain, speed] = flown_rmse
    for speed in (0.05, 0.2):
        assert errors[3.0, speed] < errors[1.0, speed]
    for gain in (1.0, 3.0):
        assert errors[gain, 0.05] < errors[gain, 0.2]


def _lag_rmse(flight: Flown, gain: float) -> float:
    """What a first-order observer of the true normal force would err by, in contact, N.

    Against the force as the comparison filters it, which takes away the blow of the touch.
    """
    force: Array = flight.state["f_normal"]
    lagged = first_order_response(force, 0.01, gain)
    filtered = low_pass(force[:, None], 100.0)[:, 0]
    touching = force > 0.1
    return float(np.sqrt(np.mean((lagged - filtered)[touching] ** 2)))
