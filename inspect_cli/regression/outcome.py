"""What a regression came to, as ``inspect regress --json`` prints it."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import Strict
from inspect_cli.schema.result import Check, Status

FlightVerdict = Literal["pass", "fail", "fail-known"]


class Change(Strict):
    """A metric that differs from its reference by more than its tolerance."""

    metric: str
    unit: str
    reference: float | None
    value: float | None
    difference: float | None
    """value − reference; None when one of them is not measured."""
    relative: float | None
    """difference / |reference|; None where that does not exist."""
    allowed: float | None
    """The largest |difference| within tolerance."""
    what: str
    """The change in words."""


class FlightReport(Strict):
    """One mission with one seed."""

    mission: str
    platform: str
    seed: int
    verdict: FlightVerdict
    """``fail-known`` when nothing is wrong but what the mission declares as known failures."""
    status: Status | None
    """How the flight ended; None when it could not be flown."""
    reasons: tuple[str, ...]
    """What is wrong, in words; empty when it passes."""
    checks: tuple[Check, ...]
    changes: tuple[Change, ...]
    wall_s: float
    """Time that the flight took to compute."""
    folder: str | None
    """Where log and report are."""
    details: str = ""
    """The traceback of a fault of ours."""


class RegressReport(Strict):
    """All flights, in order; every flight is counted in exactly one of the three numbers."""

    missions: tuple[FlightReport, ...]
    passed: int
    failed: int
    known: int

    @classmethod
    def of(cls, flights: tuple[FlightReport, ...]) -> RegressReport:
        """Count the verdicts."""
        verdicts = [flight.verdict for flight in flights]
        return cls(
            missions=flights,
            passed=verdicts.count("pass"),
            failed=verdicts.count("fail"),
            known=verdicts.count("fail-known"),
        )
