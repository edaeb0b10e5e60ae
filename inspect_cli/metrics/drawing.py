"""How a drawing came out: against its reference, and against itself when it is drawn again.

Only what lies in the plane of the surface counts: an error e becomes e − (e·n) n with the true
outward normal n at the tip, or the planned one where the log does not know it. Across the surface
the set-point lies behind it on purpose.

Two trials of a stroke have the same reference, but for what the camera corrected of the surface
and for the moment at which it begins to move. So they are compared at equal progress σ of the
reference:

    d(σ) = |P (p_a(σ) − p_b(σ))|, P = 1 − n nᵀ, σ(τ) = s(τ) + ε τ

with the reference's way s along the surface since the slide began, τ ago. ε = 1 mm/s orders the
rows in which it rests at a corner by time. The true tip p of trial b is interpolated linearly to
the rows of trial a.

Source of the questions: Bodie et al., "An Omnidirectional Aerial Manipulation Platform for
Contact-Based Inspection", section V-C (ledger rows A6).
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import combinations

import numpy as np

from inspect_cli.metrics.contact import held_rows
from inspect_cli.metrics.flight import FlightData, NotMeasured, Rows, largest, root_mean_square
from inspect_cli.metrics.geometry import attitude_angle
from inspect_cli.records import TrueContact
from inspect_cli.schema.modes import Phase
from inspect_cli.schema.plan import Stroke, Target
from inspect_cli.spatial.arrays import Points, Vector

CREEP_MPS = 0.001
"""ε; two trials that begin to move 0.1 s apart are compared 0.1 mm apart."""
SAME_WAY = 0.02
"""Ways that differ by a larger share are not the same stroke: one of them was cut short."""


@dataclass(frozen=True)
class Repeat:
    """A stroke that was drawn twice."""

    first: Target
    second: Target
    arc_m: Vector
    """Length of the reference's way along the surface since the slide began, (n,)."""
    apart_m: Vector
    """d, (n,)."""

    @property
    def rms_m(self) -> float:
        """√(mean of d²)."""
        return root_mean_square(self.apart_m)


def drawn_targets(flight: FlightData) -> list[tuple[Target, Stroke]]:
    """The strokes of the plan, in its order.

    Raises:
        NotMeasured: there are none.
    """
    found = [(t, t.stroke) for t in flight.plan.targets if t.stroke is not None]
    if not found:
        raise NotMeasured("the plan has no stroke to draw")
    return found


def slide_rows(flight: FlightData, target: Target) -> Rows:
    """Rows of the state in which the tool slid along a target's line.

    Raises:
        NotMeasured: it never did.
    """
    sliding = flight.during(Phase.CONTACT, slides=True)
    rows: Rows = np.flatnonzero(sliding & (flight.reference["target"] == target.index))
    if len(rows) < 2:
        raise NotMeasured(f"target {target.label} was never slid along")
    return rows


def normals(flight: FlightData, target: Target, rows: Rows) -> Points:
    """Outward normals at the tip, (n, 3): the true ones where there are, else the planned one."""
    planned = np.tile(np.array(target.n_W), (len(rows), 1))
    if flight.log.rows(TrueContact) is None:
        return planned
    contact = flight.on_state_ticks(TrueContact)[rows]
    chosen: Points = np.where(contact["surface"][:, None] >= 0.0, contact["n_W"], planned)
    return chosen


def along_surface(vectors: Points, n_W: Points) -> Points:
    """P x of each vector (n, 3) with its normal (n, 3)."""
    flat: Points = vectors - np.sum(vectors * n_W, axis=1, keepdims=True) * n_W
    return flat


def way_along(p_W: Points, n_W: Points) -> Vector:
    """Length of the way along the surface up to each of the points (n, 3), (n,) m."""
    steps = np.linalg.norm(along_surface(np.diff(p_W, axis=0), n_W[:-1]), axis=1)
    return np.concatenate([np.zeros(1), np.cumsum(steps)])


def repeats(flight: FlightData) -> list[Repeat]:
    """Every two trials of every stroke that is drawn more than once.

    Raises:
        NotMeasured: there are none, or a stroke was not drawn to its end.
    """
    strokes = drawn_targets(flight)
    found = [
        _repeat(flight, a, b)
        for (a, of_a), (b, of_b) in combinations(strokes, 2)
        if (of_a.drawing, of_a.part) == (of_b.drawing, of_b.part)
    ]
    if not found:
        raise NotMeasured("no stroke is drawn twice")
    return found


def _repeat(flight: FlightData, first: Target, second: Target) -> Repeat:
    rows_a, rows_b = slide_rows(flight, first), slide_rows(flight, second)
    n_W = normals(flight, first, rows_a)
    way_a = way_along(flight.reference["p_WT"][rows_a], n_W)
    way_b = way_along(flight.reference["p_WT"][rows_b], normals(flight, second, rows_b))
    if abs(way_a[-1] - way_b[-1]) > SAME_WAY * max(way_a[-1], way_b[-1]):
        raise NotMeasured(f"strokes {first.label} and {second.label} are not equally long")
    progress_a, progress_b = _progress(flight, rows_a, way_a), _progress(flight, rows_b, way_b)
    tips = flight.state["p_WT"]
    again = [np.interp(progress_a, progress_b, tips[rows_b, k]) for k in range(3)]
    apart = along_surface(tips[rows_a] - np.column_stack(again), n_W)
    return Repeat(first, second, way_a, np.linalg.norm(apart, axis=1))


def _progress(flight: FlightData, rows: Rows, way_m: Vector) -> Vector:
    """σ, (n,) m, which grows from row to row."""
    times = flight.state["t_s"][rows]
    grown: Vector = way_m + CREEP_MPS * (times - times[0])
    return grown


def repeat_rms(flight: FlightData) -> float:
    """RMS difference of two trials of a stroke in the plane, m: of all pairs the largest."""
    return max(repeat.rms_m for repeat in repeats(flight))


def tracking_rms(flight: FlightData) -> float:
    """RMS distance in the plane between true tip and reference while sliding, all strokes, m."""
    errors = []
    for target, _ in drawn_targets(flight):
        rows = slide_rows(flight, target)
        error = flight.state["p_WT"][rows] - flight.reference["p_WT"][rows]
        errors.append(np.linalg.norm(along_surface(error, normals(flight, target, rows)), axis=1))
    return root_mean_square(np.concatenate(errors))


def attitude_error_max(flight: FlightData) -> float:
    """Largest angle between reference and true attitude from first touch to release, rad.

    Raises:
        NotMeasured: there is no stroke, or one of them was never touched.
    """
    touched = [held_rows(flight, target) for target, _ in drawn_targets(flight)]
    rows = np.concatenate(touched)
    return largest(attitude_angle(flight.reference["q_WB"][rows], flight.state["q_WB"][rows]))
