"""The surfaces as the planner believed them."""

from __future__ import annotations

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.flight.fits_table import fits_table
from inspect_cli.reporting.words.text import say

CHAPTER = Chapter(
    heading=say("Structure"),
    applies=lambda material: bool(material.plan.surfaces),
    blocks=lambda material: [fits_table(material.plan)],
    spans_sorties=True,
    appendix=True,
)
