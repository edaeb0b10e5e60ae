"""Half-cell potentials in colour and in words; ASTM C876's classes are the scale's joints."""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise

from inspect_cli.assessment.classes import ACTIVE_BELOW_V, PASSIVE_ABOVE_V
from inspect_cli.reporting.figure import Json, words
from inspect_cli.reporting.palette import POTENTIAL_STOPS
from inspect_cli.reporting.points import ReadPoint
from inspect_cli.reporting.recorded import recorded
from inspect_cli.reporting.text import NOTHING, Text, number, say, separated, together

PASSIVE_ABOVE_MV = 1e3 * PASSIVE_ABOVE_V
ACTIVE_BELOW_MV = 1e3 * ACTIVE_BELOW_V
STEP_MV = 50.0
"""Interval of the contours; a whole number of them lies between the class boundaries."""
LEAST_RANGE_MV = (-550.0, 0.0)


def potential_range(points: Sequence[ReadPoint]) -> tuple[float, float]:
    """Ends of the scale, mV: at least ``LEAST_RANGE_MV``, and every valid reading within."""
    values = [p.point.potential_mv for p in points if p.point.potential_mv is not None]
    low, high = min([*values, LEAST_RANGE_MV[0]]), max([*values, LEAST_RANGE_MV[1]])
    return STEP_MV * math.floor(low / STEP_MV), STEP_MV * math.ceil(high / STEP_MV)


def colour_scale(low: float, high: float) -> list[tuple[float, str]]:
    """Plotly's colour scale from ``low`` to ``high`` mV: it jumps where the class changes."""
    edges = {
        "active": (low, ACTIVE_BELOW_MV),
        "uncertain": (ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV),
        "passive": (PASSIVE_ABOVE_MV, high),
    }
    return [
        ((edge - low) / (high - low), colour)
        for name, (bottom, top) in edges.items()
        for edge, colour in zip((bottom, top), reversed(POTENTIAL_STOPS[name]), strict=True)
    ]


def colours(points: Sequence[ReadPoint], everywhere: Sequence[ReadPoint]) -> list[str]:
    """The colour of each point on the scale that spans all points."""
    low, high = potential_range(everywhere)
    scale = colour_scale(low, high)
    return [
        _interpolated(scale, ((p.point.potential_mv or 0.0) - low) / (high - low)) for p in points
    ]


def _interpolated(scale: Sequence[tuple[float, str]], share: float) -> str:
    """Linear in RGB, as plotly does it; at a joint the more negative class wins."""
    (a, first), (b, second) = next(
        (lower, upper) for lower, upper in pairwise(scale) if lower[0] <= share <= upper[0]
    )
    way = 0.0 if b == a else (share - a) / (b - a)
    channels = ((int(first[k : k + 2], 16), int(second[k : k + 2], 16)) for k in (1, 3, 5))
    return "#" + "".join(f"{round(x + way * (y - x)):02x}" for x, y in channels)


def colour_bar(kind: str) -> Json:
    """An empty trace that makes plotly draw the colour axis's bar."""
    place = {axis: [None] for axis in ("xyz" if kind == "scatter3d" else "xy")}
    return {
        "type": kind,
        "mode": "markers",
        **place,
        "marker": {"color": [PASSIVE_ABOVE_MV], "coloraxis": "coloraxis", "showscale": True},
        "showlegend": False,
        "hoverinfo": "skip",
    }


def colour_axis(points: Sequence[ReadPoint]) -> Json:
    """A plotly colour axis for the potentials, its bar marked at the class boundaries."""
    low, high = potential_range(points)
    return {
        "cmin": low,
        "cmax": high,
        "colorscale": colour_scale(low, high),
        "colorbar": {
            "title": {"text": " mV CSE", "side": "right", "font": {"size": 11}},
            "tickvals": [low, ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV, high],
            "orientation": "h",
            "x": 0.5,
            "len": 0.7,
            "y": 0,
            "yref": "container",
            "yanchor": "bottom",
            "thickness": 12,
            "outlinewidth": 0,
            "tickfont": {"size": 11},
        },
    }


def hover_text(p: ReadPoint) -> Text:
    """What a figure says of a valid reading under the pointer."""
    point = p.point
    ohm_m = point.resistivity_ohm_m
    lines: list[Text] = [
        say(
            "point {label}: {potential} mV CSE",
            label=words(point.label),
            potential=number(point.potential_mv, 0),
        ),
        together("ASTM C876: ", recorded(point.astm_class or NOTHING)),
        say("resistivity unknown")
        if ohm_m is None
        else say("resistivity {resistivity} Ω·m", resistivity=number(ohm_m, 0)),
        say("combined verdict: {verdict}", verdict=recorded(point.corrosion or NOTHING)),
    ]
    return separated(lines, "<br>")
