"""The map of half-cell potentials on each surface that was surveyed."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from inspect_cli.reporting.figure import Figure, Json, words
from inspect_cli.reporting.palette import ASTM_STYLES, INK, INVALID_STYLE
from inspect_cli.reporting.points import ReadPoint, by_surface
from inspect_cli.reporting.potential_scale import (
    ACTIVE_BELOW_MV,
    PASSIVE_ABOVE_MV,
    STEP_MV,
    colour_axis,
    colour_bar,
    colours,
    hover_text,
    potential_range,
)
from inspect_cli.reporting.text import Text, number, say, sentences, significant, together
from inspect_cli.schema.plan import Plan, PlannedSurface

SAME_LINE_M = 1e-3
"""Planned points whose coordinate differs by less stand in one row or column."""
LEAST_FILLED_SHARE = 0.9
"""Least share of a grid's nodes that were asked for; a survey leaves a few out."""
LEAST_VALID_SHARE = 0.75
"""Least share of valid readings in a grid for contours to mean something."""
MAX_WRITTEN_VALUES = 80
MARKER_PX = 15
HALO = ", ".join(["0 0 2px #ffffff"] * 3)
"""Keeps labels readable on any colour and across lines."""
MAP_WIDTH_PX = 1000.0
MAP_FRAME_PX = 44 + 110


def map_figures(points: Sequence[ReadPoint], plan: Plan) -> Iterator[Figure]:
    """A potential map for each surface that was surveyed."""
    for k, (surface, own) in enumerate(by_surface(points, plan)):
        yield _map(k, surface, own, points)


def _map(
    k: int,
    surface: PlannedSurface,
    points: Sequence[ReadPoint],
    everywhere: Sequence[ReadPoint],
) -> Figure:
    """The map of one surface; the colours of all surfaces share one scale."""
    scale, ends = colour_axis(everywhere), potential_range(everywhere)
    valid = [p for p in points if p.point.potential_mv is not None]
    invalid = [p for p in points if p.point.potential_mv is None]
    grid = potential_grid(points)
    traces = [] if grid is None else _contours(grid, scale, ends)
    traces += _valid_markers(valid, everywhere) + _invalid_markers(invalid)
    traces += _labels(valid, invalid)
    (u_low, u_high), (v_low, v_high) = (_span(points, axis) for axis in (0, 1))
    height_px = MAP_WIDTH_PX * (v_high - v_low) / (u_high - u_low)
    layout: Json = {
        "coloraxis": scale,
        "margin": {"t": 44, "r": 20, "b": 110},
        "hovermode": "closest",
        "showlegend": True,
        "xaxis": {"title": {"text": "u (m)"}, "range": [u_low, u_high], "constrain": "domain"},
        "yaxis": {
            "title": {"text": "v (m)"},
            "range": [v_low, v_high],
            "scaleanchor": "x",
            "constrain": "domain",
        },
    }
    return Figure(
        f"map-{k + 1}",
        _caption(surface.name, contoured=grid is not None),
        say(
            "Map of {valid} valid and {invalid} invalid half-cell readings.",
            valid=number(len(valid), 0),
            invalid=number(len(invalid), 0),
        ),
        traces,
        layout,
        MAP_FRAME_PX + int(min(max(height_px, 160.0), 560.0)),
    )


def _caption(surface: str, *, contoured: bool) -> Text:
    contours = say(
        "Contours are interpolated linearly between neighbouring valid readings, one every {step} "
        "mV; the heavy lines are the class boundaries, {active} and {passive} mV.",
        step=significant(STEP_MV),
        active=number(ACTIVE_BELOW_MV, 0),
        passive=number(PASSIVE_ABOVE_MV, 0),
    )
    return sentences(
        [
            say(
                "Half-cell potential on surface “{surface}” in mV against copper/copper sulphate, "
                "at the planned points, seen from the side that was touched (on a wall u runs to "
                "the right, v up).",
                surface=surface,
            ),
            contours if contoured else "",
            say("Crosses are invalid readings; they carry no value."),
        ]
    )


def _span(points: Sequence[ReadPoint], axis: int) -> tuple[float, float]:
    """The drawn stretch of u or v: the points with room around them, never a mere line."""
    other = [p.point.uv_m[1 - axis] for p in points if p.point.uv_m]
    own = [p.point.uv_m[axis] for p in points if p.point.uv_m]
    widest = max(max(own) - min(own), max(other) - min(other), 0.1)
    room = 0.12 * widest
    return min(own) - room, max(own) + room


def potential_grid(
    points: Sequence[ReadPoint],
) -> tuple[list[float], list[float], list[list[float | None]]] | None:
    """(u, v, potentials by row) if the points fill a grid of at least two rows and two columns.

    Nodes that were left out or whose reading is invalid are None, and nothing is drawn across
    them. Grids with few valid readings give None: a contour would be invented. Single points
    between the lines of a grid, where a survey was refined, are no nodes of it.
    """
    places = [(p.point.uv_m, p.point.potential_mv) for p in points if p.point.uv_m is not None]
    columns = _full_lines([uv[0] for uv, _ in places])
    rows = _full_lines([uv[1] for uv, _ in places])
    if len(columns) < 2 or len(rows) < 2:
        return None
    table: list[list[float | None]] = [[None] * len(columns) for _ in rows]
    filled = 0
    for (u, v), potential_mv in places:
        i, j = _nearest(rows, v), _nearest(columns, u)
        if abs(rows[i] - v) <= SAME_LINE_M and abs(columns[j] - u) <= SAME_LINE_M:
            table[i][j] = potential_mv
            filled += 1
    nodes = len(rows) * len(columns)
    valid = sum(potential is not None for row in table for potential in row)
    if filled < LEAST_FILLED_SHARE * nodes or valid < LEAST_VALID_SHARE * nodes:
        return None
    return columns, rows, table


