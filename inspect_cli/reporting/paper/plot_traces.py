"""Traces of plotly drawn by matplotlib: lines, markers, words, bars, contours and fields.

What a screen shows under the pointer has no place on paper. A type, a symbol or a mode that is not
known here raises, so that nothing vanishes from a report unseen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.text import Annotation

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.paper.plot_axes import Axis, column
from inspect_cli.reporting.paper.plot_labels import font_points, points, write
from inspect_cli.reporting.paper.plot_marks import draw_markers, each, line_style, modes_of
from inspect_cli.reporting.paper.plot_text import rgba
from inspect_cli.spatial.arrays import Vector

STEPS: dict[str, Any] = {
    "linear": "default",
    "hv": "steps-post",
    "vh": "steps-pre",
    "hvh": "steps-mid",
}
FILL_STEPS: dict[str, Any] = {"hv": "post", "vh": "pre", "hvh": "mid"}
SIDES = {"left": "right", "center": "center", "right": "left"}
HEIGHTS = {"top": "bottom", "middle": "center", "bottom": "top"}
FILL_OPACITY = 0.5


def is_shown(trace: Json) -> bool:
    """Whether the trace is visible before the reader uses the legend."""
    return trace.get("visible", True) is True


def scatter(ax: Axes, trace: Json, x: Vector, y: Vector) -> list[list[Annotation]]:
    """Lines, what they enclose, markers and words; returns the words, label by label."""
    modes = modes_of(trace)
    if trace.get("fill", "none") != "none":
        _fill(ax, trace, x, y)
    if "lines" in modes:
        _lines(ax, trace, x, y)
    _errors(ax, trace, x, y)
    if "markers" in modes and trace.get("opacity", 1.0) > 0.0:
        draw_markers(ax, trace, x, y)
    return _texts(ax, trace, x, y) if "text" in modes else []


def _lines(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    shape = str(trace.get("line", {}).get("shape", "linear"))
    if trace.get("connectgaps"):
        known = np.isfinite(x) & np.isfinite(y)
        x, y = x[known], y[known]
    ax.plot(
        x,
        y,
        drawstyle=STEPS.get(shape, "default"),
        solid_joinstyle="round",
        solid_capstyle="butt",
        zorder=2.5,
        **line_style(trace),
    )


def _fill(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    fill = str(trace["fill"])
    line = trace.get("line", {})
    own = rgba(str(line.get("color", INK)), FILL_OPACITY)
    colour = rgba(str(trace["fillcolor"])) if "fillcolor" in trace else own
    style: dict[str, Any] = {"facecolor": colour, "linewidth": 0.0, "zorder": 1.5}
    step = FILL_STEPS.get(str(line.get("shape", "linear")))
    match fill:
        case "tozeroy":
            ax.fill_between(x, y, 0.0, step=step, **style)
        case "tozerox":
            ax.fill_betweenx(y, x, 0.0, step=step, **style)
        case "toself":
            ax.fill(x, y, **style)
        case "tonexty":
            before = np.asarray(ax.lines[-1].get_xydata())
            if len(before) != len(x) or not np.allclose(before[:, 0], x, equal_nan=True):
                ring = np.vstack([before, np.column_stack([x, y])[::-1]])
                ax.fill(ring[:, 0], ring[:, 1], **style)
            else:
                ax.fill_between(x, before[:, 1], y, step=step, **style)
        case _:
            raise ValueError(f"no filling on paper is known for “{fill}”")


def _errors(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    for axis in ("x", "y"):
        bars = trace.get(f"error_{axis}")
        if not bars or not bars.get("visible", True):
            continue
        above = np.array([math.nan if e is None else float(e) for e in column(bars["array"])])
        below = column(bars.get("arrayminus")) or list(above)
        own = bars.get("color") or trace.get("marker", {}).get("color", INK)
        lengths: dict[str, Any] = {f"{axis}err": np.vstack([np.asarray(below, dtype=float), above])}
        ax.errorbar(
            x,
            y,
            **lengths,
            fmt="none",
            ecolor=rgba(str(own) if isinstance(own, str) else INK),
            elinewidth=points(float(bars.get("thickness", 1.5))),
            capsize=points(float(bars.get("width", 4.0))),
            zorder=2.4,
        )


def _texts(ax: Axes, trace: Json, x: Vector, y: Vector) -> list[list[Annotation]]:
    n, written = len(x), []
    font = trace.get("textfont", {})
    sizes = each(font.get("size", 12.0), n)
    colours = each(font.get("color", INK), n)
    positions = each(trace.get("textposition", "middle center"), n)
    room = [0.5 * points(float(s or 0.0)) + 1.0 for s in each(_text_room(trace), n)]
    for k, label in enumerate(each(trace.get("text", ""), n)):
        if not label or not (math.isfinite(x[k]) and math.isfinite(y[k])):
            continue
        height, side = str(positions[k]).split(" ")
        dx = room[k] * {"left": -1, "center": 0, "right": 1}[side]
        dy = room[k] * {"bottom": -1, "middle": 0, "top": 1}[height]
        pieces = write(
            ax,
            label,
            (float(x[k]), float(y[k])),
            shift=(dx, dy),
            ha=SIDES[side],
            va=HEIGHTS[height],
            size=font_points(float(sizes[k])),
            colour=rgba(str(colours[k])),
            halo="shadow" in font,
        )
        written.append(pieces)
    return written


def _text_room(trace: Json) -> Any:
    return trace.get("marker", {}).get("size", 0.0) if "marker" in trace else 4.0


def bars(ax: Axes, trace: Json, x: Vector, y: Vector, slot: tuple[float, float]) -> None:
    """Bars; ``slot`` is how far from its place a bar begins, and how wide it is."""
    marker = trace.get("marker", {})
    edge = marker.get("line", {})
    style: dict[str, Any] = {
        "color": [rgba(str(c or INK)) for c in each(marker.get("color", INK), len(x))],
        "edgecolor": rgba(str(edge.get("color", INK)))
        if edge.get("width", 0.0) or marker.get("pattern")
        else "none",
        "linewidth": points(float(edge.get("width", 0.5 if marker.get("pattern") else 0.0))),
        "zorder": 2.0,
    }
    pattern = marker.get("pattern", {}).get("shape", "")
    if pattern:
        style |= {"hatch": 3 * str(pattern), "fill": False, "color": None}
        style["edgecolor"] = rgba(str(each(marker.get("color", INK), 1)[0]))
        style.pop("color")
    base = column(trace.get("base")) or 0.0
    if trace.get("orientation") == "h":
        ax.barh(y + slot[0], x, slot[1], left=base, align="edge", **style)
    else:
        ax.bar(x + slot[0], y, slot[1], bottom=base, align="edge", **style)


def slots(traces: Sequence[Json], layout: Json) -> Iterator[tuple[float, float]]:
    """Where the bars of each of the traces stand beside a category."""
    width = 1.0 - float(layout.get("bargap", 0.2))
    mode = str(layout.get("barmode", "group"))
    if mode not in ("group", "overlay"):
        raise ValueError(f"no bars on paper are known for the mode “{mode}”")
    for k in range(len(traces)):
        if mode == "overlay":
            yield -0.5 * width, width
        else:
            yield width * (k / len(traces) - 0.5), width / len(traces)


def measure(trace: Json, x_axis: Axis, y_axis: Axis) -> tuple[Vector, Vector]:
    """Coordinates of a trace's points; the ranges of its axes are extended to them."""
    x, y = x_axis.places(trace.get("x")), y_axis.places(trace.get("y"))
    if trace["type"] == "bar":
        _take_bars(trace, x, y, x_axis, y_axis)
        return x, y
    markers = trace["type"] == "scatter" and modes_of(trace) != {"lines"}
    n = min(len(x), len(y)) if trace["type"] == "scatter" else None
    x, y = x[:n], y[:n]
    x_axis.take(x, markers=markers)
    y_axis.take(y, markers=markers)
    if trace.get("fill") in ("tozeroy", "tozerox"):
        (y_axis if trace["fill"] == "tozeroy" else x_axis).take(np.zeros(1), markers=False)
    return x, y


def _take_bars(trace: Json, x: Vector, y: Vector, x_axis: Axis, y_axis: Axis) -> None:
    flat = trace.get("orientation") == "h"
    along, across, lengths = (x_axis, y_axis, x) if flat else (y_axis, x_axis, y)
    base = np.array(column(trace.get("base")) or [0.0], dtype=float)
    along.take(np.broadcast_to(base, lengths.shape).astype(float), markers=False)
    along.take(base + lengths, markers=False)
    places = y if flat else x
    across.take(places, markers=True)
