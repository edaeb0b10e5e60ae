"""Compares the metrics of a result with those of its reference.

On one machine a mission and seed give the same bytes. Another processor adds in another order,
and a closed loop with contact amplifies the last digit. A metric may therefore differ by a few
percent plus an absolute amount that does not matter in its unit. Counts may not differ at all.
"""

from __future__ import annotations

from dataclasses import dataclass

from inspect_cli.regression.outcome import Change
from inspect_cli.regression.reference import ReferenceMetrics, rounded
from inspect_cli.schema.result import Metric, Result


@dataclass(frozen=True)
class Tolerance:
    """A metric may differ from its reference by ``absolute`` + ``relative`` · |reference|."""

    absolute: float
    relative: float

    def around(self, reference: float) -> float:
        """The largest allowed difference."""
        return self.absolute + self.relative * abs(reference)


EXACT = Tolerance(0.0, 0.0)

BY_UNIT: dict[str, Tolerance] = {
    "m": Tolerance(0.0005, 0.05),
    "m²": Tolerance(1e-5, 0.001),
    "m/s": Tolerance(0.01, 0.05),
    "rad": Tolerance(0.001, 0.05),
    "°": Tolerance(0.05, 0.05),
    "N": Tolerance(0.05, 0.02),
    "N·m": Tolerance(0.01, 0.05),
    "V": Tolerance(0.0005, 0.05),
    "s": Tolerance(0.1, 0.01),
    "Wh": Tolerance(0.01, 0.005),
    "m/N": Tolerance(0.0005, 0.05),
    "rad/(N·m)": Tolerance(0.001, 0.05),
    "1": EXACT,
}
"""The tolerance of a metric by its unit; a metric with any other unit must not change."""

BY_METRIC: dict[str, Tolerance] = {
    # Extremes of noisy signals move more than means do.
    "tracking.attitude_max_rad": Tolerance(0.002, 0.15),
    "contact.force_peak_n": Tolerance(0.1, 0.10),
    "contact.body_force_max_n": Tolerance(0.1, 0.10),
    "actuators.thrust_max_n": Tolerance(0.1, 0.10),
    # Dimensionless metrics that are no counts.
    "contact.force_cv": Tolerance(0.005, 0.10),
    "contact.residual_cv": Tolerance(0.005, 0.10),
    "contact.oscillation_growth": Tolerance(0.05, 0.10),
    "estimation.moving_over_hovering": Tolerance(0.05, 0.10),
    "half_cell.resistance_error_rel_max": Tolerance(0.002, 0.10),
    # Two points on either side of a site may give the same reading.
    "half_cell.potential_min_point": Tolerance(1.0, 0.0),
    # A difference of about 150 mV may fall on either side.
    "assessment.proposals_count": Tolerance(1.0, 0.0),
    "flight.energy_planned_over_flown": Tolerance(0.0, 0.01),
    "scoring.detected_share": Tolerance(0.0, 0.001),
    "scoring.too_resistive_share": Tolerance(0.0, 0.001),
    "flight.saturated_share": Tolerance(0.002, 0.10),
    "pull.along_over_z": Tolerance(0.1, 0.15),
    "pull.along_over_attitude": Tolerance(0.1, 0.15),
}
"""Exceptions from ``BY_UNIT``."""


def tolerance_of(name: str, unit: str) -> Tolerance:
    """The tolerance of a metric."""
    return BY_METRIC.get(name, BY_UNIT.get(unit, EXACT))


def compare(result: Result, reference: ReferenceMetrics) -> tuple[Change, ...]:
    """Every metric that differs from the reference beyond its tolerance, sorted by name.

    A metric that appears, vanishes, becomes or ceases to be measured has changed.
    """
    names = sorted(result.metrics.keys() | reference.metrics.keys())
    changes = (_change(name, result, reference) for name in names)
    return tuple(change for change in changes if change is not None)


def _change(name: str, result: Result, reference: ReferenceMetrics) -> Change | None:
    if name not in result.metrics:
        return _bare(name, Metric(value=None, unit=""), reference.metrics[name], "is gone")
    metric = result.metrics[name]
    value = rounded(metric.value)
    if name not in reference.metrics:
        return _bare(name, metric, None, "is new, the reference does not have it")
    known = reference.metrics[name]
    if value is None and known is None:
        return None
    if value is None:
        return _bare(name, metric, known, f"is not measured any more: {metric.why}")
    if known is None:
        return _bare(name, metric, None, "was not measured in the reference")
    allowed = tolerance_of(name, metric.unit).around(known)
    difference = value - known
    if abs(difference) <= allowed:
        return None
    relative = difference / abs(known) if known else None
    share = f" ({relative:+.1%})" if relative is not None else ""
    return Change(
        metric=name,
        unit=metric.unit,
        reference=known,
        value=value,
        difference=difference,
        relative=relative,
        allowed=allowed,
        what=(
            f"{known:.6g} → {value:.6g} {metric.unit}, by {difference:+.3g}{share}, "
            f"allowed ±{allowed:.3g}"
        ),
    )


def _bare(name: str, metric: Metric, reference: float | None, what: str) -> Change:
    return Change(
        metric=name,
        unit=metric.unit,
        reference=reference,
        value=rounded(metric.value),
        difference=None,
        relative=None,
        allowed=None,
        what=what,
    )
