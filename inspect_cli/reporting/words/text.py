"""Pieces of text before they are put into a language.

A piece is a plain ``str`` if it is somebody else's (a title, a label, a unit, a name): it is shown
as it is. Whatever the project says itself is ``say("…")``, whatever is a number is ``number(…)`` or
``significant(…)``, so that a language can put it in its own words and signs.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from typing import Literal, TypeAlias


@dataclass(frozen=True)
class Said:
    """A sentence of ours. ``template`` is its English, with {names} for the ``values``."""

    template: str
    values: Mapping[str, Text] = field(default_factory=dict)
    many: str = ""
    """The English for any ``count`` but one; empty where nothing is counted."""
    count: int = 1


@dataclass(frozen=True)
class Amount:
    """A number as a reader wants it: with so many decimals, or so many significant digits."""

    value: float | None
    digits: int
    significant: bool = False


@dataclass(frozen=True)
class Joined:
    """Pieces one after the other."""

    parts: tuple[Text, ...]


@dataclass(frozen=True)
class Listed:
    """Pieces as an enumeration: "1, 2 and 3"."""

    items: tuple[Text, ...]


@dataclass(frozen=True)
class Marked:
    """A piece set apart from the text around it."""

    text: Text
    role: Literal["strong", "code", "sub"]


@dataclass(frozen=True)
class Chip:
    """A word with a coloured mark before it; ``kind`` names the class that the mark stands for."""

    text: Text
    kind: str


@dataclass(frozen=True)
class Badge:
    """A word in a coloured frame."""

    text: Text
    kind: str


@dataclass(frozen=True)
class Link:
    """A link to another file beside the report."""

    text: Text
    href: str


@dataclass(frozen=True)
class Lines:
    """Pieces one below the other."""

    items: tuple[Text, ...]


Text: TypeAlias = str | Said | Amount | Joined | Listed | Marked | Chip | Badge | Link | Lines

NOTHING = "–"


def say(template: str, **values: Text) -> Said:
    """A sentence of ours; the template is what the catalogues of languages are keyed with."""
    return Said(template, values)


def count(n: int, one: str, many: str, **values: Text) -> Said:
    """``one`` if ``n`` is 1, else ``many``; {n} stands for the number in both."""
    return Said(one, {"n": number(n, 0), **values}, many, n)


def number(value: float | None, digits: int) -> Amount:
    """A number with ``digits`` decimals; a dash when there is none."""
    return Amount(value, digits)


def significant(value: float | None, digits: int = 4) -> Amount:
    """A number with ``digits`` significant digits."""
    return Amount(value, digits, significant=True)


def together(*parts: Text) -> Joined:
    """Pieces one after the other, with nothing between."""
    return Joined(parts)


def sentences(parts: Iterable[Text]) -> Joined:
    """Sentences with a blank between each two."""
    return separated(parts, " ")


def separated(parts: Iterable[Text], sign: str) -> Joined:
    """The pieces that say something, with ``sign`` between each two."""
    kept = [part for part in parts if part]
    return Joined(tuple(piece for part in kept for piece in (sign, part))[1:])


def strong(text: Text) -> Marked:
    """A piece that stands out."""
    return Marked(text, "strong")


def code(text: str) -> Marked:
    """A name as programs know it."""
    return Marked(text, "code")


def indexed(text: str) -> Text:
    """A symbol of a formula: ``f_x`` with its index below the line."""
    base, _, index = text.partition("_")
    return together(base, Marked(index, "sub")) if index else text


def exists(value: float | None) -> bool:
    """Whether there is a number to show."""
    return value is not None and math.isfinite(value)
