"""Coverage of a surface: what was asked for, what was left out, and the way through it."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.chapters.chapter import Chapter
from inspect_cli.reporting.content.blocks import Block, Column, Paragraph, Table, drawn
from inspect_cli.reporting.flight.sorties import tour_figures
from inspect_cli.reporting.words.text import Text, count, number, say, sentences
from inspect_cli.schema.coverage import CoveragePlan, Skipped
from inspect_cli.schema.plan import Plan


def _coverage(survey: CoveragePlan, plan: Plan) -> list[Block]:
    added = [t.label for s in survey.sorties if s.added for t in s.plan.targets]
    statements: list[Text] = [
        extent(survey),
        say(
            "The shortest way that was found through the standoffs of all points is {length} m, "
            "before it was split.",
            length=number(survey.tour_m, 1),
        ),
    ]
    if added:
        statements.append(
            count(
                len(added),
                "{labels} was added by the refinement rule of ASTM C876, between neighbours whose "
                "readings differ by more than the mission allows; a label names those neighbours.",
                "{labels} were added by the refinement rule of ASTM C876, between neighbours whose "
                "readings differ by more than the mission allows; a label names those neighbours.",
                labels=", ".join(added),
            )
        )
    return [
        Paragraph(sentences(statements)),
        *drawn(tour_figures(survey, plan)),
        *_skipped_table(survey.skipped),
    ]


def extent(survey: CoveragePlan) -> Text:
    """How much of the surface was asked for and how much was left out."""
    points = number(survey.points, 0)
    sorties = count(len(survey.sorties), "{n} sortie", "{n} sorties")
    if not survey.skipped:
        return say(
            "{points} points were planned in {sorties}; none was left out.",
            points=points,
            sorties=sorties,
        )
    return count(
        len(survey.skipped),
        "{points} points were planned in {sorties}; {n} was left out.",
        "{points} points were planned in {sorties}; {n} were left out.",
        points=points,
        sorties=sorties,
    )


def _skipped_table(skipped: Sequence[Skipped]) -> list[Block]:
    if not skipped:
        return []
    rows: list[list[Text]] = [
        [point.label, point.surface, *(number(x, 3) for x in point.uv_m), point.reason]
        for point in skipped
    ]
    columns = [
        Column(say("Point")),
        Column(say("Surface")),
        Column("u", "m", numeric=True),
        Column("v", "m", numeric=True),
        Column(say("Reason"), prose=True),
    ]
    return [Table(say("Points that were left out, and why."), columns, rows)]


CHAPTER = Chapter(
    heading=say("Coverage"),
    applies=lambda material: material.coverage is not None,
    blocks=lambda material: (
        _coverage(material.coverage.plan, material.plan) if material.coverage else ()
    ),
    spans_sorties=True,
)
