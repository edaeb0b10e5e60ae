"""How lines and markers look: plotly's dashes and symbols as matplotlib has them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.lines import Line2D
from matplotlib.markers import MarkerStyle

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.paper.plot_axes import column
from inspect_cli.reporting.paper.plot_labels import points
from inspect_cli.reporting.paper.plot_text import rgba
from inspect_cli.spatial.arrays import Vector

DASHES: dict[str, Any] = {
    "solid": "solid",
    "dot": (0, (1.2, 1.6)),
    "dash": (0, (5, 2.5)),
    "longdash": (0, (9, 3)),
    "dashdot": (0, (5, 2, 1.2, 2)),
    "longdashdot": (0, (9, 3, 1.2, 3)),
}
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
THIN_SYMBOLS: dict[str, Any] = {
    "x-thin": "x",
    "cross-thin": "+",
    "line-ns": "|",
    "line-ew": "_",
    "asterisk": (6, 2, 0),
}
DIAMOND = 0.72
"""Matplotlib's diamond is as wide as its side's square would be long."""


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


def each(value: Any, n: int) -> list[Any]:
    """A setting for each of ``n`` points, given once for all or as a column."""
    if isinstance(value, list | tuple | dict):
        cells = column(value)
        return [*cells, *[None] * (n - len(cells))][:n]
    return [value] * n


def modes_of(trace: Json) -> set[str]:
    """What a scatter trace draws: lines, markers, text.

    Raises:
        ValueError: the mode is none of these.
    """
    default = "lines+markers" if len(column(trace.get("y"))) < 20 else "lines"
    modes = set(str(trace.get("mode", default)).split("+"))
    if not modes <= {"lines", "markers", "text", "none"}:
        raise ValueError(f"no drawing on paper is known for the mode “{trace['mode']}”")
    return modes


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


def draw_markers(ax: Axes, trace: Json, x: Vector, y: Vector) -> None:
    """The markers at the points that are there, alike ones together."""
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


def legend_handle(trace: Json) -> Line2D:
    """The symbol before the trace's name in the legend."""
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
