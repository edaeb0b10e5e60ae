"""``study.html``: how varied parameters change the metrics of a mission."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import (
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
from inspect_cli.reporting.content.metrics_table import unit_shown
from inspect_cli.reporting.figures.figure import Figure
from inspect_cli.reporting.words.published import SOURCE
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
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

WHOLE = 100.0
"""From this value on, three significant digits are a whole number."""


def study_document(study: StudyResult, explained: Text, figures: Sequence[Figure]) -> Document:
    """What the page of a study says; it draws what ``study`` holds and computes nothing.

    Args:
        study: the flights' numbers.
        explained: what was varied and held against what, in sentences.
        figures: the metrics against the quantities.
    """
    sweeps: list[Block] = [*_findings(study), Paragraph(explained), *drawn(figures)]
    sections = [
        Section("sweeps", say("Sweeps"), sweeps),
        Section("variants", say("Variants"), [*_shortfalls(study), _numbers(study)]),
    ]
    if _flown(study):
        sections.append(Section("flights", say("Flights"), [_flights(study)]))
    title = Said(study.title)
    return Document(say("{title} – study", title=title), _cover(study, title), sections)


def _cover(study: StudyResult, title: Text) -> Cover:
    facts: list[tuple[Text, Text]] = [
        (say("Mission"), study.mission),
        (say("Platform"), study.platform),
        (say("Seed"), str(study.seed)),
        (say("Kind"), _kind(study)),
        (say("Flights"), number(len(_flown(study)), 0)),
        *(
            (
                say("{symbol} of the mission", symbol=q.symbol),
                together(significant(q.base), f" {q.unit}"),
            )
            for q in study.quantities
        ),
    ]
    return Cover(say("Study"), title, "", facts)


def _kind(study: StudyResult) -> Text:
    if not study.trials:
        return say("simulated flights")
    trials = number(study.trials, 0)
    if not _flown(study):
        return say("planned, and sampled {n} times each", n=trials)
    return say("planned, and sampled {n} times each; flown once in simulation", n=trials)


def _flown(study: StudyResult) -> list[StudyVariant]:
    """The variants that have a folder of a run, or should have one."""
    return [variant for variant in study.variants if variant.folder is not None]


def _findings(study: StudyResult) -> list[Block]:
    return [Paragraph(recorded(text), "finding") for text in study.findings]


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
            _named(study, variant),
            *(significant(variant.values[q.name]) for q in study.quantities),
            *(_value(variant, c.metric) for c in study.columns),
        ]
        for variant in study.variants
    ]
    caption: list[Text] = [say("Each variant's numbers; one of them is the mission as it stands.")]
    if any(column.published is not None for column in study.columns):
        published = [significant(c.published, 3) for c in study.columns]
        rows.append([say("published"), *[NOTHING] * len(quantities), *published])
        caption.append(say("Published: {source}.", source=SOURCE))
    return Table(
        sentences(caption), [Column(say("Variant")), *quantities, *metrics], rows, wide=True
    )


def _named(study: StudyResult, variant: StudyVariant) -> Text:
    name = code(variant.name)
    return Lines((name, say("mission"))) if _as_it_stands(study, variant) else name


def _value(variant: StudyVariant, metric: str) -> Text:
    """A number, with its standard error if it is a mean."""
    value, error = variant.value(metric), variant.standard_errors.get(metric)
    shown = significant(value, 3) if abs(value or 0.0) < WHOLE else number(value, 0)
    return shown if error is None else together(shown, " ± ", significant(error, 2))


def _as_it_stands(study: StudyResult, variant: StudyVariant) -> bool:
    return all(variant.values[q.name] == q.base for q in study.quantities)


def _lines(heading: str) -> Lines:
    """A heading broken at its commas, for a narrow column."""
    return Lines(tuple(Said(part) for part in heading.split(", ")))


def _flights(study: StudyResult) -> Table:
    rows: list[list[Text]] = [
        [
            code(variant.folder or ""),
            Chip(
                recorded(variant.status),
                "pass" if variant.status == study.expect_status else "fail",
            ),
            ", ".join(variant.failed_checks) or NOTHING,
        ]
        for variant in _flown(study)
    ]
    columns = [
        Column(say("Run's folder beside this page")),
        Column(say("Status")),
        Column(say("Checks of the mission that this variant misses"), prose=True),
    ]
    caption = say("Each is a run of its own: “inspect report” makes its page.")
    return Table(caption, columns, rows)
