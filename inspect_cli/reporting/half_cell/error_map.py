"""The map of the standard error of the kriged potentials."""

from __future__ import annotations

import math

import numpy as np

from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Figure, Json, numbers
from inspect_cli.reporting.figures.palette import ERROR_STOPS, INK
from inspect_cli.reporting.half_cell.map_captions import error_caption
from inspect_cli.reporting.half_cell.map_frame import MAP_FRAME_PX, TALL, field_trace, frame_of
from inspect_cli.reporting.half_cell.map_marks import MOST_MARKERS
from inspect_cli.reporting.half_cell.potential_scale import colour_bar, lying_bar
from inspect_cli.reporting.words.text import number, say, together

STEPS_MV = tuple(m * 10.0**power for power in (-1, 0, 1, 2) for m in (1, 2, 5))
MOST_BANDS = 8
SMALLER = 0.6


def error_figure(k: int, evaluated: SurfaceFindings) -> Figure | None:
    """The standard error on the same grid as the map of surface ``k``; None without a map."""
    kriged = evaluated.map
    if not isinstance(kriged, KrigedMap):
        return None
    readings = evaluated.assessed.readings
    frame, error_mv = frame_of(readings.uv_m), 1e3 * kriged.standard_error_v
    top, step = scale_of(float(np.nanmax(error_mv)))
    few = kriged.readings <= MOST_MARKERS
    stops = [list(stop) for stop in ERROR_STOPS]
    field: Json = {
        **field_trace(kriged, error_mv),
        "contours": {"start": 0.0, "end": top, "size": step},
        "line": {"width": 0.6 if few else 0.0, "color": INK, "smoothing": 0},
        "colorscale": stops,
        "zmin": 0.0,
        "zmax": top,
        "hovertemplate": together(say("standard error: {z} mV", z="%{z:.1f}"), "<extra></extra>"),
    }
    valid = readings.uv_m[readings.valid]
    dots: Json = {
        "type": "scatter",
        "mode": "markers",
        "name": say("readings"),
        "x": numbers(valid[:, 0]),
        "y": numbers(valid[:, 1]),
        "marker": {"size": 3, "color": INK},
        "hoverinfo": "skip",
    }
    bar = lying_bar(" mV", [step * n for n in range(round(top / step) + 1)])
    axis = {"cmin": 0.0, "cmax": top, "colorscale": stops, "colorbar": bar}
    high = frame.height_px if frame.slope > TALL else SMALLER * frame.height_px
    return Figure(
        f"error-{k + 1}",
        error_caption(evaluated, kriged),
        say(
            "Map of the standard error of the interpolated potentials, up to {most} mV.",
            most=number(float(np.nanmax(error_mv)), 0),
        ),
        [field, colour_bar("scatter"), *([dots] if few else [])],
        {**frame.layout(), "coloraxis": axis},
        MAP_FRAME_PX + int(max(high, 120.0)),
        slope=min(frame.slope, 1.6),
    )


def scale_of(largest_mv: float) -> tuple[float, float]:
    """Upper end of the scale and the step of its bands, mV."""
    step = next((s for s in STEPS_MV if s * MOST_BANDS >= largest_mv), STEPS_MV[-1])
    return step * max(math.ceil(largest_mv / step - 1e-9), 1), step
