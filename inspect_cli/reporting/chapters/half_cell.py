"""A survey of half-cell potentials by contact: what was found and how the readings were taken."""

from __future__ import annotations

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Heading
from inspect_cli.reporting.half_cell.evaluation import evaluation_blocks
from inspect_cli.reporting.half_cell.findings_text import few_readings, reading_caveats
from inspect_cli.reporting.half_cell.reading_method import reading_method
from inspect_cli.reporting.half_cell.readings_text import findings, reading_boxes
from inspect_cli.reporting.half_cell.truth_table import truth_table
from inspect_cli.reporting.words.text import Text, say


def _blocks(material: Material) -> list[Block]:
    return [
        *evaluation_blocks(material.surfaces, material.points, material.result.scoring),
        *truth_table(material.points),
        Heading(say("How the readings were taken")),
        reading_method(material.log, material.plan),
    ]


def _caveats(material: Material) -> list[Text]:
    read = sum(p.point.potential_mv is not None for p in material.points)
    return [*reading_caveats(material.surfaces), *few_readings(read)]


CHAPTER = Chapter(
    heading=say("Corrosion survey"),
    applies=lambda material: bool(material.points),
    blocks=_blocks,
    subjects=lambda material: [say("half-cell potential by contact")],
    sentences=lambda material: findings(material.points, material.surfaces),
    boxes=lambda material: reading_boxes(material.points),
    caveats=_caveats,
    shared_groups=("half_cell", "contact", "guidance"),
    spans_sorties=True,
)
