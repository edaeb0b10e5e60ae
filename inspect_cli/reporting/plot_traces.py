"""Traces of plotly drawn by matplotlib: lines, markers, words, bars, contours and fields.

What a screen shows under the pointer has no place on paper. A type, a symbol or a mode that is not
known here raises, so that nothing vanishes from a report unseen.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle

from inspect_cli.reporting.figure import Json
from inspect_cli.reporting.palette import INK
from inspect_cli.reporting.plot_axes import Axis, column
from inspect_cli.reporting.plot_labels import font_points, points, write
from inspect_cli.reporting.plot_text import rgba
from inspect_cli.spatial.arrays import Vector

DASHES = {
    "solid": "solid",
    "dot": (0, (1.2, 1.6)),
    "dash": (0, (5, 2.5)),
    "longdash": (0, (9, 3)),
    "dashdot": (0, (5, 2, 1.2, 2)),
    "longdashdot": (0, (9, 3, 1.2, 3)),
}
STEPS = {"linear": "default", "hv": "steps-post", "vh": "steps-pre", "hvh": "steps-mid"}
FILL_STEPS = {"hv": "post", "vh": "pre", "hvh": "mid"}
SYMBOLS = {
    "circle": "o",
    "square": "s",
    "diamond": "D",
    "diamond-tall": "d",
    "cross": "P",
    "x": "X",
    "triangle-up": "^",
    "triangle-down": "v",
    "triangle-left": "<",
    "triangle-right": ">",
    "pentagon": "p",
    "hexagon": "h",
    "octagon": "8",
    "star": "*",
    "arrow": "^",
    "arrow-up": "^",
    "arrow-down": "v",
}
THIN_SYMBOLS = {
    "x-thin": "x",
    "cross-thin": "+",
    "line-ns": "|",
    "line-ew": "_",
    "asterisk": (6, 2, 0),
}
DIAMOND = 0.72
"""Matplotlib's diamond is as wide as its side's square would be long."""
SIDES = {"left": "right", "center": "center", "right": "left"}
HEIGHTS = {"top": "bottom", "middle": "center", "bottom": "top"}
FILL_OPACITY = 0.5


@dataclass(frozen=True)
class Marks:
    """The markers of a trace, each with its own symbol, size, colour and angle."""

    symbols: list[str]
    sizes: list[float]
    colours: list[Any]
    edge: Any
    edge_width: float
    angles: list[float]

    def marker(self, k: int) -> tuple[MarkerStyle, bool, bool]:
        """Shape of the k-th, whether it is a mere line, and whether it is open."""
        name = self.symbols[k]
        base, is_open = name.removesuffix("-open"), name.endswith("-open")
        if base in THIN_SYMBOLS:
            return MarkerStyle(THIN_SYMBOLS[base]), True, is_open
        if base not in SYMBOLS:
            raise ValueError(f"no marker for paper is known for the symbol “{name}”")
        return MarkerStyle(SYMBOLS[base]).rotated(deg=self.angles[k]), False, is_open

    def points(self, k: int) -> float:
        """Diameter of the k-th."""
        scale = DIAMOND if self.symbols[k].startswith("diamond") else 1.0
        return scale * points(self.sizes[k])


def is_shown(trace: Json) -> bool:
    """Whether a screen draws it before anybody has touched the legend."""
    return trace.get("visible", True) is True


def each(value: Any, n: int) -> list[Any]:
    """A setting for each of ``n`` points, be it given once or as a column."""
    if isinstance(value, list | tuple | dict):
        cells = column(value)
        return [*cells, *[None] * (n - len(cells))][:n]
    return [value] * n


def modes_of(trace: Json) -> set[str]:
    """What a scatter trace draws: lines, markers, text.

    Raises:
        ValueError: it is told to draw something else.
    """
    default = "lines+markers" if len(column(trace.get("y"))) < 20 else "lines"
    modes = set(str(trace.get("mode", default)).split("+"))
    if not modes <= {"lines", "markers", "text", "none"}:
        raise ValueError(f"no drawing on paper is known for the mode “{trace['mode']}”")
    return modes


def scatter(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    """Lines, what they enclose, markers and words."""
    modes = modes_of(trace)
    if trace.get("fill", "none") != "none":
        _fill(ax, trace, x, y)
    if "lines" in modes:
        _lines(ax, trace, x, y)
    _errors(ax, trace, x, y)
    if "markers" in modes and trace.get("opacity", 1.0) > 0.0:
        _markers(ax, trace, x, y)
    if "text" in modes:
        _texts(ax, trace, x, y)


def line_style(trace: Json) -> dict[str, Any]:
    """Colour, width and dash of a trace's line, for matplotlib."""
    line = trace.get("line", {})
    opacity = float(trace.get("opacity", 1.0))
    dash = str(line.get("dash", "solid"))
    if dash not in DASHES:
        raise ValueError(f"no line on paper is known for the dash “{dash}”")
    return {
        "color": rgba(str(line.get("color", INK)), opacity),
        "linewidth": max(0.4, points(float(line.get("width", 2.0)))),
        "linestyle": DASHES[dash],
    }


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
            before = ax.lines[-1].get_xydata()
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
        ax.errorbar(
            x,
            y,
            **{f"{axis}err": np.vstack([np.asarray(below, dtype=float), above])},
            fmt="none",
            ecolor=rgba(str(own) if isinstance(own, str) else INK),
            elinewidth=points(float(bars.get("thickness", 1.5))),
            capsize=points(float(bars.get("width", 4.0))),
            zorder=2.4,
        )


