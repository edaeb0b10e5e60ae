"""Tables on paper: how small they are set, and whether they need a page on its side."""

from __future__ import annotations

from inspect_cli.reporting.content import Column, Table
from inspect_cli.reporting.figure import Json
from inspect_cli.reporting.language import Language
from inspect_cli.reporting.paper_text import runs
from inspect_cli.reporting.printable import LONGEST_WORD, breakable, printable
from inspect_cli.reporting.text import Text

UPRIGHT_MM, FLIPPED_MM = 170.0, 257.0
MM_PER_PT_OF_LETTER = 0.185
"""Width of a letter, about, per point of its size."""
CELL_INSET_MM = {False: 3.2, True: 2.2}
SIZES = (9.0, 8.0, 7.0)
WIDE_SIZES = (7.5, 7.0, 6.5)
PROSE = 24
"""Letters to a line that prose needs to be readable."""


def paper_table(table: Table, language: Language) -> Json:
    """The table's data, with the largest size of letters at which it fits a page.

    Upright where that is possible; else on its side, as small as need be.
    """
    size, landscape = _fitted(table, language)
    return {
        "is": "table",
        "caption": runs(table.caption, language),
        "wide": table.wide,
        "size": size,
        "landscape": landscape,
        "columns": [
            {
                "heading": runs(column.heading, language),
                "unit": runs(column.unit, language),
                "numeric": column.numeric,
                "prose": column.prose,
            }
            for column in table.columns
        ],
        "cells": [runs(cell, language) for row in table.rows for cell in row],
    }


def _fitted(table: Table, language: Language) -> tuple[float, bool]:
    """(size of the letters in points, whether the page lies on its side)."""
    letters = sum(
        _least_letters(column, [row[k] for row in table.rows], language)
        for k, column in enumerate(table.columns)
    )
    insets = CELL_INSET_MM[table.wide] * len(table.columns)
    sizes = WIDE_SIZES if table.wide else SIZES
    for landscape, room in ((False, UPRIGHT_MM), (True, FLIPPED_MM)):
        for size in sizes:
            if letters * size * MM_PER_PT_OF_LETTER + insets <= room:
                return size, landscape
    return sizes[-1], True


def _least_letters(column: Column, cells: list[Text], language: Language) -> int:
    """How narrow a column can be: its longest word, or a whole number."""
    texts = [printable(language.plain(cell)) for cell in cells]
    heads = [language.plain(text) for text in (column.heading, column.unit)]
    words = [_longest(head) for head in heads]
    words += [len(text) if column.numeric else _longest(text) for text in texts]
    if column.prose and any(len(text) > PROSE for text in texts):
        words.append(PROSE)
    return min(max(words, default=1), LONGEST_WORD)


def _longest(text: str) -> int:
    pieces = breakable(text).replace("\u200b", " ").split(" ")
    return max(len(piece) for piece in pieces)
