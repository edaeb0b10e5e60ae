"""A survey of half-cell potentials by contact: what was found and how the readings were taken."""

from __future__ import annotations

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Block, Heading
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.evaluation import evaluation_blocks
from inspect_cli.reporting.half_cell.findings_text import few_readings, reading_caveats
from inspect_cli.reporting.half_cell.reading_method import reading_method
from inspect_cli.reporting.half_cell.readings_text import findings, reading_boxes
from inspect_cli.reporting.half_cell.scene_marks import scene_marks
from inspect_cli.reporting.half_cell.truth_table import truth_table
from inspect_cli.reporting.words.text import Text, say

INSTRUMENT = "half_cell"


def _points(material: Material) -> tuple[ReadPoint, ...]:
    return material.read_by(INSTRUMENT)


def _blocks(material: Material) -> list[Block]:
    points = _points(material)
    return [
        *evaluation_blocks(material.surfaces, points, material.result.scoring),
        *truth_table(points),
        Heading(say("How the readings were taken")),
        reading_method(material.log, material.plan, points),
    ]


def _caveats(material: Material) -> list[Text]:
    read = sum(p.point.potential_mv is not None for p in _points(material))
    return [*reading_caveats(material.surfaces), *few_readings(read)]


CHAPTER = Chapter(
    heading=say("Corrosion survey"),
    applies=lambda material: bool(_points(material)),
    blocks=_blocks,
    subjects=lambda material: [say("half-cell potential by contact")],
    sentences=lambda material: findings(_points(material), material.surfaces),
    boxes=lambda material: reading_boxes(_points(material)),
    caveats=_caveats,
    instruments=(INSTRUMENT,),
    scene_marks=lambda material: [scene_marks(_points(material))],
    shared_groups=(INSTRUMENT, "contact", "guidance"),
    spans_sorties=True,
)
