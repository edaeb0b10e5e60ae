"""From the results of several flights of one survey to one result."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

from inspect_cli.metrics.acceptance import answer_all
from inspect_cli.metrics.aggregation import Joined
from inspect_cli.metrics.assessed import with_uncertainty
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.catalogue_assessment import assessment_metrics
from inspect_cli.metrics.catalogue_scoring import metrics_of
from inspect_cli.metrics.evaluation import Evaluation
from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.metrics.readings import AssessAll, ScoreAll
from inspect_cli.schema.mission import Acceptance
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import Metric, PointResult, Result, Status
from inspect_cli.schema.scoring import Scoring

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed

UNVISITED = "not visited"
MISSED = ("contact.points_total", *(n for row in INSTRUMENTS.values() for n in row.missed))
"""Counts in which a point that no flight came to counts, too."""


def joined_result(
    results: Sequence[Result],
    unvisited: Sequence[Target],
    acceptance: Iterable[Acceptance],
    seed: int | None,
    score_all: ScoreAll | None = None,
    assess_all: AssessAll | None = None,
) -> Result:
    """The result of a survey: see ``joined_evaluation``, which returns the arrays, too."""
    return joined_evaluation(results, unvisited, acceptance, seed, score_all, assess_all).result


def joined_evaluation(
    results: Sequence[Result],
    unvisited: Sequence[Target],
    acceptance: Iterable[Acceptance],
    seed: int | None,
    score_all: ScoreAll | None = None,
    assess_all: AssessAll | None = None,
) -> Evaluation:
    """The flights as one survey: all points, every metric by its rule, the mission's acceptance.

    Args:
        results: of the flights in their order, one at least.
        unvisited: the targets of flights that were planned and not flown.
        acceptance: of the mission.
        seed: of the whole run, from which those of the flights were drawn.
        score_all: holds all points together against what is truly so, where that is known.
        assess_all: finds what all points together say (``readings.assessor``).
    """
    first = results[0]
    points = tuple(_numbered([*_visited(results), *map(_never_read, unvisited)]))
    scoring = score_all(points) if score_all else None
    assessed = assess_all(points) if assess_all else ()
    metrics = joined_metrics(results, len(unvisited), scoring, assessed)
    status, reason = _status(results, len(unvisited))
    result = Result(
        mission=first.mission,
        platform=first.platform,
        seed=seed,
        status=status,
        status_reason=reason,
        checks=answer_all(acceptance, metrics),
        metrics=metrics,
        points=with_uncertainty(points, assessed),
        scoring=scoring,
        assessment=tuple(one.summary for one in assessed),
    )
    return Evaluation(result, assessed)


def joined_metrics(
    results: Sequence[Result],
    unvisited: int = 0,
    scoring: Scoring | None = None,
    assessed: Sequence[Assessed] = (),
) -> dict[str, Metric]:
    """Every metric of the flights by the rule that stands beside it in the catalogue.

    A metric that one of the flights does not have is not measured of the survey either. The
    ``unvisited`` points of flights that were not flown count as points and have no reading.
    ``scoring`` and ``assessed`` are those of all points.
    """
    known = metrics_of(scoring) if scoring else {}
    known |= assessment_metrics(assessed) if assessed else {}
    metrics = {
        name: known.get(name) or _joined(name, spec.joined, results)
        for name, spec in METRICS.items()
    }
    if not unvisited:
        return metrics
    for name in MISSED:
        value = metrics[name].value
        if value is not None:
            metrics[name] = metrics[name].model_copy(update={"value": value + unvisited})
    total, valid = metrics["contact.points_total"].value, metrics["contact.points_valid"].value
    if total is not None and valid is not None:
        share = metrics["contact.valid_share"].model_copy(update={"value": valid / total})
        metrics["contact.valid_share"] = share
    return metrics


def _joined(name: str, joined: Joined, results: Sequence[Result]) -> Metric:
    unit = METRICS[name].unit
    if joined.rule == "none":
        why = "it belongs to a single flight and is in the report of each"
        return Metric(value=None, unit=unit, why=why)
    if joined.rule == "anew":
        first = results[0].metrics.get(name)
        why = (
            first.why if first else ""
        ) or "the points of all sorties were not looked at together"
        return Metric(value=None, unit=unit, why=why)
    needed = [name, joined.weight] if joined.weight else [name]
    for number, result in enumerate(results, 1):
        for other in needed:
            metric = result.metrics.get(other)
            if metric is None or metric.value is None:
                why = metric.why if metric else f"there is no metric '{other}'"
                return Metric(value=None, unit=unit, why=f"sortie {number}: {why}")
    values = [_value(result, name) for result in results]
    weights = [_value(result, joined.weight) if joined.weight else 1.0 for result in results]
    if joined.weight and sum(weights) <= 0.0:
        return Metric(value=None, unit=unit, why=f"{joined.weight} is zero in every sortie")
    return Metric(value=joined.of(values, weights), unit=unit)


def _value(result: Result, name: str) -> float:
    return result.metrics[name].value or 0.0


def _status(results: Sequence[Result], unvisited: int) -> tuple[Status, str]:
    """Completed if every flight was; else how the first that was not ended."""
    for number, result in enumerate(results, 1):
        if result.status != "completed":
            why = f": {result.status_reason}" if result.status_reason else ""
            return result.status, f"sortie {number} was {result.status}{why}"
    if unvisited:
        only = (
            "the first sortie was"
            if len(results) == 1
            else f"the first {len(results)} sorties were"
        )
        return "interrupted", f"only {only} flown"
    return "completed", ""


def _visited(results: Sequence[Result]) -> Iterable[PointResult]:
    return (point for result in results for point in result.points)


def _never_read(target: Target) -> PointResult:
    described = INSTRUMENTS[target.sensor].reader.described() if target.sensor else {}
    return PointResult(
        index=target.index,
        label=target.label,
        valid=False,
        reason=UNVISITED,
        p_W=target.p_WC,
        surface=target.surface or "",
        uv_m=target.uv_m,
        probe_force_n=None,
        contact_s=0.0,
        **described,
    )


def _numbered(points: Iterable[PointResult]) -> Iterable[PointResult]:
    """The points with their place in the whole survey as their index."""
    for index, point in enumerate(points):
        yield point.model_copy(update={"index": index})
