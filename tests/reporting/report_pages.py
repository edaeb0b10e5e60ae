"""How the tests look into a page: as a parser sees it, and as plotly is handed it."""

from __future__ import annotations

import base64
import json
from dataclasses import dataclass, field
from html.parser import HTMLParser
from pathlib import Path
from typing import Any

import numpy as np
from example_flights import Flight

from inspect_cli.schema.result import Result


@dataclass
class Page(HTMLParser):
    """A page taken apart by the standard library's parser, as a browser would."""

    source: str
    text: str = ""
    tags: list[tuple[str, dict[str, str | None]]] = field(default_factory=list)
    scripts: list[tuple[dict[str, str | None], str]] = field(default_factory=list)

    def __post_init__(self) -> None:
        super().__init__(convert_charrefs=True)
        self._raw: str | None = None
        self.feed(self.source)

    def handle_starttag(self, tag: str, attrs: list[tuple[str, str | None]]) -> None:
        self.tags.append((tag, dict(attrs)))
        self._raw = tag if tag in ("script", "style") else None
        if tag == "script":
            self.scripts.append((dict(attrs), ""))

    def handle_endtag(self, tag: str) -> None:
        self._raw = None

    def handle_data(self, data: str) -> None:
        if self._raw == "script":
            attributes, before = self.scripts[-1]
            self.scripts[-1] = (attributes, before + data)
        elif self._raw is None:
            self.text += data

    @property
    def figures(self) -> dict[str, dict[str, Any]]:
        """What plotly is handed, by the figure's name."""
        return {
            str(attributes["data-plot"]).removeprefix("plot-"): json.loads(text)
            for attributes, text in self.scripts
            if "data-plot" in attributes
        }


def decoded(column: Any) -> np.ndarray:
    """A plotly column as numbers, whichever of its two forms it has."""
    if isinstance(column, dict):
        assert column["dtype"] == "f4"
        return np.frombuffer(base64.b64decode(column["bdata"]), "<f4").astype(float)
    return np.array([np.nan if x is None else x for x in column], float)


def trace(figure: dict[str, Any], name: str) -> dict[str, Any]:
    """The first trace of that name."""
    return next(t for t in figure["data"] if t.get("name") == name)


@dataclass
class Reported:
    """A flight with its result and its page."""

    flight: Flight
    result: Result
    path: Path
    page: Page
