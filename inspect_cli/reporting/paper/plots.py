"""Figures on paper: plotly's figures drawn as SVG by matplotlib.

The drawing is made of the figure's own traces and layout, so that paper shows what the screen
shows. Three-dimensional scenes are left to the screen. Where metres are as long across as they
are up, the drawing is to a round scale.
"""

from __future__ import annotations

import warnings
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from io import BytesIO
from typing import Any

import matplotlib.style
import numpy as np
from matplotlib.axes import Axes
from matplotlib.backends.backend_agg import FigureCanvasAgg
from matplotlib.figure import Figure as Sheet
from matplotlib.text import Annotation

from inspect_cli.reporting.figures.figure import Figure, Json
from inspect_cli.reporting.paper.plot_axes import Axis, axes_of, domain, limits, panels_of
from inspect_cli.reporting.paper.plot_fields import bar_scales, coloured, contour, heatmap
from inspect_cli.reporting.paper.plot_frame import (
    Paper,
    add_legend,
    add_remark,
    add_shape,
    draw_bar,
    plain_frame,
    set_ticks,
)
from inspect_cli.reporting.paper.plot_labels import thin_out
from inspect_cli.reporting.paper.plot_scale import (
    MapScale,
    draw_scale_bar,
    has_equal_scales,
    scale_for,
)
from inspect_cli.reporting.paper.plot_traces import bars, is_shown, measure, scatter, slots
from inspect_cli.reporting.words.language import Language
from inspect_cli.spatial.arrays import Vector

ON_SCREEN_ONLY = frozenset({"scatter3d", "surface", "mesh3d"})
DRAWN = frozenset({"scatter", "scattergl", "bar", "contour", "heatmap"})
MM_PER_PX = 0.2
"""Of a figure's height; it is as wide as the page has room for."""
MM_PER_INCH = 25.4
LEGEND_GAP_MM = 1.0
"""Above and below the legend."""
BAR_MM = 12.0
"""Height of a colour bar below the drawing with its ticks, mm."""
SCALE_BAR_MM = 9.0
STYLE: dict[str, Any] = {
    "font.family": ["DejaVu Sans"],
    "font.size": 7.0,
    "mathtext.fontset": "dejavusans",
    "svg.fonttype": "none",
    "svg.hashsalt": "inspect",
    "path.simplify": True,
    "path.simplify_threshold": 0.05,
    "hatch.linewidth": 0.6,
}


@dataclass(frozen=True)
class Plot:
    """A drawing as SVG, its size on paper, and its scale if it has one."""

    svg: bytes
    width_mm: float
    height_mm: float
    scale: MapScale | None = None


@dataclass
class Margins:
    """Around the panels, mm."""

    left: float = 14.0
    right: float = 4.0
    top: float = 4.0
    bottom: float = 10.0


def draw(
    figure: Figure,
    language: Language,
    width_mm: float,
    max_height_mm: float = 200.0,
    least_denominator: float = 1.0,
) -> Plot | None:
    """The figure as a drawing of this width; None if it has three dimensions.

    The same figure, language and size give the same bytes. A map is drawn at the largest round
    scale that fits, at 1 : ``least_denominator`` or smaller.

    Raises:
        ValueError: a trace, a mode or a shape is of a kind that no drawing is known for.
    """
    layout, traces = language.resolved(figure.layout), language.resolved(figure.traces)
    kinds = {str(trace.get("type", "scatter")) for trace in traces}
    if kinds & ON_SCREEN_ONLY:
        return None
    if unknown := kinds - DRAWN:
        raise ValueError(f"figure “{figure.name}”: no drawing on paper is known for {unknown}")
    traces = [_normal(trace, layout) for trace in traces if is_shown(trace)]
    # A letter that the font lacks is drawn as a box by the typesetter; measuring it may not warn.
    with matplotlib.style.context(["default", STYLE]), warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".*missing from.*font")
        drawing = _Drawing(layout, traces, language, width_mm)
        height_mm = min(max_height_mm, MM_PER_PX * figure.height_px)
        return drawing.finish(height_mm, max_height_mm, least_denominator)


