"""Pieces of text as data for the typesetter: runs of words, and what sets each run apart."""

from __future__ import annotations

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.words.language import Language, pieces
from inspect_cli.reporting.words.printable import breakable, printable
from inspect_cli.reporting.words.text import (
    Amount,
    Badge,
    Chip,
    Joined,
    Lines,
    Link,
    Listed,
    Marked,
    Said,
    Text,
)


def runs(text: Text, language: Language) -> list[Json]:
    """The piece as runs ``{"is": …, "text" or "body": …}``; printable, and breakable if long.

    A link is its words alone: on paper, and beside other files than the report's own, it leads
    nowhere.
    """
    match text:
        case str():
            return _words(text)
        case Said():
            found: list[Json] = []
            for words, name in pieces(language.template(text)):
                found += _words(words)
                found += runs(text.values[name], language) if name else []
            return found
        case Amount() | Listed():
            return _words(language.plain(text))
        case Joined(parts):
            return [run for part in parts for run in runs(part, language)]
        case Lines(items):
            broken = [[{"is": "break"}, *runs(item, language)] for item in items]
            return [run for line in broken for run in line][1:]
        case Marked():
            return [{"is": text.role, "body": runs(text.text, language)}]
        case Chip():
            return [{"is": "chip", "kind": printable(text.kind), "body": runs(text.text, language)}]
        case Badge():
            return [
                {"is": "badge", "kind": printable(text.kind), "body": runs(text.text, language)}
            ]
        case Link():
            return runs(text.text, language)


def _words(text: str) -> list[Json]:
    return [{"is": "text", "text": breakable(printable(text))}] if text else []
