"""Plotly's labels and colours as matplotlib takes them."""

from __future__ import annotations

import html
import re
from collections.abc import Sequence
from dataclasses import dataclass

from matplotlib.colors import to_rgba

from inspect_cli.reporting.words.printable import printable, shortened

TAG = re.compile(r"<(/?)(br|b|i|em|strong|sub|sup)\s*/?>", re.IGNORECASE)
FUNCTIONAL = re.compile(r"rgba?\(([^)]*)\)")
LONGEST_LABEL = 80
"""Characters; a longer label would push the drawing off its sheet."""
PLAIN_INDEX = re.compile(r"[A-Za-z0-9]+")

Rgba = tuple[float, float, float, float]


@dataclass(frozen=True)
class TextLine:
    """One line of a label: what matplotlib draws, and how."""

    text: str
    bold: bool = False
    formula: bool = False
    """Whether ``text`` has indices in it, as matplotlib's formulas."""


def label_lines(label: object) -> list[TextLine]:
    """The lines of a label, plotly's tags and entities read.

    ``words`` of a user's text holds entities alone, so that no tag is ever read in it.
    """
    lines: list[list[tuple[str, str]]] = [[]]
    bold, level = [False], ""
    marked = [False]
    at = 0
    text = str(label)
    for tag in TAG.finditer(text):
        lines[-1].append((html.unescape(text[at : tag.start()]), level))
        closes, name = bool(tag[1]), tag[2].lower()
        if name == "br":
            lines.append([])
            marked.append(bold[-1])
        elif name in ("b", "strong"):
            bold[-1] = not closes
            marked[-1] = marked[-1] or bold[-1]
        elif name in ("sub", "sup"):
            level = "" if closes else {"sub": "_", "sup": "^"}[name]
        at = tag.end()
    lines[-1].append((html.unescape(text[at:]), level))
    return [_line(pieces, mark) for pieces, mark in zip(lines, marked, strict=True)]


def one_line(label: object) -> TextLine:
    """A label that has to stand on one line."""
    lines = label_lines(label)
    formula = any(line.formula for line in lines)
    texts = (
        line.text if line.formula or not formula else _plain_in_formula(line.text) for line in lines
    )
    return TextLine(" ".join(texts), formula=formula)


def _line(pieces: Sequence[tuple[str, str]], bold: bool) -> TextLine:
    shown = [(shortened(printable(text), LONGEST_LABEL), level) for text, level in pieces if text]
    formula = any(level and PLAIN_INDEX.fullmatch(text) for text, level in shown)
    if not formula:
        return TextLine("".join(level + text for text, level in shown), bold)
    return TextLine("".join(_in_formula(text, level) for text, level in shown), bold, True)


def _in_formula(text: str, level: str) -> str:
    if level and PLAIN_INDEX.fullmatch(text):
        return f"${level}{{\\mathrm{{{text}}}}}$"
    return _plain_in_formula(level + text)


def _plain_in_formula(text: str) -> str:
    return text.replace("$", r"\$")


def rgba(colour: str, opacity: float = 1.0) -> Rgba:
    """A colour of CSS as red, green, blue and opacity from 0 to 1.

    Raises:
        ValueError: it is no colour.
    """
    functional = FUNCTIONAL.fullmatch(colour.strip())
    if functional is None:
        red, green, blue, own = to_rgba(colour)
        return red, green, blue, own * opacity
    parts = [float(part) for part in functional[1].split(",")]
    own = parts[3] if len(parts) > 3 else 1.0
    return parts[0] / 255.0, parts[1] / 255.0, parts[2] / 255.0, own * opacity
