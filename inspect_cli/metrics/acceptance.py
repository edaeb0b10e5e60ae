"""The mission's acceptance entries, answered from metrics."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from difflib import get_close_matches

from inspect_cli.schema.mission import Acceptance
from inspect_cli.schema.result import Check, Metric, Result, Verdict

Resolve = Callable[[str], Result | None]
"""From a mission's name to its result at the same seed; None if it was not flown."""


def answer_all(
    entries: Iterable[Acceptance], metrics: Mapping[str, Metric], resolve: Resolve | None = None
) -> tuple[Check, ...]:
    """One check for each acceptance entry, in order; see ``answer``."""
    return tuple(answer(entry, metrics, resolve) for entry in entries)


def answer(
    entry: Acceptance, metrics: Mapping[str, Metric], resolve: Resolve | None = None
) -> Check:
    """Hold a metric against its bounds, which belong to the accepted range.

    A metric that is unknown, that the log cannot tell, or whose divisor is not at hand has the
    verdict ``not_measured``, which never passes; a ``known_failure`` does not excuse it. A
    ``known_failure`` that holds after all passes, and the reason says so.

    Args:
        entry: the bounds.
        metrics: the run's metrics by name.
        resolve: finds the other mission of an ``over`` entry; without it there is none.
    """
    value = _value(entry.metric, metrics)
    if entry.over is not None and not value.why:
        value = _ratio(value, entry.over.mission, entry.over.metric, resolve)
    verdict, reason = _verdict(entry, value)
    return Check(
        metric=entry.metric,
        value=value.value,
        unit=value.unit,
        min=entry.min,
        max=entry.max,
        ref=entry.ref,
        verdict=verdict,
        reason=reason,
        over=None if entry.over is None else f"{entry.over.mission}:{entry.over.metric}",
    )


def _verdict(entry: Acceptance, metric: Metric) -> tuple[Verdict, str]:
    if metric.value is None:
        return "not_measured", metric.why
    above = entry.min is None or metric.value >= entry.min
    below = entry.max is None or metric.value <= entry.max
    if above and below:
        note = "marked as a known failure, but it holds" if entry.known_failure else ""
        return "pass", note
    if entry.known_failure:
        return "fail-known", entry.known_failure
    return "fail", ""


def _value(name: str, metrics: Mapping[str, Metric]) -> Metric:
    if name not in metrics:
        near = get_close_matches(name, metrics, n=1)
        hint = f"; did you mean '{near[0]}'?" if near else ""
        return Metric(value=None, unit="", why=f"there is no metric '{name}'{hint}")
    metric = metrics[name]
    if metric.value is None:
        return Metric(value=None, unit=metric.unit, why=metric.why or "it was not measured")
    return metric


def _ratio(metric: Metric, mission: str, name: str, resolve: Resolve | None) -> Metric:
    if resolve is None:
        why = f"it compares with mission '{mission}', which only `inspect regress` flies beside it"
        return Metric(value=None, unit=metric.unit, why=why)
    other = resolve(mission)
    if other is None:
        why = f"mission '{mission}' was not flown with the same seed"
        return Metric(value=None, unit=metric.unit, why=why)
    divisor = _value(name, other.metrics)
    unit = "1" if divisor.unit == metric.unit else f"{metric.unit}/({divisor.unit})"
    if divisor.value is None:
        return Metric(value=None, unit=unit, why=f"in mission '{mission}': {divisor.why}")
    if divisor.value == 0.0 or metric.value is None:
        return Metric(value=None, unit=unit, why=f"'{name}' is zero in mission '{mission}'")
    return Metric(value=metric.value / divisor.value, unit=unit)
