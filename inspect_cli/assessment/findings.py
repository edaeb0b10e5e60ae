"""The summary's parts, each from what was computed at the points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Final

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.classes import ASTM_CLASSES, NO_CLASS, Codes, millivolts
from inspect_cli.assessment.conditions import CONDITIONS
from inspect_cli.assessment.gradient import WITHIN_M, Minima, Steps
from inspect_cli.assessment.mixture import Mixture
from inspect_cli.assessment.readings import Merged, Readings
from inspect_cli.assessment.spacing import Spacing
from inspect_cli.assessment.uncertainty import Budget
from inspect_cli.schema.assessment import (
    ClassShare,
    ConditionCount,
    Crossed,
    GradientFindings,
    Minimum,
    MixtureFindings,
    Population,
    PotentialStatistics,
    Proposal,
    RefinementFindings,
    RepeatabilityFindings,
    UncertaintyFindings,
)
from inspect_cli.spatial.arrays import Vector

MAX_LISTED: Final = 20
"""Minima and proposals that the summary names; it counts all."""
PERCENTILES: Final = (5, 10, 25, 50, 75, 90, 95)
DISAGREE_V: Final = 0.020
"""Readings of a place that differ by more contradict each other: twice what one electrode's may by
ASTM C876, and as much as two electrodes' may."""
ROUNDING_V: Final = 1e-9
NO_READING: Final = "no reading is valid"
ALONE: Final = "fewer than two valid readings have no neighbours"


def class_shares(
    names: Sequence[str], codes: Codes, area_m2: Vector | None
) -> tuple[ClassShare, ...]:
    """How many points (m,) are in each class, and what they stand for."""
    total = int(np.count_nonzero(codes != NO_CLASS))
    shares = []
    for code, name in enumerate(names):
        among = codes == code
        count = int(np.count_nonzero(among))
        shares.append(
            ClassShare(
                name=name,
                count=count,
                share=count / total if total else 0.0,
                area_m2=None if area_m2 is None else float(np.sum(area_m2[among])),
            )
        )
    return tuple(shares)


def crossed(astm: Codes, resistivity: Codes, names: Sequence[str]) -> tuple[Crossed, ...]:
    """How many points (m,) are in each potential's and resistivity's class; all cells."""
    columns: list[tuple[int, str | None]] = [*enumerate(names), (NO_CLASS, None)]
    return tuple(
        Crossed(
            astm_class=astm_name,
            resistivity_class=name,
            count=int(np.count_nonzero((astm == row) & (resistivity == column))),
        )
        for row, astm_name in enumerate(ASTM_CLASSES)
        for column, name in columns
    )


def potential_statistics(potential_v: Vector) -> PotentialStatistics | None:
    """Of the valid potentials (n,), V; None without any."""
    mv = millivolts(potential_v[np.isfinite(potential_v)])
    if not len(mv):
        return None
    percentiles = np.percentile(mv, PERCENTILES)
    return PotentialStatistics(
        min_mv=float(np.min(mv)),
        median_mv=float(np.median(mv)),
        mean_mv=float(np.mean(mv)),
        max_mv=float(np.max(mv)),
        sd_mv=float(np.std(mv, ddof=1)) if len(mv) > 1 else None,
        **{f"p{p}_mv": float(v) for p, v in zip(PERCENTILES, percentiles, strict=True)},
    )


def condition_counts(typical: NDArray[np.bool_]) -> tuple[ConditionCount, ...]:
    """Points (m, 6) per condition."""
    counts = np.count_nonzero(typical, axis=0)
    return tuple(
        ConditionCount(name=c.name, low_mv=c.low_mv, high_mv=c.high_mv, count=int(count))
        for c, count in zip(CONDITIONS, counts, strict=True)
    )


def gradient_findings(
    points: Readings, minima: Minima, spacing: Spacing | None
) -> GradientFindings:
    """The minima, and why there may be none to judge."""
    mv = millivolts(points.potential_v)
    steepest = [
        Minimum(
            label=str(points.labels[i]),
            uv_m=_place(points.uv_m[i]),
            potential_mv=float(mv[i]),
            rise_mv=_known(rise),
            rise_within_m=_known(within),
            active=bool(active),
        )
        for i, rise, within, active in zip(
            minima.index[:MAX_LISTED],
            minima.rise_mv[:MAX_LISTED],
            minima.rise_within_m[:MAX_LISTED],
            minima.is_active[:MAX_LISTED],
            strict=True,
        )
    ]
    not_judged = int(np.count_nonzero(np.isnan(minima.rise_mv)))
    why = ""
    if np.count_nonzero(points.valid) < 2:
        why = ALONE
    elif spacing is not None and min(spacing.u_m, spacing.v_m) > WITHIN_M:
        why = (
            f"readings are {min(spacing.u_m, spacing.v_m):.3g} m apart; "
            "the criterion compares those within 1 m"
        )
    elif not len(minima.index):
        why = f"no negative minimum is {minima.least_depth_mv:.0f} mV deep"
    return GradientFindings(
        minima=len(minima.index),
        active=int(np.count_nonzero(minima.is_active)),
        not_judged=not_judged,
        steepest=tuple(steepest),
        least_depth_mv=minima.least_depth_mv,
        scatter_mv=minima.scatter_mv,
        why=why,
    )


