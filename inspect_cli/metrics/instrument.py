"""What metrics know of an instrument: the parts of its row in the registry."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.flight import FlightData
from inspect_cli.metrics.planned_cells import PlannedCells
from inspect_cli.metrics.spec import MetricSpec, Tolerance
from inspect_cli.records import PointReading
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.scoring import Scoring

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed

    AssessPoints = Callable[
        [Sequence[PointResult], Mission, Any, PlannedCells], tuple[Assessed, ...]
    ]
    """Takes the points of one instrument, the mission, the model of its sensor and the cells."""

Values = Mapping[str, float]
"""By the names of the fields of an instrument's reading; what is not finite is left out."""
Complete = Callable[[FlightData, Target, PointResult, Values], PointResult]
"""Adds what was read to the result of a point, which says already where it lies, how it was
touched and whether it is valid; without a valid reading there are no values."""
ScorePoints = Callable[[Sequence[PointResult], Sequence[TrueRaster], PlannedCells], Scoring]


def values_as_read(
    flight: FlightData, target: Target, point: PointResult, values: Values
) -> PointResult:
    """The values stand in the result under the names of their fields."""
    return point.model_copy(update={"values": dict(values)})


def no_reasons(model: Any) -> Mapping[float, str]:
    """There are no reasons but those of all instruments."""
    return {}


@dataclass(frozen=True)
class PointReader:
    """How the readings of an instrument become results of points."""

    kind: str
    """The kind of its sensor, by which missions and plans name it."""
    reading: type[PointReading]
    """Its readings are valid only where the first of their values is finite."""
    complete: Complete = values_as_read
    reasons: Callable[[Any], Mapping[float, str]] = no_reasons
    """Words for the numbers of ``InvalidReason`` that are its own, given the model of its
    sensor."""
    has_fields: bool = False
    """Whether its values are fields of ``PointResult``; else a point names instrument and units."""

    def described(self) -> dict[str, Any]:
        """What a point says of the instrument that was to be read there."""
        if self.has_fields:
            return {}
        return {"instrument": self.kind, "units": self.reading.units()}


@dataclass(frozen=True)
class Instrument:
    """An instrument: its row in the registry. What it has no need of is left out."""

    reader: PointReader
    metrics: Mapping[str, MetricSpec]
    """By names that begin with its kind and a dot."""
    tolerances: Mapping[str, Tolerance] = field(default_factory=dict)
    """Of its metrics in regressions, where that of the unit does not fit."""
    missed: tuple[str, ...] = ()
    """Its counts in which a point that no flight of a survey came to counts, too."""
    assess: AssessPoints | None = None
    """What its readings say of each surface; of a survey, of all flights together."""
    score: ScorePoints | None = None
    """The same against what is truly so. Raises NotMeasured where that is not known."""
