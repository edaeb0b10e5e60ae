"""Metrics of what the readings say; of a survey, over all its points anew.

Points are places: a place that was read several times counts once. Several surfaces count
together, each assessed by itself.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from inspect_cli.metrics.aggregation import ANEW
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.readings import assessor, point_results
from inspect_cli.metrics.spec import MetricSpec
from inspect_cli.records import PointReading
from inspect_cli.schema.assessment import SurfaceAssessment
from inspect_cli.schema.result import Metric
from inspect_cli.spatial.arrays import Vector

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed


@dataclass(frozen=True)
class Finding:
    """A number of assessed surfaces; ``of`` raises NotMeasured where there is none."""

    unit: str
    of: Callable[[Sequence[Assessed]], float]
    meaning: str

    def value(self, assessed: Sequence[Assessed]) -> float:
        """The number.

        Raises:
            NotMeasured: no reading is valid, or the number does not exist.
        """
        if not any(one.summary.valid for one in assessed):
            raise NotMeasured("no reading is valid")
        return self.of(assessed)


def potential_median(assessed: Sequence[Assessed]) -> float:
    """Median, V, of the points' potentials."""
    return _median([one.readings.potential_v for one in assessed])


def uncertainty_median(assessed: Sequence[Assessed]) -> float:
    """Median, V, of the standard uncertainties of the points' potentials."""
    return _median([one.budget.total_v for one in assessed])


def astm_active_share(assessed: Sequence[Assessed]) -> float:
    """Points in ASTM C876's class active, as a share of those with a valid reading."""
    active = sum(_count(one.summary, "active") for one in assessed)
    return active / sum(one.summary.valid for one in assessed)


def active_area(assessed: Sequence[Assessed]) -> float:
    """Area, m², that the points with the combined verdict active stand for."""
    total_m2 = 0.0
    for one in assessed:
        if one.area_m2 is None:
            raise NotMeasured(one.summary.area_why)
        share = next(s for s in one.summary.verdicts if s.name == "active")
        total_m2 += share.area_m2 or 0.0
    return total_m2


def mixture_threshold(assessed: Sequence[Assessed]) -> float:
    """Where the two populations of potentials part, V."""
    mixtures = [one.summary.mixture for one in assessed]
    found = [m.threshold_mv for m in mixtures if m.threshold_mv is not None]
    if len(found) > 1:
        raise NotMeasured("several surfaces have populations of their own")
    if not found:
        whys = [m.why or m.threshold_why for m in mixtures]
        raise NotMeasured(next(filter(None, whys), "there is no threshold between two populations"))
    return 1e-3 * found[0]


FINDINGS: dict[str, Finding] = {
    "assessment.potential_median_v": Finding(
        "V", potential_median, "median potential of the points, against CSE at 22.2 °C"
    ),
    "assessment.uncertainty_median_v": Finding(
        "V", uncertainty_median, "median standard uncertainty of the points' potentials"
    ),
    "assessment.astm_active_share": Finding(
        "1", astm_active_share, "points in ASTM C876's class active, as a share of the valid ones"
    ),
    "assessment.active_area_m2": Finding(
        "m²", active_area, "area that the points with the combined verdict active stand for"
    ),
    "assessment.gradient_active_count": Finding(
        "1",
        lambda assessed: float(sum(one.summary.gradient.active for one in assessed)),
        "minima around which the potential rises by 100 mV within 1 m (RILEM TC 154-EMC)",
    ),
    "assessment.mixture_threshold_v": Finding(
        "V", mixture_threshold, "potential at which two populations of potentials part"
    ),
    "assessment.proposals_count": Finding(
        "1",
        lambda assessed: float(sum(one.summary.refinement.total for one in assessed)),
        "places to read between neighbours that differ by more than 150 mV (ASTM C876)",
    ),
}


def assessment_metrics(assessed: Sequence[Assessed]) -> dict[str, Metric]:
    """Every number of the assessed surfaces, one at least."""
    return {name: _metric(finding, assessed) for name, finding in FINDINGS.items()}


def _metric(finding: Finding, assessed: Sequence[Assessed]) -> Metric:
    try:
        return Metric(value=finding.value(assessed), unit=finding.unit)
    except NotMeasured as reason:
        return Metric(value=None, unit=finding.unit, why=str(reason))


def _function(finding: Finding) -> Callable[[FlightData], float]:
    def value(flight: FlightData) -> float:
        _ = flight.read_targets  # without them there is nothing to assess
        assess = assessor(flight.mission, flight.platform, flight.plan.targets)
        assessed = assess(point_results(flight))
        if not assessed:
            raise NotMeasured("no point to read lies on a known surface")
        return finding.value(assessed)

    return value


def _median(values: Sequence[Vector]) -> float:
    """Of all values that there are."""
    joined = np.concatenate(values)
    return float(np.median(joined[np.isfinite(joined)]))


def _count(summary: SurfaceAssessment, name: str) -> int:
    return next(share.count for share in summary.astm if share.name == name)


ASSESSMENT_METRICS: dict[str, MetricSpec] = {
    name: MetricSpec(f.unit, _function(f), f.meaning, (PointReading,), ANEW)
    for name, f in FINDINGS.items()
}
