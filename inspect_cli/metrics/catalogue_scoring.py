"""Metrics of the verdicts against what is truly so; of a survey, over all its points anew."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

from inspect_cli.metrics.aggregation import ANEW
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.readings import scoring_of
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import PointReading
from inspect_cli.schema.result import Metric
from inspect_cli.schema.scoring import Scoring

NOTHING_ACTIVE = "nothing is truly active in the measured region"


@dataclass(frozen=True)
class Score:
    """A number of a scoring; NaN where there is none."""

    unit: str
    of: Callable[[Scoring], float]
    meaning: str


def detected_share(scoring: Scoring) -> float:
    """1 − missed / truly active area; NaN where nothing is truly active."""
    confusion = scoring.confusion()
    if confusion.active_m2 == 0.0:
        return math.nan
    return 1.0 - confusion.missed_m2 / confusion.active_m2


def too_resistive_share(scoring: Scoring) -> float:
    """Of the truly active area; NaN where nothing is truly active."""
    active_m2 = scoring.confusion().active_m2
    return scoring.too_resistive_m2 / active_m2 if active_m2 > 0.0 else math.nan


SCORES: dict[str, Score] = {
    "scoring.region_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion().region_m2,
        "the measured region: a square of one pitch around each planned point",
    ),
    "scoring.active_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion().active_m2,
        "truly active area in the measured region",
    ),
    "scoring.missed_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion().missed_m2,
        "truly active area in the measured region without the combined verdict active",
    ),
    "scoring.false_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion().false_m2,
        "area with the combined verdict active that is not truly so",
    ),
    "scoring.detected_share": Score(
        "1", detected_share, "truly active area with the combined verdict active, as a share"
    ),
    "scoring.too_resistive_area_m2": Score(
        "m²",
        lambda scoring: scoring.too_resistive_m2,
        "truly active area whose true resistivity is too high for the combined verdict active",
    ),
    "scoring.too_resistive_share": Score(
        "1", too_resistive_share, "the same as a share of the truly active area"
    ),
    "scoring.potential_missed_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion("astm").missed_m2,
        "truly active area in the measured region that ASTM C876's class does not call active",
    ),
    "scoring.potential_false_area_m2": Score(
        "m²",
        lambda scoring: scoring.confusion("astm").false_m2,
        "area that ASTM C876's class calls active and that is not truly so",
    ),
    "scoring.sites_found": Score(
        "1",
        lambda scoring: float(scoring.sites_found),
        "truly active sites with a planned point within that was judged active",
    ),
    "scoring.sites_total": Score(
        "1",
        lambda scoring: float(scoring.sites_total),
        "connected regions of truly active area in the measured region",
    ),
}


def metrics_of(scoring: Scoring) -> dict[str, Metric]:
    """Every number of a scoring."""
    return {name: _metric(score, scoring) for name, score in SCORES.items()}


def _metric(score: Score, scoring: Scoring) -> Metric:
    value = score.of(scoring)
    if math.isnan(value):
        return Metric(value=None, unit=score.unit, why=NOTHING_ACTIVE)
    return Metric(value=value, unit=score.unit)


def _function(score: Score) -> Callable[[FlightData], float]:
    def value(flight: FlightData) -> float:
        found = score.of(scoring_of(flight))
        if math.isnan(found):
            raise NotMeasured(NOTHING_ACTIVE)
        return found

    return value


SCORING_METRICS: dict[str, MetricSpec] = {
    name: MetricSpec(score.unit, _function(score), score.meaning, (PointReading,), ANEW)
    for name, score in SCORES.items()
}
