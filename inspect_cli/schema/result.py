"""``metrics.json``: what a run came to. The report draws it and never computes."""

from __future__ import annotations

from collections.abc import Sized
from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.assessment import AstmClass, SurfaceAssessment
from inspect_cli.schema.base import Strict, Triple
from inspect_cli.schema.scoring import Scoring

Status = Literal["completed", "aborted", "diverged", "interrupted"]
Verdict = Literal["pass", "fail", "fail-known", "not_measured"]
Corrosion = Literal["none", "possible", "active"]


class Check(Strict):
    """One acceptance entry, answered."""

    metric: str
    value: float | None
    unit: str
    min: float | None
    max: float | None
    ref: str | None
    verdict: Verdict
    reason: str = ""
    """Why it is not measured, or the mission's ``known_failure``."""
    over: str | None = None
    """``mission:metric`` by which the value was divided."""


class Metric(Strict):
    """A number with its unit; ``None`` when the log lacks what it is computed from."""

    value: float | None
    unit: str
    why: str = ""


def _is_empty(values: Sized) -> bool:
    return len(values) == 0


class PointResult(Strict):
    """One target of the plan and what became of it."""

    index: int
    label: str
    valid: bool
    reason: str
    """Why it is invalid, in words; empty when valid."""
    p_W: Triple
    """Where the tool was believed to be; the planned point if it never got there."""
    surface: str = ""
    """That it lies on; empty where no surface was known beforehand."""
    uv_m: tuple[float, float] | None
    read_mv: float | None = None
    """As the voltmeter showed it: against the platform's electrode, not corrected."""
    potential_mv: float | None = None
    """As evaluated: against CSE at 22.2 °C."""
    potential_sd_mv: float | None = None
    """Standard uncertainty of the evaluated potential, of this reading by itself."""
    resistance_ohm: float | None = None
    resistivity_ohm_m: float | None = None
    probe_force_n: float | None
    contact_s: float | None
    """None where nobody timed it, as of readings by hand."""
    astm_class: AstmClass | None = None
    corrosion: Corrosion | None = None
    """The combined verdict of potential and resistance, by the rule that the report states."""
    true_force_n: float | None = None
    """Mean true normal force over the last 2 s of the dwell."""
    true_force_peak_n: float | None = None
    position_error_m: float | None = None
    """Between the planned and the true contact point, along the surface."""
    true_potential_mv: float | None = None
    """What a perfect reading under the tip would be evaluated as, mean over the last 2 s of the
    dwell."""
    true_resistivity_ohm_m: float | None = None
    true_corrosion: Corrosion | None = None
    """What the combined rule says of the specimen under the tip."""
    instrument: Annotated[str, Field(exclude_if=_is_empty)] = ""
    """Kind of the instrument that was to be read; left out for a half-cell, whose values are fields
    above."""
    values: Annotated[dict[str, float], Field(exclude_if=_is_empty)] = {}
    """What that instrument read, by names of its own; left out where there is nothing."""
    units: Annotated[dict[str, str], Field(exclude_if=_is_empty)] = {}
    """Of its values, by the same names; known of invalid points, too."""


class Result(Strict):
    """The whole of ``metrics.json``."""

    schema_version: Annotated[Literal[1], Field(alias="schema")] = 1
    mission: str
    platform: str
    seed: int | None
    status: Status
    status_reason: str = ""
    checks: tuple[Check, ...]
    metrics: dict[str, Metric]
    points: tuple[PointResult, ...]
    scoring: Scoring | None = None
    """The verdicts against what is truly so; a real flight has none."""
    assessment: tuple[SurfaceAssessment, ...] = ()
    """The findings of each surface with points to read."""

    @property
    def passed(self) -> bool:
        """Whether the flight was completed and no check failed or was left unmeasured."""
        missed = any(check.verdict in ("fail", "not_measured") for check in self.checks)
        return self.status == "completed" and not missed

    def value(self, metric: str) -> float | None:
        """A metric's value; None where there is none."""
        found = self.metrics.get(metric)
        return found.value if found else None
