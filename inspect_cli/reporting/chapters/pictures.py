"""Rendered pictures of a flight in its report: a scene, a film, or why there are none."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

from inspect_cli.reporting.content.blocks import Block, Film, Paragraph, Picture, Section
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import Text, say, sentences

RENDERED = "Rendered from the log"
"""Opens the second sentence of a caption; before it stands a vehicle's name, which may hold any
sign."""


class Rendered(Protocol):
    """What was rendered of a flight, with captions in our own English."""

    @property
    def scene_png(self) -> bytes | None:
        """A still."""

    @property
    def scene_caption(self) -> str:
        """What it shows."""

    @property
    def film_mp4(self) -> bytes | None:
        """A film."""

    @property
    def film_caption(self) -> str:
        """What it shows."""

    @property
    def note(self) -> str:
        """Why one of them is missing; empty when there are both."""


def pictures_sections(pictures: Rendered | None) -> list[Section]:
    """The section with the pictures; none where none were wanted."""
    if pictures is None:
        return []
    return [Section("pictures", say("Pictures"), list(_blocks(pictures)))]


def _blocks(pictures: Rendered) -> Iterator[Block]:
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
