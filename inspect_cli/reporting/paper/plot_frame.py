"""Everything around the traces: ticks, titles, shaded stretches, annotations, legend, colour
bar."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
from matplotlib.axes import Axes
from matplotlib.figure import Figure as Sheet
from matplotlib.legend import Legend
from matplotlib.lines import Line2D
from matplotlib.patches import Rectangle
from matplotlib.ticker import NullLocator
from matplotlib.transforms import (
    Bbox,
    BboxTransformTo,
    Transform,
    TransformedBbox,
    blended_transform_factory,
)

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import GRID, INK, MUTED
from inspect_cli.reporting.paper.plot_axes import Axis, decades, round_ticks
from inspect_cli.reporting.paper.plot_fields import scale_colours
from inspect_cli.reporting.paper.plot_labels import font_points, points, write
from inspect_cli.reporting.paper.plot_marks import DASHES, legend_handle
from inspect_cli.reporting.paper.plot_text import one_line, rgba
from inspect_cli.reporting.paper.plot_traces import is_shown
from inspect_cli.reporting.words.language import Language
from inspect_cli.reporting.words.text import number, significant

TICK_PT = 7.0
TITLE_PT = 7.5
FRAME_COLOUR = "#8c96a0"
TICK_EVERY_MM = {True: 17.0, False: 6.0}
"""Between ticks of a horizontal and of a vertical axis, about."""
BAR_SHADES = 480


def set_ticks(ax: Axes, axis: Axis, length_mm: float, language: Language, *, shown: bool) -> None:
    """Ticks at round numbers, or where the figure wants them, in the language's signs."""
    mine = ax.xaxis if axis.horizontal else ax.yaxis
    low, high = ax.get_xlim() if axis.horizontal else ax.get_ylim()
    places, labels = _ticks(axis, low, high, length_mm, language)
    kept = [k for k, p in enumerate(places) if min(low, high) <= p <= max(low, high)]
    mine.set_minor_locator(NullLocator())
    mine.set_ticks([places[k] for k in kept])
    shown = shown and bool(axis.settings.get("showticklabels", True))
    mine.set_ticklabels([labels[k] if shown else "" for k in kept], parse_math=False)
    mine.set_tick_params(
        which="both", length=2.5, width=0.5, color=FRAME_COLOUR, labelsize=TICK_PT, labelcolor=INK
    )
    title = axis.settings.get("title", {})
    text = title.get("text", "") if isinstance(title, Mapping) else title
    if shown and text:
        line = one_line(text)
        mine.set_label_text(line.text, fontsize=TITLE_PT, color=INK, parse_math=line.formula)


def _ticks(
    axis: Axis, low: float, high: float, length_mm: float, language: Language
) -> tuple[list[float], list[str]]:
    if axis.categories:
        return [float(k) for k in range(len(axis.categories))], [
            one_line(name).text for name in axis.categories
        ]
    if "tickvals" in axis.settings:
        places = [float(v) for v in axis.settings["tickvals"]]
        given = axis.settings.get("ticktext")
        labels = [one_line(t).text for t in given] if given else None
        return places, labels or [language.plain(significant(v)) for v in places]
    if axis.logarithmic:
        places = list(decades(low, high))
        return places, [language.plain(significant(v, 3)) for v in places]
    count = max(2, int(length_mm / TICK_EVERY_MM[axis.horizontal]))
    count = min(count, int(axis.settings.get("nticks", count)))
    places, decimals = round_ticks(low, high, count)
    if max(abs(low), abs(high)) >= 1e6 or decimals > 5:
        return places, [language.plain(significant(v, 3)) for v in places]
    return places, [language.plain(number(v, decimals)) for v in places]


def plain_frame(ax: Axes) -> None:
    """Two thin lines for the axes, a pale grid, and nothing behind."""
    ax.patch.set_visible(False)
    ax.set_axisbelow(True)
    ax.grid(True, color=GRID, linewidth=0.5)
    for side, spine in ax.spines.items():
        spine.set_visible(side in ("left", "bottom"))
        spine.set_color(FRAME_COLOUR)
        spine.set_linewidth(0.6)


