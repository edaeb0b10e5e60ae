"""Contours, coloured fields and their colour bars."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Any

import numpy as np
from matplotlib import colormaps
from matplotlib.axes import Axes
from matplotlib.colors import ListedColormap, Normalize, to_hex

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.paper.plot_axes import column
from inspect_cli.reporting.paper.plot_labels import points
from inspect_cli.reporting.paper.plot_marks import DASHES
from inspect_cli.reporting.paper.plot_text import rgba
from inspect_cli.spatial.arrays import Points, Vector

SHADES = 512
NAMED_SCALES = {"Viridis": "viridis", "Greys": "Greys", "Blues": "Blues", "RdBu": "RdBu"}


def grid_of(trace: Json) -> Points:
    """The values of a field by rows, (n, m); NaN where there is none."""
    rows = column(trace["z"])
    return np.array([[np.nan if z is None else float(z) for z in column(row)] for row in rows])


def field_scale(trace: Json, layout: Json) -> Json:
    """The colour scale of a field and its ends: its own, or that of the colour axis it names."""
    shared = layout.get(str(trace.get("coloraxis", "")), {})
    values = grid_of(trace)
    known = values[np.isfinite(values)]
    low, high = (float(known.min()), float(known.max())) if len(known) else (0.0, 1.0)
    return {
        "colorscale": shared.get("colorscale", trace.get("colorscale", "Viridis")),
        "cmin": float(shared.get("cmin", trace.get("zmin", low))),
        "cmax": float(shared.get("cmax", trace.get("zmax", high))),
        "colorbar": shared.get("colorbar", trace.get("colorbar", {})),
        "reversescale": bool(shared.get("reversescale", trace.get("reversescale", False))),
    }


def colour_map(scale: Json) -> ListedColormap:
    """The colour scale as a matplotlib colour map with steps too small to be seen."""
    shares = np.linspace(0.0, 1.0, SHADES)
    if scale.get("reversescale"):
        shares = 1.0 - shares
    return ListedColormap(scale_colours(scale, shares))


def scale_colours(scale: Json, shares: Vector) -> list[Any]:
    """Colours at shares of the scale, whether it is given by its stops or by a name.

    Raises:
        ValueError: the name is not known.
    """
    stops = scale["colorscale"]
    if not isinstance(stops, str):
        return band_colours(stops, shares)
    if stops not in NAMED_SCALES:
        raise ValueError(f"no colours on paper are known for the scale “{stops}”")
    return [colormaps[NAMED_SCALES[stops]](float(share)) for share in shares]


def contour(ax: Axes, trace: Json, layout: Json, x: Vector, y: Vector) -> None:
    """Bands between equidistant levels, or mere lines on them."""
    values = np.ma.masked_invalid(grid_of(trace))
    scale, settings = field_scale(trace, layout), trace.get("contours", {})
    line = trace.get("line", {})
    levels = _levels(settings, scale)
    coloring = str(settings.get("coloring", "fill"))
    if settings.get("type", "levels") != "levels" or coloring not in ("fill", "none", "lines"):
        raise ValueError(f"no contours on paper are known for {settings!r}")
    width = points(float(line.get("width", 0.5)))
    if coloring == "fill":
        middles = 0.5 * (levels[1:] + levels[:-1])
        shares = (middles - scale["cmin"]) / (scale["cmax"] - scale["cmin"])
        colours = np.array(scale_colours(scale, np.clip(shares, 0.0, 1.0)))
        colours[:, 3] *= float(trace.get("opacity", 1.0))
        ax.contourf(x, y, values, levels, colors=colours, corner_mask=False, zorder=1.0)
    if width == 0.0:
        return
    drawn = ax.contour(
        x,
        y,
        values,
        levels,
        colors=[rgba(str(line.get("color", INK)))],
        linewidths=width,
        linestyles=[DASHES[str(line.get("dash", "solid"))]],
        corner_mask=False,
        zorder=1.5,
    )
    if settings.get("showlabels"):
        ax.clabel(drawn, fontsize=6.0)


def _levels(settings: Json, scale: Json) -> Vector:
    if "size" not in settings:
        return np.linspace(float(scale["cmin"]), float(scale["cmax"]), 16)
    start, end, size = (float(settings[key]) for key in ("start", "end", "size"))
    levels: Vector = start + size * np.arange(max(1, round((end - start) / size)) + 1.0)
    return levels


def heatmap(ax: Axes, trace: Json, layout: Json, x: Vector, y: Vector) -> None:
    """A coloured cell around each node; drawn as pixels, because a field may have thousands."""
    values, scale = np.ma.masked_invalid(grid_of(trace)), field_scale(trace, layout)
    n, m = values.shape
    ax.pcolormesh(
        _edges(x if len(x) else np.arange(m, dtype=float), m),
        _edges(y if len(y) else np.arange(n, dtype=float), n),
        values,
        cmap=colour_map(scale),
        norm=Normalize(scale["cmin"], scale["cmax"]),
        alpha=float(trace.get("opacity", 1.0)),
        rasterized=True,
        linewidth=0.0,
        zorder=0.8,
    )


def _edges(centres: Vector, n: int) -> Vector:
    """The n + 1 edges of cells whose centres are given; edges themselves stay as they are."""
    if len(centres) == n + 1:
        return centres
    if n == 1:
        return np.array([centres[0] - 0.5, centres[0] + 0.5])
    between = 0.5 * (centres[1:] + centres[:-1])
    first, last = 1.5 * centres[0] - 0.5 * centres[1], 1.5 * centres[-1] - 0.5 * centres[-2]
    edges: Vector = np.concatenate([[first], between, [last]])
    return edges


def bar_scales(traces: Sequence[Json], layout: Json) -> list[Json]:
    """The colour scales that the figure shows a bar of."""
    found: dict[str, Json] = {}
    for k, trace in enumerate(traces):
        marker = trace.get("marker", {})
        for owner in (trace, marker):
            name = owner.get("coloraxis")
            if name and "colorscale" in layout.get(name, {}):
                if layout[name].get("showscale", True):
                    found[name] = layout[name]
            elif owner is trace and trace["type"] in ("contour", "heatmap"):
                lines_only = trace.get("contours", {}).get("coloring") == "none"
                if trace.get("showscale", True) and not lines_only:
                    found[str(k)] = field_scale(trace, layout)
    return list(found.values())


def coloured(trace: Json, layout: Json) -> Json:
    """The trace with the numbers among its markers' colours looked up on their scale."""
    marker: Json = trace.get("marker", {})
    colours = column(marker["color"]) if isinstance(marker.get("color"), list | dict) else []
    if not any(isinstance(colour, int | float) for colour in colours):
        return trace
    scale: Json = layout.get(str(marker.get("coloraxis", "")), marker)
    known = [float(c) for c in colours if isinstance(c, int | float)]
    low, high = float(scale.get("cmin", min(known))), float(scale.get("cmax", max(known)))
    shares = np.array([((c or 0.0) - low) / ((high - low) or 1.0) for c in colours])
    found = scale_colours({"colorscale": scale.get("colorscale", "Viridis")}, shares)
    return {**trace, "marker": {**marker, "color": [to_hex(c, keep_alpha=True) for c in found]}}


def band_colours(scale: Sequence[Sequence[Any]], shares: Vector) -> list[Any]:
    """Colours at shares from 0 to 1 of a plotly colour scale, linear in RGB between its stops."""
    stops = [(float(share), np.array(rgba(str(colour)))) for share, colour in scale]
    found = []
    for share in np.clip(shares, stops[0][0], stops[-1][0]):
        (a, first), (b, second) = next((p, q) for p, q in pairwise(stops) if p[0] <= share <= q[0])
        found.append(first if b == a else first + (share - a) / (b - a) * (second - first))
    return found
