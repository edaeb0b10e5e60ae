"""All chapters that a report may have, in their order: adding one takes a file and a row here."""

from __future__ import annotations

from collections.abc import Mapping

from inspect_cli.plugins import registered
from inspect_cli.reporting.chapters import (
    contact,
    coverage,
    drawing,
    flight,
    ground_truth,
    half_cell,
    holding,
    pictures,
    provenance,
    pulls,
    readings,
    servoing,
    sorties,
    structure,
)
from inspect_cli.reporting.chapters.chapter import Chapter

GROUP = "inspect_cli.chapters"
"""Entry points of installed packages; each names a ``Chapter``."""

CHAPTERS: Mapping[str, Chapter] = {
    "pictures": pictures.CHAPTER,
    "survey": half_cell.CHAPTER,
    "readings": readings.CHAPTER,
    "drawing": drawing.CHAPTER,
    "servoing": servoing.CHAPTER,
    "contact": contact.CHAPTER,
    "pulls": pulls.CHAPTER,
    "holding": holding.CHAPTER,
    "ground-truth": ground_truth.CHAPTER,
    "coverage": coverage.CHAPTER,
    "sorties": sorties.CHAPTER,
    "flight": flight.CHAPTER,
    "structure": structure.CHAPTER,
    "provenance": provenance.CHAPTER,
}
"""By the anchor of the section."""


def chapters() -> dict[str, Chapter]:
    """The built-in chapters and those of installed packages, appendices last.

    Raises:
        EnvironmentFault: an installed chapter cannot be imported or has a name that is taken.
    """
    found = registered(GROUP, CHAPTERS, Chapter)
    return dict(sorted(found.items(), key=lambda row: row[1].appendix))
