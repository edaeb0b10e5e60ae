"""Drawings to trace: from a polyline or an SVG file to strokes of smooth pieces on a surface.

A stroke is what is drawn without lifting. It consists of pieces, arrays (n, 2) of points (u, v)
in m: a piece is smooth, between two of them the line has a corner. A straight piece is its two
ends.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np

from inspect_cli.errors import InspectError
from inspect_cli.scans.files import confined, refused, require_file
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.tasks.base import MAX_POINTS, SHORTEST_M
from inspect_cli.schema.tasks.trace import Trace
from inspect_cli.spatial.arrays import Points, Vector

Stroke = tuple[Points, ...]

SAMPLE_M = 0.002
"""Between the points of a curved piece on the surface."""
CORNER_RAD = float(np.radians(10.0))
"""A line that turns by more between two segments has a corner there."""
CURVE_SAMPLES = 257
"""On each curved segment, for its length and extent: half a circle is 0.01 ‰ longer."""
NEAR = 1e-4
"""Share of a segment's parameter after which its direction is looked at."""
LARGEST = 1e9
"""In the units of the file; beyond, the squares of lengths run out of numbers."""
NO_WIDTH = 1e-6
"""Of its height: a drawing that is narrower is an upright line."""


def drawings_of(mission: Mission, root: Path) -> dict[int, tuple[Stroke, ...]]:
    """The strokes of every task that traces, by the task's place in the mission."""
    return {
        place: strokes_of(task.work, root)
        for place, task in enumerate(mission.tasks)
        if isinstance(task.work, Trace)
    }


def strokes_of(trace: Trace, root: Path) -> tuple[Stroke, ...]:
    """The strokes of a trace on its surface, once through; ``root`` is the campaign folder.

    Raises GeometryError for a file that holds no line, or more than can be flown, and InputError
    for one outside of the campaign.
    """
    if trace.polyline_m is not None:
        corners = np.array(trace.polyline_m) + np.array(trace.at_m)
        edges = [corners[k : k + 2] for k in range(len(corners) - 1)]
        return (tuple(edge for edge in edges if _length_m(edge) > SHORTEST_M),)
    assert trace.svg is not None  # the schema saw to it, and to the width
    assert trace.width_m is not None
    path = confined(root, trace.svg)
    require_file(path, (".svg",), "drawing")
    lines = _svg_lines(path)
    if not lines:
        raise refused(path, "there is no line in it", "draw paths, not text or images")
    scale, middle = _placing(path, lines, trace.width_m)

    def on_surface(points: Points) -> Points:
        """SVG's y runs down; v runs up."""
        placed: Points = np.array(trace.at_m) + scale * (points - middle) * np.array([1.0, -1.0])
        return placed

    strokes = (tuple(on_surface(p) for p in _pieces(line, SAMPLE_M / scale)) for line in lines)
    kept = (tuple(p for p in stroke if _length_m(p) > SHORTEST_M) for stroke in strokes)
    found = tuple(stroke for stroke in kept if stroke)
    if not found:
        what = f"at {trace.width_m:g} m width no line in it is longer than {SHORTEST_M:g} m"
        raise refused(path, what, "draw it larger")
    return found


def _placing(path: Path, lines: Sequence[list[Any]], width_m: float) -> tuple[float, Vector]:
    """(m on the surface per unit of the drawing, middle (2,) of the drawing)."""
    segments = [_points(segment, _shares(segment)) for line in lines for segment in line]
    points = np.concatenate(segments)
    low, high = points.min(axis=0), points.max(axis=0)
    extent = high - low
    if not extent.max() <= LARGEST:  # written so that a NaN is refused
        raise refused(path, "its numbers are too large", "draw it smaller")
    if not extent[0] > NO_WIDTH * extent[1]:
        raise refused(path, "the drawing has no width to scale", "use polyline_m for a line")
    scale = width_m / float(extent[0])
    length_m = scale * sum(_length_m(segment) for segment in segments)
    if not length_m <= MAX_POINTS * SAMPLE_M:
        raise refused(
            path,
            f"at {width_m:g} m width its lines are longer than {MAX_POINTS * SAMPLE_M:g} m",
            "draw it smaller, or split it into several missions",
        )
    return scale, 0.5 * (low + high)


