"""What the tool did to the surface: true forces, bounces, where it touched."""

from __future__ import annotations

import numpy as np

from inspect_cli.metrics.flight import TOUCH_N, FlightData, NotMeasured, Rows, largest, mean
from inspect_cli.records import TrueContact
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Vector

LONGEST_GAP_S = 0.050
"""A loss of contact longer than this is a bounce (ledger rows A6.force, A7.slide)."""
SETTLE_S = 1.0
"""The force may settle for this long after the first touch (ledger row A6.force)."""
SLID = ("stroke", "following")
"""Kinds of target that are held in contact until the tool lifts off."""


def steady_forces(flight: FlightData) -> Vector:
    """Mean true normal force over the last 2 s of each point's dwell, (n_targets,) N.

    A point that was planned and never pressed counts as 0 N.
    """
    force = flight.state["f_normal"]
    dwells = [flight.dwells.get(target.index) for target in flight.contact_targets]
    return np.array([np.mean(force[dwell.steady]) if dwell else 0.0 for dwell in dwells])


def force_mean(flight: FlightData) -> float:
    """Mean over the points of their steady forces, N."""
    return mean(steady_forces(flight))


def force_mean_min(flight: FlightData) -> float:
    """The least of the points' steady forces, N."""
    return -largest(-steady_forces(flight))


def force_mean_max(flight: FlightData) -> float:
    """The greatest of the points' steady forces, N."""
    return largest(steady_forces(flight))


def force_peak(flight: FlightData) -> float:
    """Largest true normal force of the whole flight, N."""
    return largest(flight.state["f_normal"])


def force_cv(flight: FlightData) -> float:
    """Worst coefficient of variation (σ / mean) of the true normal force of a contact.

    Each from 1 s after its first touch: of a point to the end of its dwell, of a stroke and of a
    surface that is followed to the release.

    Raises:
        NotMeasured: a stroke or a surface to follow was never touched, or no contact lasted.
    """
    ratios = [_variation(flight, _held(flight, target)) for target in flight.plan.targets]
    settled = [ratio for ratio in ratios if ratio is not None]
    if not settled:
        raise NotMeasured(f"no contact lasted longer than {SETTLE_S:g} s")
    return max(settled)


def _held(flight: FlightData, target: Target) -> Rows:
    if target.kind in SLID:
        return held_rows(flight, target)
    dwell = flight.dwells.get(target.index)
    return dwell.rows if dwell else np.empty(0, np.intp)


def _variation(flight: FlightData, rows: Rows) -> float | None:
    times = flight.state["t_s"][rows]
    settled = flight.state["f_normal"][rows][times > times[:1] + SETTLE_S]
    if len(settled) < 2:
        return None
    return float(np.std(settled) / np.mean(settled))


def held_rows(flight: FlightData, target: Target) -> Rows:
    """Rows from first touch to release of a target along which the tool slides.

    Raises:
        NotMeasured: it was never touched. Left out, it would make the others speak for it.
    """
    rows = flight.contact_rows(target.index)
    if len(rows) == 0:
        raise NotMeasured(f"target {target.label} was never touched")
    return rows


def bounce_gaps(flight: FlightData) -> float:
    """Number of gaps longer than 50 ms with less than 0.1 N between first touch and release.

    Raises:
        NotMeasured: a stroke or a surface to follow was never touched.
    """
    for target in flight.contact_targets:
        if target.kind in SLID:
            held_rows(flight, target)
    return float(sum(gaps_of(flight, target) for target in flight.contact_targets))


def gaps_of(flight: FlightData, target: Target) -> int:
    """Those of one target.

    The release is the last touch or the end of the touching modes, whichever comes later: a contact
    that is lost before the tool is asked to leave, and never found again, is a gap as well.
    """
    rows = flight.contact_rows(target.index)
    touching = rows[flight.state["f_normal"][rows] >= TOUCH_N]
    times = flight.state["t_s"]
    tick_s = float(np.median(np.diff(times))) if len(times) > 1 else 0.0
    asked = flight.during(Phase.CONTACT)
    last = np.flatnonzero(asked & (flight.reference["target"] == target.index))[-1:]
    ends_s = times[touching]
    if len(ends_s) and len(last) and last[0] > touching[-1]:
        ends_s = np.append(ends_s, times[last[0]] + tick_s)
    # The tool is off for the rows in between, which is one tick less than from touch to touch.
    gaps_s = np.diff(ends_s) - tick_s
    return int(np.sum(gaps_s > LONGEST_GAP_S + 1e-6))


def body_force_max(flight: FlightData) -> float:
    """Largest contact force on anything but tool and landing gear, N, in the whole flight."""
    return largest(flight.state["f_body"])


def position_error(flight: FlightData, target: Target) -> float | None:
    """Distance along the surface between planned and true contact point, m; None if not pressed.

    e − (e·n) n with e from the planned point to the tip's true mean position over the steady end
    of the dwell and n the true normal there (the planned one where the log has no truth).
    """
    dwell = flight.dwells.get(target.index)
    if dwell is None:
        return None
    normal = np.array(target.n_W)
    if flight.log.rows(TrueContact) is not None:
        normal = np.mean(flight.on_state_ticks(TrueContact)["n_W"][dwell.steady], axis=0)
        normal /= np.linalg.norm(normal)
    error = np.mean(flight.state["p_WT"][dwell.steady], axis=0) - np.array(target.p_WC)
    return float(np.linalg.norm(error - (error @ normal) * normal))


def position_error_max(flight: FlightData) -> float:
    """The largest ``position_error`` of the points that were pressed, m.

    Where a surface is found by the camera alone, no point of it was planned.
    """
    planned = (target for target in flight.contact_targets if target.surface is not None)
    errors = [position_error(flight, target) for target in planned]
    pressed = [error for error in errors if error is not None]
    if not pressed:
        raise NotMeasured("no point was pressed")
    return max(pressed)
