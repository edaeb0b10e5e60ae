"""A figure as plain plotly JSON, and how numbers and words get into it."""

from __future__ import annotations

import base64
import html
from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.reporting.markup import Markup, data_script, element, joined

Json = dict[str, Any]

EQUAL_FRAME_PX = 170
"""Legend and axes around what is drawn at equal scales."""


@dataclass(frozen=True)
class Figure:
    """Traces and layout as plotly.js takes them, with the words around them.

    ``name`` is unique on the page and fixed, so that the same log gives the same bytes.
    ``description`` is what a screen reader says instead of the drawing.
    """

    name: str
    caption: str
    description: str
    traces: Sequence[Json]
    layout: Json
    height_px: int = 320
    timed: bool = field(default=False)
    """Whether x is the time since the start: such figures zoom together."""
    slope: float | None = None
    """Height over width of what is drawn at equal scales: a narrow screen gets a lower figure."""

    @property
    def _height(self) -> str:
        if self.slope is None:
            return f"{self.height_px}px"
        return f"min({self.height_px}px, calc({EQUAL_FRAME_PX}px + {100.0 * self.slope:.1f}vw))"

    def html(self) -> Markup:
        """The figure element; the page's script draws it from the data beside it."""
        plot = element(
            "div",
            id=f"plot-{self.name}",
            class_="plot",
            role="img",
            aria_label=self.description,
            style=f"height:{self._height}",
        )
        content = {"data": self.traces, "layout": self.layout, "timed": self.timed}
        data = data_script(content, data_plot=f"plot-{self.name}")
        return element("figure", plot, data, element("figcaption", self.caption), id=self.name)


def drawn(figures: Iterable[Figure], *, side_by_side: bool = False) -> Markup:
    """The figures one after the other, or in two columns where the page is wide enough."""
    shown = joined(*(figure.html() for figure in figures))
    if side_by_side and shown:
        return element("div", shown, class_="pair")
    return shown


def numbers(values: ArrayLike) -> Json:
    """A column of numbers as plotly's base64 form of single-precision floats.

    Seven digits are more than a screen shows. NaN and what single precision cannot hold leave
    a gap in the line.
    """
    column = np.asarray(values, dtype=float)
    single = np.where(np.abs(column) < np.finfo(np.float32).max, column, np.nan)
    data = np.ascontiguousarray(single, dtype="<f4").tobytes()
    return {"dtype": "f4", "bdata": base64.b64encode(data).decode("ascii")}


def words(text: str) -> str:
    """A user's text for plotly, which reads tags and entities in any label."""
    return html.escape(text, quote=False)


def merged(base: Mapping[str, Any], extra: Mapping[str, Any]) -> Json:
    """``base`` with the entries of ``extra``; nested objects are merged, not replaced."""
    result = dict(base)
    for key, value in extra.items():
        old = result.get(key)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            value = merged(old, value)
        result[key] = value
    return result
