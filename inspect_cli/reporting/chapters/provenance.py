"""The chapter on provenance: files, versions, seed, plan, chosen constants."""

from __future__ import annotations

import hashlib

from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import (
    Block,
    Column,
    Facts,
    Heading,
    Notes,
    Paragraph,
    Table,
)
from inspect_cli.reporting.words.text import (
    NOTHING,
    Text,
    code,
    number,
    say,
    sentences,
    strong,
    together,
)
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def _blocks(material: Material) -> list[Block]:
    """Everything that is needed to compute the page again; it holds no time of day."""
    facts = _provenance(material.log, material.result, material.plan)
    if material.coverage is None:
        return facts
    note = say("Attachments and versions are those of the first sortie; all fly with the same.")
    return [Paragraph(note), *facts]


def _provenance(log: RunLog, result: Result, plan: Plan) -> list[Block]:
    platform = log.platform()
    mission = log.mission()
    facts = Facts(
        [
            (say("Mission"), result.mission),
            (say("Platform"), f"{result.platform} ({platform.kind})"),
            (say("Impedance profile"), plan.impedance or NOTHING),
            (say("Estimation"), mission.estimation),
            (say("Seed"), NOTHING if result.seed is None else str(result.seed)),
            (say("Planned duration"), together(number(plan.duration_s, 1), " s")),
            (say("Planned energy"), together(number(plan.energy_wh, 1), " Wh")),
            (say("Planned path"), together(number(plan.path_m, 1), " m")),
        ]
    )
    source = strong(say("Source of the platform's numbers."))
    sourced = [Paragraph(sentences([source, platform.source]))] if platform.source else []
    return [facts, *sourced, *_warnings(plan), *_versions(log), _files(log), *_chosen(log)]


def _warnings(plan: Plan) -> list[Block]:
    if not plan.warnings:
        return []
    return [Heading(say("Warnings of the planner")), Notes(plan.warnings)]


def _versions(log: RunLog) -> list[Block]:
    if not log.versions:
        return []
    rows = [[name, version] for name, version in sorted(log.versions.items())]
    columns = [Column(say("Software")), Column(say("Version"))]
    return [Table(say("Versions of what computed the flight."), columns, rows)]


def _files(log: RunLog) -> Table:
    rows: list[list[Text]] = [
        [name, number(len(data), 0), code(hashlib.sha256(data).hexdigest())]
        for name, data in sorted(log.attachments.items())
    ]
    columns = [
        Column(say("Attachment")),
        Column(say("Size"), say("bytes"), numeric=True),
        Column("SHA-256", prose=True),
    ]
    return Table(say("Files that the log carries."), columns, rows)


def _chosen(log: RunLog) -> list[Block]:
    """Numbers of the platform that no source gives, each with its reason."""
    chosen = log.platform().chosen
    if not chosen:
        return []
    rows = [[name, reason] for name, reason in sorted(chosen.items())]
    caption = say("Numbers of the platform that no source gives, and why they were chosen.")
    return [Table(caption, [Column(say("Number")), Column(say("Reason"), prose=True)], rows)]


CHAPTER = Chapter(
    heading=say("Provenance"),
    applies=lambda material: True,
    blocks=_blocks,
    spans_sorties=True,
    appendix=True,
)
