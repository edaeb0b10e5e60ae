"""Tables of the potentials' distribution: statistics, typical conditions, the two populations."""

from __future__ import annotations

from collections.abc import Iterator

from inspect_cli.reporting.content.blocks import Block, Column, Paragraph, Table
from inspect_cli.reporting.half_cell.classes import percent
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Text,
    number,
    say,
    sentences,
    together,
)
from inspect_cli.schema.assessment import MixtureFindings, Population, SurfaceAssessment

PERCENTILES = (5, 10, 25, 50, 75, 90, 95)


def statistics_blocks(summary: SurfaceAssessment) -> list[Block]:
    """Extremes, percentiles, mean and standard deviation; or why there are none."""
    found = summary.potential
    if found is None:
        return [
            Paragraph(
                say("No statistics of the potentials: {why}.", why=recorded(summary.potential_why)),
                "note",
            )
        ]
    percentiles = [
        (say("median") if p == 50 else f"{p} %", getattr(found, f"p{p}_mv")) for p in PERCENTILES
    ]
    values: list[tuple[Text, float | None]] = [
        (say("minimum"), found.min_mv),
        *percentiles,
        (say("maximum"), found.max_mv),
        (say("mean"), found.mean_mv),
        (say("standard deviation"), found.sd_mv),
    ]
    columns = [
        Column(say("Points"), numeric=True),
        *(Column(name, "mV", numeric=True) for name, _ in values),
    ]
    row = [number(summary.valid, 0), *(number(value, 1) for _, value in values)]
    caption = say(
        "Statistics of the valid potentials. That many per cent of the points are more negative "
        "than a percentile."
    )
    return [Table(caption, columns, [row], wide=True)]


def conditions_table(summary: SurfaceAssessment) -> Table:
    """Of which states of concrete and steel the potentials are typical."""
    rows: list[list[Text]] = [
        [
            recorded(c.name),
            together(number(c.low_mv, 0), " … ", number(c.high_mv, 0)),
            number(c.count, 0),
            percent(c.count / summary.valid if summary.valid else None),
        ]
        for c in summary.conditions
    ]
    none = summary.no_condition
    rows.append(
        [
            say("typical of none of them"),
            NOTHING,
            number(none, 0),
            percent(none / summary.valid if summary.valid else None),
        ]
    )
    columns = [
        Column(say("Condition"), prose=True),
        Column(say("Typical potential"), "mV CSE", numeric=True),
        Column(say("Points"), numeric=True),
        Column(say("Share"), numeric=True),
    ]
    caption = say(
        "Conditions of concrete that the potentials are typical of (RILEM TC 154-EMC). The ranges "
        "overlap and leave gaps: a point may count in several rows or in none, and the potential "
        "alone does not tell which holds."
    )
    return Table(caption, columns, rows)


def mixture_blocks(mixture: MixtureFindings) -> list[Block]:
    """The populations with standard errors and what separates them; or why there is one."""
    if mixture.verdict is None:
        return [
            Paragraph(
                say("Populations were not separated: {why}.", why=recorded(mixture.why)), "note"
            )
        ]
    bic = say(
        "BIC {one} for one normal population, {two} for two.",
        one=number(mixture.bic_one, 1),
        two=number(mixture.bic_two, 1),
    )
    if mixture.active is None or mixture.passive is None:
        why = say(
            "The potentials are of one population: {why}.",
            why=recorded(mixture.why),
        )
        return [Paragraph(sentences([why, bic]))]
    columns = [
        Column(say("Population")),
        Column(say("Share"), numeric=True),
        Column(say("Mean"), "mV", numeric=True),
        Column(say("Standard deviation"), "mV", numeric=True),
        Column(say("Limit of 95 %"), "mV", numeric=True),
    ]
    rows = [
        _population(
            say("active"),
            mixture.active,
            mixture,
            together("< ", number(mixture.active_limit_mv, 0)),
        ),
        _population(
            say("passive"),
            mixture.passive,
            mixture,
            together("> ", number(mixture.passive_limit_mv, 0)),
        ),
    ]
    caption = say(
        "Two normal populations of potentials by maximum likelihood, ± standard errors. Active is "
        "the more negative one by their order alone. 95 % of the active population lie below its "
        "limit, 95 % of the passive one above its own."
    )
    return [
        Table(caption, columns, rows),
        Paragraph(sentences([*_threshold(mixture), bic])),
    ]


def _population(name: Text, found: Population, mixture: MixtureFindings, limit: Text) -> list[Text]:
    error = mixture.share_error
    return [
        name,
        _with_error(100.0 * found.share, None if error is None else 100.0 * error, " %"),
        _with_error(found.mean_mv, found.mean_error_mv),
        _with_error(found.sd_mv, found.sd_error_mv),
        limit,
    ]


def _with_error(value: float, error: float | None, unit: str = "") -> Text:
    if error is None:
        return together(number(value, 1), unit)
    return together(number(value, 1), " ± ", number(error, 1), unit)


def _threshold(mixture: MixtureFindings) -> Iterator[Text]:
    if mixture.threshold_mv is None:
        yield say("There is no threshold: {why}.", why=recorded(mixture.threshold_why))
    elif mixture.threshold_error_mv is None:
        yield say(
            "A reading of {mv} mV belongs to either population with probability one half.",
            mv=number(mixture.threshold_mv, 0),
        )
    else:
        yield say(
            "A reading of {mv} ± {error} mV belongs to either population with probability one "
            "half.",
            mv=number(mixture.threshold_mv, 0),
            error=number(mixture.threshold_error_mv, 0),
        )
    if mixture.errors_why:
        yield say("Standard errors are not stated: {why}.", why=recorded(mixture.errors_why))
