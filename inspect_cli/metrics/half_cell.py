"""How true the half-cell readings are, and what they say of the reinforcement."""

from __future__ import annotations

from inspect_cli.assessment.classes import astm_class
from inspect_cli.metrics.flight import Flight, NotMeasured
from inspect_cli.metrics.points import point_results, probe_of
from inspect_cli.records import Reading
from inspect_cli.schema.result import PointResult


def contact_points(flight: Flight) -> list[PointResult]:
    """The results of the targets that were to be read.

    Raises:
        NotMeasured: the plan has none, or the log has no channel of readings.
    """
    if flight.log.rows(Reading) is None:
        raise NotMeasured(f"the log has nothing on {Reading.topic}")
    wanted = {target.index for target in flight.read_targets}
    return [point for point in point_results(flight) if point.index in wanted]


def points_total(flight: Flight) -> float:
    """Number of points that the plan wants read."""
    return float(len(flight.read_targets))


def points_valid(flight: Flight) -> float:
    """Number of points with a valid reading."""
    return float(sum(point.valid for point in contact_points(flight)))


def valid_share(flight: Flight) -> float:
    """Valid readings as a share of the planned points."""
    return points_valid(flight) / points_total(flight)


def false_valid_points(flight: Flight) -> float:
    """Number of readings that count although the tool did not truly press hard enough.

    The true normal force, mean over the last 2 s of the dwell, is below the least force of the
    probe's rule less three standard deviations of its load cell.
    """
    probe = probe_of(flight)
    least_n = probe.min_force_n - 3.0 * probe.force_noise_n
    _ = flight.reference  # without the truth nothing can be said
    return float(
        sum(
            point.valid and (point.true_force_n or 0.0) < least_n
            for point in contact_points(flight)
        )
    )


def potential_error_max(flight: Flight) -> float:
    """Largest difference, V, of an accepted potential from the specimen's at the true contact."""
    return max(
        1e-3 * abs(point.potential_mv - point.true_potential_mv)
        for point in _comparable(flight)
        if point.potential_mv is not None and point.true_potential_mv is not None
    )


def resistance_error_rel_max(flight: Flight) -> float:
    """Largest |R K / ρ − 1| of an accepted resistance R against the specimen's resistivity ρ."""
    errors = [
        abs(point.resistivity_ohm_m / point.true_resistivity_ohm_m - 1.0)
        for point in _comparable(flight)
        if point.resistivity_ohm_m is not None and point.true_resistivity_ohm_m is not None
    ]
    if not errors:
        raise NotMeasured("no valid reading has a resistance")
    return max(errors)


def _comparable(flight: Flight) -> list[PointResult]:
    points = [point for point in contact_points(flight) if point.valid]
    if not points:
        raise NotMeasured("no reading is valid")
    points = [point for point in points if point.true_potential_mv is not None]
    if not points:
        raise NotMeasured("the log knows no specimen where readings were taken")
    return points


def potential_min(flight: Flight) -> float:
    """Least potential, V, of the valid readings."""
    return _most_negative(flight)[0]


def potential_min_point(flight: Flight) -> float:
    """Which of the points, k = 1, 2, … in the plan's order, has the least valid potential.

    Raises NotMeasured where that is in the passive class: it would be noise that tells.
    """
    potential, point = _most_negative(flight)
    if astm_class(potential) == "passive":
        raise NotMeasured("every valid potential is in the passive class: none stands out")
    return float(point)


def _most_negative(flight: Flight) -> tuple[float, int]:
    """(V, k) of the valid reading with the least potential."""
    read = [
        (1e-3 * point.potential_mv, k)
        for k, point in enumerate(contact_points(flight), start=1)
        if point.valid and point.potential_mv is not None
    ]
    if not read:
        raise NotMeasured("no reading is valid")
    return min(read)


def active_points_count(flight: Flight) -> float:
    """Number of points with the combined verdict active."""
    return float(sum(point.corrosion == "active" for point in contact_points(flight)))


def active_mask(flight: Flight) -> float:
    """Which points are active, as one number: Σ 2^(k−1) over active points k = 1, 2, ….

    Points are numbered in the plan's order; exactly points 2 and 3 give 2 + 4 = 6.
    """
    points = contact_points(flight)
    return float(sum(2**k for k, point in enumerate(points) if point.corrosion == "active"))


def map_mismatches(flight: Flight) -> float:
    """Number of points whose combined verdict differs from the specimen's by the same rule.

    The specimen's is taken at the true contact. A point without a valid reading, or that was
    never pressed, has no verdict and counts as different.
    """
    points = contact_points(flight)
    if all(point.true_corrosion is None for point in points):
        raise NotMeasured("the log knows no specimen where the tool pressed")
    return float(
        sum(point.corrosion is None or point.corrosion != point.true_corrosion for point in points)
    )
