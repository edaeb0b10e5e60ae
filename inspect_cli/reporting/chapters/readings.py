"""Readings of instruments that have no chapter of their own: name, value, unit and validity."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Box, Table
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.content.values_table import values_marks, values_table
from inspect_cli.reporting.figures.scene_marks import SceneMarks
from inspect_cli.reporting.words.text import Text, count, number, say, together


def _by_instrument(material: Material) -> dict[str, list[ReadPoint]]:
    """The points of each instrument, in the order in which they first appear."""
    found: dict[str, list[ReadPoint]] = {}
    for point in material.other_points:
        found.setdefault(point.instrument, []).append(point)
    return found


def _blocks(material: Material) -> Iterator[Table]:
    for instrument, points in _by_instrument(material).items():
        yield values_table(instrument, points)


def _subjects(material: Material) -> Iterator[Text]:
    for instrument in _by_instrument(material):
        yield say("readings of {instrument}", instrument=instrument)


def _sentences(material: Material) -> Iterator[Text]:
    for instrument, points in _by_instrument(material).items():
        yield count(
            sum(p.point.valid for p in points),
            "{n} of {total} readings of the instrument “{instrument}” is valid.",
            "{n} of {total} readings of the instrument “{instrument}” are valid.",
            total=number(len(points), 0),
            instrument=instrument,
        )


def _boxes(material: Material) -> Iterator[Box]:
    for instrument, points in _by_instrument(material).items():
        valid = number(sum(p.point.valid for p in points), 0)
        name = say("valid readings of {instrument}", instrument=instrument)
        yield Box(name, together(valid, " / ", number(len(points), 0)))


def _scene_marks(material: Material) -> Iterator[SceneMarks]:
    for instrument, points in _by_instrument(material).items():
        yield values_marks(instrument, points)


CHAPTER = Chapter(
    heading=say("Other readings"),
    applies=lambda material: bool(material.other_points),
    blocks=_blocks,
    subjects=_subjects,
    sentences=_sentences,
    boxes=_boxes,
    scene_marks=_scene_marks,
    shared_groups=("contact", "guidance"),
    spans_sorties=True,
)
