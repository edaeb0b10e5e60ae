"""``study.json``: what came out of one mission that was flown with varied numbers."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Name, Strict
from inspect_cli.schema.result import Metric, Status


class Quantity(Strict):
    """A number that a study varies."""

    name: Name
    symbol: str
    unit: str
    base: float
    """What the mission and its platform say: held while the other quantities are varied."""

    @property
    def heading(self) -> str:
        """The symbol with its unit, as a table's head."""
        return f"{self.symbol} /{self.unit}"


class StudyColumn(Strict):
    """A metric that a study shows of every variant."""

    metric: str
    heading: str
    unit: str
    published: float | None = None
    """The number that a publication reports, for the mission as it stands."""


class StudyVariant(Strict):
    """The mission with one choice of the varied quantities, and what its flight came to."""

    name: Name
    folder: str | None
    """Of its run, relative to the study's file; None where it was not to be flown."""
    values: dict[Name, float]
    status: Status | Literal["not flown", "sampled"]
    status_reason: str = ""
    failed_checks: tuple[str, ...] = ()
    """Metrics of the mission's acceptance that the variant misses: told, not held against it."""
    metrics: dict[str, Metric]
    """Those that the study shows."""
    standard_errors: dict[str, float] = {}
    """Of the metrics that are means over several trials."""

    def value(self, metric: str) -> float | None:
        """A metric's value; None where there is none."""
        found = self.metrics.get(metric)
        return found.value if found else None


class Threshold(Strict):
    """Where a metric first falls below a level, as a quantity grows."""

    metric: str
    quantity: Name
    level: float
    first_below: float | None
    """The quantity's smallest value with the metric below the level; None where there is none."""


class StudyResult(Strict):
    """The whole of ``study.json``."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    study: Name
    title: str
    mission: str
    platform: str
    seed: int
    expect_status: Status
    """How the mission's flights have to end."""
    quantities: Annotated[tuple[Quantity, ...], Field(min_length=1)]
    columns: tuple[StudyColumn, ...]
    variants: Annotated[tuple[StudyVariant, ...], Field(min_length=1)]
    trials: Annotated[int, Field(ge=0)] = 0
    """Samples without a flight that each variant's means were taken over."""
    common: dict[str, Metric] = {}
    """Of every variant alike: what is truly so where they are sampled."""
    thresholds: tuple[Threshold, ...] = ()
    findings: tuple[str, ...] = ()
    """What came out, in sentences."""

    def sweep(self, quantity: Quantity) -> tuple[StudyVariant, ...]:
        """The variants that differ from the mission in this quantity alone, by its value."""
        others = {q.name: q.base for q in self.quantities if q is not quantity}
        alone = [
            variant
            for variant in self.variants
            if all(variant.values[name] == base for name, base in others.items())
        ]
        return tuple(sorted(alone, key=lambda variant: variant.values[quantity.name]))

    @property
    def shortfalls(self) -> tuple[str, ...]:
        """The variants that ended otherwise or lack a number, each with the reason."""
        return tuple(
            f"{variant.name}: {why}" for variant in self.variants if (why := self._short(variant))
        )

    def _short(self, variant: StudyVariant) -> str:
        if variant.status not in (self.expect_status, "sampled"):
            return ": ".join(filter(None, (variant.status, variant.status_reason)))
        missing = (c.metric for c in self.columns if variant.value(c.metric) is None)
        found = ((name, variant.metrics.get(name)) for name in missing)
        return ", ".join(
            f"{name}: {metric.why if metric else 'no number'}" for name, metric in found
        )
