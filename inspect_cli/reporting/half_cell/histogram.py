"""Histogram of the potentials, with the densities of the populations that were found."""

from __future__ import annotations

import math

import numpy as np

from inspect_cli.assessment.classes import ASTM_CLASSES, NO_CLASS, millivolts
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.figures.palette import ASTM_STYLES
from inspect_cli.reporting.half_cell.population_marks import (
    curve_trace,
    curves_caption,
    threshold_shapes,
    threshold_words,
)
from inspect_cli.reporting.half_cell.populations import curves_of
from inspect_cli.reporting.half_cell.potential_scale import (
    ACTIVE_BELOW_MV,
    PASSIVE_ABOVE_MV,
    class_line,
)
from inspect_cli.reporting.words.text import number, say, sentences
from inspect_cli.spatial.arrays import Vector

BINS_MV = (5.0, 10.0, 25.0, 50.0)
"""Widths whose edges fall on the boundaries of the classes."""
MOST_BINS = 40
CURVE_POINTS = 241


def histogram_figure(k: int, evaluated: SurfaceFindings) -> Figure | None:
    """How many readings there are at each potential, and the populations' densities."""
    readings, codes = evaluated.assessed.readings, evaluated.assessed.astm
    valid = codes != NO_CLASS
    if not np.any(valid):
        return None
    mv = millivolts(readings.potential_v[valid])
    width, edges = bins_of(mv)
    traces: list[Json] = []
    below = np.zeros(len(edges) - 1)
    for code, name in enumerate(ASTM_CLASSES):
        counts = np.histogram(mv[codes[valid] == code], edges)[0].astype(float)
        if counts.any():
            traces.append(_staircase(name, edges, below, counts))
        below += counts
    at = np.linspace(edges[0] - width, edges[-1] + width, CURVE_POINTS)
    curves = [
        (curve.style, len(mv) * width * curve.density(at))
        for curve in curves_of(evaluated.assessed.summary)
    ]
    traces += [curve_trace(style, at, y) for style, y in curves]
    highest = max([below.max(), *(y.max() for _, y in curves)])
    mixture = evaluated.assessed.summary.mixture
    layout: Json = {
        "hovermode": False,
        "showlegend": True,
        "xaxis": {
            "title": {"text": say("potential (mV CSE)")},
            "range": [float(at[0]), float(at[-1])],
        },
        "yaxis": {
            "title": {"text": say("readings per {width} mV", width=number(width, 0))},
            "range": [0.0, 1.15 * float(highest)],
        },
        "shapes": [
            *(
                {**class_line("x", v), "layer": "above"}
                for v in (PASSIVE_ABOVE_MV, ACTIVE_BELOW_MV)
                if at[0] < v < at[-1]
            ),
            *threshold_shapes("x", mixture),
        ],
        "annotations": threshold_words("x", mixture, (float(at[0]), float(at[-1]))),
    }
    caption = say("Histogram of the valid readings. Dashed: the class boundaries of ASTM C876.")
    return Figure(
        f"histogram-{k + 1}",
        sentences([caption, curves_caption(mixture)]),
        say("Histogram of {n} potentials.", n=number(len(mv), 0)),
        traces,
        layout,
        380,
    )


def bins_of(mv: Vector) -> tuple[float, Vector]:
    """Width and edges of the bins, mV. A bin has its lower edge.

    As Freedman and Diaconis have it, the width grows with the spread of the middle half and
    shrinks with the cube root of the number; it is half of theirs, because two populations are
    looked for and not one.
    """
    quarter, three_quarters = np.percentile(mv, (25, 75))
    wanted = (three_quarters - quarter) / len(mv) ** (1.0 / 3.0)
    wanted = max(wanted, (mv.max() - mv.min()) / MOST_BINS, BINS_MV[0])
    width = min(BINS_MV, key=lambda w: abs(math.log(w / wanted)))
    first, last = math.floor(mv.min() / width), math.floor(mv.max() / width) + 1
    return width, width * np.arange(first, last + 1, dtype=np.float64)


def _staircase(name: str, edges: Vector, below: Vector, counts: Vector) -> Json:
    """The bars of a class upon those of the classes before, as one closed outline."""
    some = np.flatnonzero(counts)
    part = slice(some[0], some[-1] + 1)
    x = np.repeat(edges[some[0] : some[-1] + 2], 2)[1:-1]
    top, bottom = np.repeat((below + counts)[part], 2), np.repeat(below[part], 2)
    style = ASTM_STYLES[name]
    return {
        "type": "scatter",
        "mode": "lines",
        "name": style.label,
        "x": [*x.tolist(), *x[::-1].tolist(), float(x[0])],
        "y": [*top.tolist(), *bottom[::-1].tolist(), float(top[0])],
        "fill": "toself",
        "fillcolor": _pale(style.colour),
        "line": {"color": style.colour, "width": 1.2},
    }


def _pale(colour: str) -> str:
    red, green, blue = (int(colour[k : k + 2], 16) for k in (1, 3, 5))
    return f"rgba({red}, {green}, {blue}, 0.45)"
