"""What a metric is."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from inspect_cli.metrics.flight import Flight
from inspect_cli.metrics.joined import NOT_JOINED, Joined
from inspect_cli.records import Record


@dataclass(frozen=True)
class MetricSpec:
    """A metric: ``function`` computes it from a flight that has the channels ``needs``.

    ``joined`` says what the flights of one survey come to together.
    """

    unit: str
    function: Callable[[Flight], float]
    meaning: str
    needs: tuple[type[Record], ...]
    joined: Joined = NOT_JOINED