class Paper:
    """Plotly's "paper" coordinates from 0 to 1 over all panels; they move with the layout."""

    def __init__(self, sheet: Sheet) -> None:
        self.frame = Bbox.unit()
        self.transform: Transform = BboxTransformTo(TransformedBbox(self.frame, sheet.transFigure))

    def move(self, left: float, bottom: float, width: float, height: float) -> None:
        """Put the panels' common frame somewhere on the sheet, in shares of it."""
        self.frame.set_points(np.array([[left, bottom], [left + width, bottom + height]]))


def _reference(item: Json, panels: Mapping[tuple[str, str], Axes]) -> tuple[Axes, str, str]:
    """The panel that a shape or a remark belongs to, and what its x and y mean there."""
    x, y = str(item.get("xref", "paper")), str(item.get("yref", "paper"))
    named = [(p, ax) for p, ax in panels.items() if (x in p or x == "paper")]
    named = [(p, ax) for p, ax in named if (y in p or y == "paper")] or named
    return (named[0][1] if named else next(iter(panels.values()))), x, y


def _transform(ax: Axes, paper: Paper, x: str, y: str) -> Transform:
    across = paper.transform if x == "paper" else ax.transData
    up = paper.transform if y == "paper" else ax.transData
    return blended_transform_factory(across, up)


def add_shape(ax_of: Mapping[tuple[str, str], Axes], paper: Paper, shape: Json) -> None:
    """A line or a rectangle, below the traces or above them.

    Raises:
        ValueError: it is another kind of shape.
    """
    ax, x, y = _reference(shape, ax_of)
    ends = {key: float(shape[key]) for key in ("x0", "x1", "y0", "y1")}
    line = shape.get("line", {})
    width = points(float(line.get("width", 2.0)))
    colour, dash = rgba(str(line.get("color", INK))), DASHES[str(line.get("dash", "solid"))]
    z = 0.6 if shape.get("layer", "above") == "below" else 3.0
    transform = _transform(ax, paper, x, y)
    kind = str(shape.get("type"))
    if kind == "rect":
        artist: Any = Rectangle(
            (ends["x0"], ends["y0"]),
            ends["x1"] - ends["x0"],
            ends["y1"] - ends["y0"],
            facecolor=rgba(str(shape.get("fillcolor", "rgba(0,0,0,0)"))),
            edgecolor=colour if width else "none",
            linewidth=width,
            linestyle=dash,
        )
    elif kind == "line":
        artist = Line2D(
            [ends["x0"], ends["x1"]],
            [ends["y0"], ends["y1"]],
            color=colour,
            linewidth=max(0.5, width),
            linestyle=dash,
        )
    else:
        raise ValueError(f"no shape on paper is known for “{kind}”")
    artist.set_transform(transform)
    artist.set_zorder(z)
    ax.add_artist(artist)
    clip = Rectangle((0, 0), 1, 1, transform=_clip(ax, paper, x, y))
    artist.set_clip_path(clip)


def _clip(ax: Axes, paper: Paper, x: str, y: str) -> Transform:
    across = paper.transform if x == "paper" else ax.transAxes
    up = paper.transform if y == "paper" else ax.transAxes
    return blended_transform_factory(across, up)


