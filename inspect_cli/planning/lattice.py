"""Points that fill a surface at a pitch along its geometry.

Planes and cylinders are developable: arc lengths (u, v) are distances on the surface unrolled, so
an even lattice in (u, v) is even on the surface. A sphere is not: its rows are parallels one pitch
apart, and each row has its own even spacing, one pitch along the parallel. The nearest points of
neighbouring rows are then between one pitch and √1.25 pitches apart.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np

from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.primitives import CYLINDER, SPHERE, normal_at

Place = tuple[float, float]
"""(u, v) m on a surface."""

ROUNDING_M = 1e-9
LEAST_CHORD = 0.7
"""Of the pitch; around a pole points would come closer than along the parallel."""


def lattice(prim: Structured, pitch_m: float, edge_m: float, offset_m: Place) -> list[Place]:
    """The places of a lattice, row by row from the top, each from the lowest u to the highest.

    Args:
        prim: the surface, a PRIMITIVE array of length 1.
        pitch_m: between neighbours, along the surface.
        edge_m: no place is nearer to the patch's edge than this.
        offset_m: shifts the lattice from where it lies evenly within the patch.
    """
    half_u, half_v = (float(x) for x in prim["half_size"][0])
    rows = _line(half_v, pitch_m, edge_m, offset_m[1])[::-1]
    if prim["kind"][0] != SPHERE:
        columns = _line(half_u, pitch_m, edge_m, offset_m[0])
        return [(float(u), float(v)) for v in rows for u in columns]
    return [
        (float(u), float(v)) for v in rows for u in _parallel(prim, v, pitch_m, edge_m, offset_m)
    ]


def along_m(prim: Structured, a: Place, b: Place) -> float:
    """The distance of two places, m, along the surface the shortest way."""
    if prim["kind"][0] == SPHERE:
        n_a, n_b = normal_at(prim, 0, *a), normal_at(prim, 0, *b)
        half_chord = 0.5 * float(np.linalg.norm(n_a - n_b))
        return float(prim["radius"][0]) * 2.0 * float(np.arcsin(min(half_chord, 1.0)))
    return float(np.hypot(_over_u(prim, a, b), b[1] - a[1]))


def between(prim: Structured, a: Place, b: Place, pitch_m: float) -> Iterator[Place]:
    """Places that divide the way from ``a`` to ``b`` into steps of at most ``pitch_m``."""
    steps = int(np.ceil(along_m(prim, a, b) / pitch_m - ROUNDING_M))
    du, dv = _over_u(prim, a, b), b[1] - a[1]
    for k in range(1, steps):
        yield (a[0] + k / steps * du, a[1] + k / steps * dv)


def _over_u(prim: Structured, a: Place, b: Place) -> float:
    """The way along u, the short way around a closed surface."""
    du = b[0] - a[0]
    if prim["kind"][0] not in (CYLINDER, SPHERE):
        return du
    turn = 2.0 * np.pi * float(prim["radius"][0])
    return float(du - turn * np.round(du / turn))


def _line(half_m: float, pitch_m: float, edge_m: float, offset_m: float) -> Vector:
    """Ascending places pitch_m apart with |x| ≤ half − edge, evenly about ``offset_m``."""
    room_m = half_m - edge_m
    if room_m < -ROUNDING_M:
        return np.empty(0)
    count = int(np.floor((2.0 * room_m + ROUNDING_M) / pitch_m)) + 1
    middle_m = offset_m + (0.0 if count % 2 else 0.5 * pitch_m)
    first = int(np.ceil((-room_m - middle_m - ROUNDING_M) / pitch_m))
    last = int(np.floor((room_m - middle_m + ROUNDING_M) / pitch_m))
    places: Vector = middle_m + pitch_m * np.arange(first, last + 1, dtype=np.float64)
    return places


def _parallel(prim: Structured, v: float, pitch_m: float, edge_m: float, offset_m: Place) -> Vector:
    """The u of a row on a sphere's parallel; u counts along the equator."""
    radius_m, half_u = float(prim["radius"][0]), float(prim["half_size"][0, 0])
    share = float(np.cos(v / radius_m))
    ring_m = radius_m * share
    if half_u >= np.pi * radius_m - ROUNDING_M:
        return _ring(ring_m, pitch_m, offset_m[0]) / max(share, ROUNDING_M)
    if 2.0 * ring_m * np.sin(min(0.5 * pitch_m / max(ring_m, ROUNDING_M), 0.5 * np.pi)) < (
        LEAST_CHORD * pitch_m
    ):
        return np.zeros(1)
    return _line(half_u * share, pitch_m, edge_m, offset_m[0] * share) / share


def _ring(ring_m: float, pitch_m: float, offset_m: float) -> Vector:
    """Arc lengths along a whole parallel, evenly spread all around."""
    around_m = 2.0 * np.pi * ring_m
    count = max(1, round(around_m / pitch_m))
    while count > 1 and 2.0 * ring_m * np.sin(np.pi / count) < LEAST_CHORD * pitch_m:
        count -= 1
    step_m = around_m / count
    places: Vector = (np.arange(count, dtype=np.float64) - 0.5 * (count - 1)) * step_m + offset_m
    return places
