"""A map of half-cell potential between the readings of one surface, with its standard error.

Ordinary kriging (PyKrige) on a grid of nodes, from a moving neighbourhood of at most 32 readings,
drawn only where neighbouring readings stand (``hull``). What would be invention is refused in
words: ``NoMap``.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.hull import LARGEST_GAP, measured_hull, typical_pitch
from inspect_cli.assessment.spacing import PLACE_DECIMALS, from_corner
from inspect_cli.assessment.supports import (
    Supports,
    distinct_places,
    readings_per_cell,
    supports,
)
from inspect_cli.assessment.variogram import Variogram, fit, semivariances

Floats = NDArray[np.float64]

NEIGHBOURS = 32
FEWEST_PLACES = 5
_NODES_PER_PITCH = 5
_FEWEST_NODES, _MOST_NODES = 20, 200
_LINE = 5e-3
"""Readings are in one line if they spread across it less than this fraction of along it."""
_FLAT_V = 1e-9
_LEAST_NUGGET = 1e-6
"""Of the variance of the readings: readings almost at one place may differ, and a kriging system
without a nugget would be singular."""
_WHOLE = 300
_TILE = 12


@dataclass(frozen=True)
class KrigedMap:
    """Potential and its standard error on a grid; NaN outside the measured hull."""

    u_m: Floats
    """(columns,) where the nodes stand along u, m, ascending."""
    v_m: Floats
    """(rows,) where the nodes stand along v, m, ascending."""
    potential_v: Floats
    """(rows, columns) V, in the reference of the readings."""
    standard_error_v: Floats
    """(rows, columns) V, of the true potential there; a further reading there would differ from
    the map by this and by its own measurement error, independently."""
    variogram: Variogram
    readings: int
    """How many readings had a potential and a place."""
    places: int
    """How many values were kriged: readings closer than two nodes are averaged."""
    pitch_m: tuple[float, float]
    """Typical distance of neighbouring readings along u and v, m."""
    how: str
    """How the map was made, in one sentence."""


@dataclass(frozen=True)
class NoMap:
    """Why there is no map."""

    why: str


def krige(uv_m: Floats, potential_v: Floats, measurement_sd_v: Floats | None) -> KrigedMap | NoMap:
    """Interpolate readings between their places by ordinary kriging.

    The potential at a node is Ê = Σ λ_i E_i over the nearest readings with Σ λ_i = 1 and the
    least variance σ² = Σ λ_i γ_i + μ; λ and μ solve Σ_j λ_j γ_ij + μ = γ_i. A nugget is taken
    for noise: the map is not forced through the readings. σ² then is that of a further reading,
    and the standard error is √(σ² − the mean variance of a measurement).

    Args:
        uv_m: (n, 2) places along the surface, m. Rows that are not finite are left out.
        potential_v: (n,) potentials, V; NaN where there is none.
        measurement_sd_v: (n,) standard uncertainty of each reading, V, NaN unknown; or None.
            Their mean variance is the least nugget.

    Source: Cressie, Statistics for Spatial Data (1993), section 3.2.
    """
    uv, potential, variance = _valid(uv_m, potential_v, measurement_sd_v)
    origin, uv = from_corner(uv) if len(uv) else (np.zeros(2), uv)
    # A micrometre is finer than any place is known, and coarser than the rounding of large
    # coordinates, which otherwise chose the 32 nearest among readings that are equally near.
    uv = np.round(uv, PLACE_DECIMALS)
    places = distinct_places(uv)
    why = _why_not(places, len(uv))
    if why is not None:
        return NoMap(why)
    pitch = typical_pitch(places)
    low, high = uv.min(axis=0), uv.max(axis=0)
    u, v = (_nodes(low[axis], high[axis], pitch[axis]) for axis in (0, 1))
    node_m = np.array([u[1] - u[0], v[1] - v[0]])
    held = supports(uv, potential, variance, node_m)
    if len(held.potential_v) < FEWEST_PLACES:
        return NoMap(_too_few(len(held.potential_v)))
    hull = measured_hull(held.uv_m, uv, np.maximum(pitch, node_m))
    crowded = readings_per_cell(uv, node_m, (len(v), len(u))) > 1
    nodes = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    inside = hull.contains(nodes, crowded.ravel()).reshape(crowded.shape)
    if not inside.any():
        return NoMap("no three readings stand near enough to each other to draw between them")
    variogram = _variogram(held)
    estimate, variance_of = _on_grid(held, variogram, u, v, inside)
    error = np.sqrt(np.maximum(variance_of - held.measurement_v2, 0.0))
    return KrigedMap(
        u_m=u + origin[0],
        v_m=v + origin[1],
        potential_v=estimate,
        standard_error_v=error,
        variogram=variogram,
        readings=len(potential),
        places=len(held.potential_v),
        pitch_m=(float(pitch[0]), float(pitch[1])),
        how=_how(len(potential), held, variogram),
    )


def kriged_at(held: Supports, variogram: Variogram, at_m: Floats) -> tuple[Floats, Floats]:
    """Ordinary kriging at ``at_m`` (n, 2), m, from the nearest 32 of ``held``.

    PyKrige takes all pairs of what it is given: give it what is near.

    Returns:
        potentials (n,), V, and variances (n,) of a further reading there, V².
    """
    if variogram.scale_v2 == 0.0 and np.ptp(held.potential_v) <= _FLAT_V:
        return _flat(held, variogram, len(at_m))
    from importlib.util import find_spec

    from pykrige.ok import OrdinaryKriging

    model = OrdinaryKriging(
        held.uv_m[:, 0],
        held.uv_m[:, 1],
        held.potential_v,
        variogram_model=variogram.model,
        variogram_parameters=_for_pykrige(variogram),
        exact_values=False,
    )
    estimate, variance = model.execute(
        "points",
        at_m[:, 0],
        at_m[:, 1],
        backend="C" if find_spec("pykrige.lib.cok") else "loop",
        n_closest_points=min(NEIGHBOURS, len(held.potential_v)),
    )
    return np.asarray(estimate), np.asarray(variance)


def _for_pykrige(variogram: Variogram) -> dict[str, float]:
    nugget, scale, length = variogram.nugget_v2, variogram.scale_v2, variogram.length_m
    if variogram.model == "power":
        exponent = variogram.exponent
        return {"scale": scale / length**exponent, "exponent": exponent, "nugget": nugget}
    return {"psill": scale, "range": length, "nugget": nugget}


def _flat(held: Supports, variogram: Variogram, count: int) -> tuple[Floats, Floats]:
    """Readings that are all equal, with a nugget at most: PyKrige's system may be singular."""
    neighbours = min(NEIGHBOURS, len(held.potential_v))
    variance = variogram.nugget_v2 * (1.0 + 1.0 / neighbours)
    return np.full(count, held.potential_v[0]), np.full(count, variance)


