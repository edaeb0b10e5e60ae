"""``study.html``: what varied numbers did to a mission, on one page."""

from __future__ import annotations

from inspect_cli.reporting.content import (
    Block,
    Column,
    Cover,
    Document,
    Notes,
    Paragraph,
    Section,
    Table,
    drawn,
)
from inspect_cli.reporting.figure import Figure
from inspect_cli.reporting.published import SOURCE
from inspect_cli.reporting.recorded import recorded
from inspect_cli.reporting.tables import unit_shown
from inspect_cli.reporting.text import (
    NOTHING,
    Chip,
    Lines,
    Said,
    Text,
    code,
    number,
    say,
    sentences,
    significant,
    together,
)
from inspect_cli.schema.study import StudyResult, StudyVariant


def study_document(study: StudyResult, explained: Text, figure: Figure) -> Document:
    """What the page of a study says; it draws what ``study`` holds and computes nothing.

    Args:
        study: the flights' numbers.
        explained: what was varied and held against what, in sentences.
        figure: the metrics against the quantities.
    """
    sections = [
        Section("sweeps", say("Sweeps"), [Paragraph(explained), *drawn([figure])]),
        Section("variants", say("Variants"), [*_shortfalls(study), _numbers(study)]),
        Section("flights", say("Flights"), [_flights(study)]),
    ]
    title = Said(study.title)
    return Document(say("{title} – study", title=title), _cover(study, title), sections)


def _cover(study: StudyResult, title: Text) -> Cover:
    facts: list[tuple[Text, Text]] = [
        (say("Mission"), study.mission),
        (say("Platform"), study.platform),
        (say("Seed"), str(study.seed)),
        (say("Kind"), say("simulated flights")),
        (say("Flights"), number(len(study.variants), 0)),
        *(
            (
                say("{symbol} of the mission", symbol=q.symbol),
                together(significant(q.base), f" {q.unit}"),
            )
            for q in study.quantities
        ),
    ]
    return Cover(say("Study"), title, "", facts)


def _shortfalls(study: StudyResult) -> list[Block]:
    if not study.shortfalls:
        return []
    return [
        Paragraph(say("Flights that ended otherwise than expected:")),
        Notes(study.shortfalls),
    ]


def _numbers(study: StudyResult) -> Table:
    quantities = [Column(q.symbol, q.unit, numeric=True) for q in study.quantities]
    metrics = [Column(_lines(c.heading), unit_shown(c.unit), numeric=True) for c in study.columns]
    rows: list[list[Text]] = [
        [
            say("mission") if _as_it_stands(study, variant) else "",
            *(significant(variant.values[q.name]) for q in study.quantities),
            *(significant(variant.value(c.metric), 3) for c in study.columns),
        ]
        for variant in study.variants
    ]
    caption: list[Text] = [say("Each variant's numbers; one of them is the mission as it stands.")]
    if any(column.published is not None for column in study.columns):
        published = [significant(c.published, 3) for c in study.columns]
        rows.append([say("published"), *[NOTHING] * len(quantities), *published])
        caption.append(say("Published: {source}.", source=SOURCE))
    return Table(sentences(caption), [Column(""), *quantities, *metrics], rows, wide=True)


def _as_it_stands(study: StudyResult, variant: StudyVariant) -> bool:
    return all(variant.values[q.name] == q.base for q in study.quantities)


def _lines(heading: str) -> Lines:
    """A heading broken at its commas, for a narrow column."""
    return Lines(tuple(Said(part) for part in heading.split(", ")))


def _flights(study: StudyResult) -> Table:
    rows: list[list[Text]] = [
        [
            code(variant.folder),
            Chip(
                recorded(variant.status),
                "pass" if variant.status == study.expect_status else "fail",
            ),
            ", ".join(variant.failed_checks) or NOTHING,
        ]
        for variant in study.variants
    ]
    columns = [
        Column(say("Run's folder beside this page")),
        Column(say("Status")),
        Column(say("Checks of the mission that this variant misses"), prose=True),
    ]
    caption = say("Each is a run of its own: “inspect report” makes its page.")
    return Table(caption, columns, rows)
