"""A report as a page for the screen: one file that loads nothing."""

from __future__ import annotations

import base64
from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import (
    Block,
    Boxes,
    Column,
    Cover,
    Document,
    Facts,
    Figures,
    Film,
    Folded,
    Heading,
    Notes,
    Paragraph,
    Picture,
    Section,
    Table,
)
from inspect_cli.reporting.figures.figure import EQUAL_FRAME_PX, Figure
from inspect_cli.reporting.screen.markup import Markup, data_script, element, escaped, joined
from inspect_cli.reporting.screen.page import page
from inspect_cli.reporting.words.language import Language, pieces
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
    say,
)

SEPARATORS = {",": ",\u202f", ".": ".\u202f"}
"""Plotly's signs for decimals and thousands, by the language's decimal sign."""
TURNING = "\u202a\u202b\u202d\u202e\u2066\u2067\u2068"
"""Characters that reverse the direction of the text after them; they must not reach the report's
own words."""


def html(document: Document, language: Language) -> str:
    """The page as text; the same document and language give the same bytes."""
    return page(
        language.plain(document.title),
        _cover(document.cover, language),
        [(s.name, inline(s.heading, language)) for s in document.sections],
        [_section(section, language) for section in document.sections],
        language,
    )


def inline(text: Text, language: Language) -> Markup:
    """A piece of text as HTML; text of users is escaped."""
    match text:
        case str():
            isolated = any(sign in text for sign in TURNING)
            return element("bdi", text) if isolated else escaped(text)
        case Said():
            return joined(
                *(
                    joined(words, inline(text.values[name], language) if name else "")
                    for words, name in pieces(language.template(text))
                )
            )
        case Amount() | Listed():
            return escaped(language.plain(text))
        case Joined(parts):
            return joined(*(inline(part, language) for part in parts))
        case Lines(items):
            first, *others = items
            more = (joined(Markup("<br>"), inline(item, language)) for item in others)
            return joined(inline(first, language), *more)
        case Marked():
            return element(text.role, inline(text.text, language))
        case Chip():
            return element("span", inline(text.text, language), class_=f"chip {text.kind}")
        case Badge():
            return element("span", inline(text.text, language), class_=f"badge {text.kind}")
        case Link():
            return element("a", inline(text.text, language), href=text.href)


def _cover(cover: Cover, language: Language) -> Markup:
    description = inline(cover.description, language)
    return joined(
        element("p", inline(cover.kicker, language), class_="kicker"),
        element("h1", inline(cover.title, language)),
        element("p", description, class_="description") if description else "",
        _facts(Facts(cover.facts), language),
    )


def _section(section: Section, language: Language) -> Markup:
    heading = f"{section.name}-heading"
    return element(
        "section",
        element("h2", inline(section.heading, language), id=heading),
        blocks(section.blocks, language),
        id=section.name,
        aria_labelledby=heading,
    )


def blocks(content: Sequence[Block], language: Language) -> Markup:
    """The blocks one after the other."""
    return joined(*(_block(block, language) for block in content))


def _block(block: Block, language: Language) -> Markup:
    match block:
        case Heading():
            return element("h3", inline(block.text, language))
        case Paragraph():
            kind: dict[str, str] = {"class_": block.role} if block.role else {}
            return element("p", inline(block.text, language), **kind)
        case Facts():
            return _facts(block, language)
        case Notes():
            return _notes(block, language)
        case Boxes():
            return _boxes(block, language)
        case Table():
            return _table(block, language)
        case Folded():
            summary = element("summary", inline(block.summary, language))
            return element("details", summary, blocks(block.blocks, language))
        case Figures():
            shown = joined(*(_figure(figure, language) for figure in block.figures))
            return element("div", shown, class_="pair") if block.side_by_side and shown else shown
        case Picture():
            return _picture(block, language)
        case Film():
            return _film(block, language)


def _facts(facts: Facts, language: Language) -> Markup:
    pairs = (
        element(
            "div",
            element("dt", inline(name, language)),
            element("dd", inline(value, language)),
        )
        for name, value in facts.pairs
    )
    return element("dl", *pairs)