def _valid(uv_m: Floats, potential_v: Floats, sd_v: Floats | None) -> tuple[Floats, Floats, Floats]:
    """The readings that have a place and a potential, and their variances (NaN unknown)."""
    valid = np.isfinite(potential_v) & np.isfinite(uv_m).all(axis=1)
    sd = np.full(len(potential_v), np.nan) if sd_v is None else sd_v
    return uv_m[valid], potential_v[valid], sd[valid] ** 2


def _why_not(places: Floats, readings: int) -> str | None:
    """Why these places of valid readings span no map; None if they do."""
    if readings == 0:
        return "there are no valid readings"
    if len(places) == 1 and readings > 1:
        return f"all {readings} valid readings are at one place"
    if len(places) < FEWEST_PLACES:
        return _too_few(len(places))
    across, along = np.linalg.eigvalsh(np.cov(places.T))
    if across < _LINE**2 * along:
        return "the valid readings are in one line: there is no area between them"
    return None


def _too_few(places: int) -> str:
    valid = "valid reading is" if places == 1 else "places with valid readings are"
    return f"{places} {valid} too few for a map, which needs {FEWEST_PLACES}"


def _nodes(low: float, high: float, pitch: float) -> Floats:
    wanted = int(np.ceil((high - low) / pitch * _NODES_PER_PITCH - 1e-6)) + 1
    return np.linspace(low, high, min(max(wanted, _FEWEST_NODES), _MOST_NODES))


