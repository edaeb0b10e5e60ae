"""Markers and labels on a map of potentials: readings, minima, proposals."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.figures.figure import Json, words
from inspect_cli.reporting.figures.palette import ASTM_STYLES, BLUE, INK, INVALID_STYLE
from inspect_cli.reporting.half_cell.map_frame import MAX_WRITTEN_VALUES
from inspect_cli.reporting.half_cell.places import Place, places_of
from inspect_cli.reporting.half_cell.potential_scale import colours
from inspect_cli.reporting.words.printable import shortened
from inspect_cli.reporting.words.text import Text, number, say, together

MOST_MARKERS = 2000
"""Largest number of readings that are drawn one by one; above it only the field is drawn."""
MOST_SIGNS = 300
"""Largest number of minima and of proposals that are drawn, the steepest first."""
MARKER_PX = 15
SIZES_PX = ((MAX_WRITTEN_VALUES, MARKER_PX), (400, 9), (MOST_MARKERS, 5))
HALO = ", ".join(["0 0 2px #ffffff"] * 3)
"""Keeps labels readable on any colour and across lines."""
MOST_LETTERS = 14
"""Letters of a label on the map; the tables show all of it."""


def valid_markers(places: Sequence[Place], ends: tuple[float, float]) -> list[Json]:
    """The valid readings, by class in shape and by potential in colour."""
    size = next(size for most, size in SIZES_PX if len(places) <= most)
    traces = []
    for name, style in ASTM_STYLES.items():
        own = [p for p in places if p.astm_class == name]
        if not own:
            continue
        edge = 1.2 if size == MARKER_PX else 0.7
        traces.append(
            {
                **_at(own),
                "name": together(style.label, " (ASTM C876)"),
                "marker": {
                    "symbol": style.symbol,
                    "size": size,
                    "color": colours((p.potential_mv or 0.0 for p in own), ends),
                    "line": {"width": edge, "color": INK},
                },
                "customdata": [p.text() for p in own],
            }
        )
    return traces


def invalid_markers(places: Sequence[Place], reasons: Mapping[str, Text]) -> list[Json]:
    """Crosses, with the reason why there is no value."""
    if not places:
        return []
    style = INVALID_STYLE
    unknown = say("no potential")
    hover = [
        say(
            "{label}: no valid reading, {reason}",
            label=words(p.label),
            reason=words(reasons.get(p.label, unknown)),
        )
        for p in places
    ]
    few = len(places) <= MAX_WRITTEN_VALUES
    line = {"width": 2 if few else 1}
    marker = {"symbol": style.symbol, "size": 12 if few else 6, "color": INK, "line": line}
    return [{**_at(places), "name": style.label, "marker": marker, "customdata": hover}]


def minima_trace(evaluated: SurfaceFindings, *, written: bool) -> list[Json]:
    """The minima that the gradient criterion calls active, around their readings' markers."""
    minima = evaluated.assessed.minima
    active = np.flatnonzero(minima.is_active)[:MOST_SIGNS]
    if not len(active):
        return []
    places = places_of(evaluated.assessed, minima.index[active])
    hover = [
        say(
            "minimum at {label}: rises by {rise} mV within 1 m",
            label=words(p.label),
            rise=number(float(minima.rise_mv[k]), 0),
        )
        for p, k in zip(places, active, strict=True)
    ]
    marker = {
        "symbol": "triangle-down-open",
        "size": 26 if written else 15,
        "color": INK,
        "line": {"width": 2, "color": INK},
    }
    name = say("minimum, active by its gradient")
    return [{**_at(places), "name": name, "marker": marker, "customdata": hover}]


def proposals_trace(evaluated: SurfaceFindings) -> list[Json]:
    """Places where the refinement rule asks for another reading."""
    steps, labels = evaluated.assessed.steps, evaluated.assessed.readings.labels
    if not len(steps.pairs):
        return []
    hover = [
        say(
            "between {first} and {second}: {difference} mV",
            first=words(str(labels[a])),
            second=words(str(labels[b])),
            difference=number(float(difference), 0),
        )
        for (a, b), difference in zip(
            steps.pairs[:MOST_SIGNS], steps.difference_mv[:MOST_SIGNS], strict=True
        )
    ]
    at = steps.midpoint_m[:MOST_SIGNS]
    return [
        {
            **_scatter(at[:, 0].tolist(), at[:, 1].tolist()),
            "name": say("read more closely here"),
            "marker": {
                "symbol": "cross-open",
                "size": 12,
                "color": BLUE,
                "line": {"width": 1.6, "color": BLUE},
            },
            "customdata": hover,
        }
    ]


def label_trace(valid: Sequence[Place], invalid: Sequence[Place]) -> list[Json]:
    """The labels as a trace of their own, drawn last, so that no marker covers them.

    Its markers cannot be seen; plotly keeps a text as far from its point as the marker is large.
    """
    places = [*valid, *invalid]
    if not places:
        return []
    return [
        {
            **_scatter([p.uv_m[0] for p in places], [p.uv_m[1] for p in places]),
            "name": "labels",
            "mode": "markers+text",
            "marker": {"size": MARKER_PX, "opacity": 0},
            "text": [_written(p) for p in valid] + [_bold(p.label) for p in invalid],
            "textposition": _text_sides(places),
            "textfont": {"size": 11, "color": INK, "shadow": HALO},
            "hoverinfo": "skip",
            "showlegend": False,
        }
    ]


def _text_sides(places: Sequence[Place]) -> list[str]:
    """Above each place; in a single row by turns above and below, for room."""
    v_m = [p.uv_m[1] for p in places]
    if max(v_m) - min(v_m) > 1e-3:
        return ["top center"] * len(places)
    order = {id(p): k for k, p in enumerate(sorted(places, key=lambda p: p.uv_m))}
    return ["bottom center" if order[id(p)] % 2 else "top center" for p in places]


def _at(places: Sequence[Place]) -> Json:
    return _scatter([p.uv_m[0] for p in places], [p.uv_m[1] for p in places])


def _scatter(u_m: list[float], v_m: list[float]) -> Json:
    return {
        "type": "scatter",
        "mode": "markers",
        "x": u_m,
        "y": v_m,
        "cliponaxis": False,
        "hovertemplate": "%{customdata}<extra></extra>",
    }


def _written(p: Place) -> Text:
    return together(_bold(p.label), "<br>", number(p.potential_mv, 0))


def _bold(label: str) -> Text:
    return together("<b>", words(shortened(label, MOST_LETTERS)), "</b>")
