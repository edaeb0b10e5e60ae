"""The half-cell: results of its points, how true they are, and what they say of the steel."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from inspect_cli.assessment.classes import astm_class, combined_verdict, resistivity
from inspect_cli.assessment.electrodes import as_evaluated, to_standard
from inspect_cli.metrics.aggregation import GREATEST, LEAST, SUM
from inspect_cli.metrics.assessed import assess_points, basis_on
from inspect_cli.metrics.flight import FlightData, NotMeasured
from inspect_cli.metrics.instrument import Instrument, PointReader, Values
from inspect_cli.metrics.points import contact_points, dwell_on, finite
from inspect_cli.metrics.spec import MetricSpec, Tolerance
from inspect_cli.metrics.truth_scoring import score
from inspect_cli.records import InvalidReason, Reading, Reference, State, TrueContact
from inspect_cli.schema.plan import Target
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.vehicle import HalfCellModel


@dataclass(frozen=True)
class TrueSpecimen:
    """What was so under the tip while a point was pressed; None where the log does not say."""

    potential_v: float | None = None
    """As a CSE at the concrete's temperature would have read it."""
    resistivity_ohm_m: float | None = None


def complete(flight: FlightData, target: Target, point: PointResult, values: Values) -> PointResult:
    """The point with potential and resistance as evaluated, and with what they are in truth."""
    probe = probe_of(flight)
    basis = basis_on(flight.mission, target.surface, probe.electrode)
    true = true_specimen(flight, target)
    found: dict[str, object] = {"true_resistivity_ohm_m": true.resistivity_ohm_m}
    if true.potential_v is not None:
        true_v = float(as_evaluated(true.potential_v, basis))
        found["true_potential_mv"] = 1e3 * true_v
        found["true_corrosion"] = combined_verdict(true_v, true.resistivity_ohm_m)
    if "potential" in values:
        potential_v = float(to_standard(values["potential"], basis))
        ohm = values.get("resistance")
        rho = None if ohm is None else resistivity(ohm, probe.cell_constant_m)
        found |= {
            "read_mv": 1e3 * values["potential"],
            "potential_mv": 1e3 * potential_v,
            "resistance_ohm": ohm,
            "resistivity_ohm_m": rho,
            "astm_class": astm_class(potential_v),
            "corrosion": combined_verdict(potential_v, rho),
        }
    return point.model_copy(update=found)


def probe_of(flight: FlightData) -> HalfCellModel:
    """The half-cell that took the flight's readings.

    Raises:
        NotMeasured: the platform has none.
    """
    probe = flight.platform.find(HalfCellModel)
    if probe is None:
        raise NotMeasured(f"the platform has no instrument '{READER.kind}'")
    return probe


def true_specimen(flight: FlightData, target: Target) -> TrueSpecimen:
    """What was so at a target, averaged over the last 2 s of its dwell."""
    dwell = dwell_on(flight, target)
    if dwell is None or flight.log.rows(TrueContact) is None:
        return TrueSpecimen()
    try:
        contact = flight.on_state_ticks(TrueContact)[dwell.steady]
    except NotMeasured:
        return TrueSpecimen()
    return TrueSpecimen(
        finite(np.mean(contact["potential"])), finite(np.mean(contact["resistivity"]))
    )


def reasons(probe: HalfCellModel) -> Mapping[float, str]:
    """Why its rule did not accept a reading."""
    return {
        InvalidReason.FORCE: (
            f"force: it did not stay at {probe.min_force_n:g} N for {probe.min_contact_s:g} s"
        ),
        InvalidReason.UNSTABLE: (
            f"the potential did not stay within {1e3 * probe.stable_v:g} mV "
            f"for {probe.stable_s:g} s"
        ),
        InvalidReason.OPEN_CIRCUIT: "open circuit between probe and reinforcement",
    }


READER = PointReader("half_cell", Reading, complete, reasons, has_fields=True)


def false_valid_points(flight: FlightData) -> float:
    """Number of readings that count although the tool did not truly press hard enough.

    The true normal force, mean over the last 2 s of the dwell, is below the least force of the
    probe's rule less three standard deviations of its load cell.
    """
    probe = probe_of(flight)
    points = contact_points(READER, flight)
    least_n = probe.min_force_n - 3.0 * probe.force_noise_n
    _ = flight.reference  # without the truth nothing can be said
    return float(sum(point.valid and (point.true_force_n or 0.0) < least_n for point in points))


def potential_error_max(flight: FlightData) -> float:
    """Largest difference, V, of an accepted potential from the specimen's at the true contact."""
    return max(
        1e-3 * abs(point.potential_mv - point.true_potential_mv)
        for point in _comparable(flight)
        if point.potential_mv is not None and point.true_potential_mv is not None
    )