def marks_of(trace: Json, x: Vector, y: Vector) -> Marks:
    """The markers of a trace; a colour that is a number is looked up on its scale."""
    marker = trace.get("marker", {})
    n = len(x)
    opacity = float(trace.get("opacity", 1.0)) * float(marker.get("opacity", 1.0))
    default = str(trace.get("line", {}).get("color", INK))
    colours = [
        rgba(str(c), opacity) if isinstance(c, str) else rgba(default, 0.0)
        for c in each(marker.get("color", default), n)
    ]
    angles = [float(a or 0.0) for a in each(marker.get("angle", 0.0), n)]
    if marker.get("angleref") == "previous":
        angles = _headings(x, y)
    edge = marker.get("line", {})
    return Marks(
        [str(s or "circle") for s in each(marker.get("symbol", "circle"), n)],
        [float(s or 0.0) for s in each(marker.get("size", 6.0), n)],
        colours,
        rgba(str(edge.get("color", default)), opacity),
        points(float(edge.get("width", 0.0))),
        angles,
    )


def _headings(x: Vector, y: Vector) -> list[float]:
    """The direction from each point's predecessor to it, degrees from up; 0 where there is none."""
    ways = np.column_stack([np.diff(x), np.diff(y)])
    turned = np.degrees(np.arctan2(ways[:, 1], ways[:, 0])) - 90.0
    return [0.0, *np.nan_to_num(turned).tolist()]


def _markers(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    marks = marks_of(trace, x, y)
    alike: dict[tuple[str, float], list[int]] = {}
    for k in np.flatnonzero(np.isfinite(x) & np.isfinite(y)):
        if marks.sizes[k] > 0.0 and (marks.colours[k][3] > 0.0 or marks.edge[3] > 0.0):
            alike.setdefault((marks.symbols[k], marks.angles[k]), []).append(int(k))
    for rows in alike.values():
        shape, thin, is_open = marks.marker(rows[0])
        colours = [marks.colours[k] for k in rows]
        edges: dict[str, Any] = {"edgecolors": [marks.edge], "linewidths": marks.edge_width}
        if thin or is_open:
            edges = {"linewidths": max(marks.edge_width, 1.0)}
            edges |= {"facecolors": "none", "edgecolors": colours} if is_open and not thin else {}
        if not (is_open and not thin):
            edges["facecolors"] = colours
        ax.scatter(
            x[rows],
            y[rows],
            s=[marks.points(k) ** 2 for k in rows],
            marker=shape,
            clip_on=bool(trace.get("cliponaxis", True)),
            zorder=4.0,
            **(edges if not thin else {"c": colours, "linewidths": edges["linewidths"]}),
        )


def _texts(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    n = len(x)
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
        write(
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


def legend_handle(trace: Json) -> Line2D:
    """What stands before the trace's name in the legend."""
    if trace["type"] == "bar":
        marker = trace.get("marker", {})
        colour = rgba(str(each(marker.get("color", INK), 1)[0]))
        face = "white" if marker.get("pattern") else colour
        return Line2D([], [], linestyle="", marker="s", ms=6, mfc=face, mec=colour)
    modes = modes_of(trace)
    style: dict[str, Any] = line_style(trace) if "lines" in modes else {"linestyle": ""}
    x = np.zeros(max(1, len(column(trace.get("x")))))
    if "markers" in modes and marks_of(trace, x, x).sizes[0] > 0.0:
        marks = marks_of(trace, x, x)
        shape, thin, is_open = marks.marker(0)
        style |= {"marker": shape, "markersize": min(6.5, marks.points(0))}
        style |= {"markerfacecolor": "none" if is_open else marks.colours[0]}
        style |= {"markeredgecolor": marks.colours[0] if thin or is_open else marks.edge}
        style |= {"markeredgewidth": max(marks.edge_width, 1.0 if thin or is_open else 0.0)}
    return Line2D([], [], **style)


def measure(trace: Json, x_axis: Axis, y_axis: Axis) -> tuple[Vector, Vector]:
    """Where the points of a trace stand; its axes are widened by them."""
    x, y = x_axis.places(trace.get("x")), y_axis.places(trace.get("y"))
    if trace["type"] == "bar":
        _take_bars(trace, x, y, x_axis, y_axis)
        return x, y
    markers = trace["type"] == "scatter" and "lines" != "+".join(sorted(modes_of(trace)))
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


def band_colours(scale: Sequence[Sequence[Any]], shares: Vector) -> list[Any]:
    """Colours at shares from 0 to 1 of a plotly colour scale, linear in RGB between its stops."""
    stops = [(float(share), np.array(rgba(str(colour)))) for share, colour in scale]
    found = []
    for share in np.clip(shares, stops[0][0], stops[-1][0]):
        (a, first), (b, second) = next(
            (p, q) for p, q in pairwise(stops) if p[0] <= share <= q[0]
        )
        found.append(first if b == a else first + (share - a) / (b - a) * (second - first))
    return found
