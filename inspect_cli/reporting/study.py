"""``study.html``: what varied numbers did to a mission, on one page."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.figure import Figure, drawn
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.page import Section, page
from inspect_cli.reporting.published import SOURCE
from inspect_cli.reporting.table import (
    NOTHING,
    Column,
    chip,
    definitions,
    number,
    significant,
    table,
)
from inspect_cli.schema.study import StudyResult, StudyVariant

WHOLE = 100.0
"""From here on three digits are a whole number."""


def study_html(study: StudyResult, explained: str, figures: Sequence[Figure]) -> str:
    """The page as text; it draws what ``study`` holds and computes nothing.

    Args:
        study: the flights' numbers.
        explained: what was varied and held against what, in sentences.
        figures: the metrics against the quantities.
    """
    sweeps = joined(_findings(study), element("p", explained), drawn(figures))
    sections = [
        Section("sweeps", "Sweeps", sweeps),
        Section("variants", "Variants", joined(_shortfalls(study), _numbers(study))),
    ]
    if _flown(study):
        sections.append(Section("flights", "Flights", _flights(study)))
    return page(f"{study.title} – study", _header(study), sections)


def _header(study: StudyResult) -> Markup:
    facts = [
        ("Mission", study.mission),
        ("Platform", study.platform),
        ("Seed", str(study.seed)),
        ("Kind", _kind(study)),
        ("Flights", str(len(_flown(study)))),
        *(
            (f"{q.symbol} of the mission", f"{significant(q.base)} {q.unit}")
            for q in study.quantities
        ),
    ]
    kicker = element("p", "Study", class_="kicker")
    return joined(kicker, element("h1", study.title), definitions(facts))


def _kind(study: StudyResult) -> str:
    if not study.trials:
        return "simulated flights"
    sampled = f"planned, and sampled {study.trials} times each"
    return f"{sampled}; flown once in simulation" if _flown(study) else sampled


def _flown(study: StudyResult) -> list[StudyVariant]:
    """The variants that have a folder of a run, or should have one."""
    return [variant for variant in study.variants if variant.folder is not None]


def _findings(study: StudyResult) -> Markup:
    return joined(*(element("p", element("strong", text)) for text in study.findings))


def _shortfalls(study: StudyResult) -> Markup:
    if not study.shortfalls:
        return Markup("")
    items = (element("li", text) for text in study.shortfalls)
    return joined(
        element("p", "Flights that ended otherwise than expected:"), element("ul", *items)
    )


def _numbers(study: StudyResult) -> Markup:
    quantities = [Column(q.symbol, q.unit, numeric=True) for q in study.quantities]
    metrics = [Column(_lines(c.heading), _unit(c.unit), numeric=True) for c in study.columns]
    rows = [
        [
            "mission" if _as_it_stands(study, variant) else "",
            *(significant(variant.values[q.name]) for q in study.quantities),
            *(_value(variant, c.metric) for c in study.columns),
        ]
        for variant in study.variants
    ]
    published = [significant(c.published, 3) for c in study.columns]
    caption = "Each variant's numbers; one of them is the mission as it stands."
    if any(cell != NOTHING for cell in published):
        rows.append(["published", *[NOTHING] * len(quantities), *published])
        caption += f" Published: {SOURCE}."
    return table(caption, [Column(""), *quantities, *metrics], rows, wide=True)


def _value(variant: StudyVariant, metric: str) -> str:
    """A number, with its standard error if it is a mean."""
    value, error = variant.value(metric), variant.standard_errors.get(metric)
    shown = significant(value, 3) if abs(value or 0.0) < WHOLE else number(value, 0)
    return shown if error is None else f"{shown} ± {significant(error, 2)}"


def _as_it_stands(study: StudyResult, variant: StudyVariant) -> bool:
    return all(variant.values[q.name] == q.base for q in study.quantities)


def _lines(heading: str) -> Markup:
    """A heading broken at its commas, for a narrow column."""
    first, *others = heading.split(", ")
    return joined(first, *(joined(Markup("<br>"), other) for other in others))


def _unit(unit: str) -> str:
    return "" if unit == "1" else unit


def _flights(study: StudyResult) -> Markup:
    rows = [
        [
            element("code", variant.folder or ""),
            chip(variant.status, "pass" if variant.status == study.expect_status else "fail"),
            ", ".join(variant.failed_checks) or NOTHING,
        ]
        for variant in _flown(study)
    ]
    columns = [
        Column("Run's folder beside this page"),
        Column("Status"),
        Column("Checks of the mission that this variant misses", prose=True),
    ]
    caption = "Each is a run of its own: “inspect report” makes its page."
    return table(caption, columns, rows)
