"""Readings of a surface that nobody flew over, evaluated."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.assessment.assess import assess
from inspect_cli.assessment.classes import astm_class, combined_verdict
from inspect_cli.assessment.readings import Readings
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.commands.surface_maps import with_map
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.schema.assessment import Basis
from inspect_cli.schema.result import PointResult


def surveyed(
    uv_m: ArrayLike,
    potential_mv: ArrayLike,
    resistivity_ohm_m: ArrayLike | None = None,
    *,
    surface: str = "deck",
    basis: Basis | None = None,
) -> SurfaceFindings:
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
    return with_map(assess(surface, readings, basis=basis))


def points_of(evaluated: SurfaceFindings) -> list[ReadPoint]:
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
        contact_s=None,
        astm_class=astm_class(potential_v) if valid else None,
        corrosion=combined_verdict(potential_v, known) if valid else None,
    )
