"""What a metric is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from inspect_cli.metrics.aggregation import NOT_JOINED, Joined
from inspect_cli.metrics.flight import FlightData
from inspect_cli.records import Record


@dataclass(frozen=True)
class Tolerance:
    """A metric may differ from its reference by ``absolute`` + ``relative`` · |reference|."""

    absolute: float
    relative: float

    def around(self, reference: float) -> float:
        """The largest allowed difference."""
        return self.absolute + self.relative * abs(reference)


@dataclass(frozen=True)
class MetricSpec:
    """A metric: ``function`` computes it from a flight that has the channels ``needs``.

    ``PointReading`` in ``needs`` stands for the readings of every instrument of the plan.

    ``joined`` says what the flights of one survey come to together.
    """

    unit: str
    function: Callable[[FlightData], float]
    meaning: str
    needs: tuple[type[Record], ...]
    joined: Joined = NOT_JOINED
