"""Drawings to trace: from a polyline or an SVG file to strokes of smooth pieces on a surface.

A stroke is what is drawn without lifting. It consists of pieces, arrays (n, 2) of points (u, v)
in m: a piece is smooth, between two of them the line has a corner. A straight piece is its two
ends.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from typing import Any
from xml.etree.ElementTree import ParseError

import numpy as np

from inspect_cli.scans.files import confined, refused, require_file
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.tasks import MAX_POINTS, Trace
from inspect_cli.spatial.arrays import Points

Stroke = tuple[Points, ...]

SAMPLE_M = 0.002
"""Between the points of a curved piece on the surface."""
CORNER_RAD = float(np.radians(10.0))
"""A line that turns by more between two segments has a corner there."""
SHORTEST_M = 1e-4
"""Pieces that are shorter are marks of the pen, not lines."""


def drawings_of(mission: Mission, root: Path) -> dict[int, tuple[Stroke, ...]]:
    """The strokes of every task that traces, by the task's place in the mission."""
    return {
        place: strokes_of(task.trace, root)
        for place, task in enumerate(mission.tasks)
        if task.trace is not None
    }


def strokes_of(trace: Trace, root: Path) -> tuple[Stroke, ...]:
    """The strokes of a trace on its surface, once through; ``root`` is the campaign folder.

    Raises GeometryError for a file that holds no line, or more points than can be flown, and
    InputError for one outside of the campaign.
    """
    if trace.polyline_m is not None:
        corners = np.array(trace.polyline_m) + np.array(trace.at_m)
        edges = [corners[k : k + 2] for k in range(len(corners) - 1)]
        return (tuple(edge for edge in edges if _length_m(edge) > SHORTEST_M),)
    assert trace.svg is not None  # the schema saw to it, and to the width
    assert trace.width_m is not None
    return _svg_strokes(confined(root, trace.svg), trace.width_m, np.array(trace.at_m))


def _svg_strokes(path: Path, width_m: float, middle_m: Points) -> tuple[Stroke, ...]:
    lines = [line for drawn in _svg_paths(path) for line in drawn.continuous_subpaths()]
    lines = [line for line in lines if len(line) > 0 and line.length() > 0.0]
    if not lines:
        raise refused(path, "there is no line in it", "draw paths, not text or images")
    boxes = np.array([line.bbox() for line in lines])
    left, right = boxes[:, 0].min(), boxes[:, 1].max()
    top, bottom = boxes[:, 2].min(), boxes[:, 3].max()
    if not right > left:
        raise refused(path, "the drawing has no width to scale", "use polyline_m for a line")
    scale = width_m / (right - left)
    if scale * sum(line.length() for line in lines) > MAX_POINTS * SAMPLE_M:
        raise refused(
            path,
            f"at {width_m:g} m width its lines are longer than {MAX_POINTS * SAMPLE_M:g} m",
            "draw it smaller, or split it into several missions",
        )
    center = 0.5 * np.array([left + right, top + bottom])

    def on_surface(points: Any) -> Points:
        """SVG's y runs down; v runs up."""
        xy = np.column_stack([np.real(points), np.imag(points)]) - center
        placed: Points = middle_m + scale * xy * np.array([1.0, -1.0])
        return placed

    strokes = (tuple(on_surface(p) for p in _pieces(line, SAMPLE_M / scale)) for line in lines)
    kept = (tuple(p for p in stroke if _length_m(p) > SHORTEST_M) for stroke in strokes)
    return tuple(stroke for stroke in kept if stroke)


def _svg_paths(path: Path) -> list[Any]:
    """Every path of the file with the transforms of its groups applied."""
    require_file(path, (".svg",), "drawing")
    from svgpathtools import Document  # large, and only a trace needs it

    try:
        return list(Document(str(path)).paths())
    except (ParseError, ValueError, AssertionError, IndexError, KeyError) as error:
        raise refused(
            path, f"it is no SVG that can be read: {error}", "save it as plain SVG"
        ) from error


def _pieces(line: Any, step: float) -> Iterator[Any]:
    """Complex points of each smooth piece of a continuous SVG path."""
    runs: list[list[Any]] = [[]]
    for segment in line:
        if segment.length() <= 0.0:
            continue
        if runs[-1] and _turn(runs[-1][-1], segment) > CORNER_RAD:
            runs.append([])
        runs[-1].append(segment)
    for run in runs:
        if len(run) == 1 and type(run[0]).__name__ == "Line":
            yield np.array([run[0].start, run[0].end])
            continue
        points = [np.array([run[0].start])]
        for segment in run:
            n = max(2, int(np.ceil(segment.length() / step)))
            shares = np.arange(1, n + 1) / n
            points.append(np.array([segment.point(segment.ilength(s * segment.length()))
                                    for s in shares]))  # fmt: skip
        yield np.concatenate(points)


def _turn(before: Any, after: Any) -> float:
    """The angle, rad, by which the line turns between two segments."""
    ratio = after.unit_tangent(0.0) / before.unit_tangent(1.0)
    return float(abs(np.angle(ratio)))


def _length_m(points: Points) -> float:
    return float(np.linalg.norm(np.diff(points, axis=0), axis=1).sum())