def _svg_lines(path: Path) -> list[list[Any]]:
    """The segments of every continuous line of the file, the transforms of its groups applied."""
    from svgpathtools import Document  # large, and only a trace needs it

    # The library warns of what it mends, and raises whatever Python raises on a bad number.
    with warnings.catch_warnings(), np.errstate(all="ignore"):
        warnings.simplefilter("ignore")
        try:
            drawn = Document(str(path), strict_transform_parsing=True).paths()
            count = sum(len(one) for one in drawn)
            if count > MAX_POINTS:
                what = f"it has {count} segments; at most {MAX_POINTS} can be traced"
                raise refused(path, what, "simplify it, or split it into several missions")
            lines = [line for one in drawn if len(one) for line in one.continuous_subpaths()]
        except InspectError:
            raise
        except Exception as error:
            what = f"it is no SVG that can be read: {error or type(error).__name__}"
            raise refused(path, what, "save it as plain SVG") from error
    found = [[segment for segment in line if _is_long(segment)] for line in lines]
    return [line for line in found if line]


def _is_long(segment: Any) -> bool:
    """Whether a segment is more than a point."""
    return bool(np.any(np.ptp(_points(segment, np.linspace(0.0, 1.0, 5)), axis=0) > 0.0))


def _points(segment: Any, shares: Vector) -> Points:
    """Points (n, 2) of a segment at shares of its parameter."""
    with np.errstate(all="ignore"):
        at = np.array([segment.point(share) for share in shares], dtype=np.complex128)
    return np.column_stack([at.real, at.imag])


def _shares(segment: Any) -> Vector:
    """Shares of the parameter that show a segment's shape."""
    return np.linspace(0.0, 1.0, 2 if _is_straight(segment) else CURVE_SAMPLES)


def _is_straight(segment: Any) -> bool:
    return type(segment).__name__ == "Line"


def _pieces(line: list[Any], step: float) -> Iterator[Points]:
    """The smooth pieces of a line, with points about ``step`` apart where they are curved."""
    runs: list[list[Any]] = [[]]
    for segment in line:
        if runs[-1] and _turn(runs[-1][-1], segment) > CORNER_RAD:
            runs.append([])
        runs[-1].append(segment)
    for run in runs:
        if len(run) == 1 and _is_straight(run[0]):
            yield _points(run[0], np.array([0.0, 1.0]))
            continue
        parts = [_evenly(segment, step) for segment in run]
        yield np.concatenate([parts[0][:1], *[part[1:] for part in parts]])


def _evenly(segment: Any, step: float) -> Points:
    """Points of a segment, even in arc length: both ends, and at least one between."""
    shares = _shares(segment)
    steps = np.linalg.norm(np.diff(_points(segment, shares), axis=0), axis=1)
    at = np.concatenate([[0.0], np.cumsum(steps)])
    places = np.linspace(0.0, at[-1], max(2, int(np.ceil(at[-1] / step))) + 1)
    return _points(segment, np.interp(places, at, shares))


def _turn(before: Any, after: Any) -> float:
    """The angle, rad, by which the line turns between two segments."""
    a, b = -_direction(before, end=True), _direction(after, end=False)
    return float(abs(np.arctan2(a[0] * b[1] - a[1] * b[0], a @ b)))


def _direction(segment: Any, end: bool) -> Vector:
    """The way (2,) from an end of a segment into it.

    A handle of no length, as pens draw it, leaves a Bézier without a derivative there; the way
    to a point near by is defined always.
    """
    near = np.array([0.0, NEAR, *_shares(segment)[1:]])
    points = _points(segment, 1.0 - near if end else near)
    ways = points[1:] - points[0]
    found: Vector = ways[np.argmax(np.any(ways != 0.0, axis=1))]
    return found


def _length_m(points: Points) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
