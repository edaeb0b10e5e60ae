"""The readings of all instruments of a flight or a survey: points, findings, scores."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from functools import partial
from typing import TYPE_CHECKING

from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.instruments import INSTRUMENTS
from inspect_cli.metrics.planned_cells import planned_cells
from inspect_cli.metrics.points import points_read_by
from inspect_cli.metrics.truth_scoring import NO_TRUTH
from inspect_cli.records import PointReading, Record
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.scoring import Scoring
from inspect_cli.schema.vehicle import PlatformBase

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed

AssessAll = Callable[[Sequence[PointResult]], "tuple[Assessed, ...]"]
ScoreAll = Callable[[Sequence[PointResult]], Scoring | None]


def channels_of(flight: FlightData, needs: Iterable[type[Record]]) -> tuple[type[Record], ...]:
    """The channels of a log that a metric needs (``MetricSpec.needs``).

    A plan that reads nothing is taken for one that reads with the first instrument.
    """
    kinds = flight.plan.instruments or tuple(INSTRUMENTS)[:1]
    readings = tuple(INSTRUMENTS[kind].reader.reading for kind in kinds)
    each = (readings if record is PointReading else (record,) for record in needs)
    return tuple(record for records in each for record in records)


def has_readings(flight: FlightData) -> bool:
    """Whether the log has a channel of readings."""
    return any(flight.log.rows(kind) is not None for kind in channels_of(flight, [PointReading]))


def point_results(flight: FlightData) -> tuple[PointResult, ...]:
    """One result for each target of the plan that is read, in the plan's order."""
    found: dict[int, PointResult] = {}
    for kind in flight.plan.instruments:
        found |= points_read_by(INSTRUMENTS[kind].reader, flight)
    return tuple(found[index] for index in sorted(found))


def points_total(flight: FlightData) -> float:
    """Number of points that the plan wants read."""
    return float(len(flight.read_targets))


def points_valid(flight: FlightData) -> float:
    """Number of points with a valid reading."""
    _ = flight.read_targets  # without them there is nothing to count
    return float(sum(point.valid for point in point_results(flight)))


def valid_share(flight: FlightData) -> float:
    """Valid readings as a share of the planned points."""
    return points_valid(flight) / points_total(flight)


def assessor(mission: Mission, platform: PlatformBase, targets: Iterable[Target]) -> AssessAll:
    """What assesses the points of a flight, or all points of a survey, to these targets.

    Each instrument assesses its own. Surfaces stand in the order in which they first appear.
    """
    return partial(_assess, mission=mission, platform=platform, targets=tuple(targets))


def _assess(
    points: Sequence[PointResult],
    mission: Mission,
    platform: PlatformBase,
    targets: Sequence[Target],
) -> tuple[Assessed, ...]:
    cells = planned_cells(targets)
    assessed: list[Assessed] = []
    for kind, own in _by_instrument(points, targets).items():
        assess, model = INSTRUMENTS[kind].assess, platform.instruments.get(kind)
        if assess is not None and model is not None:
            assessed += assess(own, mission, model, cells)
    return tuple(assessed)


def scorer(rasters: Sequence[TrueRaster], targets: Iterable[Target]) -> ScoreAll:
    """What scores the points of a survey, whose flights go to these targets.

    It gives None where nothing can be scored.
    """
    known = tuple(targets)

    def score_all(points: Sequence[PointResult]) -> Scoring | None:
        try:
            return score_points(points, rasters, known)
        except NotMeasured:
            return None

    return score_all


def score_points(
    points: Sequence[PointResult], rasters: Sequence[TrueRaster], targets: Sequence[Target]
) -> Scoring:
    """The points against what is truly so, each instrument by its own rule.

    Raises:
        NotMeasured: nothing can be scored; the first reason.
    """
    cells, scorings = planned_cells(targets), []
    reasons: list[NotMeasured] = []
    for kind, own in _by_instrument(points, targets).items():
        score = INSTRUMENTS[kind].score
        if score is None:
            continue
        try:
            scorings.append(score(own, rasters, cells))
        except NotMeasured as reason:
            reasons.append(reason)
    if not scorings:
        raise reasons[0] if reasons else NotMeasured(NO_TRUTH)
    return Scoring(surfaces=tuple(one for scoring in scorings for one in scoring.surfaces))


def scoring_of(flight: FlightData) -> Scoring:
    """The scoring of one flight.

    Raises:
        NotMeasured: nothing was to be read, or the log does not know the truth there.
    """
    _ = flight.read_targets  # without them there is nothing to score
    rasters = flight.log.true_rasters()
    if not rasters:
        raise NotMeasured(NO_TRUTH)
    return score_points(point_results(flight), rasters, flight.plan.targets)


def _by_instrument(
    points: Iterable[PointResult], targets: Iterable[Target]
) -> dict[str, list[PointResult]]:
    """The points that each instrument read, by the labels of the plan's targets."""
    kinds = {target.label: target.sensor for target in targets}
    found: dict[str, list[PointResult]] = {}
    for point in points:
        kind = kinds.get(point.label)
        if kind is not None:
            found.setdefault(kind, []).append(point)
    return found
