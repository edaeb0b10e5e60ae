"""What a chapter of a report is.

A chapter adds itself with one file and one row in ``registry.CHAPTERS``, or with an entry point of
an installed package in the group ``inspect_cli.chapters``. A report consists of the chapters that
apply to its flight; screen and paper show the same.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass

from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Box
from inspect_cli.reporting.figures.scene_marks import SceneMarks
from inspect_cli.reporting.words.text import Text


def _no_blocks(material: Material) -> Iterable[Block]:
    return ()


def _no_boxes(material: Material) -> Iterable[Box]:
    return ()


def _no_text(material: Material) -> Iterable[Text]:
    return ()


def _no_marks(material: Material) -> Iterable[SceneMarks]:
    return ()


@dataclass(frozen=True)
class Chapter:
    """One chapter; every part but ``heading`` and ``applies`` may be left out.

    All functions take the material of the report and are called only where the chapter applies.
    """

    heading: Text
    applies: Callable[[Material], bool]
    """Whether the flight has anything to do with this chapter."""
    blocks: Callable[[Material], Iterable[Block]] = _no_blocks
    """The section of the chapter; without blocks there is no section."""
    subjects: Callable[[Material], Iterable[Text]] = _no_text
    """What the line above the title calls the flight."""
    sentences: Callable[[Material], Iterable[Text]] = _no_text
    """What was done and what came out, for the summary."""
    boxes: Callable[[Material], Iterable[Box]] = _no_boxes
    """Key figures for the summary."""
    caveats: Callable[[Material], Iterable[Text]] = _no_text
    """What the chapter's numbers do not say."""
    instruments: tuple[str, ...] = ()
    """Kinds of the instruments whose points the chapter shows; it applies wherever one of them was
    read. Points of an instrument that no chapter names stand in the chapter on other readings."""
    scene_marks: Callable[[Material], Iterable[SceneMarks]] = _no_marks
    """What it adds to the view of the structure in the chapter on the flight."""
    metric_groups: tuple[str, ...] = ()
    """Groups of metrics (the part of a name before its dot) that the chapter's own table shows."""
    shared_groups: tuple[str, ...] = ()
    """Further groups that concern the chapter, shown by the chapter on the flight. A group that is
    named by chapters and by none that applies is left out of the report."""
    spans_sorties: bool = False
    """Whether the section also fits a survey of several sorties. One that draws a log does not."""
    on_paper: bool = True
    """Whether a printed report carries the section."""
    appendix: bool = False
    """Whether the section follows those on what the mission was for."""