def mixture_findings(mixture: Mixture | str) -> MixtureFindings:
    """Both populations where the second is supported."""
    if isinstance(mixture, str):
        return MixtureFindings(verdict=None, why=mixture)
    if not mixture.is_supported:
        return MixtureFindings(
            verdict="one population",
            why=mixture.why_one,
            bic_one=mixture.one_bic,
            bic_two=mixture.bic,
        )
    errors = mixture.standard_errors or (None,) * 5
    weights = (mixture.weight, 1.0 - mixture.weight)
    active, passive = (
        Population(
            share=weights[k],
            mean_mv=mixture.mean_mv[k],
            mean_error_mv=errors[1 + 2 * k],
            sd_mv=mixture.sd_mv[k],
            sd_error_mv=errors[2 + 2 * k],
        )
        for k in (0, 1)
    )
    return MixtureFindings(
        verdict="two populations",
        bic_one=mixture.one_bic,
        bic_two=mixture.bic,
        active=active,
        passive=passive,
        share_error=errors[0],
        errors_why=mixture.errors_why,
        threshold_mv=mixture.threshold_mv,
        threshold_error_mv=mixture.threshold_error_mv,
        threshold_why=mixture.threshold_why,
        active_limit_mv=mixture.active_limit_mv,
        passive_limit_mv=mixture.passive_limit_mv,
    )


def refinement_findings(points: Readings, steps: Steps) -> RefinementFindings:
    """Where to read more, the greatest differences first."""
    greatest = [
        Proposal(
            between=(str(points.labels[a]), str(points.labels[b])),
            uv_m=_place(midpoint),
            difference_mv=float(difference),
        )
        for (a, b), midpoint, difference in zip(
            steps.pairs[:MAX_LISTED],
            steps.midpoint_m[:MAX_LISTED],
            steps.difference_mv[:MAX_LISTED],
            strict=True,
        )
    ]
    return RefinementFindings(
        total=len(steps.pairs),
        greatest=tuple(greatest),
        why=ALONE if np.count_nonzero(points.valid) < 2 else "",
    )


def repeatability_findings(places: Merged) -> RepeatabilityFindings:
    """What repeated readings say."""
    repeated = places.within_sd_v[np.isfinite(places.within_sd_v)]
    sd_v = places.repeatability_v
    apart = np.flatnonzero(places.spread_v > DISAGREE_V + ROUNDING_V)
    worst = apart[np.argmax(places.spread_v[apart])] if len(apart) else None
    return RepeatabilityFindings(
        places=len(repeated),
        degrees_of_freedom=places.degrees_of_freedom,
        sd_mv=None if sd_v is None else 1e3 * sd_v,
        greatest_sd_mv=1e3 * float(np.max(repeated)) if len(repeated) else None,
        disagreeing=len(apart),
        worst=None if worst is None else str(places.readings.labels[worst]),
        worst_spread_mv=None if worst is None else 1e3 * float(places.spread_v[worst]),
        why="" if len(repeated) else "no place was read twice",
    )


def disagreement(found: RepeatabilityFindings) -> tuple[str, ...]:
    """The warning of places whose readings contradict each other; empty without any."""
    if found.worst_spread_mv is None:
        return ()
    asked = "repeated readings should agree within 10 mV (ASTM C876)."
    if found.disagreeing == 1:
        return (
            f"The readings at the place of point {found.worst} differ by "
            f"{found.worst_spread_mv:.0f} mV; {asked}",
        )
    return (
        f"At {found.disagreeing} places the readings differ by more than 20 mV, most at the place "
        f"of point {found.worst}, by {found.worst_spread_mv:.0f} mV; {asked}",
    )


def uncertainty_findings(
    budget: Budget, doubtful: NDArray[np.bool_], valid: NDArray[np.bool_]
) -> UncertaintyFindings:
    """The budget in medians over the valid points (m,)."""
    some = bool(np.any(valid))

    def median_mv(sd_v: Vector) -> float | None:
        return 1e3 * float(np.median(sd_v[valid])) if some else None

    return UncertaintyFindings(
        median_mv=median_mv(budget.total_v),
        max_mv=1e3 * float(np.max(budget.total_v[valid])) if some else None,
        reading_mv=median_mv(budget.reading_v),
        repeatability_mv=median_mv(budget.repeatability_v),
        conversion_mv=1e3 * budget.conversion_v,
        temperature_mv=1e3 * budget.temperature_v,
        single_reading_mv=1e3 * budget.single_v,
        single_reading_from=budget.single_from,
        doubtful=int(np.count_nonzero(doubtful)),
        why="" if some else NO_READING,
    )


def _place(uv: Vector) -> tuple[float, float]:
    return (float(uv[0]), float(uv[1]))


def _known(value: float) -> float | None:
    return None if np.isnan(value) else float(value)
