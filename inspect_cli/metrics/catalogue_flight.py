"""The metrics of what a flight took: time, energy, actuators."""

from __future__ import annotations

from inspect_cli.metrics import energy, operation
from inspect_cli.metrics.aggregation import GREATEST, MEAN_OVER_ENERGY, MEAN_OVER_TIME, SUM
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import Command, Reference, State

FOLLOWED = (State, Reference)

FLIGHT_METRICS: dict[str, MetricSpec] = {
    "flight.duration_s": MetricSpec(
        "s",
        operation.duration,
        "time off the ground",
        FOLLOWED,
        SUM,
    ),
    "flight.energy_wh_planned": MetricSpec(
        "Wh",
        operation.energy_planned,
        "energy of the flight by the plan",
        (),
        SUM,
    ),
    "flight.energy_wh_flown": MetricSpec(
        "Wh",
        energy.energy_flown,
        "electrical energy from take-off to landing, from the true speeds of the rotors",
        FOLLOWED,
        SUM,
    ),
    "flight.energy_planned_over_flown": MetricSpec(
        "1",
        energy.planned_over_flown,
        "energy of the flight by the plan over the energy that the rotors took",
        FOLLOWED,
        MEAN_OVER_ENERGY,
    ),
    "flight.saturated_share": MetricSpec(
        "1",
        operation.saturated_share,
        "share of the flight in which the allocation granted less than was asked",
        (State, Reference, Command),
        MEAN_OVER_TIME,
    ),
    "flight.end_speed_mps": MetricSpec(
        "m/s",
        operation.end_speed,
        "largest true speed over the last second of the log",
        (State,),
        GREATEST,
    ),
    "actuators.thrust_max_n": MetricSpec(
        "N",
        operation.thrust_max,
        "largest true thrust of a single rotor",
        (State,),
        GREATEST,
    ),
}
