"""The energy of a flight from its rotors' speeds, against a computation by hand."""

from __future__ import annotations

import numpy as np
import pytest
from modes import Mode
from synthetic import SyntheticFlight, nine_points

from inspect_cli.commands.plan import vehicle_of
from inspect_cli.interfaces import at_origin
from inspect_cli.metrics.energy import electrical_power_w, shaft_power_w
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.records import Reference, State
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.vehicle import RotorDrive


@pytest.fixture
def flight() -> SyntheticFlight:
    return nine_points()


def test_one_rotor_by_hand() -> None:
    """4 N: ω = √(4 / 7.2e-6) = 745.356 rad/s, Q = 0.06 N·m, 44.72 W at the shaft."""
    drive = RotorDrive(7.2e-6, 0.015, 0.65)
    shaft_w = shaft_power_w(np.array([[4.0]]), (drive,))
    assert shaft_w[0, 0] == pytest.approx(44.7214, rel=1e-5)
    electrical_w = electrical_power_w(np.array([[4.0], [0.0]]), (drive,), 25.0)
    assert electrical_w == pytest.approx([44.7214 / 0.65 + 25.0, 25.0], rel=1e-5)


def test_constant_thrust_gives_power_times_time(flight: SyntheticFlight) -> None:
    """12 rotors at 4 N: 6 · (44.72 + 14.91) W / 0.65 + 25 W = 575.4 W from take-off to landing."""
    mode = flight.rows(Reference)["mode"]
    airborne_s = np.ptp(flight.rows(Reference)["t_s"][(mode >= Mode.TAKEOFF) & (mode <= Mode.LAND)])
    metrics = evaluate(flight.log()).metrics
    flown_wh = metrics["flight.energy_wh_flown"].value
    assert flown_wh == pytest.approx(575.43 * airborne_s / 3600.0, rel=1e-4)
    assert metrics["flight.energy_planned_over_flown"].value == pytest.approx(12.5 / flown_wh)


def test_idle_rotors_take_nothing_but_the_avionics(flight: SyntheticFlight) -> None:
    mode = flight.rows(Reference)["mode"]
    whole = evaluate(flight.log()).metrics["flight.energy_wh_flown"].value
    flight.rows(State)["rotor_thrust"][mode < Mode.TAKEOFF] = 0.0
    assert evaluate(flight.log()).metrics["flight.energy_wh_flown"].value == whole


def test_the_safe_hover_after_an_abort_takes_energy(flight: SyntheticFlight) -> None:
    mode = flight.rows(Reference)["mode"]
    whole = evaluate(flight.log()).metrics["flight.energy_wh_flown"].value
    flying = np.flatnonzero((mode >= Mode.TAKEOFF) & (mode <= Mode.LAND))
    mode[flying[len(flying) // 2] :] = Mode.HOVER
    hovering_s = np.ptp(flight.rows(Reference)["t_s"][flying[0] :])
    aborted = evaluate(flight.log()).metrics["flight.energy_wh_flown"].value
    assert aborted == pytest.approx(575.43 * hovering_s / 3600.0, rel=1e-4)
    assert aborted >= whole


def test_both_power_models_agree_in_level_hover(root) -> None:
    """The drive's efficiency was chosen so; the other attitudes follow, both being T^1.5."""
    loaded = load_mission(root / "missions" / "nine_point_half_cell.yaml")
    capabilities = vehicle_of(loaded).capabilities
    weight_n = 4.75 * 9.81
    thrust = np.full((1, 12), weight_n / 12)
    battery = loaded.platform.battery
    flown_w = electrical_power_w(thrust, loaded.platform.rotor_drives(), battery.avionics_w)[0]
    planned_w = capabilities.power_w(at_origin(np.empty(0)), {})
    assert flown_w == pytest.approx(planned_w, rel=0.002)


def test_a_kind_without_drives_is_not_measured(flight: SyntheticFlight, monkeypatch) -> None:
    monkeypatch.setattr(type(flight.platform), "rotor_drives", lambda _: None)
    metric = evaluate(flight.log()).metrics["flight.energy_wh_flown"]
    assert metric.value is None
    assert metric.why == "a platform of kind 'tilt_rotor' states no rotor drives"
