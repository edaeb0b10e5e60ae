"""Every metric by its name: unit, meaning, the channels it needs and the function."""

from __future__ import annotations

from inspect_cli.metrics import (
    contact,
    estimation,
    guidance,
    pull,
    readings,
    tracking,
)
from inspect_cli.metrics.aggregation import (
    GREATEST,
    LEAST,
    MEAN_OVER_POINTS,
    MEAN_OVER_TIME,
    RMS_OVER_TIME,
    SUM,
)
from inspect_cli.metrics.catalogue_assessment import ASSESSMENT_METRICS
from inspect_cli.metrics.catalogue_estimation import ESTIMATION_METRICS
from inspect_cli.metrics.catalogue_flight import FLIGHT_METRICS
from inspect_cli.metrics.catalogue_scoring import SCORING_METRICS
from inspect_cli.metrics.catalogue_sliding import SLIDING_METRICS
from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import (
    Estimate,
    PointReading,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
    TrueDisturbance,
)

FOLLOWED = (State, Reference)
ESTIMATED = (State, Reference, Estimate)
READ = (PointReading,)
PULLED = (State, Reference, TrueDisturbance)

METRICS: dict[str, MetricSpec] = {
    "tracking.position_rmse_x_m": MetricSpec(
        "m",
        tracking.position_rmse_x,
        "reference against true tool position along x_W, RMS, take-off to landing out of contact",
        FOLLOWED,
        RMS_OVER_TIME,
    ),
    "tracking.position_rmse_y_m": MetricSpec(
        "m",
        tracking.position_rmse_y,
        "reference against true tool position along y_W, RMS, take-off to landing out of contact",
        FOLLOWED,
        RMS_OVER_TIME,
    ),
    "tracking.position_rmse_z_m": MetricSpec(
        "m",
        tracking.position_rmse_z,
        "reference against true tool position along z_W, RMS, take-off to landing out of contact",
        FOLLOWED,
        RMS_OVER_TIME,
    ),
    "tracking.position_rmse_max_axis_m": MetricSpec(
        "m",
        tracking.position_rmse_max_axis,
        "the largest of the three RMS position errors",
        FOLLOWED,
        GREATEST,
    ),
    "tracking.tool_error_p95_m": MetricSpec(
        "m",
        tracking.tool_error_p95,
        "95th percentile of the tool's distance from its reference, out of contact",
        FOLLOWED,
        GREATEST,
    ),
    "tracking.attitude_rmse_rad": MetricSpec(
        "rad",
        tracking.attitude_rmse,
        "angle between reference and true attitude, RMS, take-off to landing",
        FOLLOWED,
        RMS_OVER_TIME,
    ),
    "tracking.attitude_max_rad": MetricSpec(
        "rad",
        tracking.attitude_max,
        "largest angle between reference and true attitude, take-off to landing",
        FOLLOWED,
        GREATEST,
    ),
    "estimation.position_rmse_m": MetricSpec(
        "m",
        estimation.position_rmse,
        "distance between estimated and true position, RMS, take-off to landing",
        ESTIMATED,
        RMS_OVER_TIME,
    ),
    "estimation.attitude_rmse_rad": MetricSpec(
        "rad",
        estimation.attitude_rmse,
        "angle between estimated and true attitude, RMS, take-off to landing",
        ESTIMATED,
        RMS_OVER_TIME,
    ),
    "estimation.wrench_force_rmse_n": MetricSpec(
        "N",
        estimation.wrench_force_rmse,
        "observed against true external force, RMS length, between take-off and landing",
        ESTIMATED,
        RMS_OVER_TIME,
    ),
    "estimation.wrench_torque_rmse_nm": MetricSpec(
        "N·m",
        estimation.wrench_torque_rmse,
        "observed against true external torque, RMS length, between take-off and landing",
        ESTIMATED,
        RMS_OVER_TIME,
    ),
    "guidance.normal_error_mean_deg": MetricSpec(
        "°",
        guidance.normal_error_mean_deg,
        "mean angle between seen and true surface normal, valid estimates near the surface",
        (SurfaceEstimate, TrueContact, State, Reference),
        MEAN_OVER_TIME,
    ),
    "guidance.tool_axis_error_mean_deg": MetricSpec(
        "°",
        guidance.tool_axis_error_mean_deg,
        "mean angle between the tool's axis and the true inward normal in contact",
        (State, Reference, TrueContact),
        MEAN_OVER_TIME,
    ),
    "contact.force_mean_n": MetricSpec(
        "N",
        contact.force_mean,
        "mean over the points of the true normal force over the last 2 s of the dwell",
        FOLLOWED,
        MEAN_OVER_POINTS,
    ),
    "contact.force_mean_min_n": MetricSpec(
        "N",
        contact.force_mean_min,
        "least of the points' mean forces; a point never pressed counts as 0",
        FOLLOWED,
        LEAST,
    ),
    "contact.force_mean_max_n": MetricSpec(
        "N",
        contact.force_mean_max,
        "greatest of the points' mean forces",
        FOLLOWED,
        GREATEST,
    ),
    "contact.force_peak_n": MetricSpec(
        "N",
        contact.force_peak,
        "largest true normal force of the flight",
        (State,),
        GREATEST,
    ),
    "contact.force_cv": MetricSpec(
        "1",
        contact.force_cv,
        "worst coefficient of variation of a contact's true force after its first second",
        FOLLOWED,
        GREATEST,
    ),
    "contact.bounce_gaps": MetricSpec(
        "1",
        contact.bounce_gaps,
        "gaps over 50 ms below 0.1 N between first touch and release, all points",
        FOLLOWED,
        SUM,
    ),
    "contact.position_error_max_m": MetricSpec(
        "m",
        contact.position_error_max,
        "largest distance along the surface between planned and true contact point",
        FOLLOWED,
        GREATEST,
    ),
    "contact.body_force_max_n": MetricSpec(
        "N",
        contact.body_force_max,
        "largest contact force on anything but tool and landing gear",
        (State,),
        GREATEST,
    ),
    "contact.points_total": MetricSpec(
        "1",
        readings.points_total,
        "points that the plan wants read",
        (),
        SUM,
    ),
    "contact.points_valid": MetricSpec(
        "1",
        readings.points_valid,
        "points with a valid reading",
        READ,
        SUM,
    ),
    "contact.valid_share": MetricSpec(
        "1",
        readings.valid_share,
        "valid readings as a share of the planned points",
        READ,
        MEAN_OVER_POINTS,
    ),
    **{name: spec for row in INSTRUMENTS.values() for name, spec in row.metrics.items()},
    "pull.force_peak_n": MetricSpec(
        "N", pull.force_peak, "largest force of the rope on the tip over all pulls", PULLED
    ),
    "pull.angle_to_x_B_deg": MetricSpec(
        "°",
        pull.angle_to_x_B_deg,
        "largest angle between the rope's force and ±x_B while above half of a pull's peak",
        PULLED,
    ),
    "pull.displacement_max_m": MetricSpec(
        "m",
        pull.displacement_max,
        "largest displacement of the body since a pull began",
        PULLED,
    ),
    "pull.displacement_along_m": MetricSpec(
        "m",
        pull.displacement_along,
        "largest displacement along the rope's peak force, of the pulls the least",
        PULLED,
    ),
    "pull.displacement_z_m": MetricSpec(
        "m", pull.displacement_z, "largest displacement up or down since a pull began", PULLED
    ),
    "pull.attitude_motion_m": MetricSpec(
        "m",
        pull.attitude_motion,
        "largest motion of the tip by the body's rotation since a pull began",
        PULLED,
    ),
    "pull.along_over_z": MetricSpec(
        "1",
        pull.along_over_z,
        "displacement along the rope's force over that in z, of the pulls the least",
        PULLED,
    ),
    "pull.along_over_attitude": MetricSpec(
        "1",
        pull.along_over_attitude,
        "displacement along the rope's force over attitude motion, of the pulls the least",
        PULLED,
    ),
    "pull.metres_per_newton": MetricSpec(
        "m/N",
        pull.metres_per_newton,
        "displacement along the rope's force over the force's peak, mean over the pulls",
        PULLED,
    ),
    "pull.torque_peak_nm": MetricSpec(
        "N·m",
        pull.torque_peak,
        "largest torque of the rope about z_B through O_b",
        PULLED,
    ),
    "pull.yaw_max_rad": MetricSpec("rad", pull.yaw_max, "largest yaw since a pull began", PULLED),
    "pull.yaw_per_nm": MetricSpec(
        "rad/(N·m)",
        pull.yaw_per_nm,
        "largest yaw over largest torque about z_B, mean over the pulls",
        PULLED,
    ),
    **FLIGHT_METRICS,
    **ESTIMATION_METRICS,
    **SLIDING_METRICS,
    **ASSESSMENT_METRICS,
    **SCORING_METRICS,
}
