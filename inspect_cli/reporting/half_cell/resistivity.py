"""Potential against resistivity."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from inspect_cli.assessment.classes import SUSTAINS_CORROSION_OHM_M, is_resistivity
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Figure, Json, words
from inspect_cli.reporting.figures.palette import CORROSION_STYLES, INK
from inspect_cli.reporting.half_cell.places import Indices, Place, places_of
from inspect_cli.reporting.half_cell.potential_scale import (
    ACTIVE_BELOW_MV,
    PASSIVE_ABOVE_MV,
    class_line,
    potential_range,
)
from inspect_cli.reporting.words.text import number, say, sentences
from inspect_cli.spatial.arrays import Points

TEXT_SIDES = ("top center", "bottom center", "middle right", "middle left")
"""Sides of labels in turn, so that labels of equal readings do not cover each other."""
MOST_LABELLED = 40
MOST_DRAWN = 2000
SIZES_PX = ((100, 11), (500, 7), (MOST_DRAWN, 4))


def resistivity_figure(k: int, evaluated: SurfaceFindings) -> Figure | None:
    """Potential against resistivity of surface ``k`` with the regions of the combined rule."""
    readings = evaluated.assessed.readings
    known = np.flatnonzero(readings.valid & is_resistivity(readings.resistivity_ohm_m))
    if not len(known):
        return None
    both = np.column_stack([readings.potential_v[known], readings.resistivity_ohm_m[known]])
    places = places_of(evaluated.assessed, known[spread(both, MOST_DRAWN)])
    low, high = potential_range(p.potential_mv for p in places if p.potential_mv is not None)
    layout: Json = {
        "hovermode": "closest",
        "showlegend": True,
        "xaxis": {"title": {"text": say("potential (mV CSE)")}, "range": [low, high]},
        "yaxis": {
            "title": {"text": say("resistivity (Ω·m), log scale")},
            "type": "log",
            "range": _decades(places),
            "tickvals": [m * 10**e for e in range(-1, 6) for m in (1, 2, 5)],
        },
        "shapes": [
            *(class_line("x", value) for value in (PASSIVE_ABOVE_MV, ACTIVE_BELOW_MV)),
            class_line("y", SUSTAINS_CORROSION_OHM_M),
            _active_region(low),
        ],
    }
    thinned = say(
        "Of {n} readings {drawn} are drawn, the extremes among them.",
        n=number(len(known), 0),
        drawn=number(len(places), 0),
    )
    caption = say(
        "Potential against resistivity of the valid readings. Dashed: the boundaries of the "
        "combined rule; shaded: where it says active. 10 Ω·m are 1 kΩ·cm."
    )
    return Figure(
        f"resistivity-{k + 1}",
        sentences([caption, thinned if len(places) < len(known) else ""]),
        say("Scatter of potential against resistivity of {n} readings.", n=number(len(known), 0)),
        _markers(places),
        layout,
        360,
    )


def spread(values: Points, most: int) -> Indices:
    """At most ``most`` rows of values (n, m), the extremes of each column among them."""
    n = len(values)
    if n <= most:
        return np.arange(n)
    ends = [*np.argmin(values, axis=0), *np.argmax(values, axis=0)]
    even = np.linspace(0, n - 1, most - len(ends)).round().astype(np.intp)
    return np.unique([*even, *ends])


def _markers(places: Sequence[Place]) -> list[Json]:
    size = next(size for most, size in SIZES_PX if len(places) <= most)
    labelled = sum(p.verdict != "none" for p in places) <= MOST_LABELLED
    traces: list[Json] = []
    for name, style in CORROSION_STYLES.items():
        own = [p for p in places if p.verdict == name]
        if not own:
            continue
        trace: Json = {
            "type": "scatter",
            "mode": "markers",
            "name": say("corrosion: {verdict}", verdict=style.label),
            "x": [p.potential_mv for p in own],
            "y": [p.resistivity_ohm_m for p in own],
            "marker": {
                "symbol": style.symbol,
                "size": size,
                "color": style.colour,
                "line": {"width": 1 if size > SIZES_PX[-1][1] else 0.3, "color": INK},
            },
            "customdata": [p.text() for p in own],
            "hovertemplate": "%{customdata}<extra></extra>",
        }
        if labelled:
            trace |= {
                "mode": "markers+text",
                "text": [words(p.label) if name != "none" else "" for p in own],
                "textposition": [TEXT_SIDES[k % len(TEXT_SIDES)] for k in range(len(own))],
                "textfont": {"size": 11},
            }
        traces.append(trace)
    return traces


def _decades(places: Sequence[Place]) -> list[float]:
    """Ends of the logarithmic axis: all points, and room on both sides of the rule's boundary."""
    values = [p.resistivity_ohm_m or SUSTAINS_CORROSION_OHM_M for p in places]
    low = min([*values, SUSTAINS_CORROSION_OHM_M / 3.0])
    high = max([*values, SUSTAINS_CORROSION_OHM_M * 3.0])
    return [math.log10(low) - 0.1, math.log10(high) + 0.15]


def _active_region(low: float) -> Json:
    """Active potential and conductive concrete: the lower left of the diagram."""
    return {
        "type": "rect",
        "xref": "x",
        "x0": low,
        "x1": ACTIVE_BELOW_MV,
        "yref": "y",
        "y0": 1e-3,
        "y1": SUSTAINS_CORROSION_OHM_M,
        "fillcolor": "rgba(213, 94, 0, 0.10)",
        "line": {"width": 0},
        "layer": "below",
    }
