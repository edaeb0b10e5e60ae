"""What is truly so beneath a surface, as a simulated flight leaves it in its log.

A raster divides the believed surface into equal cells in (u, v) and holds what is so at the middle
of each. It travels as NumPy's archive of arrays: for a surface ``wall`` the members ``wall/u_m``,
``wall/v_m``, ``wall/potential_v``, ….
"""

from __future__ import annotations

import io
import zipfile
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inspect_cli.spatial.arrays import Mask, Matrix, Points, Vector

Numbers = NDArray[np.intp]
"""Of rows or columns."""
SINGLE = np.dtype("<f4")
"""Nobody measures a potential to seven digits."""


ROUNDING = 1e-6
"""In cells."""


@dataclass(frozen=True, eq=False)
class TrueRaster:
    """The truth beneath one surface; cell (row, column) has its middle at (u_m[column], v_m[row]).

    Both axes ascend evenly and have two cells at least.
    """

    surface: str
    u_m: Vector
    v_m: Vector
    potential_v: Matrix
    """(rows, columns), V against CSE; NaN where nothing is known."""
    resistivity_ohm_m: Matrix
    active: Mask
    """Whether the steel truly corrodes."""
    radius_m: float
    """Of a sphere, on which u counts along the equator; 0 elsewhere."""
    turn_m: float
    """What leads along u once around a surface that is closed; 0 where it is not."""

    @property
    def step_m(self) -> tuple[float, float]:
        """The size of a cell along u and v."""
        return float(self.u_m[1] - self.u_m[0]), float(self.v_m[1] - self.v_m[0])

    def across(self, v_m: Vector) -> Vector:
        """Metres along the surface for a metre of u at each v: cos(v/r) on a sphere, else 1."""
        if self.radius_m == 0.0:
            return np.ones_like(v_m)
        share: Vector = np.cos(v_m / self.radius_m)
        return share

    def cells(self, uv_m: Points) -> tuple[Numbers, Numbers, Mask]:
        """Row and column of the cells that places (n, 2) lie in, and whether they lie in any."""
        u = uv_m[:, 0]
        if self.turn_m:
            u = u - self.turn_m * np.round(u / self.turn_m)
        columns, in_column = _placed(u, self.u_m)
        rows, in_row = _placed(uv_m[:, 1], self.v_m)
        return rows, columns, in_column & in_row


def _placed(x_m: Vector, middles_m: Vector) -> tuple[Numbers, Mask]:
    """Which of the cells of an axis places (n,) lie in, the nearest beyond its ends."""
    place = (x_m - middles_m[0]) / (middles_m[1] - middles_m[0]) + 0.5
    count = len(middles_m)
    # A place on the very edge belongs to the last cell.
    inside = (place >= -ROUNDING) & (place <= count + ROUNDING)
    return np.clip(np.floor(place), 0, count - 1).astype(np.intp), inside


def encoded(rasters: Sequence[TrueRaster]) -> bytes:
    """Rasters as one archive; the same rasters give the same bytes."""
    members: dict[str, np.ndarray] = {}
    for raster in rasters:
        name = raster.surface
        members[f"{name}/u_m"] = raster.u_m
        members[f"{name}/v_m"] = raster.v_m
        members[f"{name}/potential_v"] = raster.potential_v.astype(SINGLE)
        members[f"{name}/resistivity_ohm_m"] = raster.resistivity_ohm_m.astype(SINGLE)
        members[f"{name}/active"] = raster.active
        members[f"{name}/closing"] = np.array([raster.radius_m, raster.turn_m])
    data = io.BytesIO()
    np.savez_compressed(data, allow_pickle=False, **members)
    return data.getvalue()


def decoded(data: bytes) -> tuple[TrueRaster, ...]:
    """The rasters of an archive.

    Raises:
        ValueError: it is damaged, or its arrays do not fit each other.
    """
    try:
        with np.load(io.BytesIO(data), allow_pickle=False) as archive:
            members = {name: archive[name] for name in archive.files}
        names = dict.fromkeys(name.rpartition("/")[0] for name in members)
        return tuple(_raster(name, members) for name in names)
    except (zipfile.BadZipFile, KeyError, EOFError, OSError, TypeError) as error:
        raise ValueError(f"no archive of rasters: {error}") from error


def _raster(name: str, members: dict[str, np.ndarray]) -> TrueRaster:
    u_m, v_m = (np.asarray(members[f"{name}/{axis}"], np.float64) for axis in ("u_m", "v_m"))
    fields = [members[f"{name}/{field}"] for field in ("potential_v", "resistivity_ohm_m")]
    active = np.asarray(members[f"{name}/active"], np.bool_)
    shape = (v_m.size, u_m.size)
    if min(shape) < 2 or any(field.shape != shape for field in (*fields, active)):
        raise ValueError(f"the arrays of '{name}' do not fit each other")
    potential, resistivity = (np.asarray(field, np.float64) for field in fields)
    radius_m, turn_m = (float(x) for x in members[f"{name}/closing"])
    return TrueRaster(name, u_m, v_m, potential, resistivity, active, radius_m, turn_m)