def _variogram(held: Supports) -> Variogram:
    found = semivariances(held.uv_m, held.potential_v, NEIGHBOURS)
    if np.ptp(held.potential_v) <= _FLAT_V:
        return Variogram("spherical", held.measurement_v2, 0.0, float(found.lag_m[-1]))
    least = _LEAST_NUGGET * float(np.var(held.potential_v))
    return fit(found, max(least, held.measurement_v2))


def _on_grid(
    held: Supports, variogram: Variogram, u: Floats, v: Floats, inside: NDArray[np.bool_]
) -> tuple[Floats, Floats]:
    """Kriged potential and variance at the nodes ``inside``, NaN elsewhere."""
    from threadpoolctl import threadpool_limits

    estimate = np.full(inside.shape, np.nan)
    variance = np.full(inside.shape, np.nan)
    # The systems are small: threads gain nothing, and where the processors are busy with other
    # work they wait for each other a hundred times longer than one thread computes.
    with threadpool_limits(limits=1, user_api="blas"):
        for rows, columns, near in _tiles(held, u, v, inside):
            at = np.column_stack([u[columns], v[rows]])
            estimate[rows, columns], variance[rows, columns] = kriged_at(near, variogram, at)
    return estimate, variance


def _tiles(
    held: Supports, u: Floats, v: Floats, inside: NDArray[np.bool_]
) -> Iterator[tuple[NDArray[np.intp], NDArray[np.intp], Supports]]:
    """Nodes by rows and columns, with every reading that is in the neighbourhood of one of them."""
    from scipy.spatial import cKDTree

    rows, columns = np.nonzero(inside)
    if len(held.potential_v) <= _WHOLE:
        yield rows, columns, held
        return
    nodes = np.column_stack([u[columns], v[rows]])
    _, nearest = cKDTree(held.uv_m).query(nodes, k=NEIGHBOURS)
    tile = (rows // _TILE) * _MOST_NODES + columns // _TILE
    order = np.argsort(tile, kind="stable")
    for of_tile in np.split(order, np.flatnonzero(np.diff(tile[order])) + 1):
        near = np.zeros(len(held.potential_v), dtype=bool)
        near[nearest[of_tile]] = True
        yield rows[of_tile], columns[of_tile], held.taken(np.flatnonzero(near))


def _how(readings: int, held: Supports, variogram: Variogram) -> str:
    places = len(held.potential_v)
    merged = f", averaged at {places} places," if places < readings else ""
    article = "an" if variogram.model == "exponential" else "a"
    mv2 = f"nugget {1e6 * variogram.nugget_v2:.3g} mV²"
    if variogram.model == "power":
        mv2 += (
            f", {1e6 * variogram.scale_v2:.3g} mV² at {variogram.length_m:.3g} m, "
            f"exponent {variogram.exponent:.2f}"
        )
    else:
        mv2 += (
            f", partial sill {1e6 * variogram.scale_v2:.3g} mV², range {variogram.length_m:.3g} m"
        )
    return (
        f"Ordinary kriging of {readings} readings{merged} from the nearest {NEIGHBOURS} at most, "
        f"with {article} {variogram.model} variogram ({mv2}); nothing is drawn outside the "
        f"measured area or across gaps wider than {LARGEST_GAP:g} spacings of the readings."
    )
