"""The study ``force``: what the observer's gain and the speed of the reference do to its force.

An error of the estimated force "is due largely to a slow response to a step force, which is
influenced by the chosen K_I" (Bodie et al., RSS 2019, V-F). The gain is varied on the platform,
for the force along all three axes alike; the speed is that of approach, press and retreat.

The prediction is the error of a first-order lag alone, f̂ = K/(s + K) f, on the force f that the
wall's sensor measured in the same flight. What it leaves is no lag: forces of near surfaces, the
noise of the estimate, a wrong mass.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inspect_cli.commands.sweeps import Factor, Study, revalidated
from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.estimation.observer_lag import first_order_response
from inspect_cli.metrics.flight import FlightData, root_mean_square
from inspect_cli.metrics.force_sensor import measured_force
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import Reference, State, WallForce
from inspect_cli.reporting.studies.sweep_figures import PREDICTED, force_figure
from inspect_cli.reporting.words.published import TABLE_IV
from inspect_cli.reporting.words.text import say
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.study import StudyColumn
from inspect_cli.schema.vehicle import ControlModel, ImpedancePlatform, PlatformBase


def lag_contact_rmse(flight: FlightData) -> float:
    """RMS error along x_W of a first-order lag of the sensor's force, N, in contact.

    Raises:
        NotMeasured: no sensor in the wall, or no contact.
    """
    force = measured_force(flight)[:, 0]
    period_s = float(np.median(np.diff(flight.state["t_s"])))
    lagged = first_order_response(force, period_s, _control(flight.platform).observer_gain[0])
    return root_mean_square((lagged - force)[flight.off_ground & flight.touching])


def _control(platform: PlatformBase) -> ControlModel:
    """The gains of a platform that flies by selective impedance."""
    if not isinstance(platform, ImpedancePlatform):
        raise InputError(f"{platform.name} has no momentum observer, whose gain this study varies")
    return platform.control


def _gain(loaded: Loaded) -> float:
    gain, *others = _control(loaded.platform).observer_gain
    if any(other != gain for other in others):
        what = f"{loaded.platform.name} has another observer_gain along each axis"
        raise InputError(Problem(what, Location(str(loaded.platform_file)), "make them equal"))
    return gain


def _with_gain(loaded: Loaded, gain: float) -> Loaded:
    platform = loaded.platform
    control = revalidated(_control(platform), observer_gain=(gain, gain, gain))
    return replace(loaded, platform=revalidated(platform, control=control))


def _speed(loaded: Loaded) -> float:
    return loaded.mission.flight.approach_speed_mps


def _with_speed(loaded: Loaded, speed_mps: float) -> Loaded:
    limit_mps = loaded.platform.limits.speed_mps
    if speed_mps > limit_mps:
        raise ValueError(f"{loaded.platform.name} flies at most {limit_mps:g} m/s")
    flight = revalidated(loaded.mission.flight, approach_speed_mps=speed_mps)
    return replace(loaded, mission=revalidated(loaded.mission, flight=flight))


def _refuse(loaded: Loaded) -> None:
    if loaded.mission.is_survey or not any(
        surface.force_sensor for surface in loaded.truth.structure.values()
    ):
        what = "the study 'force' needs a flight before a surface with a force_sensor"
        hint = "see missions/paper_a/force_evaluation.yaml, under truth: structure"
        raise InputError(Problem(what, Location(str(loaded.mission_file)), hint))


def _errors(scope: str, prefix: str, *, published: bool) -> tuple[StudyColumn, ...]:
    return tuple(
        StudyColumn(
            metric=f"force_sensor.{prefix}rmse_f{axis}_n",
            heading=f"RMSE f{axis}, {scope}",
            unit="N",
            published=TABLE_IV[f"force_sensor.rmse_f{axis}_n"][1] if published else None,
        )
        for axis in "xyz"
    )


FORCE = Study(
    title="Force estimate: observer gain and speed of the reference",
    explained=say(
        "The force of the momentum observer against the sensor in the wall, with the observer's "
        "gain K_I varied at the mission's speed and the speed v of approach and press varied at "
        "the platform's gain. “Flight” is take-off to landing, as published; “predicted” is the "
        "error that a first-order lag with the time constant 1/K_I alone would make in contact, "
        "given the force that the sensor measured in the same flight."
    ),
    factors=(
        Factor(
            option="gains",
            metavar="K,K,…",
            help="observer gains K_I, 1/s",
            name="gain",
            symbol="K_I",
            unit="1/s",
            values=(0.5, 1.0, 2.0, 4.0),
            base=_gain,
            changed=_with_gain,
        ),
        Factor(
            option="speeds",
            metavar="V,V,…",
            help="speeds of the approach, m/s",
            name="speed",
            symbol="v",
            unit="m/s",
            values=(0.05, 0.1, 0.2, 0.4),
            base=_speed,
            changed=_with_speed,
        ),
    ),
    columns=(
        *_errors("flight", "", published=True),
        *_errors("contact", "contact_", published=False),
        StudyColumn(metric=PREDICTED, heading="RMSE fx, predicted", unit="N"),
        StudyColumn(metric="contact.force_peak_n", heading="Force, peak", unit="N"),
        StudyColumn(metric="contact.oscillation_growth", heading="Oscillation growth", unit="1"),
    ),
    refuse=_refuse,
    own={
        PREDICTED: MetricSpec(
            "N",
            lag_contact_rmse,
            "a first-order lag of the sensor force against it along x_W, RMS, in contact",
            (WallForce, State, Reference),
        )
    },
    figures=(force_figure,),
)