def _full_lines(values: Sequence[float]) -> list[float]:
    """The lines on which at least half as many points stand as on the fullest."""
    lines = _lines(values)
    counts = [0] * len(lines)
    for value in values:
        counts[_nearest(lines, value)] += 1
    return [line for line, count in zip(lines, counts, strict=True) if 2 * count >= max(counts)]


def _lines(values: Sequence[float]) -> list[float]:
    lines: list[float] = []
    for value in sorted(values):
        if not lines or value - lines[-1] > SAME_LINE_M:
            lines.append(value)
    return lines


def _nearest(lines: Sequence[float], value: float) -> int:
    return min(range(len(lines)), key=lambda k: abs(lines[k] - value))


def _contours(
    grid: tuple[list[float], list[float], list[list[float | None]]],
    scale: Json,
    ends: tuple[float, float],
) -> list[Json]:
    u, v, table = grid
    base: Json = {"type": "contour", "x": u, "y": v, "z": table, "hoverinfo": "skip"}
    filled = {
        **base,
        "autocontour": False,
        "contours": {"start": ends[0], "end": ends[1], "size": STEP_MV},
        "line": {"width": 0.5, "color": "#ffffff", "smoothing": 0},
        "colorscale": scale["colorscale"],
        "zmin": ends[0],
        "zmax": ends[1],
        "showscale": False,
        "opacity": 0.75,
    }
    boundary = {
        **base,
        "autocontour": False,
        "contours": {
            "coloring": "none",
            "start": ACTIVE_BELOW_MV,
            "end": PASSIVE_ABOVE_MV,
            "size": PASSIVE_ABOVE_MV - ACTIVE_BELOW_MV,
        },
        "line": {"width": 1.6, "color": INK, "smoothing": 0},
        "showlegend": False,
    }
    return [filled, boundary]


def _valid_markers(points: Sequence[ReadPoint], everywhere: Sequence[ReadPoint]) -> list[Json]:
    traces = [colour_bar("scatter")] if points else []
    for name, style in ASTM_STYLES.items():
        own = [p for p in points if p.point.astm_class == name]
        if not own:
            continue
        traces.append(
            {
                **_markers(own, style.symbol, MARKER_PX),
                "name": together(style.label, " (ASTM C876)"),
                "mode": "markers",
                "marker": {
                    "symbol": style.symbol,
                    "size": MARKER_PX,
                    "color": colours(own, everywhere),
                    "line": {"width": 1.2, "color": INK},
                },
                "customdata": [hover_text(p) for p in own],
            }
        )
    return traces


def _text_sides(points: Sequence[ReadPoint]) -> dict[int, str]:
    """Above each point, by its index; in a single row by turns above and below, for room."""
    one_row = len(_lines([p.point.uv_m[1] for p in points if p.point.uv_m])) == 1
    ordered = sorted(points, key=lambda p: p.point.uv_m or (0.0, 0.0))
    return {
        p.point.index: "bottom center" if one_row and k % 2 else "top center"
        for k, p in enumerate(ordered)
    }


def _invalid_markers(points: Sequence[ReadPoint]) -> list[Json]:
    if not points:
        return []
    style = INVALID_STYLE
    return [
        {
            **_markers(points, style.symbol, 12),
            "name": style.label,
            "mode": "markers",
            "customdata": [
                say(
                    "{label}: no valid reading, {reason}",
                    label=words(p.point.label),
                    reason=words(p.reason),
                )
                for p in points
            ],
        }
    ]


def _labels(valid: Sequence[ReadPoint], invalid: Sequence[ReadPoint]) -> list[Json]:
    """The labels as a trace of their own, drawn last, so that no marker covers them.

    Its markers cannot be seen; plotly keeps a text as far from its point as the marker is large.
    """
    written = len(valid) <= MAX_WRITTEN_VALUES
    sides = _text_sides([*valid, *invalid])
    labelled = [(p, _written(p)) for p in valid if written]
    labelled += [(p, _bold(p.point.label)) for p in invalid]
    if not labelled:
        return []
    return [
        {
            "type": "scatter",
            "name": "labels",
            "mode": "markers+text",
            "marker": {"size": MARKER_PX, "opacity": 0},
            "x": [p.point.uv_m[0] for p, _ in labelled if p.point.uv_m],
            "y": [p.point.uv_m[1] for p, _ in labelled if p.point.uv_m],
            "text": [text for _, text in labelled],
            "textposition": [sides[p.point.index] for p, _ in labelled],
            "textfont": {"size": 11, "color": INK, "shadow": HALO},
            "cliponaxis": False,
            "hoverinfo": "skip",
            "showlegend": False,
        }
    ]


def _markers(points: Sequence[ReadPoint], symbol: str, size: int) -> Json:
    return {
        "type": "scatter",
        "x": [p.point.uv_m[0] for p in points if p.point.uv_m],
        "y": [p.point.uv_m[1] for p in points if p.point.uv_m],
        "cliponaxis": False,
        "marker": {"symbol": symbol, "size": size, "color": INK, "line": {"width": 2}},
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def _written(p: ReadPoint) -> Text:
    return together(_bold(p.point.label), "<br>", number(p.point.potential_mv, 0))


def _bold(label: str) -> Text:
    return together("<b>", words(label), "</b>")