def add_remark(ax_of: Mapping[tuple[str, str], Axes], paper: Paper, remark: Json) -> None:
    """An annotation at a place, with an arrow if plotly would draw one."""
    ax, x, y = _reference(remark, ax_of)
    font = remark.get("font", {})
    ha = str(remark.get("xanchor", "center")).replace("auto", "center")
    va = str(remark.get("yanchor", "center")).replace("auto", "center").replace("middle", "center")
    shift = (points(float(remark.get("xshift", 0.0))), points(float(remark.get("yshift", 0.0))))
    place, transform = (float(remark["x"]), float(remark["y"])), _transform(ax, paper, x, y)
    if remark.get("showarrow", True):
        shift = (points(float(remark.get("ax", -10.0))), -points(float(remark.get("ay", -30.0))))
        arrow = {"arrowstyle": "-|>", "linewidth": 0.6, "color": INK, "shrinkA": 0, "shrinkB": 0}
        ax.annotate(
            "",
            place,
            shift,
            xycoords=transform,
            textcoords="offset points",
            arrowprops=arrow,
            annotation_clip=False,
        )
        va = "bottom" if shift[1] > 0.0 else "top" if shift[1] < 0.0 else "center"
    write(
        ax,
        remark.get("text", ""),
        place,
        coordinates=transform,
        shift=shift,
        ha=ha,
        va=va,
        size=font_points(float(font.get("size", 12.0))),
        colour=rgba(str(font.get("color", MUTED))),
        halo=bool(remark.get("bgcolor")),
        angle=-float(remark.get("textangle", 0.0)),
    )


def add_legend(
    sheet: Sheet, traces: Sequence[Json], layout: Json, width_pt: float
) -> Legend | None:
    """The names of the traces above the drawing, in as many columns as fit its width."""
    named = [t for t in traces if t.get("name") and t.get("showlegend", True) and is_shown(t)]
    named = [t for t in named if t["type"] in ("scatter", "bar")]
    if not named or not layout.get("showlegend", len(traces) > 1):
        return None
    lines = [one_line(t["name"]) for t in named]
    handles = [legend_handle(t) for t in named]
    for columns in range(len(named), 0, -1):
        legend = sheet.legend(
            handles,
            [line.text for line in lines],
            ncols=columns,
            loc="upper left",
            bbox_to_anchor=(0.0, 1.0),
            frameon=False,
            fontsize=TITLE_PT,
            borderpad=0.0,
            borderaxespad=0.0,
            handlelength=2.2,
            columnspacing=1.6,
            labelspacing=0.35,
        )
        for text, line in zip(legend.get_texts(), lines, strict=True):
            text.set_parse_math(line.formula)
        if columns == 1 or _width_pt(legend) <= width_pt:
            return legend
        legend.remove()
    return None


def _width_pt(artist: Any) -> float:
    return float(artist.get_window_extent().width) * 72.0 / float(artist.figure.dpi)


def draw_bar(ax: Axes, scale: Json, language: Language) -> None:
    """The colour bar of a scale, lying, with its marks below and its title at its right end."""
    low, high = float(scale["cmin"]), float(scale["cmax"])
    shares = (np.arange(BAR_SHADES) + 0.5) / BAR_SHADES
    if scale.get("reversescale"):
        shares = 1.0 - shares
    colours = np.array([tuple(c) for c in scale_colours(scale, shares)])[None, :, :3]
    ax.imshow(colours, extent=(low, high, 0.0, 1.0), aspect="auto", interpolation="none")
    bar = scale.get("colorbar", {})
    places = [float(v) for v in bar.get("tickvals") or round_ticks(low, high, 5)[0]]
    given = bar.get("ticktext")
    labels = [one_line(t).text for t in given] if given else None
    ax.set_yticks([])
    ax.set_xticks(places)
    ax.set_xticklabels(labels or [language.plain(significant(v)) for v in places], parse_math=False)
    ax.tick_params(length=2.0, width=0.5, color=FRAME_COLOUR, labelsize=TICK_PT, pad=1.5)
    ax.set_xlim(low, high)
    for spine in ax.spines.values():
        spine.set_linewidth(0.5)
        spine.set_color(INK)
    title = bar.get("title", {})
    text = one_line(title.get("text", "") if isinstance(title, Mapping) else title)
    ax.annotate(
        text.text.strip(),
        (1.0, 0.5),
        (4.0, 0.0),
        xycoords="axes fraction",
        textcoords="offset points",
        va="center",
        fontsize=TICK_PT,
        parse_math=text.formula,
        annotation_clip=False,
    )
