"""Electrical energy of a flight from the speeds of its rotors, and against the plan's.

A rotor with the free-air thrust T turns at ω = √(T / k_f) against the moment Q = k_m T, so that

    P = Σ Q ω / η + avionics,    E = ∫ P dt from take-off to landing

with η of motor and controller. Nothing of the planner's momentum theory is in it: k_f and k_m are
the rotors' measured constants. The logged thrusts are free-air thrusts, which is to say speeds:
near a surface the thrust changes by a factor, and the models of ceiling and ground give it at
constant power, so that P holds there as well. Spinning the rotors up costs J ω δω, which comes
back as they slow down, and is left out.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.vehicle import RotorDrive
from inspect_cli.spatial.arrays import Points, Vector

JOULE_PER_WH = 3600.0


def shaft_power_w(thrust_n: Points, drives: tuple[RotorDrive, ...]) -> Points:
    """Mechanical power Q ω (n, n_rotors), W, of free-air thrusts (n, n_rotors), N."""
    k_f = np.array([drive.thrust_constant_ns2 for drive in drives])
    k_m = np.array([drive.moment_constant_m for drive in drives])
    thrust = np.maximum(thrust_n, 0.0)
    power: Points = k_m * thrust * np.sqrt(thrust / k_f)
    return power


def electrical_power_w(
    thrust_n: Points, drives: tuple[RotorDrive, ...], avionics_w: float
) -> Vector:
    """Power from the battery (n,), W."""
    efficiency = np.array([drive.efficiency for drive in drives])
    power: Vector = (shaft_power_w(thrust_n, drives) / efficiency).sum(axis=1) + avionics_w
    return power


def energy_flown(flight: FlightData) -> float:
    """Energy, Wh, from take-off to landing, the safe hover after an abort included."""
    drives = flight.platform.rotor_drives()
    if drives is None:
        raise NotMeasured(f"a platform of kind '{flight.platform.kind}' states no rotor drives")
    thrust = flight.state["rotor_thrust"]
    if thrust.shape[1] != len(drives):
        raise NotMeasured(f"the log has {thrust.shape[1]} rotors, the platform {len(drives)}")
    rows = flight.airborne | flight.during(Phase.SAFE)
    times = flight.state["t_s"][rows]
    if len(times) < 2:
        raise NotMeasured("the vehicle never left the ground")
    power_w = electrical_power_w(thrust[rows], drives, flight.platform.battery.avionics_w)
    return float(np.trapezoid(power_w, times)) / JOULE_PER_WH


def planned_over_flown(flight: FlightData) -> float:
    """The plan's energy as a share of the flown one."""
    return flight.plan.energy_wh / energy_flown(flight)
