"""Rasters whose truth is known in closed form, and points that were judged on them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.truth_scoring import Judged
from inspect_cli.schema.result import PointResult
from inspect_cli.spatial.arrays import Mask, Points, Vector

Truth = Callable[[Vector, Vector], Mask]
"""Whether the steel is active at (u, v)."""


def raster_of(
    truth: Truth,
    size_m: tuple[float, float] = (2.0, 1.0),
    step_m: float = 0.005,
    name: str = "wall",
    radius_m: float = 0.0,
    turn_m: float = 0.0,
) -> TrueRaster:
    """A raster of square cells; active steel reads −450 mV in 60 Ω·m, sound −120 mV in 220 Ω·m."""
    columns, rows = (round(length / step_m) for length in size_m)
    u_m = (np.arange(columns) + 0.5) * step_m - 0.5 * size_m[0]
    v_m = (np.arange(rows) + 0.5) * step_m - 0.5 * size_m[1]
    active = np.asarray(truth(*np.meshgrid(u_m, v_m)), bool)
    return TrueRaster(
        name,
        u_m,
        v_m,
        np.where(active, -0.45, -0.12),
        np.where(active, 60.0, 220.0),
        active,
        radius_m,
        turn_m,
    )


def disc(u_m: float, v_m: float, radius_m: float) -> Truth:
    """Active within a circle."""
    return lambda u, v: (u - u_m) ** 2 + (v - v_m) ** 2 <= radius_m**2


def judged_truly(uv_m: Points, truth: Truth) -> Judged:
    """Points judged without any error."""
    active = [bool(truth(u, v)) for u, v in uv_m]
    return Judged(
        uv_m,
        tuple("active" if so else "none" for so in active),
        tuple("active" if so else "passive" for so in active),
    )


def grid(columns: int, rows: int, pitch_m: float, at_m: tuple[float, float] = (0, 0)) -> Points:
    """(u, v) of a grid around a middle."""
    u = (np.arange(columns) - 0.5 * (columns - 1)) * pitch_m + at_m[0]
    v = (np.arange(rows) - 0.5 * (rows - 1)) * pitch_m + at_m[1]
    return np.column_stack([np.tile(u, rows), np.repeat(v, columns)])


def point(
    index: int, uv_m: tuple[float, float], said: str | None, surface: str = "wall"
) -> PointResult:
    """A point as a flight leaves it; None for one without a valid reading."""
    astm = {"none": "passive", "possible": "uncertain", "active": "active", None: None}
    return PointResult(
        index=index,
        label=str(index + 1),
        valid=said is not None,
        reason="" if said else "not visited",
        p_W=(0.0, 0.0, 0.0),
        surface=surface,
        uv_m=uv_m,
        potential_mv=None,
        resistance_ohm=None,
        resistivity_ohm_m=None,
        probe_force_n=None,
        contact_s=0.0,
        astm_class=astm[said],
        corrosion=said,
    )
