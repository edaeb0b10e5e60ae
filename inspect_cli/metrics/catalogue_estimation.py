"""The metrics of on-board estimation and of the force sensor in the wall, by name."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

from inspect_cli.metrics import force_sensor, odometry_drift, pose_error, settling
from inspect_cli.metrics.flight import FlightData
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import Estimate, Reference, State, WallForce

ESTIMATED = (State, Reference, Estimate)
SENSED = (WallForce, State, Reference, Estimate)
AXES = "xyz"
ANGLES = ("roll", "pitch", "yaw")
WAY = "take-off to landing"
OFF_GROUND = "between take-off and landing"


def _per_axis(
    name: str,
    axes: str,
    unit: str,
    function: Callable[[FlightData, int], float],
    meaning: str,
) -> dict[str, MetricSpec]:
    """One metric per axis, against the force sensor; {} in name and meaning is the axis."""
    return {
        name.format(axis): MetricSpec(
            unit, partial(_of_axis, function, index), meaning.format(axis), SENSED
        )
        for index, axis in enumerate(axes)
    }


def _of_axis(function: Callable[[FlightData, int], float], axis: int, flight: FlightData) -> float:
    return function(flight, axis)


def _pose_errors() -> dict[str, MetricSpec]:
    specs = {}
    for axis, name in enumerate(AXES):
        specs[f"estimation.rmse_{name}_m"] = MetricSpec(
            "m",
            partial(_of_axis, pose_error.position_rmse, axis),
            f"estimated against true position along {name}_W, RMS, {WAY}",
            ESTIMATED,
        )
    bodies = (("", "the tracker's body frame"), ("true_", "the true body"))
    for prefix, body in bodies:
        error = partial(pose_error.attitude_rmse, true_body=prefix == "true_")
        for axis, name in enumerate(ANGLES):
            specs[f"estimation.{prefix}rmse_{name}_rad"] = MetricSpec(
                "rad",
                partial(_of_axis, error, axis),
                f"{name} of the estimated attitude against {body}, RMS, {WAY}",
                ESTIMATED,
            )
    return specs | _expected_errors()


def _expected_errors() -> dict[str, MetricSpec]:
    specs = {
        f"estimation.expected_rmse_{name}_m": MetricSpec(
            "m",
            partial(_of_axis, odometry_drift.expected_position_rmse, axis),
            f"RMS error along {name}_W that the model of the odometry expects of the path, {WAY}",
            (State, Reference),
        )
        for axis, name in enumerate(AXES)
    }
    specs["estimation.expected_rmse_yaw_rad"] = MetricSpec(
        "rad",
        odometry_drift.expected_yaw_rmse,
        f"RMS error of yaw that the model of the odometry expects of the path, {WAY}",
        (State, Reference),
    )
    return specs


ESTIMATION_METRICS: dict[str, MetricSpec] = {
    **_pose_errors(),
    "estimation.moving_over_hovering": MetricSpec(
        "1",
        pose_error.moving_over_hovering,
        "growth of the position error in 1 s in motion over that in quasi-static hover, RMS",
        ESTIMATED,
    ),
    "estimation.drift_at_first_contact_m": MetricSpec(
        "m",
        pose_error.drift_at_first_contact,
        "distance between estimated and true tip of the tool at the first touch",
        (State, Estimate),
    ),
    **_per_axis(
        "force_sensor.rmse_f{}_n",
        AXES,
        "N",
        force_sensor.force_rmse,
        f"observed against filtered sensor force along {{}}_W, RMS, {OFF_GROUND}",
    ),
    **_per_axis(
        "force_sensor.contact_rmse_f{}_n",
        AXES,
        "N",
        force_sensor.contact_force_rmse,
        "observed against filtered sensor force along {}_W, RMS, in contact",
    ),
    **_per_axis(
        "force_sensor.rmse_s{}_n",
        AXES,
        "N",
        force_sensor.sensor_force_rmse,
        f"observed against filtered sensor force along {{}}_S, RMS, {OFF_GROUND}",
    ),
    **_per_axis(
        "force_sensor.rmse_t{}_nm",
        AXES,
        "N·m",
        force_sensor.torque_rmse,
        f"observed against sensor torque about the tip and {{}}_W, RMS, {OFF_GROUND}",
    ),
    **_per_axis(
        "force_sensor.contact_rmse_t{}_nm",
        AXES,
        "N·m",
        force_sensor.contact_torque_rmse,
        "observed against sensor torque about the tip and {}_W, RMS, in contact",
    ),
    "force_sensor.peak_n": MetricSpec(
        "N", force_sensor.peak, "largest pressing force of the filtered signal", (WallForce,)
    ),
    "force_sensor.noise_n": MetricSpec(
        "N",
        force_sensor.noise,
        "RMS noise of the raw normal force, at least 1 s from any touch",
        (WallForce, State),
    ),
    "contact.oscillation_growth": MetricSpec(
        "1",
        settling.oscillation_growth,
        "worst ratio of the true force's oscillation in the second half of a dwell to the first",
        (State, Reference),
    ),
    "contact.residual_cv": MetricSpec(
        "1",
        settling.residual_variation,
        "worst coefficient of variation of a dwell's true force in its last 2 s",
        (State, Reference),
    ),
}
