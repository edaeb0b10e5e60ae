"""Readings evaluated for the tests of the report: those of a flight, and made up ones."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.assessment.assess import assess
from inspect_cli.assessment.classes import astm_class, combined_verdict
from inspect_cli.assessment.kriging import krige
from inspect_cli.assessment.readings import Readings, readings_of
from inspect_cli.reporting.evaluated import Evaluated
from inspect_cli.reporting.points import ReadPoint, read_points
from inspect_cli.schema.assessment import Basis
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import PointResult, Result


def evaluated_of(result: Result, plan: Plan) -> list[Evaluated]:
    """The readings of each surface of a flight."""
    points = read_points(result, plan)
    names = dict.fromkeys(p.surface for p in points if p.surface)
    own = {n: [p.point for p in points if p.surface == n and p.point.uv_m] for n in names}
    return [_evaluated(n, readings_of(found, 0.003), None) for n, found in own.items() if found]


def surveyed(
    uv_m: ArrayLike,
    potential_mv: ArrayLike,
    resistivity_ohm_m: ArrayLike | None = None,
    *,
    surface: str = "deck",
    basis: Basis | None = None,
) -> Evaluated:
    """Readings labelled 1, 2, … of a survey from a file."""
    mv = np.asarray(potential_mv, dtype=np.float64).reshape(-1)
    n = len(mv)
    rho = np.full(n, np.nan) if resistivity_ohm_m is None else np.asarray(resistivity_ohm_m)
    readings = Readings(
        labels=np.array([str(k + 1) for k in range(n)], dtype=np.str_),
        uv_m=np.asarray(uv_m, dtype=np.float64).reshape(n, 2),
        potential_v=1e-3 * mv,
        resistivity_ohm_m=rho.reshape(-1).astype(np.float64),
        measurement_sd_v=np.full(n, 0.002),
    )
    return _evaluated(surface, readings, basis)


def _evaluated(surface: str, readings: Readings, basis: Basis | None) -> Evaluated:
    assessed = assess(surface, readings, basis=basis)
    found = assessed.readings
    kriged = krige(found.uv_m, found.potential_v, assessed.budget.reading_v)
    return Evaluated(assessed, kriged)


def points_of(evaluated: Evaluated) -> list[ReadPoint]:
    """The readings one by one, as a survey from a file has them: without targets."""
    readings = evaluated.assessed.readings
    rows: Sequence[tuple[str, list[float], float, float]] = list(
        zip(
            map(str, readings.labels),
            readings.uv_m.tolist(),
            readings.potential_v.tolist(),
            readings.resistivity_ohm_m.tolist(),
            strict=True,
        )
    )
    return [ReadPoint(_point(k, *row), None) for k, row in enumerate(rows)]


def _point(k: int, label: str, uv_m: list[float], potential_v: float, rho: float) -> PointResult:
    valid = bool(np.isfinite(potential_v))
    known = float(rho) if np.isfinite(rho) else None
    return PointResult(
        index=k,
        label=label,
        valid=valid,
        reason="" if valid else "open circuit between probe and reinforcement",
        p_W=(0.0, 0.0, 0.0),
        uv_m=(uv_m[0], uv_m[1]),
        potential_mv=1e3 * potential_v if valid else None,
        resistance_ohm=None,
        resistivity_ohm_m=known,
        probe_force_n=None,
        contact_s=0.0,
        astm_class=astm_class(potential_v) if valid else None,
        corrosion=combined_verdict(potential_v, known) if valid else None,
    )
