"""From the strokes of a drawing to the places that are checked and the time they take."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.guidance.stroke import StrokePath
from inspect_cli.planning.points import ContactPoint, point_on
from inspect_cli.schema.plan import Stroke
from inspect_cli.schema.tasks import Trace
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


def sliding_s(stroke: Stroke, acceleration_mps2: float) -> float:
    """How long the tool takes along the stroke, its rests at corners included."""
    return sum(
        StrokePath(np.array(piece), stroke.speed_mps, acceleration_mps2).duration_s
        for piece in stroke.pieces_m
    )
