"""The table of acceptance checks with the published values beside ours."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.content.blocks import Column, Table
from inspect_cli.reporting.content.metrics_table import meaning, unit_shown
from inspect_cli.reporting.words.published import SOURCE, published_of
from inspect_cli.reporting.words.recorded import recorded
from inspect_cli.reporting.words.text import (
    NOTHING,
    Chip,
    Text,
    code,
    say,
    sentences,
    separated,
    significant,
    together,
)
from inspect_cli.schema.result import Check, Verdict

VERDICT_WORDS: dict[Verdict, Text] = {
    "pass": say("✓ pass"),
    "fail": say("✗ fail"),
    "fail-known": say("! known failure"),
    "not_measured": say("– not measured"),
}


def checks_table(checks: Sequence[Check]) -> Table:
    """Every acceptance entry with its bounds, the published row it answers, and our value."""
    published = any(published_of(check.ref) for check in checks)
    remarked = any(check.over or check.reason for check in checks)
    columns = [
        Column(say("Check"), prose=True),
        Column(say("Reference")),
        *([Column(say("Published"), prose=True)] if published else []),
        Column(say("Required"), numeric=True),
        Column(say("Measured"), numeric=True),
        Column(say("Unit")),
        Column(say("Verdict")),
        *([Column(say("Remark"), prose=True)] if remarked else []),
    ]
    what = say(
        "Acceptance checks: what the mission requires, the row of the ledger of published results "
        "that a check answers for, and what this flight measured."
    )
    source = say("Published: {source}.", source=SOURCE) if published else ""
    rows = [_check_row(check, published=published, remarked=remarked) for check in checks]
    return Table(sentences([what, source]), columns, rows)


def _check_row(check: Check, *, published: bool, remarked: bool) -> list[Text]:
    known = published_of(check.ref)
    return [
        together(meaning(check.metric), " ", code(check.metric)),
        check.ref or NOTHING,
        *([known.cited(check.metric) if known else NOTHING] if published else []),
        bounds(check.min, check.max),
        significant(check.value),
        unit_shown(check.unit),
        Chip(VERDICT_WORDS[check.verdict], check.verdict),
        *([_remark(check)] if remarked else []),
    ]


def _remark(check: Check) -> Text:
    """What a value is relative to, and why it is missing; a known failure in its author's words."""
    over = say("relative to {metric}", metric=check.over) if check.over else ""
    theirs = check.verdict == "fail-known"
    return separated([over, check.reason if theirs else recorded(check.reason)], "; ")


def bounds(low: float | None, high: float | None) -> Text:
    """A required interval in signs: ≥, ≤, = or both ends."""
    if low is not None and high is not None:
        if low == high:
            return together("= ", significant(low))
        return together(significant(low), " … ", significant(high))
    if low is not None:
        return together("≥ ", significant(low))
    return together("≤ ", significant(high))
