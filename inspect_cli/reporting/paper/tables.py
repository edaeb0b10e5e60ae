"""Tables on paper: size of letters, width of columns, upright or landscape page.

The typesetter would give every column its widest line first and leave sentences the rest; here a
column is never narrower than its longest word, and what room is left goes where lines are long.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.figures.figure import Json
from inspect_cli.reporting.paper.runs import runs
from inspect_cli.reporting.words.language import Language
from inspect_cli.reporting.words.printable import BREAK, breakable, printable
from inspect_cli.reporting.words.text import Badge, Chip, Joined, Lines, Marked, Text

UPRIGHT_MM, FLIPPED_MM = 170.0, 257.0
MM_PER_PT_OF_LETTER = 0.178
"""Width of an average letter per point of its size."""
CELL_INSET_MM = {False: 3.2, True: 2.2}
"""Left and right of a cell, together."""
SIZES = {False: (9.0, 8.0, 7.0), True: (7.5, 7.0, 6.5)}
PROSE = 22.0
"""Letters per line that a sentence needs to be readable."""
LONGEST_LINE = 90.0
NARROW, BROAD = frozenset("iljftrI.,:;'|!()[]-/ "), frozenset("mwMW@%&—…")
LATIN = 0x2100
"""Beyond this, characters come from broader fonts."""
BOLDER = 1.1
"""Factor by which bold letters are wider."""
SHORT = 10.0
"""Longest cell that is never broken, in letters."""
MARK_LETTERS = 2.4
"""Width of the mark before a word, in letters."""
UNBROKEN = 400
"""Letters; a row with a longer cell may be broken over pages, others stay together. A longer
heading is not repeated on each page, of which it would leave nothing."""


@dataclass(frozen=True)
class Extent:
    """Letters per line of a column: the least it needs, and the most it could use."""

    least: float
    most: float


def paper_table(table: Table, language: Language) -> Json:
    """The table's data with the largest letters at which it fits a page, upright if possible."""
    extents = [
        _extent(column, [row[k] for row in table.rows], language)
        for k, column in enumerate(table.columns)
    ]
    size, room_mm = _fitted(extents, wide=table.wide)
    return {
        "is": "table",
        "caption": runs(table.caption, language),
        "wide": table.wide,
        "size": size,
        "repeated": all(len(language.plain(c.heading)) < UNBROKEN for c in table.columns),
        "landscape": room_mm == FLIPPED_MM,
        "widths": _widths(extents, size, room_mm, CELL_INSET_MM[table.wide]),
        "columns": [
            {
                "heading": runs(column.heading, language),
                "unit": runs(column.unit, language),
                "numeric": column.numeric,
            }
            for column in table.columns
        ],
        "cells": [
            {"body": runs(cell, language), "long": len(language.plain(cell)) > UNBROKEN}
            for row in table.rows
            for cell in row
        ],
    }


def turned(blocks: Sequence[Json]) -> list[Json]:
    """The blocks with those on their side put together, each with the heading that opens it."""
    found: list[Json] = []
    for block in blocks:
        if not block.get("landscape"):
            found.append(block)
            continue
        if found and found[-1]["is"] == "landscape":
            found[-1]["blocks"].append(block)
            continue
        opening = [found.pop()] if found and found[-1]["is"] == "heading" else []
        found.append({"is": "landscape", "blocks": [*opening, block]})
    return found


def _fitted(extents: Sequence[Extent], *, wide: bool) -> tuple[float, float]:
    """(size of the letters in points, width of the page); the smallest if nothing is enough."""
    insets = CELL_INSET_MM[wide] * len(extents)
    for room_mm in (UPRIGHT_MM, FLIPPED_MM):
        for size in SIZES[wide]:
            if sum(e.least for e in extents) * size * MM_PER_PT_OF_LETTER + insets <= room_mm:
                return size, room_mm
    return SIZES[wide][-1], FLIPPED_MM


def _widths(extents: Sequence[Extent], size: float, room_mm: float, inset_mm: float) -> list[float]:
    """Width of each column in mm: what it needs, and a share of what is left by what it lacks."""
    letter_mm = size * MM_PER_PT_OF_LETTER
    least = [e.least * letter_mm + inset_mm for e in extents]
    lacking = [(e.most - e.least) * letter_mm for e in extents]
    left = room_mm - sum(least)
    if left < 0.0:
        return [width * room_mm / sum(least) for width in least]
    share = min(1.0, left / sum(lacking)) if sum(lacking) > 0.0 else 0.0
    return [width + share * more for width, more in zip(least, lacking, strict=True)]


def _extent(column: Column, cells: Sequence[Text], language: Language) -> Extent:
    """A number and what is short are never broken, other cells only between words."""
    least, most = 1.0, 1.0
    for text in (column.heading, column.unit):
        words = printable(language.plain(text))
        least = max(least, BOLDER * _longest_word(words))
        most = max(most, BOLDER * _letters(words))
    for cell in cells:
        words, is_code = printable(language.plain(cell)), _is_code(cell)
        extra = MARK_LETTERS if isinstance(cell, Chip | Badge) else 0.0
        whole = _letters(words, even=is_code) + extra
        needed = whole if column.numeric else _longest_word(words, even=is_code) + extra
        needed = max(needed, min(whole, PROSE)) if column.prose else needed
        needed = whole if whole <= SHORT else needed
        least, most = max(least, needed), max(most, min(whole, LONGEST_LINE))
    return Extent(least, max(least, most))


def _is_code(cell: Text) -> bool:
    """Whether it holds a name in letters of even width."""
    if isinstance(cell, Joined | Lines):
        return any(map(_is_code, cell.parts if isinstance(cell, Joined) else cell.items))
    return isinstance(cell, Marked) and cell.role == "code"


def _longest_word(text: str, *, even: bool = False) -> float:
    pieces = breakable(text).replace(BREAK, " ").split(" ")
    return max(_letters(piece, even=even) for piece in pieces)


def _letters(text: str, *, even: bool = False) -> float:
    """Width of the text in average letters."""
    if even:
        return float(len(text))
    return sum(
        0.62
        if c in NARROW
        else 1.7
        if c in BROAD or ord(c) > LATIN
        else 1.3
        if c.isupper()
        else 0.95
        for c in text
    )