def _notes(notes: Notes, language: Language) -> Markup:
    if not notes.items:
        return Markup("")
    items = (element("li", inline(item, language)) for item in notes.items)
    attributes: dict[str, str] = {"class_": notes.role} if notes.role else {}
    if notes.role == "warnings":
        attributes |= {"role": "note", "aria_label": language.plain(say("Warnings"))}
    return element("ul", *items, **attributes)


def _boxes(content: Boxes, language: Language) -> Markup:
    items = (
        element(
            "li",
            element("span", inline(box.value, language), class_="value"),
            element("span", joined(" ", inline(box.unit, language)), class_="unit")
            if box.unit
            else "",
            element("span", inline(box.name, language), class_="name"),
        )
        for box in content.boxes
    )
    return element("ul", *items, class_="boxes")


def _table(content: Table, language: Language) -> Markup:
    head = element("tr", *(_heading(column, language) for column in content.columns))
    body = joined(*(_row(content.columns, row, language) for row in content.rows))
    whole = element(
        "table",
        element("caption", inline(content.caption, language)),
        element("thead", head),
        element("tbody", body),
        class_="wide" if content.wide else "plain",
    )
    label = language.plain(content.caption)
    return element("div", whole, class_="scroll", role="region", aria_label=label, tabindex="0")


def _heading(column: Column, language: Language) -> Markup:
    unit = inline(column.unit, language)
    shown = joined(" ", element("span", unit, class_="unit")) if unit else Markup("")
    text = joined(inline(column.heading, language), shown)
    return element("th", text, scope="col", **_kind(column))


def _row(columns: Sequence[Column], cells: Sequence[Text], language: Language) -> Markup:
    written = []
    for k, (column, cell) in enumerate(zip(columns, cells, strict=True)):
        text = inline(cell, language)
        if k == 0:
            written.append(element("th", text, scope="row", **_kind(column)))
        else:
            written.append(element("td", text, **_kind(column)))
    return element("tr", *written)


def _kind(column: Column) -> dict[str, str]:
    """What the style sheet needs to know of a cell in this column."""
    kind = "number" if column.numeric else "prose" if column.prose else ""
    return {"class_": kind} if kind else {}


def _figure(figure: Figure, language: Language) -> Markup:
    """The figure element; the page's script draws it from the data beside it."""
    name = f"plot-{figure.name}"
    plot = element(
        "div",
        id=name,
        class_="plot",
        role="group",
        aria_label=language.plain(figure.description),
        style=f"height:{_height(figure)}",
    )
    layout = {**figure.layout, "separators": SEPARATORS[language.decimal_sign]}
    content = {"data": figure.traces, "layout": layout, "timed": figure.timed}
    data = data_script(language.resolved(content), data_plot=name)
    caption = element("figcaption", inline(figure.caption, language))
    return element("figure", plot, data, caption, id=figure.name)


def _height(figure: Figure) -> str:
    if figure.slope is None:
        return f"{figure.height_px}px"
    return f"min({figure.height_px}px, calc({EQUAL_FRAME_PX}px + {100.0 * figure.slope:.1f}vw))"


def _picture(picture: Picture, language: Language) -> Markup:
    source = f"data:image/png;base64,{base64.b64encode(picture.png).decode('ascii')}"
    image = element("img", src=source, alt=language.plain(picture.description))
    caption = element("figcaption", inline(picture.caption, language))
    return element("figure", image, caption, class_="picture")


def _film(film: Film, language: Language) -> Markup:
    source = f"data:video/mp4;base64,{base64.b64encode(film.mp4).decode('ascii')}"
    label = language.plain(film.description)
    video = element(
        "video",
        src=source,
        controls="",
        muted="",
        playsinline="",
        preload="metadata",
        aria_label=label,
    )
    caption = element("figcaption", inline(film.caption, language))
    return element("figure", video, caption, class_="picture")
