"""The mission's acceptance, answered, with what was published beside it."""

from __future__ import annotations

from collections.abc import Sequence

from inspect_cli.reporting.markup import Markup, element, joined
from inspect_cli.reporting.published import SOURCE, published_of
from inspect_cli.reporting.table import NOTHING, Column, chip, significant, table
from inspect_cli.reporting.tables import meaning, unit_shown
from inspect_cli.schema.result import Check

VERDICT_WORDS = {
    "pass": "✓ pass",
    "fail": "✗ fail",
    "fail-known": "! known failure",
    "not_measured": "– not measured",
}


def checks_table(checks: Sequence[Check]) -> list[Block]:
    """Every acceptance entry with its bounds, the published row it answers, and our value."""
    published = any(published_of(check.ref) for check in checks)
    remarked = any(_remark(check) for check in checks)
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
    source = f" Published: {SOURCE}." if published else ""
    return table(
        "Acceptance checks: what the mission requires, the row of the ledger of published results "
        f"that a check answers for, and what this flight measured.{source}",
        columns,
        [_check_row(check, published=published, remarked=remarked) for check in checks],
    )


def _check_row(check: Check, *, published: bool, remarked: bool) -> list[str]:
    known = published_of(check.ref)
    return [
        joined(meaning(check.metric), Markup(" "), element("code", check.metric)),
        check.ref or NOTHING,
        *([known.cited(check.metric) if known else NOTHING] if published else []),
        bounds(check.min, check.max),
        significant(check.value),
        unit_shown(check.unit),
        chip(VERDICT_WORDS[check.verdict], check.verdict),
        *([_remark(check)] if remarked else []),
    ]


def _remark(check: Check) -> str:
    over = f"relative to {check.over}" if check.over else ""
    return "; ".join(part for part in (over, check.reason) if part)


def bounds(low: float | None, high: float | None) -> str:
    """A required interval in words: ≥, ≤, = or both ends."""
    if low is not None and high is not None:
        if low == high:
            return f"= {significant(low)}"
        return f"{significant(low)} … {significant(high)}"
    return f"≥ {significant(low)}" if low is not None else f"≤ {significant(high)}"
