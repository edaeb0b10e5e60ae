"""Cumulative frequency of the potentials, with the populations that were found."""

from __future__ import annotations

import numpy as np

from inspect_cli.assessment.classes import ASTM_CLASSES, millivolts
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Figure, Json, words
from inspect_cli.reporting.figures.palette import ASTM_STYLES, INK, MUTED
from inspect_cli.reporting.half_cell.places import Indices
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
    potential_range,
)
from inspect_cli.reporting.words.text import number, say, sentences
from inspect_cli.spatial.arrays import Vector

PERCENTS = (0.01, 0.1, 1, 2, 5, 10, 20, 30, 50, 70, 80, 90, 95, 98, 99, 99.9, 99.99)
MOST_DRAWN = 2000
SIZES_PX = ((100, 9), (500, 6), (MOST_DRAWN, 4))
CURVE_POINTS = 961


def cumulative_figure(k: int, evaluated: SurfaceFindings) -> Figure | None:
    """Potentials in order of size against their share, on a normal probability scale.

    The k-th of n values, counted from the least negative, stands at k / (n + 1), the plotting
    position that ASTM C876 gives for its cumulative frequency diagram. A straight line is one
    normal population; a bend tells of two.
    """
    from scipy.special import ndtri

    readings = evaluated.assessed.readings
    valid = np.flatnonzero(readings.valid)
    if not len(valid):
        return None
    order = valid[np.argsort(-readings.potential_v[valid], kind="stable")]
    mv = millivolts(readings.potential_v[order])
    shares: Vector = np.arange(1.0, len(order) + 1.0) / (len(order) + 1.0)
    z = ndtri(shares)
    kept = _kept(z)
    least = min(0.02, shares[0])
    ends = (float(ndtri(least)) - 0.15, float(ndtri(1.0 - least)) + 0.15)
    low, high = potential_range((float(mv.min()), float(mv.max())))
    mixture = evaluated.assessed.summary.mixture
    ticks = [p for p in PERCENTS if ends[0] <= float(ndtri(p / 100.0)) <= ends[1]]
    layout: Json = {
        "hovermode": "closest",
        "showlegend": True,
        "xaxis": {
            "title": {"text": say("share at least as positive (%), normal scale")},
            "tickvals": [float(ndtri(percent / 100.0)) for percent in ticks],
            "ticktext": [number(p, 0 if p in (1, 99) or 1 < p < 99 else 2) for p in ticks],
            "range": list(ends),
        },
        "yaxis": {"title": {"text": say("potential (mV CSE)")}, "range": [low, high]},
        "shapes": [
            *(class_line("y", value) for value in (PASSIVE_ABOVE_MV, ACTIVE_BELOW_MV)),
            *threshold_shapes("y", mixture),
        ],
        "annotations": threshold_words("y", mixture, (low, high)),
    }
    return Figure(
        f"cumulative-{k + 1}",
        sentences(
            [
                say(
                    "Cumulative frequency of the valid readings, plotting position k / (n + 1). "
                    "Dashed: the class boundaries of ASTM C876. One straight line is one "
                    "population; a bend tells of passive and active steel side by side."
                ),
                curves_caption(mixture),
                say(
                    "Of {n} readings {drawn} are drawn, more towards the ends and all at both.",
                    n=number(len(order), 0),
                    drawn=number(len(kept), 0),
                )
                if len(kept) < len(order)
                else "",
            ]
        ),
        say("Cumulative frequency diagram of {n} potentials.", n=number(len(order), 0)),
        [_ordered(evaluated, order[kept], z[kept], shares[kept]), *_lines(evaluated, ends)],
        layout,
        380,
    )


def _kept(z: Vector) -> Indices:
    """Indices of ascending normal scores (n,) that are evenly spread over the axis."""
    if len(z) <= MOST_DRAWN:
        return np.arange(len(z))
    nearest = np.searchsorted(z, np.linspace(z[0], z[-1], MOST_DRAWN))
    return np.unique(np.clip(nearest, 0, len(z) - 1))


def _ordered(evaluated: SurfaceFindings, order: Indices, z: Vector, shares: Vector) -> Json:
    """The readings on the scale, each with the shape and colour of its class."""
    assessed = evaluated.assessed
    mv = millivolts(assessed.readings.potential_v[order])
    styles = [ASTM_STYLES[ASTM_CLASSES[code]] for code in assessed.astm[order]]
    size = next(size for most, size in SIZES_PX if len(order) <= most)
    return {
        "type": "scatter",
        "mode": "lines+markers" if len(order) <= SIZES_PX[0][0] else "markers",
        "name": say("readings"),
        "x": z.tolist(),
        "y": mv.tolist(),
        "line": {"color": MUTED, "width": 1},
        "marker": {
            "size": size,
            "symbol": [style.symbol for style in styles],
            "color": [style.colour for style in styles],
            "line": {"width": 1 if size > SIZES_PX[-1][1] else 0.3, "color": INK},
        },
        "customdata": [
            say(
                "{label}: {potential} mV at {share} %",
                label=words(str(label)),
                potential=number(potential, 0),
                share=number(100.0 * share, 1),
            )
            for label, potential, share in zip(
                assessed.readings.labels[order], mv.tolist(), shares.tolist(), strict=True
            )
        ],
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def _lines(evaluated: SurfaceFindings, ends: tuple[float, float]) -> list[Json]:
    """The populations on the probability scale: one normal population is a straight line."""
    from scipy.special import ndtri

    low, high = _room(evaluated)
    mv = np.linspace(low, high, CURVE_POINTS)
    traces = []
    for curve in curves_of(evaluated.assessed.summary):
        with np.errstate(divide="ignore"):
            z = ndtri(curve.above(mv))
        shown = (z >= ends[0]) & (z <= ends[1])
        traces.append(curve_trace(curve.style, z[shown], mv[shown]))
    return traces


def _room(evaluated: SurfaceFindings) -> tuple[float, float]:
    mv = millivolts(evaluated.assessed.readings.potential_v[evaluated.assessed.readings.valid])
    return potential_range((float(mv.min()), float(mv.max())))
