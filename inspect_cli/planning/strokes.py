"""From the strokes of a drawing to the places that are checked and the time they take."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from inspect_cli.guidance.stroke import StrokePath
from inspect_cli.interfaces import Capabilities
from inspect_cli.planning.contact_poses import Touch
from inspect_cli.planning.points import ContactPoint, outside, point_on
from inspect_cli.planning.timing import extent
from inspect_cli.schema.plan import Stroke
from inspect_cli.schema.tasks.trace import Trace
from inspect_cli.spatial.arrays import Points, Structured

SAMPLE_M = 0.10
"""Between the places along a stroke at which its postures are checked."""


def stroke_model(
    pieces: Sequence[Points], speed_mps: float, drawing: int, trial: int, part: int
) -> Stroke:
    """A stroke as the plan keeps it."""
    written = tuple(tuple((float(u), float(v)) for u, v in piece) for piece in pieces)
    return Stroke(pieces_m=written, speed_mps=speed_mps, drawing=drawing, trial=trial, part=part)


def points_along(
    prim: Structured, stroke: Stroke, label: str, trace: Trace, impedance: str
) -> list[ContactPoint]:
    """Places along the stroke, its two ends among them, at most ``SAMPLE_M`` apart on a piece."""
    places = [stroke.pieces_m[0][0]]
    for piece in stroke.pieces_m:
        line = np.array(piece)
        at = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(line, axis=0), axis=1))])
        count = max(1, int(np.ceil(at[-1] / SAMPLE_M)))
        for share in np.arange(1, count + 1) / count:
            u, v = (float(np.interp(share * at[-1], at, line[:, k])) for k in range(2))
            places.append((u, v))
    return [point_on(prim, uv, label, trace.on, trace, impedance) for uv in places]


def fault_of(prim: Structured, stroke: Stroke) -> str:
    """Where the first of the stroke's points that is beyond the patch lies; empty if none is."""
    faults = (outside(prim, u, v) for piece in stroke.pieces_m for u, v in piece)
    return next((fault for fault in faults if fault), "")


def slowed(
    stroke: Stroke,
    points: Sequence[ContactPoint],
    line: Sequence[Touch],
    capabilities: Capabilities,
) -> Stroke:
    """The stroke at a speed of the tool at which the body keeps its limits of speed and turn.

    On a bend of the surface the body, a lever away from the tool, goes faster or slower than it.
    """
    speed = min(stroke.speed_mps, capabilities.max_speed_mps)
    for (p, a), (q, b) in pairwise(zip(points, line, strict=True)):
        way_m = math.dist(p.uv_m, q.uv_m)
        moved_m, turned_rad = extent(a.setpoint, b.setpoint)
        if not way_m > 0.0:  # a loop between two places
            continue
        if moved_m > 0.0:
            speed = min(speed, capabilities.max_speed_mps * way_m / moved_m)
        if turned_rad > 0.0:
            speed = min(speed, capabilities.max_angular_rate_radps * way_m / turned_rad)
    return stroke.model_copy(update={"speed_mps": speed})


def sliding_s(stroke: Stroke, acceleration_mps2: float) -> float:
    """How long the tool takes along the stroke, its rests at corners included."""
    return sum(
        StrokePath(np.array(piece), stroke.speed_mps, acceleration_mps2).duration_s
        for piece in stroke.pieces_m
    )
