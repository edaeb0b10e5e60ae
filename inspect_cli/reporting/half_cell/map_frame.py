"""The frame of all maps of a surface: drawn stretch, axes, field."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.assessment.kriging import KrigedMap
from inspect_cli.reporting.figures.figure import Json
from inspect_cli.spatial.arrays import Points

MAX_WRITTEN_VALUES = 80
"""Readings whose labels and values a map has room for."""
MAP_WIDTH_PX = 1000.0
MAP_FRAME_PX = 44 + 110
LOWEST_PX, HIGHEST_PX, TALLEST_PX = 160.0, 560.0, 840.0
FLATTEST = 0.36
"""Least ratio of the shorter to the longer side of a map with labels."""
TALL = 1.3
"""Height over width from which two maps stand side by side."""


@dataclass(frozen=True)
class Frame:
    """The drawn stretch of a surface: all readings with a margin, never of zero width."""

    u_m: tuple[float, float]
    v_m: tuple[float, float]

    @property
    def slope(self) -> float:
        """Height over width."""
        return (self.v_m[1] - self.v_m[0]) / (self.u_m[1] - self.u_m[0])

    @property
    def height_px(self) -> float:
        """Of the drawing within axes and legend."""
        highest = TALLEST_PX if self.slope > TALL else HIGHEST_PX
        return float(np.clip(MAP_WIDTH_PX * self.slope, LOWEST_PX, highest))

    @property
    def px_per_m(self) -> float:
        """Pixels per metre on a wide screen."""
        across = MAP_WIDTH_PX / (self.u_m[1] - self.u_m[0])
        return min(across, self.height_px / (self.v_m[1] - self.v_m[0]))

    def layout(self) -> Json:
        """Axes at equal scales, with a colour bar's room below."""
        return {
            "margin": {"t": 44, "r": 20, "b": 110},
            "hovermode": "closest",
            "showlegend": True,
            "xaxis": {"title": {"text": "u (m)"}, "range": list(self.u_m), "constrain": "domain"},
            "yaxis": {
                "title": {"text": "v (m)"},
                "range": list(self.v_m),
                "scaleanchor": "x",
                "constrain": "domain",
            },
        }


def frame_of(uv_m: Points) -> Frame:
    """Around all places (n, 2) with n ≥ 1, m; with room for words where there are few."""
    low, high = uv_m.min(axis=0), uv_m.max(axis=0)
    share = 0.12 if len(uv_m) <= MAX_WRITTEN_VALUES else 0.05
    room = share * max(float(np.max(high - low)), 0.1)
    if len(uv_m) <= MAX_WRITTEN_VALUES:
        # A row of readings has room above and below it for what is written there, on a phone too.
        room = np.maximum(room, 0.5 * (FLATTEST * (np.max(high - low) + 2.0 * room) - (high - low)))
    (u_low, v_low), (u_high, v_high) = (low - room).tolist(), (high + room).tolist()
    return Frame((u_low, u_high), (v_low, v_high))


def field_trace(kriged: KrigedMap, field: Points) -> Json:
    """A contour trace of a map's field (rows, columns); NaN stays empty."""
    shown = np.where(np.isfinite(field), np.round(field, 2), np.nan)
    return {
        "type": "contour",
        "x": np.round(kriged.u_m, 5).tolist(),
        "y": np.round(kriged.v_m, 5).tolist(),
        "z": [[None if np.isnan(z) else z for z in row] for row in shown.tolist()],
        "autocontour": False,
        "line": {"width": 0, "smoothing": 0},
        "showscale": False,
        "name": "",
    }
