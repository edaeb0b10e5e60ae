"""From a log to everything that is said of the flight."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.metrics.acceptance import answer_all
from inspect_cli.metrics.assessed import with_uncertainty
from inspect_cli.metrics.catalogue import METRICS
from inspect_cli.metrics.catalogue_assessment import assessment_metrics
from inspect_cli.metrics.catalogue_scoring import metrics_of
from inspect_cli.metrics.evaluation import Evaluation
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.readings import (
    assessor,
    channels_of,
    has_readings,
    point_results,
    scoring_of,
)
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.schema.result import Metric, PointResult, Result
from inspect_cli.schema.scoring import Scoring

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed


def evaluate(log: RunLog) -> Result:
    """The result of a flight: see ``evaluate_with_arrays``, which returns the arrays, too."""
    return evaluate_with_arrays(log).result


def evaluate_with_arrays(log: RunLog) -> Evaluation:
    """Compute every metric, the fate of every point, and the mission's acceptance.

    The log alone is enough. Checks that divide by another mission's metric stay
    ``not_measured`` here; ``inspect_cli.regression`` answers them from several results.

    Raises:
        LogError: mission, platform or plan are not attached to the log.
    """
    flight = FlightData(log)
    mission = flight.mission
    # The states of a diverged flight overflow; what is not finite is caught number by number.
    with np.errstate(all="ignore"):
        scoring = _scoring(flight)
        points = point_results(flight)
        assessed = _assessed(flight, points)
        known = metrics_of(scoring) if scoring else {}
        known |= assessment_metrics(assessed) if assessed else {}
        metrics = {n: known.get(n) or measure(spec, flight) for n, spec in METRICS.items()}
        points = with_uncertainty(points, assessed)
    result = Result(
        mission=mission.name,
        platform=log.platform().name,
        seed=log.seed,
        status=log.status,
        status_reason=log.status_reason,
        checks=answer_all(mission.acceptance, metrics),
        metrics=metrics,
        points=points,
        scoring=scoring,
        assessment=tuple(one.summary for one in assessed),
    )
    return Evaluation(result, assessed)


def _assessed(flight: FlightData, points: Sequence[PointResult]) -> tuple[Assessed, ...]:
    """The findings of every surface; none of a log that has no readings."""
    if not has_readings(flight):
        return ()
    return assessor(flight.mission, flight.platform, flight.plan.targets)(points)


def _scoring(flight: FlightData) -> Scoring | None:
    """The verdicts against the truth, taken once for all the metrics that show parts of it."""
    if not has_readings(flight):
        return None
    try:
        return scoring_of(flight)
    except NotMeasured:
        return None


def measure(spec: MetricSpec, flight: FlightData) -> Metric:
    """The metric's value, or None and the reason why the log cannot tell it."""
    needed = channels_of(flight, spec.needs)
    missing = [record.topic for record in needed if flight.log.rows(record) is None]
    if missing:
        return Metric(value=None, unit=spec.unit, why=f"the log has no {', '.join(missing)}")
    try:
        value = spec.function(flight)
    except NotMeasured as reason:
        return Metric(value=None, unit=spec.unit, why=str(reason))
    if not math.isfinite(value):
        return Metric(value=None, unit=spec.unit, why="the log holds numbers that are not finite")
    return Metric(value=value, unit=spec.unit)
