"""Rendered pictures of a flight in its report: a scene, a film, or why there are none."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Rendered
from inspect_cli.reporting.content.blocks import Block, Film, Paragraph, Picture
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, say, sentences

RENDERED = "Rendered from the log"
"""Opens the second sentence of a caption; before it stands a vehicle's name, which may hold any
sign."""


def picture_blocks(pictures: Rendered | None) -> Iterator[Block]:
    """The scene and the film with their captions, and why one is missing; none if not wanted."""
    if pictures is None:
        return
    if pictures.scene_png is not None:
        description = say("Rendered view of the vehicle at the structure with its readings.")
        yield Picture(pictures.scene_png, caption(pictures.scene_caption), description)
    if pictures.film_mp4 is not None:
        description = say("Film of the flight.")
        yield Film(pictures.film_mp4, caption(pictures.film_caption), description)
    if pictures.note:
        yield Paragraph(recorded(pictures.note), "note")


def caption(text: str) -> Text:
    """A caption sentence by sentence, so that a language can put it in its own words."""
    first, mark, rest = text.partition(f". {RENDERED}. ")
    if not mark:
        return recorded(text)
    others = rest.removesuffix(".").split(". ")
    return sentences(recorded(f"{part}.") for part in (first, RENDERED, *others))


CHAPTER = Chapter(
    heading=say("Pictures"),
    applies=lambda material: material.pictures is not None,
    blocks=lambda material: picture_blocks(material.pictures),
    spans_sorties=True,
)
