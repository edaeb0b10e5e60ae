"""Traces and shapes for the populations and their threshold in a diagram."""

from __future__ import annotations

from inspect_cli.reporting.figures.figure import Json, numbers
from inspect_cli.reporting.figures.palette import LineStyle
from inspect_cli.reporting.half_cell.populations import BAND, BAND_EDGE, threshold_text
from inspect_cli.reporting.half_cell.potential_scale import class_line
from inspect_cli.reporting.words.text import Text, say
from inspect_cli.schema.assessment import MixtureFindings
from inspect_cli.spatial.arrays import Vector


def curve_trace(style: LineStyle, x: Vector, y: Vector) -> Json:
    """A curve as it is drawn everywhere, with its name in the legend."""
    return {
        "type": "scatter",
        "mode": "lines",
        "name": style.label,
        "x": numbers(x),
        "y": numbers(y),
        "line": {"color": style.colour, "dash": style.dash, "width": style.width},
        "hoverinfo": "skip",
    }


def threshold_shapes(axis: str, mixture: MixtureFindings) -> list[Json]:
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


def threshold_words(axis: str, mixture: MixtureFindings, ends: tuple[float, float]) -> list[Json]:
    """The threshold in words, where it stands on the axis; ``ends`` are the axis's."""
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


def curves_caption(mixture: MixtureFindings) -> Text:
    """A sentence on the curves; empty if there are none."""
    if mixture.active is not None:
        return say(
            "Curves: the two normal populations and their sum, fitted by maximum likelihood; the "
            "band is the threshold between them with its standard error."
        )
    if mixture.verdict is not None:
        return say("Solid: a single normal population; a second one is not called for.")
    return ""
