"""What a report says, before it is a page: blocks of text, numbers, tables and figures.

The content is free of any language and of any medium. ``screen`` and ``paper`` turn the same
document into a page for the screen and into one for paper, in a ``Language``.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import Literal, TypeAlias

from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.words.text import Text

REPORT_NAME = "report.html"
"""The page of a flight, a survey or a file, in its folder; pages link to one another by it."""


@dataclass(frozen=True)
class Column:
    """A column's heading with its unit, and what its cells hold."""

    heading: Text
    unit: Text = ""
    numeric: bool = False
    """Numbers are set flush right and never broken."""
    prose: bool = False
    """Sentences keep a readable width where the table has to scroll."""


@dataclass(frozen=True)
class Heading:
    """Opens a part of a section."""

    text: Text


@dataclass(frozen=True)
class Paragraph:
    """Running text; ``role`` sets findings and rules apart."""

    text: Text
    role: Literal["", "finding", "rule", "note"] = ""


@dataclass(frozen=True)
class Facts:
    """Pairs of a name and its value."""

    pairs: Sequence[tuple[Text, Text]]


@dataclass(frozen=True)
class Notes:
    """A list of sentences; warnings cannot be overlooked."""

    items: Sequence[Text]
    role: Literal["", "warnings", "caveats"] = ""


@dataclass(frozen=True)
class Box:
    """A key figure."""

    name: Text
    value: Text
    unit: Text = ""


@dataclass(frozen=True)
class Boxes:
    """Key figures side by side."""

    boxes: Sequence[Box]


@dataclass(frozen=True)
class Table:
    """A table under a caption; the first cell of each row is its heading."""

    caption: Text
    columns: Sequence[Column]
    rows: Sequence[Sequence[Text]]
    wide: bool = False
    """Whether the table has many columns and is set in smaller letters."""


@dataclass(frozen=True)
class Folded:
    """Blocks that a screen shows on demand and paper leaves out."""

    summary: Text
    blocks: Sequence[Block]


@dataclass(frozen=True)
class Figures:
    """Drawings one after the other, or in two columns where there is room."""

    figures: Sequence[Figure]
    side_by_side: bool = False


@dataclass(frozen=True)
class Picture:
    """A rendered image, PNG."""

    png: bytes
    caption: Text
    description: Text
    """What a screen reader says instead."""


@dataclass(frozen=True)
class Film:
    """A short film, MP4, that the screen alone shows."""

    mp4: bytes
    caption: Text
    description: Text


Block: TypeAlias = (
    Heading | Paragraph | Facts | Notes | Boxes | Table | Folded | Figures | Picture | Film
)


def drawn(figures: Iterable[Figure], *, side_by_side: bool = False) -> list[Block]:
    """The figures as a block; nothing where there is none."""
    kept = tuple(figures)
    return [Figures(kept, side_by_side)] if kept else []


@dataclass(frozen=True)
class Section:
    """A part of the report under a heading; ``name`` is its anchor."""

    name: str
    heading: Text
    blocks: Sequence[Block]
    on_paper: bool = True
    """Whether a printed report carries it: the diagrams of a flight stay on the screen."""


@dataclass(frozen=True)
class Cover:
    """The opening of a report, before its sections."""

    kicker: Text
    """The line over the title: what kind of report this is."""
    title: Text
    description: Text
    facts: Sequence[tuple[Text, Text]]
    signed: Sequence[Text] = ()
    """Lines to be filled in by hand, on paper only."""


@dataclass(frozen=True)
class Document:
    """A whole report."""

    title: Text
    """Title of the browser window and of the file."""
    cover: Cover
    sections: Sequence[Section]