def _normal(trace: Json, layout: Json) -> Json:
    kind = "scatter" if trace.get("type", "scatter") == "scattergl" else trace.get("type")
    return coloured({**trace, "type": kind or "scatter"}, layout)


class _Drawing:
    """A sheet with its panels, filled first and then laid out by what it holds."""

    def __init__(
        self, layout: Json, traces: Sequence[Json], language: Language, width_mm: float
    ) -> None:
        self.layout, self.language, self.width_mm = layout, language, width_mm
        self.traces = traces
        self.sheet = Sheet(figsize=(width_mm / MM_PER_INCH, 4.0), dpi=288)
        FigureCanvasAgg(self.sheet)
        self.paper = Paper(self.sheet)
        self.axes = axes_of(layout, traces)
        self.places = [
            measure(t, self.axes[t.get("xaxis", "x")], self.axes[t.get("yaxis", "y")])
            for t in traces
        ]
        self.panels: dict[tuple[str, str], Axes] = {}
        self.labels: list[list[Annotation]] = []
        for pair in panels_of(traces):
            self.panels[pair] = self.sheet.add_axes((0.1, 0.1, 0.8, 0.8), label="-".join(pair))
        self._fill()
        width_pt = width_mm / MM_PER_INCH * 72.0
        self.legend = add_legend(self.sheet, traces, layout, width_pt)
        self.bars = [
            (self.sheet.add_axes((0.2, 0.0, 0.5, 0.02), label=f"bar-{k}"), scale)
            for k, scale in enumerate(bar_scales(traces, layout))
        ]
        for ax, scale in self.bars:
            draw_bar(ax, scale, language)

    def _fill(self) -> None:
        for (x, y), ax in self.panels.items():
            plain_frame(ax)
            for axis in (self.axes[x], self.axes[y]):
                if axis.logarithmic:
                    (ax.set_xscale if axis.horizontal else ax.set_yscale)("log")
            if self.axes[y].settings.get("side") == "right":
                ax.yaxis.tick_right()
                ax.yaxis.set_label_position("right")
                ax.spines["right"].set_visible(True)
        bar_traces = [t for t in self.traces if t["type"] == "bar"]
        by_bar = dict(zip(map(id, bar_traces), slots(bar_traces, self.layout), strict=True))
        for trace, place in zip(self.traces, self.places, strict=True):
            ax = self.panels[trace.get("xaxis", "x"), trace.get("yaxis", "y")]
            self._trace(ax, trace, *place, by_bar.get(id(trace), (0.0, 0.0)))
        for (x_name, y_name), ax in self.panels.items():
            ax.set_xlim(limits(self.axes[x_name], self.axes))
            ax.set_ylim(limits(self.axes[y_name], self.axes))
        for shape in self.layout.get("shapes", ()):
            add_shape(self.panels, self.paper, shape)
        for remark in self.layout.get("annotations", ()):
            add_remark(self.panels, self.paper, remark)

    def _trace(
        self, ax: Axes, trace: Json, x: Vector, y: Vector, slot: tuple[float, float]
    ) -> None:
        match trace["type"]:
            case "scatter":
                self.labels += scatter(ax, trace, x, y)
            case "bar":
                bars(ax, trace, x, y, slot)
            case "contour":
                contour(ax, trace, self.layout, x, y)
            case "heatmap":
                heatmap(ax, trace, self.layout, x, y)

    def finish(self, height_mm: float, max_height_mm: float, least_denominator: float) -> Plot:
        """Lay the sheet out, to scale if it is a map, and write it."""
        legend_mm = 0.0
        if self.legend is not None:
            legend_mm = self._mm(self.legend.get_window_extent().height) + 2.0 * LEGEND_GAP_MM
        below_mm = BAR_MM * len(self.bars)
        is_map = has_equal_scales(self.layout)
        below_mm += SCALE_BAR_MM if is_map else 0.0
        scale, margins = None, Margins()
        for _ in range(3):
            around = margins.top + margins.bottom + legend_mm + below_mm
            wide, high = self.width_mm - margins.left - margins.right, height_mm - around
            if is_map:
                scale, wide, high = self._to_scale(
                    (wide, max_height_mm - around), least_denominator
                )
                height_mm = high + around
            self._place(margins, wide, high, below_mm, height_mm)
            if self.legend is not None:
                self.legend.set_bbox_to_anchor((0.0, 1.0 - LEGEND_GAP_MM / height_mm))
            margins = self._measured(margins, wide, high, below_mm)
        self._thin_ticks()
        thin_out(self.labels)
        if scale is not None:
            size = (self.width_mm, height_mm)
            draw_scale_bar(self.sheet, scale, (margins.left, 1.0), size, self.language)
        return Plot(self._written(), self.width_mm, height_mm, scale)

    def _to_scale(
        self, room_mm: tuple[float, float], least: float
    ) -> tuple[MapScale, float, float]:
        """The scale, and the exact size of the frame at it."""
        (x, y), _ = next(iter(self.panels.items()))
        (left, right), (bottom, top) = (limits(self.axes[name], self.axes) for name in (x, y))
        scale = scale_for(right - left, top - bottom, room_mm, least)
        return scale, scale.millimetres(right - left), scale.millimetres(top - bottom)

    def _place(
        self, margins: Margins, wide: float, high: float, below_mm: float, height_mm: float
    ) -> None:
        self.sheet.set_size_inches(self.width_mm / MM_PER_INCH, height_mm / MM_PER_INCH)
        size = (self.width_mm, height_mm)
        left, bottom = margins.left / size[0], (margins.bottom + below_mm) / size[1]
        share = (wide / size[0], high / size[1])
        self.paper.move(left, bottom, *share)
        for (x, y), ax in self.panels.items():
            (x0, x1), (y0, y1) = (domain(self.axes[name], self.axes) for name in (x, y))
            ax.set_position(
                (
                    left + x0 * share[0],
                    bottom + y0 * share[1],
                    (x1 - x0) * share[0],
                    (y1 - y0) * share[1],
                )
            )
            self._ticks(ax, self.axes[x], (x1 - x0) * wide, y)
            self._ticks(ax, self.axes[y], (y1 - y0) * high, x)
        self.sheet.align_ylabels(list(self.panels.values()))
        for k, (ax, _) in enumerate(self.bars):
            first = below_mm - BAR_MM * (k + 1) + 6.0
            ax.set_position((left, first / size[1], 0.6 * share[0], 2.6 / size[1]))

    def _ticks(self, ax: Axes, axis: Axis, length_mm: float, across: str) -> None:
        set_ticks(ax, axis, length_mm, self.language, shown=axis.anchor == across)

    def _measured(self, margins: Margins, wide: float, high: float, below_mm: float) -> Margins:
        """The margins that the text around the panels needs, mm."""
        found = [ax.get_tightbbox() for ax in self.panels.values()]
        boxes = [box for box in found if box is not None]
        left = self._mm(min(box.x0 for box in boxes))
        right = self._mm(max(box.x1 for box in boxes))
        bottom = self._mm(min(box.y0 for box in boxes))
        top = self._mm(max(box.y1 for box in boxes))
        return Margins(
            left=max(margins.left - left, 1.0) + 0.3,
            right=max(right - margins.left - wide, 1.0) + 0.3,
            top=max(top - margins.bottom - below_mm - high, 0.5) + 0.3,
            bottom=max(margins.bottom + below_mm - bottom, 1.0) + 0.8,
        )

    def _mm(self, pixels: float) -> float:
        return float(pixels) / float(self.sheet.dpi) * MM_PER_INCH

    def _thin_ticks(self) -> None:
        """Hide each tick label that would touch the one before it."""
        for ax in [*self.panels.values(), *(bar for bar, _ in self.bars)]:
            last = -np.inf
            for label in ax.get_xticklabels():
                box = label.get_window_extent()
                if label.get_text() and self._mm(box.x0) < last + 0.8:
                    label.set_visible(False)
                elif label.get_text():
                    last = self._mm(box.x1)

    def _written(self) -> bytes:
        file = BytesIO()
        nothing: Mapping[str, None] = {"Date": None, "Creator": None}
        self.sheet.savefig(file, format="svg", metadata=dict(nothing), facecolor="none")
        return file.getvalue()
