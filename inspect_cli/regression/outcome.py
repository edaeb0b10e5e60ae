"""Models of a regression's result, as ``inspect regress --json`` prints it."""

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
    """difference / |reference|; None if the reference is zero or not measured."""
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
    """``fail-known`` if only checks fail that the mission declares as known failures."""
    status: Status | None
    """How the flight ended; None when it could not be flown."""
    reasons: tuple[str, ...]
    """Why the flight fails; empty if it does not."""
    checks: tuple[Check, ...]
    changes: tuple[Change, ...]
    wall_s: float
    """Wall-clock time of planning, flight and evaluation, s."""
    folder: str | None
    """The folder of log and report."""
    details: str = ""
    """The traceback of an error that is a defect of the program."""


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
