"""How the tool slid along a surface that only the depth camera knows.

The translation of a slide lasts from the first to the last row of mode SLIDE in which the
reference of the tip goes along the surface with more than a tenth of its greatest speed there:
reference and tip start and stop together within their lag, and the time is free of the tip's
own trembling. Distances are those of the true tip in it,

    distance = Σ |P (p_(k+1) − p_k)| over steps that touch at both ends, P = 1 − n nᵀ
    chord    = |p_last − p_first|

with the true outward normal n. Rotations are Log(R_0ᵀ R) of the true tool about its own axes
at the beginning of the translation, R_0. Of several slides the lengths and speeds are
averaged, of angles the largest counts.

Source of the questions: Bodie et al., "An Omnidirectional Aerial Manipulation Platform for
Contact-Based Inspection", section V-D (ledger rows A7).
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from inspect_cli.metrics.contact import gaps_of, held_rows
from inspect_cli.metrics.drawing import along_surface, slide_rows
from inspect_cli.metrics.flight import FlightData, NotMeasured, Rows, largest, mean
from inspect_cli.metrics.geometry import direction_angle, rotation_vectors, turned_by
from inspect_cli.metrics.guidance import NO_SURFACE
from inspect_cli.records import TrueContact
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Points, Vector

MOVING_SHARE = 0.1
"""Of the reference's greatest speed along the surface; below it stands still."""
STILL_MPS = 0.005
"""A reference that never exceeds this is only corrected, not moved."""


@dataclass(frozen=True)
class Slide:
    """One following of a surface."""

    target: Target
    contact: Rows
    """Rows of the state from first touch to release."""
    moving: Rows
    """Those of the translation."""


def followed_targets(flight: FlightData) -> list[Target]:
    """The targets along which the tool follows what the camera sees.

    Raises:
        NotMeasured: there are none.
    """
    found = [target for target in flight.plan.targets if target.following is not None]
    if not found:
        raise NotMeasured("the plan has no surface to follow")
    return found


def slides(flight: FlightData) -> list[Slide]:
    """Every slide of the flight.

    Raises:
        NotMeasured: there is none, or one of them never came to move.
    """
    return [
        Slide(target, flight.contact_rows(target.index), moving_rows(flight, target))
        for target in followed_targets(flight)
    ]


def moving_rows(flight: FlightData, target: Target) -> Rows:
    """The rows of a target's translation.

    Raises:
        NotMeasured: the reference did not move along the surface.
    """
    rows = slide_rows(flight, target)
    times, tip_W = flight.state["t_s"][rows], flight.reference["p_WT"][rows]
    n_W = flight.on_state_ticks(TrueContact)["n_W"][rows]
    velocity = along_surface(np.gradient(tip_W, times, axis=0), n_W)
    speed = np.linalg.norm(velocity, axis=1)
    if largest(speed) < STILL_MPS:
        raise NotMeasured(f"the reference of target {target.label} did not move along the surface")
    fast = np.flatnonzero(speed > MOVING_SHARE * speed.max())
    moving: Rows = rows[fast[0] : fast[-1] + 1]
    return moving


def _each(flight: FlightData, of_slide: Callable[[FlightData, Slide], float]) -> Vector:
    return np.array([of_slide(flight, slide) for slide in slides(flight)])


def distance(flight: FlightData) -> float:
    """Way of the true tip along the surface in contact during the translation, m."""
    return mean(_each(flight, _distance))


def _distance(flight: FlightData, slide: Slide) -> float:
    rows = slide.moving
    n_W = flight.on_state_ticks(TrueContact)["n_W"][rows[:-1]]
    steps = along_surface(np.diff(flight.state["p_WT"][rows], axis=0), n_W)
    touching = flight.touching[rows]
    held = touching[:-1] & touching[1:]
    return float(np.sum(np.linalg.norm(steps[held], axis=1)))


def chord(flight: FlightData) -> float:
    """Distance between the true tip's places at both ends of the translation, m."""

    def length(flight: FlightData, slide: Slide) -> float:
        tip_W = flight.state["p_WT"][slide.moving]
        return float(np.linalg.norm(tip_W[-1] - tip_W[0]))

    return mean(_each(flight, length))


def speed_mean(flight: FlightData) -> float:
    """The distance over the time of the translation, m/s."""

    def speed(flight: FlightData, slide: Slide) -> float:
        times = flight.state["t_s"][slide.moving]
        return _distance(flight, slide) / float(times[-1] - times[0])

    return mean(_each(flight, speed))


def axis_error_mean_deg(flight: FlightData) -> float:
    """Mean angle between z_T and the true inward normal from first touch to release, degrees."""
    rows = [flight.contact_rows(target.index) for target in followed_targets(flight)]
    return _axis_error_deg(flight, np.concatenate(rows))


def axis_error_moving_deg(flight: FlightData) -> float:
    """The same during the translations alone."""
    return _axis_error_deg(flight, np.concatenate([slide.moving for slide in slides(flight)]))


def _axis_error_deg(flight: FlightData, rows: Rows) -> float:
    contact = flight.on_state_ticks(TrueContact)[rows]
    known = contact["surface"] != NO_SURFACE
    z_T = np.tile([0.0, 0.0, 1.0], (int(np.count_nonzero(known)), 1))
    axes_W = turned_by(flight.state["q_WT"][rows][known], z_T)
    return float(np.degrees(mean(direction_angle(axes_W, -contact["n_W"][known]))))


def rotation_xz_max(flight: FlightData) -> float:
    """Largest rotation of the true tool about x_T or z_T during the translation, rad."""
    turns = _each(flight, lambda f, slide: largest(np.abs(turned(f, slide)[:, (0, 2)])))
    return largest(turns)


def rotation_y(flight: FlightData) -> float:
    """Largest rotation of the true tool about y_T during the translation, rad."""
    return largest(_each(flight, lambda f, slide: largest(np.abs(turned(f, slide)[:, 1]))))


def turned(flight: FlightData, slide: Slide) -> Points:
    """Log(R_0ᵀ R) of the true tool in the translation, (n, 3) rad about x_T, y_T, z_T."""
    attitudes = flight.state["q_WT"][slide.moving]
    return rotation_vectors(np.tile(attitudes[0], (len(attitudes), 1)), attitudes)


def gaps(flight: FlightData) -> float:
    """Gaps over 50 ms below 0.1 N between first touch and release of the slides.

    Raises:
        NotMeasured: one of them was never touched.
    """
    targets = followed_targets(flight)
    for target in targets:
        held_rows(flight, target)
    return float(sum(gaps_of(flight, target) for target in targets))
