"""Colours of all figures: each stands for one meaning on the whole page.

After Okabe & Ito, Color Universal Design (2008), with darker blue and vermilion and a bluer purple,
so that each pair in a figure can be distinguished with all common kinds of colour blindness. No
meaning is shown by colour alone: lines differ in dash, classes in marker shape, verdicts in words.
"""

from __future__ import annotations

from dataclasses import dataclass
from itertools import cycle
from typing import Any

from inspect_cli.reporting.words.text import Text, number, say
from inspect_cli.schema.modes import ModeTable, Phase

INK = "#1f2328"
MUTED = "#59636e"
RULE = "#d1d9e0"
GRID = "#e8ecf0"
PAPER = "#ffffff"
CONTACT_SHADE = "rgba(89, 99, 110, 0.13)"

BLACK = "#000000"
ORANGE = "#e69f00"
SKY_BLUE = "#56b4e9"
GREEN = "#009e73"
BLUE = "#00639f"
VERMILION = "#cc5500"
PURPLE = "#c77aab"

FONT = 'system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, sans-serif'


@dataclass(frozen=True)
class LineStyle:
    """How a signal is drawn in every figure, with the name that the legend gives it."""

    label: Text
    colour: str
    dash: str = "solid"
    width: float = 1.4


REFERENCE = LineStyle(say("reference"), INK, "dot", 1.3)
TIP = LineStyle(say("tool's tip"), "#7fceb9", "solid", 1.0)
ESTIMATE = LineStyle(say("estimate"), BLUE, "solid", 1.4)
TRUTH = LineStyle(say("truth"), GREEN, "solid", 1.8)
SENSOR = LineStyle(say("load cell"), PURPLE, "solid", 1.2)
COMMAND = LineStyle(say("command"), MUTED, "dot", 1.0)
# A difference has the colour of what it is taken from.
TRACKING_ERROR = LineStyle(say("truth − reference"), GREEN, "solid", 1.4)
BELIEVED_ERROR = LineStyle(say("estimate − reference"), BLUE, "solid", 1.4)
ESTIMATION_ERROR = LineStyle(say("estimate − truth"), BLUE, "solid", 1.2)
CORD = LineStyle(say("cord (truth)"), GREEN, "solid", 1.8)
SENSOR_RAW = LineStyle(say("wall sensor, raw"), "#e3c3d5", "solid", 0.7)
SENSOR_FILTERED = LineStyle(say("wall sensor, filtered"), PURPLE, "solid", 1.6)
TRUE_SURFACE = LineStyle(say("true surface"), MUTED, "solid", 3.0)
SEEN_SURFACE = LineStyle(say("surface as seen"), ORANGE, "solid", 1.2)
SATURATED = LineStyle(say("saturated"), VERMILION, "solid", 1.0)


TRIALS = ((BLUE, "solid"), (VERMILION, "dash"), (GREEN, "dashdot"), (PURPLE, "longdash"))
"""Colours and dashes of repeated trials, by repetition index; the list repeats."""


def trial_style(trial: int) -> LineStyle:
    """How a trial is drawn, by its number from 0."""
    colour, dash = TRIALS[trial % len(TRIALS)]
    return LineStyle(say("trial {k}", k=number(trial + 1, 0)), colour, dash, 1.5)


@dataclass(frozen=True)
class ClassStyle:
    """How a class of points is drawn."""

    label: Text
    colour: str
    symbol: str


ASTM_STYLES = {
    "passive": ClassStyle(say("passive"), SKY_BLUE, "circle"),
    "uncertain": ClassStyle(say("uncertain"), ORANGE, "square"),
    "active": ClassStyle(say("active"), VERMILION, "diamond"),
}
CORROSION_STYLES = {
    "none": ClassStyle(say("not indicated"), SKY_BLUE, "circle"),
    "possible": ClassStyle(say("possible"), ORANGE, "square"),
    "active": ClassStyle(say("active"), VERMILION, "diamond"),
}
READ_STYLE = ClassStyle(say("reading"), BLUE, "circle")
"""Of valid readings that have no class."""
INVALID_STYLE = ClassStyle(say("invalid reading"), INK, "x-thin")

PHASE_COLOURS: dict[Phase, tuple[str, ...]] = {
    Phase.GROUND: ("#c4ccd4",),
    Phase.NEAR_GROUND: ("#8c96a0",),
    Phase.FREE: (SKY_BLUE, GREEN),
    Phase.NEAR: (BLUE,),
    Phase.CONTACT: (INK, PURPLE),
    Phase.PERCHED: (ORANGE,),
    Phase.SAFE: (VERMILION,),
}
"""Colours of a phase's modes, in the order of the vehicle's table, and from the first again."""


def mode_colours(modes: ModeTable) -> dict[str, str]:
    """The colour of each mode, by its name."""
    colours: dict[str, str] = {}
    for phase, of_phase in PHASE_COLOURS.items():
        names = [row.name for row in modes.modes if row.phase is phase]
        colours |= dict(zip(names, cycle(of_phase), strict=False))
    return colours


POTENTIAL_STOPS = {
    "passive": ("#edf5fb", "#93c7ea"),
    "uncertain": ("#f8dd9b", "#e69f00"),
    "active": ("#cc5500", "#5e2600"),
}
"""Colours of a potential map from a class's least to its most negative potential; they darken
towards corrosion, so that the map keeps its order when printed in grey."""

ERROR_STOPS = ((0.0, "#f4f8fc"), (0.35, "#b3d3ea"), (0.7, "#4a90c4"), (1.0, "#0b3c6b"))
"""Colours of a map of standard errors, from none to the largest: one hue that darkens."""


def css_variables() -> str:
    """The colours as CSS variables for the style sheet."""
    colours = {
        "ink": INK,
        "muted": MUTED,
        "rule": RULE,
        "grid": GRID,
        "paper": PAPER,
        "accent": BLUE,
        "good": GREEN,
        "bad": VERMILION,
        "warn": ORANGE,
        "passive": SKY_BLUE,
        "uncertain": ORANGE,
        "active": VERMILION,
    }
    lines = "".join(f"--{name}: {colour};" for name, colour in colours.items())
    return f":root{{{lines}--font: {FONT};}}\n"


def plot_template() -> dict[str, Any]:
    """The defaults of every figure, in plotly's own form of a template."""
    axis = {
        "gridcolor": GRID,
        "linecolor": RULE,
        "zeroline": False,
        "ticks": "outside",
        "tickcolor": RULE,
        "ticklen": 4,
        "automargin": True,
        "title": {"standoff": 6, "font": {"size": 12, "color": MUTED}},
        "tickfont": {"size": 11, "color": MUTED},
    }
    scene_axis = {"gridcolor": RULE, "backgroundcolor": "#f6f8fa", "zeroline": False}
    layout = {
        "font": {"family": FONT, "size": 12, "color": INK},
        "paper_bgcolor": PAPER,
        "plot_bgcolor": PAPER,
        "margin": {"l": 56, "r": 12, "t": 34, "b": 42},
        "hoverlabel": {"font": {"family": FONT, "size": 12}},
        "legend": {
            "orientation": "h",
            "x": 0,
            "xanchor": "left",
            "y": 1,
            "yanchor": "bottom",
            "font": {"size": 12},
        },
        "modebar": {"bgcolor": "rgba(255,255,255,0.8)", "color": MUTED, "activecolor": BLUE},
        "xaxis": axis,
        "yaxis": axis,
        "scene": {"xaxis": scene_axis, "yaxis": scene_axis, "zaxis": scene_axis},
    }
    return {"layout": layout}
