"""``study.html``: what varied numbers did to a mission, on one page."""

from __future__ import annotations

from inspect_cli.reporting.figure import Figure, drawn
from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.page import Section, page
from inspect_cli.reporting.published import SOURCE
from inspect_cli.reporting.table import NOTHING, Column, chip, definitions, significant, table
from inspect_cli.schema.study import StudyResult, StudyVariant


def study_html(study: StudyResult, explained: str, figure: Figure) -> str:
    """The page as text; it draws what ``study`` holds and computes nothing.

    Args:
        study: the flights' numbers.
        explained: what was varied and held against what, in sentences.
        figure: the metrics against the quantities.
    """
    sections = [
        Section("sweeps", "Sweeps", joined(element("p", explained), drawn([figure]))),
        Section("variants", "Variants", joined(_shortfalls(study), _numbers(study))),
        Section("flights", "Flights", _flights(study)),
    ]
    return page(f"{study.title} – study", _header(study), sections)


def _header(study: StudyResult) -> list[Block]:
    facts = [
        ("Mission", study.mission),
        ("Platform", study.platform),
        ("Seed", str(study.seed)),
        ("Kind", "simulated flights"),
        ("Flights", str(len(study.variants))),
        *(
            (f"{q.symbol} of the mission", f"{significant(q.base)} {q.unit}")
            for q in study.quantities
        ),
    ]
    kicker = element("p", "Study", class_="kicker")
    return joined(kicker, element("h1", study.title), definitions(facts))


def _shortfalls(study: StudyResult) -> list[Block]:
    if not study.shortfalls:
        return Markup("")
    items = (element("li", text) for text in study.shortfalls)
    return joined(
        element("p", "Flights that ended otherwise than expected:"), element("ul", *items)
    )


def _numbers(study: StudyResult) -> list[Block]:
    quantities = [Column(q.symbol, q.unit, numeric=True) for q in study.quantities]
    metrics = [Column(_lines(c.heading), _unit(c.unit), numeric=True) for c in study.columns]
    rows = [
        [
            "mission" if _as_it_stands(study, variant) else "",
            *(significant(variant.values[q.name]) for q in study.quantities),
            *(significant(variant.value(c.metric), 3) for c in study.columns),
        ]
        for variant in study.variants
    ]
    published = [significant(c.published, 3) for c in study.columns]
    caption = "Each variant's numbers; one of them is the mission as it stands."
    if any(cell != NOTHING for cell in published):
        rows.append(["published", *[NOTHING] * len(quantities), *published])
        caption += f" Published: {SOURCE}."
    return table(caption, [Column(""), *quantities, *metrics], rows, wide=True)


def _as_it_stands(study: StudyResult, variant: StudyVariant) -> bool:
    return all(variant.values[q.name] == q.base for q in study.quantities)


def _lines(heading: str) -> list[Block]:
    """A heading broken at its commas, for a narrow column."""
    first, *others = heading.split(", ")
    return joined(first, *(joined(Markup("<br>"), other) for other in others))


def _unit(unit: str) -> str:
    return "" if unit == "1" else unit


def _flights(study: StudyResult) -> list[Block]:
    rows = [
        [
            element("code", variant.folder),
            chip(variant.status, "pass" if variant.status == study.expect_status else "fail"),
            ", ".join(variant.failed_checks) or NOTHING,
        ]
        for variant in study.variants
    ]
    columns = [
        Column(say("Run's folder beside this page")),
        Column(say("Status")),
        Column(say("Checks of the mission that this variant misses"), prose=True),
    ]
    caption = "Each is a run of its own: “inspect report” makes its page."
    return table(caption, columns, rows)
