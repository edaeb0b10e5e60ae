"""How the potentials are distributed: cumulative frequency and histogram, with the populations."""

from __future__ import annotations

import math

import numpy as np

from inspect_cli.assessment.classes import ASTM_CLASSES, NO_CLASS, millivolts
from inspect_cli.reporting.evaluated import Evaluated
from inspect_cli.reporting.figure import Figure, Json, numbers, words
from inspect_cli.reporting.palette import ASTM_STYLES, INK, MUTED, LineStyle
from inspect_cli.reporting.places import Indices
from inspect_cli.reporting.populations import BAND, BAND_EDGE, curves_of, threshold_text
from inspect_cli.reporting.potential_scale import (
    ACTIVE_BELOW_MV,
    PASSIVE_ABOVE_MV,
    class_line,
    potential_range,
)
from inspect_cli.reporting.text import Text, number, say, sentences
from inspect_cli.schema.assessment import MixtureFindings
from inspect_cli.spatial.arrays import Vector

PERCENTS = (0.01, 0.1, 1, 2, 5, 10, 20, 30, 50, 70, 80, 90, 95, 98, 99, 99.9, 99.99)
MOST_DRAWN = 2000
SIZES_PX = ((100, 9), (500, 6), (MOST_DRAWN, 4))
BINS_MV = (5.0, 10.0, 25.0, 50.0)
"""Widths whose edges fall on the boundaries of the classes."""
MOST_BINS = 40
CURVE_POINTS = 241


def cumulative_figure(k: int, evaluated: Evaluated) -> Figure | None:
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
            *_threshold_shapes("y", mixture),
        ],
        "annotations": _threshold_words("y", mixture, (low, high)),
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
                _told_of_the_curves(mixture),
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
    """Of normal scores (n,), ascending, those that are evenly spread over the scale's axis."""
    if len(z) <= MOST_DRAWN:
        return np.arange(len(z))
    nearest = np.searchsorted(z, np.linspace(z[0], z[-1], MOST_DRAWN))
    return np.unique(np.clip(nearest, 0, len(z) - 1))


def _ordered(evaluated: Evaluated, order: Indices, z: Vector, shares: Vector) -> Json:
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


def _lines(evaluated: Evaluated, ends: tuple[float, float]) -> list[Json]:
    """The populations on the probability scale: one normal population is a straight line."""
    from scipy.special import ndtri

    low, high = _room(evaluated)
    mv = np.linspace(low, high, 4 * CURVE_POINTS)
    traces = []
    for curve in curves_of(evaluated.assessed.summary):
        with np.errstate(divide="ignore"):
            z = ndtri(curve.above(mv))
        shown = (z >= ends[0]) & (z <= ends[1])
        traces.append(_line(curve.style, z[shown], mv[shown]))
    return traces


def histogram_figure(k: int, evaluated: Evaluated) -> Figure | None:
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
    traces += [_line(style, at, y) for style, y in curves]
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
            *_threshold_shapes("x", mixture),
        ],
        "annotations": _threshold_words("x", mixture, (float(at[0]), float(at[-1]))),
    }
    caption = say("Histogram of the valid readings. Dashed: the class boundaries of ASTM C876.")
    return Figure(
        f"histogram-{k + 1}",
        sentences([caption, _told_of_the_curves(mixture)]),
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


def _line(style: LineStyle, x: Vector, y: Vector) -> Json:
    return {
        "type": "scatter",
        "mode": "lines",
        "name": style.label,
        "x": numbers(x),
        "y": numbers(y),
        "line": {"color": style.colour, "dash": style.dash, "width": style.width},
        "hoverinfo": "skip",
    }


def _room(evaluated: Evaluated) -> tuple[float, float]:
    mv = millivolts(evaluated.assessed.readings.potential_v[evaluated.assessed.readings.valid])
    return potential_range((float(mv.min()), float(mv.max())))


def _threshold_shapes(axis: str, mixture: MixtureFindings) -> list[Json]:
    """The threshold as a line, its standard error to both sides as a band."""
    mv, error = mixture.threshold_mv, mixture.threshold_error_mv
    if mv is None:
        return []
    line = class_line(axis, mv) | {"line": {"color": BAND_EDGE, "width": 1.4}}
    if error is None:
        return [line]
    band = class_line(axis, mv) | {
        "type": "rect",
        f"{axis}0": mv - error,
        f"{axis}1": mv + error,
        "fillcolor": BAND,
        "line": {"width": 0},
    }
    return [band, line]


def _threshold_words(axis: str, mixture: MixtureFindings, ends: tuple[float, float]) -> list[Json]:
    mv = mixture.threshold_mv
    if mv is None:
        return []
    base: Json = {
        "text": threshold_text(mixture),
        "showarrow": False,
        "font": {"size": 11, "color": BAND_EDGE},
        "bgcolor": "rgba(255, 255, 255, 0.75)",
    }
    if axis == "y":
        place = {"xref": "paper", "x": 0.01, "xanchor": "left", "yref": "y", "y": mv}
        return [{**base, **place, "yanchor": "bottom", "yshift": 3}]
    side, shift = ("right", -4) if 2.0 * mv > sum(ends) else ("left", 4)
    place = {"xref": "x", "x": mv, "xanchor": side, "yref": "paper", "y": 0.99}
    return [{**base, **place, "yanchor": "top", "xshift": shift}]


def _told_of_the_curves(mixture: MixtureFindings) -> Text:
    if mixture.active is not None:
        return say(
            "Curves: the two normal populations and their sum, fitted by maximum likelihood; the "
            "band is the threshold between them with its standard error."
        )
    if mixture.verdict is not None:
        return say("Solid: a single normal population; a second one is not called for.")
    return ""
