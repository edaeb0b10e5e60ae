"""``report.html`` of a flight, or of a survey of several sorties: the chapters that apply."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import replace

from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.log.reader import RunLog
from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Coverage, Material, Rendered
from inspect_cli.reporting.chapters.registry import chapters
from inspect_cli.reporting.content.blocks import Document, Section
from inspect_cli.reporting.documents.cover import cover
from inspect_cli.reporting.documents.summary import summary
from inspect_cli.reporting.words.text import say
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Result


def report_document(
    log: RunLog,
    result: Result,
    plan: Plan,
    surfaces: Sequence[SurfaceFindings] = (),
    pictures: Rendered | None = None,
) -> Document:
    """What the report of a flight says, in no language yet.

    Raises:
        EnvironmentFault: an installed chapter cannot be used.
    """
    return _document(Material(log, result, plan, surfaces, pictures))


def survey_document(
    log: RunLog,
    result: Result,
    flown: Sequence[Result],
    survey: CoveragePlan,
    plan: Plan,
    surfaces: Sequence[SurfaceFindings] = (),
    pictures: Rendered | None = None,
) -> Document:
    """What the report of a survey says, in no language yet.

    Args:
        log: of the first sortie.
        result: of all sorties joined.
        flown: the results of the sorties one by one.
        survey: the plan of the survey.
        plan: its sorties joined.
        surfaces: the findings over the readings of all sorties.
        pictures: of the first sortie.

    Raises:
        EnvironmentFault: an installed chapter cannot be used.
    """
    coverage = Coverage(survey, flown)
    return _document(Material(log, result, plan, surfaces, pictures, coverage))


def _document(material: Material) -> Document:
    known = chapters()
    material = replace(
        material,
        shown_instruments=frozenset(kind for c in known.values() for kind in c.instruments),
    )
    written = {name: chapter for name, chapter in known.items() if chapter.applies(material)}
    material = replace(
        material,
        scene_marks=[marks for c in written.values() for marks in c.scene_marks(material)],
        own_groups=frozenset(g for chapter in known.values() for g in chapter.metric_groups),
        hidden_groups=_groups(known.values()) - _groups(written.values()),
    )
    opening = Section("summary", say("Summary"), summary(material, written.values()))
    title = material.log.mission().title or material.result.mission
    whole = (
        say("{title} – inspection report", title=title)
        if material.points or material.coverage
        else say("{title} – flight report", title=title)
    )
    sections = [opening, *_sections(material, written)]
    return Document(whole, cover(material, written.values(), title), sections)


def _groups(chapters: Iterable[Chapter]) -> frozenset[str]:
    """The groups of metrics that concern any of the chapters."""
    return frozenset(g for c in chapters for g in (*c.metric_groups, *c.shared_groups))


def _sections(material: Material, written: Mapping[str, Chapter]) -> list[Section]:
    sections = []
    for name, chapter in written.items():
        if material.coverage is not None and not chapter.spans_sorties:
            continue
        blocks = list(chapter.blocks(material))
        if blocks:
            sections.append(Section(name, chapter.heading, blocks, chapter.on_paper))
    return sections
