"""Readings made of numbers, for the tests of this room."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.assessment.readings import Readings


def readings(
    uv_m: ArrayLike,
    potential_mv: ArrayLike,
    resistivity_ohm_m: ArrayLike | None = None,
    measurement_sd_v: float = 0.002,
) -> Readings:
    """Points labelled 1, 2, … ."""
    mv = np.asarray(potential_mv, dtype=np.float64).reshape(-1)
    n = len(mv)
    rho = np.full(n, np.nan) if resistivity_ohm_m is None else resistivity_ohm_m
    return Readings(
        labels=np.array([str(k + 1) for k in range(n)], dtype=np.str_),
        uv_m=np.asarray(uv_m, dtype=np.float64).reshape(n, 2),
        potential_v=1e-3 * mv,
        resistivity_ohm_m=np.asarray(rho, dtype=np.float64).reshape(-1),
        measurement_sd_v=np.full(n, measurement_sd_v),
    )


def grid(columns: int, rows: int, pitch_u_m: float, pitch_v_m: float | None = None) -> np.ndarray:
    """Places (columns · rows, 2), row by row from (0, 0)."""
    u = pitch_u_m * np.arange(columns)
    v = (pitch_u_m if pitch_v_m is None else pitch_v_m) * np.arange(rows)
    return np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
