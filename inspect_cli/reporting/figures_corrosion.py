"""Cumulative frequency of the potentials, and potential against resistivity."""

from __future__ import annotations

import math
from collections.abc import Sequence
from statistics import NormalDist

from inspect_cli.assessment.classes import SUSTAINS_CORROSION_OHM_M
from inspect_cli.reporting.figure import Figure, Json, words
from inspect_cli.reporting.palette import ASTM_STYLES, CORROSION_STYLES, INK, MUTED
from inspect_cli.reporting.points import ReadPoint
from inspect_cli.reporting.potential_scale import (
    ACTIVE_BELOW_MV,
    PASSIVE_ABOVE_MV,
    hover_text,
    potential_range,
)
from inspect_cli.reporting.text import number, say

PERCENTS = (1, 2, 5, 10, 20, 30, 50, 70, 80, 90, 95, 98, 99)
TEXT_SIDES = ("top center", "bottom center", "middle right", "middle left")
"""Taken in turn, so that the labels of equal readings do not cover each other."""
CLASS_LINE: Json = {"color": INK, "width": 1, "dash": "dash"}


def cumulative_figure(points: Sequence[ReadPoint]) -> Figure | None:
    """Potentials in order of size against their share, on a normal probability scale.

    The k-th of n values, counted from the least negative, stands at k / (n + 1), the plotting
    position that ASTM C876 gives for its cumulative frequency diagram. A straight line is one
    normal population; a bend tells of two.
    """
    valid = [p for p in points if p.point.potential_mv is not None]
    if not valid:
        return None
    ordered = sorted(valid, key=lambda p: -(p.point.potential_mv or 0.0))
    shares = [(k + 1) / (len(ordered) + 1) for k in range(len(ordered))]
    normal = NormalDist()
    least = min(0.02, shares[0])
    ends = [normal.inv_cdf(least) - 0.15, normal.inv_cdf(1.0 - least) + 0.15]
    trace: Json = {
        "type": "scatter",
        "mode": "lines+markers",
        "x": [normal.inv_cdf(share) for share in shares],
        "y": [p.point.potential_mv for p in ordered],
        "line": {"color": MUTED, "width": 1},
        "marker": {
            "size": 9,
            "symbol": [ASTM_STYLES[p.point.astm_class or "passive"].symbol for p in ordered],
            "color": [ASTM_STYLES[p.point.astm_class or "passive"].colour for p in ordered],
            "line": {"width": 1, "color": INK},
        },
        "customdata": [
            say(
                "{label}: {potential} mV at {share} %",
                label=words(p.point.label),
                potential=number(p.point.potential_mv, 0),
                share=number(100 * share, 1),
            )
            for p, share in zip(ordered, shares, strict=True)
        ],
        "hovertemplate": "%{customdata}<extra></extra>",
        "showlegend": False,
    }
    low, high = potential_range(valid)
    layout: Json = {
        "hovermode": "closest",
        "xaxis": {
            "title": {"text": say("share of readings at least as positive (%), normal scale")},
            "tickvals": [normal.inv_cdf(percent / 100.0) for percent in PERCENTS],
            "ticktext": [str(percent) for percent in PERCENTS],
            "range": ends,
        },
        "yaxis": {"title": {"text": say("potential (mV CSE)")}, "range": [low, high]},
        "shapes": [_boundary("y", value) for value in (PASSIVE_ABOVE_MV, ACTIVE_BELOW_MV)],
    }
    return Figure(
        "cumulative",
        say(
            "Cumulative frequency of the valid readings, plotting position k / (n + 1). Dashed: "
            "the class boundaries of ASTM C876. One straight line is one population; a bend tells "
            "of passive and active steel side by side."
        ),
        say("Cumulative frequency diagram of {n} potentials.", n=number(len(valid), 0)),
        [trace],
        layout,
        360,
    )


def resistivity_figure(points: Sequence[ReadPoint]) -> Figure | None:
    """Potential against resistivity with the regions of the combined rule."""
    known = [
        p
        for p in points
        if p.point.potential_mv is not None and (p.point.resistivity_ohm_m or 0.0) > 0.0
    ]
    if not known:
        return None
    traces = []
    for name, style in CORROSION_STYLES.items():
        own = [p for p in known if p.point.corrosion == name]
        if own:
            traces.append(
                {
                    "type": "scatter",
                    "mode": "markers+text",
                    "name": say("corrosion: {verdict}", verdict=style.label),
                    "x": [p.point.potential_mv for p in own],
                    "y": [p.point.resistivity_ohm_m for p in own],
                    "text": [words(p.point.label) if name != "none" else "" for p in own],
                    "textposition": [TEXT_SIDES[k % len(TEXT_SIDES)] for k in range(len(own))],
                    "textfont": {"size": 11},
                    "marker": {
                        "symbol": style.symbol,
                        "size": 11,
                        "color": style.colour,
                        "line": {"width": 1, "color": INK},
                    },
                    "customdata": [hover_text(p) for p in own],
                    "hovertemplate": "%{customdata}<extra></extra>",
                }
            )
    low, high = potential_range(known)
    layout: Json = {
        "hovermode": "closest",
        "showlegend": True,
        "xaxis": {"title": {"text": say("potential (mV CSE)")}, "range": [low, high]},
        "yaxis": {
            "title": {"text": say("resistivity (Ω·m), log scale")},
            "type": "log",
            "range": _decades(known),
            "tickvals": [m * 10**e for e in range(-1, 6) for m in (1, 2, 5)],
        },
        "shapes": [
            *(_boundary("x", value) for value in (PASSIVE_ABOVE_MV, ACTIVE_BELOW_MV)),
            _boundary("y", SUSTAINS_CORROSION_OHM_M),
            _active_region(low),
        ],
    }
    return Figure(
        "resistivity",
        say(
            "Potential against resistivity of the valid readings. Dashed: the boundaries of the "
            "combined rule; shaded: where it says active. 10 Ω·m are 1 kΩ·cm."
        ),
        say("Scatter of potential against resistivity of {n} readings.", n=number(len(known), 0)),
        traces,
        layout,
        360,
    )


def _boundary(axis: str, value: float) -> Json:
    other = "y" if axis == "x" else "x"
    return {
        "type": "line",
        f"{axis}ref": axis,
        f"{axis}0": value,
        f"{axis}1": value,
        f"{other}ref": "paper",
        f"{other}0": 0,
        f"{other}1": 1,
        "line": CLASS_LINE,
        "layer": "below",
    }


def _decades(points: Sequence[ReadPoint]) -> list[float]:
    """Ends of the logarithmic axis: all points, and room on both sides of the rule's boundary."""
    values = [p.point.resistivity_ohm_m or SUSTAINS_CORROSION_OHM_M for p in points]
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
