"""A figure as plain plotly JSON, with numbers and words encoded for plotly."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.reporting.words.text import Text

Json = dict[str, Any]

EQUAL_FRAME_PX = 170
"""Height of legend and axes around a drawing at equal scales."""


@dataclass(frozen=True)
class Figure:
    """Traces and layout as plotly.js takes them, with the words around them.

    Wherever plotly takes a string, a piece of ``Text`` may stand; a language resolves it.

    ``name`` is unique on the page and fixed, so that the same log gives the same bytes.
    ``description`` is what a screen reader says instead of the drawing.
    """

    name: str
    caption: Text
    description: Text
    traces: Sequence[Json]
    layout: Json
    height_px: int = 320
    timed: bool = field(default=False)
    """Whether x is the time since the start: such figures zoom together."""
    slope: float | None = None
    """Height over width of what is drawn at equal scales: a narrow screen gets a lower figure."""


def numbers(values: ArrayLike) -> Json:
    """A column of numbers as plotly's base64 form of single-precision floats.

    Seven digits are more than a screen shows. NaN and what single precision cannot hold leave
    a gap in the line.
    """
    column = np.asarray(values, dtype=float)
    single = np.where(np.abs(column) < np.finfo(np.float32).max, column, np.nan)
    data = np.ascontiguousarray(single, dtype="<f4").tobytes()
    return {"dtype": "f4", "bdata": base64.b64encode(data).decode("ascii")}


def words(text: Text) -> Text:
    """A user's text for plotly, which reads tags, entities and %{values} in it; ours stays."""
    if not isinstance(text, str):
        return text
    return html.escape(text, quote=False).replace("%{", "%&#123;")


def merged(base: Mapping[str, Any], extra: Mapping[str, Any]) -> Json:
    """``base`` with the entries of ``extra``; nested objects are merged, not replaced."""
    result = dict(base)
    for key, value in extra.items():
        old = result.get(key)
        if isinstance(old, Mapping) and isinstance(value, Mapping):
            value = merged(old, value)
        result[key] = value
    return result