def resistance_error_rel_max(flight: FlightData) -> float:
    """Largest |R K / ρ − 1| of an accepted resistance R against the specimen's resistivity ρ."""
    errors = [
        abs(point.resistivity_ohm_m / point.true_resistivity_ohm_m - 1.0)
        for point in _comparable(flight)
        if point.resistivity_ohm_m is not None and point.true_resistivity_ohm_m is not None
    ]
    if not errors:
        raise NotMeasured("no valid reading has a resistance")
    return max(errors)


def _comparable(flight: FlightData) -> list[PointResult]:
    points = [point for point in contact_points(READER, flight) if point.valid]
    if not points:
        raise NotMeasured("no reading is valid")
    points = [point for point in points if point.true_potential_mv is not None]
    if not points:
        raise NotMeasured("the log knows no specimen where readings were taken")
    return points


def potential_min(flight: FlightData) -> float:
    """Least potential, V, of the valid readings."""
    return _most_negative(flight)[0]


def potential_min_point(flight: FlightData) -> float:
    """Which of the points, k = 1, 2, … in the plan's order, has the least valid potential.

    Raises NotMeasured where that is in the passive class: it would be noise that tells.
    """
    potential, point = _most_negative(flight)
    if astm_class(potential) == "passive":
        raise NotMeasured("every valid potential is in the passive class: none stands out")
    return float(point)


def _most_negative(flight: FlightData) -> tuple[float, int]:
    """(V, k) of the valid reading with the least potential."""
    read = [
        (1e-3 * point.potential_mv, k)
        for k, point in enumerate(contact_points(READER, flight), start=1)
        if point.valid and point.potential_mv is not None
    ]
    if not read:
        raise NotMeasured("no reading is valid")
    return min(read)


def active_points_count(flight: FlightData) -> float:
    """Number of points with the combined verdict active."""
    return float(sum(point.corrosion == "active" for point in contact_points(READER, flight)))


def active_mask(flight: FlightData) -> float:
    """Which points are active, as one number: Σ 2^(k−1) over active points k = 1, 2, ….

    Points are numbered in the plan's order; exactly points 2 and 3 give 2 + 4 = 6.
    """
    points = contact_points(READER, flight)
    return float(sum(2**k for k, point in enumerate(points) if point.corrosion == "active"))


def map_mismatches(flight: FlightData) -> float:
    """Number of points whose combined verdict differs from the specimen's by the same rule.

    The specimen's is taken at the true contact. A point without a valid reading, or that was
    never pressed, has no verdict and counts as different.
    """
    points = contact_points(READER, flight)
    if all(point.true_corrosion is None for point in points):
        raise NotMeasured("the log knows no specimen where the tool pressed")
    return float(
        sum(point.corrosion is None or point.corrosion != point.true_corrosion for point in points)
    )


READ = (Reading,)
READ_TRULY = (Reading, State, Reference, TrueContact)

METRICS: dict[str, MetricSpec] = {
    "half_cell.false_valid_points": MetricSpec(
        "1",
        false_valid_points,
        "valid readings whose tool did not truly press hard enough",
        (Reading, State, Reference),
        SUM,
    ),
    "half_cell.potential_error_max_v": MetricSpec(
        "V",
        potential_error_max,
        "largest error of an accepted potential against the specimen at the true contact",
        READ_TRULY,
        GREATEST,
    ),
    "half_cell.resistance_error_rel_max": MetricSpec(
        "1",
        resistance_error_rel_max,
        "largest relative error of an accepted resistance against the specimen",
        READ_TRULY,
        GREATEST,
    ),
    "half_cell.potential_min_v": MetricSpec(
        "V",
        potential_min,
        "least potential of the valid readings",
        READ,
        LEAST,
    ),
    "half_cell.potential_min_point": MetricSpec(
        "1",
        potential_min_point,
        "point k, from 1 in the plan's order, with the least valid potential; none if passive",
        READ,
    ),
    "half_cell.active_points_count": MetricSpec(
        "1",
        active_points_count,
        "points with the combined verdict active",
        READ,
        SUM,
    ),
    "half_cell.active_mask": MetricSpec(
        "1",
        active_mask,
        "which points are active: sum of 2^(k−1) over active points k, so 2 and 3 give 6",
        READ,
    ),
    "half_cell.map_mismatches": MetricSpec(
        "1",
        map_mismatches,
        "points whose verdict differs from the specimen's; a point without one differs",
        READ_TRULY,
        SUM,
    ),
}

ROW = Instrument(
    READER,
    METRICS,
    tolerances={
        "half_cell.resistance_error_rel_max": Tolerance(0.002, 0.10),
        # Two points on either side of a site may give the same reading.
        "half_cell.potential_min_point": Tolerance(1.0, 0.0),
    },
    missed=("half_cell.map_mismatches",),
    assess=assess_points,
    score=score,
)
