"""The cover of a flight's report: what was flown, with what, and how it ended."""

from __future__ import annotations

from collections.abc import Iterable

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.chapters.material import Material
from inspect_cli.reporting.content.blocks import Cover
from inspect_cli.reporting.content.opening import SIGNED
from inspect_cli.reporting.documents.summary import is_simulated
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import NOTHING, Badge, Text, say, separated, together


def cover(material: Material, chapters: Iterable[Chapter], title: str) -> Cover:
    """What stands before everything else; above the title, the subjects of the chapters."""
    log, result = material.log, material.result
    mission, platform = log.mission(), log.platform()
    facts: list[tuple[Text, Text]] = [
        (say("Mission"), result.mission),
        (say("Platform"), platform.title or result.platform),
        (say("Seed"), NOTHING if result.seed is None else str(result.seed)),
        (say("Kind"), say("simulated flight") if is_simulated(log) else say("flight")),
        (say("Status"), Badge(recorded(result.status), result.status)),
    ]
    signed = () if is_simulated(log) else SIGNED
    return Cover(_kicker(material, chapters), title, mission.description, facts, signed)


def _kicker(material: Material, chapters: Iterable[Chapter]) -> Text:
    """The line over the title."""
    parts = [subject for chapter in chapters for subject in chapter.subjects(material)]
    kind = say("Inspection report") if material.profile.readings else say("Flight report")
    return together(kind, " · ", separated(parts, ", ")) if parts else kind
