"""Colours and words for half-cell potentials; the colour scale jumps at the class boundaries of
ASTM C876."""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from itertools import pairwise

from inspect_cli.assessment.classes import ACTIVE_BELOW_V, PASSIVE_ABOVE_V
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.figures.figure import Json, words
from inspect_cli.reporting.figures.palette import INK, POTENTIAL_STOPS
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Text, number, say, separated, together

PASSIVE_ABOVE_MV = 1e3 * PASSIVE_ABOVE_V
ACTIVE_BELOW_MV = 1e3 * ACTIVE_BELOW_V
TINY_MV = 1e-6
STEP_MV = 50.0
"""Step to which the ends of the scale are rounded, mV."""
LEAST_RANGE_MV = (-550.0, 0.0)


def potentials_of(points: Iterable[ReadPoint]) -> list[float]:
    """The valid potentials of points, mV."""
    return [p.point.potential_mv for p in points if p.point.potential_mv is not None]


def potential_range(values_mv: Iterable[float]) -> tuple[float, float]:
    """Ends of the scale, mV: at least ``LEAST_RANGE_MV``, and every potential within."""
    values = list(values_mv)
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


def colours(values_mv: Iterable[float], ends: tuple[float, float]) -> list[str]:
    """The colour of each potential on the scale between its ends, mV.

    Both boundaries belong to the class between them.
    """
    low, high = ends
    scale = colour_scale(low, high)
    within = (mv + TINY_MV if mv == ACTIVE_BELOW_MV else mv for mv in values_mv)
    return [_interpolated(scale, (mv - low) / (high - low)) for mv in within]


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


def colour_axis(ends: tuple[float, float]) -> Json:
    """A plotly colour axis for the potentials, its bar marked at the class boundaries."""
    low, high = ends
    return {
        "cmin": low,
        "cmax": high,
        "colorscale": colour_scale(low, high),
        "colorbar": lying_bar(" mV CSE", [low, ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV, high]),
    }


def lying_bar(unit: Text, ticks: Sequence[float]) -> Json:
    """A horizontal colour bar below the drawing, with ticks at given values."""
    return {
        "title": {"text": unit, "side": "right", "font": {"size": 11}},
        "tickvals": list(ticks),
        "orientation": "h",
        "x": 0.5,
        "len": 0.7,
        "y": 0,
        "yref": "container",
        "yanchor": "bottom",
        "thickness": 12,
        "outlinewidth": 0,
        "tickfont": {"size": 11},
    }


def hover_text(p: ReadPoint) -> Text:
    """The text that a figure shows for a valid reading under the pointer."""
    point = p.point
    return reading_text(
        point.label,
        point.potential_mv,
        point.astm_class,
        point.resistivity_ohm_m,
        point.corrosion,
    )


def reading_text(
    label: str,
    potential_mv: float | None,
    astm_class: str | None,
    resistivity_ohm_m: float | None,
    verdict: str | None,
) -> Text:
    """A valid reading and what it means, line by line."""
    lines: list[Text] = [
        say(
            "point {label}: {potential} mV CSE",
            label=words(label),
            potential=number(potential_mv, 0),
        ),
        together("ASTM C876: ", recorded(astm_class or NOTHING)),
        say("resistivity unknown")
        if resistivity_ohm_m is None
        else say("resistivity {resistivity} Ω·m", resistivity=number(resistivity_ohm_m, 0)),
        say("combined verdict: {verdict}", verdict=recorded(verdict or NOTHING)),
    ]
    return separated(lines, "<br>")


def class_line(axis: str, value: float) -> Json:
    """A dashed line across a diagram at a boundary of classes."""
    other = "y" if axis == "x" else "x"
    return {
        "type": "line",
        f"{axis}ref": axis,
        f"{axis}0": value,
        f"{axis}1": value,
        f"{other}ref": "paper",
        f"{other}0": 0,
        f"{other}1": 1,
        "line": {"color": INK, "width": 1, "dash": "dash"},
        "layer": "below",
    }
