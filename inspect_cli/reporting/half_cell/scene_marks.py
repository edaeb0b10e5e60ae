"""Half-cell readings in the view of the structure: coloured by potential."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.read_points import ReadPoint, reason_text
from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.figures.scene_marks import SceneMarks, invalid_marks, point_marks
from inspect_cli.reporting.half_cell.potential_scale import (
    colour_axis,
    colour_bar,
    colours,
    hover_text,
    potential_range,
    potentials_of,
)
from inspect_cli.reporting.words.text import say


def scene_marks(points: Sequence[ReadPoint]) -> SceneMarks:
    """Valid readings in the colours of their potentials, and crosses for invalid ones."""
    valid = [p for p in points if p.point.potential_mv is not None]
    invalid = [p for p in points if p.point.potential_mv is None]
    ends = potential_range(potentials_of(points))
    traces: list[Json] = []
    if valid:
        marker = {
            "size": 6,
            "color": colours(potentials_of(valid), ends),
            "line": {"width": 1, "color": INK},
        }
        hover = [hover_text(p) for p in valid]
        places_W = [p.point.p_W for p in valid]
        traces.append(point_marks(say("valid readings"), places_W, marker, hover))
        traces.append(colour_bar("scatter3d"))
    places_W = [p.point.p_W for p in invalid]
    reasons = [reason_text(p) for p in invalid]
    traces += invalid_marks(say("invalid readings"), places_W, reasons)
    return SceneMarks(
        traces,
        {"coloraxis": colour_axis(ends)},
        say("Half-cell readings are coloured by potential."),
    )
