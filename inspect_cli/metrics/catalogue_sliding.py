"""The metrics of drawings and of surfaces that are followed, by name."""

from __future__ import annotations

from inspect_cli.metrics import drawing, slide
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import Reference, State, TrueContact

DRAWN = (State, Reference)
SLID = (State, Reference, TrueContact)

SLIDING_METRICS: dict[str, MetricSpec] = {
    "drawing.repeat_rms_m": MetricSpec(
        "m",
        drawing.repeat_rms,
        "true tip in two trials of a stroke, RMS apart in the plane, the worst pair",
        DRAWN,
    ),
    "drawing.tracking_rms_m": MetricSpec(
        "m",
        drawing.tracking_rms,
        "true tip against reference in the plane while sliding, RMS over all strokes",
        DRAWN,
    ),
    "drawing.attitude_error_max_rad": MetricSpec(
        "rad",
        drawing.attitude_error_max,
        "largest angle between reference and true attitude of strokes, first touch to release",
        DRAWN,
    ),
    "slide.distance_m": MetricSpec(
        "m",
        slide.distance,
        "way of the true tip along the surface, in contact, while the reference moves along it",
        SLID,
    ),
    "slide.chord_m": MetricSpec(
        "m", slide.chord, "straight distance of the true tip while the reference moves along", SLID
    ),
    "slide.speed_mean_mps": MetricSpec(
        "m/s",
        slide.speed_mean,
        "mean speed of the true tip along the surface while the reference moves along it",
        SLID,
    ),
    "slide.axis_error_mean_deg": MetricSpec(
        "°",
        slide.axis_error_mean_deg,
        "mean angle between the tool's axis and the true inward normal, first touch to release",
        SLID,
    ),
    "slide.axis_error_moving_deg": MetricSpec(
        "°",
        slide.axis_error_moving_deg,
        "mean angle between the tool's axis and the true inward normal while the reference moves",
        SLID,
    ),
    "slide.rotation_xz_max_rad": MetricSpec(
        "rad",
        slide.rotation_xz_max,
        "largest rotation of the true tool about x_T or z_T while it is moved along the surface",
        SLID,
    ),
    "slide.rotation_y_rad": MetricSpec(
        "rad",
        slide.rotation_y,
        "largest rotation of the true tool about y_T while it is moved along the surface",
        SLID,
    ),
    "slide.gaps": MetricSpec(
        "1",
        slide.gaps,
        "gaps over 50 ms below 0.1 N between first touch and release of followed surfaces",
        DRAWN,
    ),
}
