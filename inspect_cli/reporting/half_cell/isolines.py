"""Lines of equal potential with their values, as traces over a kriged field."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np

from inspect_cli.assessment.classes import millivolts
from inspect_cli.assessment.contours import ContourLine, contour_levels, contour_lines
from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.reporting.figures.figure import Json, numbers
from inspect_cli.reporting.figures.palette import INK
from inspect_cli.reporting.half_cell.potential_scale import ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV
from inspect_cli.reporting.words.text import Text, number, together
from inspect_cli.spatial.arrays import Points, Vector

NARROWEST_STEP_MV = 5.0
BOUNDARIES_MV = (ACTIVE_BELOW_MV, PASSIVE_ABOVE_MV)
LABEL_PX = (40.0, 17.0)
"""Room for the value of a line."""
SHORTEST_PX = 60.0
"""Shorter lines get no value."""
TRIED = (0.5, 0.3, 0.7, 0.15, 0.85)
"""Places along a line at which its value is tried, as shares of its length."""
MOST_LABELS = 60
HALO = ", ".join(["0 0 2px #ffffff"] * 4)


def step_of(kriged: KrigedMap) -> float:
    """The interval of the lines, mV."""
    known = kriged.potential_v[np.isfinite(kriged.potential_v)]
    levels = contour_levels(float(known.min()), float(known.max()))
    return float(np.diff(millivolts(levels[:2]))[0]) if len(levels) > 1 else NARROWEST_STEP_MV


def isolines(kriged: KrigedMap) -> list[Json]:
    """Thin lines, and the heavy ones of the class boundaries."""
    heavy, thin = _heavy_and_thin(kriged)
    return [_drawn(chosen, width) for chosen, width in ((thin, 0.8), (heavy, 2.4)) if chosen]


def _heavy_and_thin(kriged: KrigedMap) -> tuple[list[ContourLine], list[ContourLine]]:
    lines = contour_lines(kriged)
    heavy = [line for line in lines if _level_mv(line) in BOUNDARIES_MV]
    return heavy, [line for line in lines if _level_mv(line) not in BOUNDARIES_MV]


def _level_mv(line: ContourLine) -> float:
    return float(millivolts(line.level_v))


def _drawn(lines: Sequence[ContourLine], width: float) -> Json:
    gap = np.full((1, 2), np.nan)
    uv = np.concatenate([part for line in lines for part in (line.uv_m, gap)])[:-1]
    return {
        "type": "scatter",
        "mode": "lines",
        "x": numbers(uv[:, 0]),
        "y": numbers(uv[:, 1]),
        "line": {"color": INK, "width": width},
        "hoverinfo": "skip",
        "showlegend": False,
    }


def values(kriged: KrigedMap, px_per_m: float, readings_m: Points) -> list[Json]:
    """The values of the lines, the heavy ones first, as far as there is room for them.

    Args:
        kriged: the map.
        px_per_m: how large a metre is drawn, for the room between values.
        readings_m: (n, 2) places that no value may cover.
    """
    heavy, thin = _heavy_and_thin(kriged)
    taken: list[Vector] = [px_per_m * place for place in readings_m]
    at: list[Vector] = []
    texts: list[Text] = []
    for line in (*heavy, *thin):
        px = px_per_m * line.uv_m
        place = _free(px, taken)
        if place is None:
            continue
        taken.append(place)
        at.append(place / px_per_m)
        value = number(_level_mv(line), 0)
        is_heavy = _level_mv(line) in BOUNDARIES_MV
        texts.append(together("<b>", value, "</b>") if is_heavy else value)
        if len(texts) == MOST_LABELS:
            break
    if not texts:
        return []
    return [
        {
            "type": "scatter",
            "mode": "text",
            "name": "levels",
            "x": [float(place[0]) for place in at],
            "y": [float(place[1]) for place in at],
            "text": texts,
            "textfont": {"size": 11, "color": INK, "shadow": HALO},
            "hoverinfo": "skip",
            "showlegend": False,
        }
    ]


def _free(px: Points, taken: Sequence[Vector]) -> Vector | None:
    """A place on the line (n, 2) whose value would cover nothing else; None if there is none."""
    along = np.concatenate([[0.0], np.cumsum(np.hypot(*np.diff(px, axis=0).T))])
    if along[-1] < SHORTEST_PX or not math.isfinite(along[-1]):
        return None
    others = np.array(taken).reshape(-1, 2)
    for share in TRIED:
        place = px[np.searchsorted(along, share * along[-1])]
        away = np.abs(others - place)
        if not np.any((away[:, 0] < LABEL_PX[0]) & (away[:, 1] < LABEL_PX[1])):
            return np.asarray(place)
    return None
