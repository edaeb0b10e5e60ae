"""What the flight took: time, energy, actuators."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import FlightData, largest, mean
from inspect_cli.records import Command
from inspect_cli.schema.modes import Phase

END_S = 1.0
"""The end of the log over which the vehicle shall be at rest."""


def duration(flight: FlightData) -> float:
    """Time off the ground, s: from take-off to landing, and what follows a failsafe."""
    times = flight.state["t_s"][flight.airborne | flight.during(Phase.SAFE)]
    return largest(times) - float(times[0])


def energy_planned(flight: FlightData) -> float:
    """Energy of the flight by the plan, Wh."""
    return flight.plan.energy_wh


def saturated_share(flight: FlightData) -> float:
    """Share of the time from take-off to landing in which the allocation granted less."""
    return mean(flight.on_state_ticks(Command)["saturated"][flight.airborne])


def thrust_max(flight: FlightData) -> float:
    """Largest true thrust of a single rotor, N."""
    return largest(flight.state["rotor_thrust"])


def end_speed(flight: FlightData) -> float:
    """Largest true speed of O_b over the last second of the log, m/s."""
    times = flight.state["t_s"]
    last = times > times[-1] - END_S
    return largest(np.linalg.norm(flight.state["v_WB_W"][last], axis=1))
