"""Tables with a caption, and numbers as a reader wants them."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

from inspect_cli.reporting.markup import Markup, element, joined

NOTHING = "–"
MINUS = "\u2212"


@dataclass(frozen=True)
class Column:
    """A column's heading with its unit, and what its cells hold."""

    heading: str
    unit: str = ""
    numeric: bool = False
    """Numbers are set flush right and never broken."""
    prose: bool = False
    """Sentences keep a readable width where the table has to scroll."""

    @property
    def attributes(self) -> dict[str, str]:
        """What the style sheet needs to know of a cell in this column."""
        kind = "number" if self.numeric else "prose" if self.prose else ""
        return {"class_": kind} if kind else {}


def number(value: float | None, digits: int) -> str:
    """A number with ``digits`` decimals and a true minus; a dash when there is none."""
    if value is None or not math.isfinite(value):
        return NOTHING
    return f"{value:,.{digits}f}".replace(",", "\u202f").replace("-", MINUS)


def significant(value: float | None, digits: int = 4) -> str:
    """A number of any size with ``digits`` significant ones."""
    if value is None or not math.isfinite(value):
        return NOTHING
    return f"{value:.{digits}g}".replace("-", MINUS)


def table(
    caption: str, columns: Sequence[Column], rows: Sequence[Sequence[str]], *, wide: bool = False
) -> Markup:
    """A table; the first cell of each row is its heading. It scrolls by itself when too wide."""
    head = element("tr", *(_heading(column) for column in columns))
    body = joined(*(_row(columns, row) for row in rows))
    whole = element(
        "table",
        element("caption", caption),
        element("thead", head),
        element("tbody", body),
        class_="wide" if wide else "plain",
    )
    return element("div", whole, class_="scroll", role="region", aria_label=caption, tabindex="0")


def definitions(pairs: Sequence[tuple[str, str]]) -> Markup:
    """A list of names and what they stand for."""
    return element(
        "dl",
        *(element("div", element("dt", name), element("dd", value)) for name, value in pairs),
    )


def chip(text: str, kind: str) -> Markup:
    """A word with a coloured mark before it; ``kind`` is a class of the style sheet."""
    return element("span", text, class_=f"chip {kind}")


def _heading(column: Column) -> Markup:
    unit = element("span", column.unit, class_="unit") if column.unit else Markup("")
    text = joined(column.heading, Markup(" ") if column.unit else "", unit)
    return element("th", text, scope="col", **column.attributes)


def _row(columns: Sequence[Column], cells: Sequence[str]) -> Markup:
    written = []
    for k, (column, cell) in enumerate(zip(columns, cells, strict=True)):
        if k == 0:
            written.append(element("th", cell, scope="row", **column.attributes))
        else:
            written.append(element("td", cell, **column.attributes))
    return element("tr", *written)
