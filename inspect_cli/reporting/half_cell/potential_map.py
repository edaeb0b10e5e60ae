"""The map of half-cell potentials on a surface: kriged field, equipotential lines, readings."""

from __future__ import annotations

from collections.abc import Mapping

import numpy as np

from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.half_cell.isolines import isolines, step_of, values
from inspect_cli.reporting.half_cell.map_captions import map_caption
from inspect_cli.reporting.half_cell.map_frame import (
    MAP_FRAME_PX,
    MAX_WRITTEN_VALUES,
    field_trace,
    frame_of,
)
from inspect_cli.reporting.half_cell.map_marks import (
    MOST_MARKERS,
    MOST_SIGNS,
    invalid_markers,
    label_trace,
    minima_trace,
    proposals_trace,
    valid_markers,
)
from inspect_cli.reporting.half_cell.places import Indices, places_of, thinned_places
from inspect_cli.reporting.half_cell.potential_scale import colour_axis, colour_bar
from inspect_cli.reporting.words.text import Text, number, say, together


def map_figure(
    k: int, evaluated: SurfaceFindings, ends: tuple[float, float], reasons: Mapping[str, Text]
) -> Figure | None:
    """The map of one surface; None where nothing was read.

    Args:
        k: number of the surface.
        evaluated: its readings.
        ends: of the scale of colours that all surfaces share, mV.
        reasons: why the readings are invalid, by their labels.
    """
    readings = evaluated.assessed.readings
    if not len(readings):
        return None
    frame, kriged = frame_of(readings.uv_m), evaluated.map
    valid, invalid = np.flatnonzero(readings.valid), np.flatnonzero(~readings.valid)
    written = len(valid) <= MAX_WRITTEN_VALUES
    shown = places_of(evaluated.assessed, _drawn(evaluated, valid))
    few = thinned_places(invalid.astype(np.float64), MOST_MARKERS)
    crosses = places_of(evaluated.assessed, invalid[few])
    traces: list[Json] = []
    if isinstance(kriged, KrigedMap):
        traces = [_field(kriged, ends), *isolines(kriged)]
    traces += [colour_bar("scatter")] if len(valid) else []
    traces += valid_markers(shown, ends)
    traces += [*minima_trace(evaluated, written=written), *proposals_trace(evaluated)]
    traces += invalid_markers(crosses, reasons)
    if isinstance(kriged, KrigedMap):
        near = readings.uv_m if written else readings.uv_m[:0]
        traces += values(kriged, frame.px_per_m, near)
    traces += label_trace(
        shown if written else [], crosses if len(invalid) <= MAX_WRITTEN_VALUES else []
    )
    return Figure(
        f"map-{k + 1}",
        map_caption(evaluated, len(shown), len(crosses), MOST_SIGNS),
        say(
            "Map of {valid} valid and {invalid} invalid half-cell readings.",
            valid=number(len(valid), 0),
            invalid=number(len(invalid), 0),
        ),
        traces,
        {**frame.layout(), "coloraxis": colour_axis(ends)},
        MAP_FRAME_PX + int(frame.height_px),
        slope=min(frame.slope, 1.6),
    )


def _drawn(evaluated: SurfaceFindings, valid: Indices) -> Indices:
    """The valid readings that are drawn one by one: where a map tells it better, none of many."""
    if len(valid) <= MOST_MARKERS:
        return valid
    if isinstance(evaluated.map, KrigedMap):
        return valid[:0]
    return valid[thinned_places(evaluated.assessed.readings.potential_v[valid], MOST_MARKERS)]


def _field(kriged: KrigedMap, ends: tuple[float, float]) -> Json:
    """The field in bands of the colours of its potentials; lines are drawn apart from it."""
    return {
        **field_trace(kriged, 1e3 * kriged.potential_v),
        "contours": {
            "start": ends[0],
            "end": ends[1],
            "size": step_of(kriged),
            "showlines": False,
        },
        "colorscale": colour_axis(ends)["colorscale"],
        "zmin": ends[0],
        "zmax": ends[1],
        "opacity": 0.75,
        "hovertemplate": together(say("interpolated: {z} mV CSE", z="%{z:.0f}"), "<extra></extra>"),
    }
