"""Bounded planes, spheres and cylinders as arrays, and the kernels that every room asks.

A primitive is one element of a ``PRIMITIVE`` array. Its frame S has its origin ``p_WS`` in the
middle of a plane's rectangle, in the centre of a sphere, or on the axis of a cylinder at half
its length. Surface coordinates (u, v) are arc lengths in metres, (0, 0) in the patch's middle:

    plane     p = p_WS + R_WS [u, v, 0]
    sphere    p = p_WS + R_WS r [cos(v/r) sin(u/r), sin(v/r), cos(v/r) cos(u/r)]
    cylinder  p = p_WS + R_WS [r sin(u/r), v, r cos(u/r)]

z_S is the plane's normal, or points from the centre or axis to the patch's middle. x_S is level
where the surface lets it be: on a wall, seen from its free side, u runs to the right and v up.
The outward normal points to the side from which the surface is touched: ``side`` times the
radial direction, +1 outside, −1 inside. The patch is |u| ≤ half_size[0], |v| ≤ half_size[1].
"""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike

from inspect_cli.compiled import kernel
from inspect_cli.errors import GeometryError
from inspect_cli.spatial.arrays import Matrix, Points, Structured, Vector

PLANE, SPHERE, CYLINDER = 0, 1, 2

PRIMITIVE: np.dtype[Any] = np.dtype(
    [
        ("kind", "<i8"),
        ("p_WS", "<f8", (3,)),
        ("R_WS", "<f8", (3, 3)),
        ("radius", "<f8"),
        ("half_size", "<f8", (2,)),
        ("side", "<f8"),
    ]
)

LEVEL_SINE = np.sin(np.radians(10.0))
"""Closer than this to the vertical, a normal gives x_S no level direction worth following: a
floor's noisy normal must not turn its coordinates."""


def level_axes(n: ArrayLike) -> Matrix:
    """R_WS with z_S = n / |n| and x_S level: x_S ∥ z_W × n.

    Where n is within 10° of the vertical, x_S is x_W projected onto the surface instead.
    """
    z = np.asarray(n, dtype=np.float64)
    z = z / np.linalg.norm(z)
    if np.hypot(z[0], z[1]) > LEVEL_SINE:
        x = np.array([-z[1], z[0], 0.0])
    else:
        x = np.array([1.0, 0.0, 0.0]) - z[0] * z
    x /= np.linalg.norm(x)
    return np.column_stack([x, np.cross(z, x), z])


def plane(center_m: ArrayLike, normal: ArrayLike, size_m: ArrayLike) -> Structured:
    """A rectangle ``size_m`` (u, v) around ``center_m``; ``normal`` points to its free side."""
    return _primitive(PLANE, center_m, level_axes(normal), 0.0, size_m, 1.0)


def sphere(
    center_m: ArrayLike, radius_m: float, facing: ArrayLike, size_m: ArrayLike, side: float = 1.0
) -> Structured:
    """A patch of a sphere around the direction ``facing`` from its centre.

    Sizes beyond the whole turn (2πr, πr) mean the whole turn.
    """
    whole = np.pi * radius_m * np.array([2.0, 1.0])
    size = np.minimum(size_m, whole)
    return _primitive(SPHERE, center_m, level_axes(facing), radius_m, size, side)


def cylinder(
    center_m: ArrayLike,
    axis: ArrayLike,
    radius_m: float,
    facing: ArrayLike,
    size_m: ArrayLike,
    side: float = 1.0,
) -> Structured:
    """A patch of a cylinder: y_S = ``axis``, z_S = ``facing`` made square to it.

    An arc beyond 2πr means the whole turn. Raises GeometryError where ``facing`` runs along
    the axis.
    """
    y = np.asarray(axis, dtype=np.float64)
    y = y / np.linalg.norm(y)
    given = np.asarray(facing, dtype=np.float64)
    z = given - (given @ y) * y
    if np.linalg.norm(z) < 1e-9 * np.linalg.norm(given):
        raise GeometryError(
            "a cylinder's facing runs along its axis",
            hint="give the direction from the axis to the middle of the patch",
        )
    z /= np.linalg.norm(z)
    R_WS = np.column_stack([np.cross(y, z), y, z])
    size = np.minimum(size_m, [2.0 * np.pi * radius_m, np.inf])
    return _primitive(CYLINDER, center_m, R_WS, radius_m, size, side)


def _primitive(
    kind: int, p_WS: ArrayLike, R_WS: Matrix, radius: float, size: ArrayLike, side: float
) -> Structured:
    array = np.zeros(1, PRIMITIVE)
    array["kind"] = kind
    array["p_WS"] = np.asarray(p_WS)
    array["R_WS"] = R_WS
    array["radius"] = radius
    array["half_size"] = 0.5 * np.asarray(size)
    array["side"] = side
    return array


@kernel
def _turned(R: Matrix, x: float, y: float, z: float) -> Vector:
    """R [x, y, z]."""
    return np.array(
        [
            R[0, 0] * x + R[0, 1] * y + R[0, 2] * z,
            R[1, 0] * x + R[1, 1] * y + R[1, 2] * z,
            R[2, 0] * x + R[2, 1] * y + R[2, 2] * z,
        ]
    )


@kernel
def _turned_back(R: Matrix, x: float, y: float, z: float) -> Vector:
    """Rᵀ [x, y, z]."""
    return np.array(
        [
            R[0, 0] * x + R[1, 0] * y + R[2, 0] * z,
            R[0, 1] * x + R[1, 1] * y + R[2, 1] * z,
            R[0, 2] * x + R[1, 2] * y + R[2, 2] * z,
        ]
    )


@kernel
def normal_at(prims: Structured, i: int, u: float, v: float) -> Vector:
    """Outward unit normal (3,) in W of primitive ``i`` at (u, v) m."""
    R_WS = prims["R_WS"][i]
    kind = prims["kind"][i]
    if kind == PLANE:
        return _turned(R_WS, 0.0, 0.0, 1.0)
    side = prims["side"][i]
    angle_u = u / prims["radius"][i]
    if kind == CYLINDER:
        return _turned(R_WS, side * np.sin(angle_u), 0.0, side * np.cos(angle_u))
    angle_v = v / prims["radius"][i]
    level = side * np.cos(angle_v)
    return _turned(R_WS, level * np.sin(angle_u), side * np.sin(angle_v), level * np.cos(angle_u))


@kernel
def point_at(prims: Structured, i: int, u: float, v: float) -> Vector:
    """The point (3,) in W, m, of primitive ``i`` at (u, v) m; also beyond the patch's edge."""
    R_WS = prims["R_WS"][i]
    kind = prims["kind"][i]
    if kind == PLANE:
        foot = _turned(R_WS, u, v, 0.0)
    else:
        foot = prims["radius"][i] * prims["side"][i] * normal_at(prims, i, u, v)
    if kind == CYLINDER:
        foot += _turned(R_WS, 0.0, v, 0.0)
    foot += prims["p_WS"][i]
    return foot


@kernel
def project(prims: Structured, i: int, p_W: Vector) -> Vector:
    """(u, v, w) m of a point: its foot on the unbounded surface and its height over it.

    w is positive on the free side. At a sphere's centre and on a cylinder's axis the foot is
    not unique; one of them is returned.
    """
    p_WS = prims["p_WS"][i]
    q = _turned_back(prims["R_WS"][i], p_W[0] - p_WS[0], p_W[1] - p_WS[1], p_W[2] - p_WS[2])
    kind = prims["kind"][i]
    if kind == PLANE:
        return q
    radius = prims["radius"][i]
    side = prims["side"][i]
    level = np.sqrt(q[0] * q[0] + q[2] * q[2])
    u = radius * np.arctan2(q[0], q[2])
    if kind == CYLINDER:
        return np.array([u, q[1], side * (level - radius)])
    distance = np.sqrt(level * level + q[1] * q[1])
    return np.array([u, radius * np.arctan2(q[1], level), side * (distance - radius)])


@kernel
def patch_distance(prims: Structured, i: int, p_W: Vector) -> float:
    """Distance, m, of a point from the bounded patch of primitive ``i``.

    Negative where the point is behind the patch with its foot within the bounds.
    """
    uvw = project(prims, i, p_W)
    half_u = prims["half_size"][i, 0]
    half_v = prims["half_size"][i, 1]
    if abs(uvw[0]) <= half_u and abs(uvw[1]) <= half_v:
        return float(uvw[2])
    u = min(max(uvw[0], -half_u), half_u)
    v = min(max(uvw[1], -half_v), half_v)
    if prims["kind"][i] != SPHERE:
        return _distance(p_W, point_at(prims, i, u, v))
    # The nearest point of the patch lies on a meridian edge or on a parallel edge. On the
    # parallel it has the point's own longitude, on the meridian another latitude than its own.
    radius = prims["radius"][i]
    parallel = _distance(p_W, point_at(prims, i, u, np.copysign(half_v, uvw[1])))
    edge_u = np.copysign(half_u, uvw[0])
    turn = (uvw[0] - edge_u) / radius
    latitude = np.arctan2(np.sin(uvw[1] / radius), np.cos(uvw[1] / radius) * np.cos(turn))
    edge_v = min(max(radius * latitude, -half_v), half_v)
    return min(parallel, _distance(p_W, point_at(prims, i, edge_u, edge_v)))


@kernel
def _distance(a: Vector, b: Vector) -> float:
    dx, dy, dz = a[0] - b[0], a[1] - b[1], a[2] - b[2]
    return float(np.sqrt(dx * dx + dy * dy + dz * dz))


@kernel
def raycast(
    prims: Structured, origin_W: Vector, directions_W: Points, max_range: float, ranges: Vector
) -> None:
    """Write into ``ranges`` (n,) the distance, m, to the first patch that each ray meets.

    ``directions_W`` (n, 3) are unit vectors in W from ``origin_W``. Patches are opaque from
    both sides. NaN where nothing is met within ``max_range``.
    """
    ranges[:] = np.inf
    for i in range(prims.shape[0]):
        R = prims["R_WS"][i]
        p_WS = prims["p_WS"][i]
        o = _turned_back(R, origin_W[0] - p_WS[0], origin_W[1] - p_WS[1], origin_W[2] - p_WS[2])
        half_u = prims["half_size"][i, 0]
        half_v = prims["half_size"][i, 1]
        if prims["kind"][i] == PLANE:
            _rays_on_plane(R, o, half_u, half_v, directions_W, ranges)
        else:
            is_sphere = prims["kind"][i] == SPHERE
            _rays_on_round(
                is_sphere, R, o, prims["radius"][i], half_u, half_v, directions_W, ranges
            )
    for k in range(ranges.size):
        if ranges[k] > max_range:
            ranges[k] = np.nan


@kernel
def _rays_on_plane(
    R: Matrix, o: Vector, half_u: float, half_v: float, directions_W: Points, ranges: Vector
) -> None:
    """Shorten ``ranges`` to the hits on a rectangle; ``o`` (3,) is the rays' origin in S."""
    for k in range(ranges.size):
        dx, dy, dz = directions_W[k, 0], directions_W[k, 1], directions_W[k, 2]
        across = R[0, 2] * dx + R[1, 2] * dy + R[2, 2] * dz
        if across == 0.0:
            continue
        t = -o[2] / across
        u = o[0] + t * (R[0, 0] * dx + R[1, 0] * dy + R[2, 0] * dz)
        v = o[1] + t * (R[0, 1] * dx + R[1, 1] * dy + R[2, 1] * dz)
        if 0.0 <= t < ranges[k] and abs(u) <= half_u and abs(v) <= half_v:
            ranges[k] = t


@kernel
def _rays_on_round(
    is_sphere: bool,
    R: Matrix,
    o: Vector,
    radius: float,
    half_u: float,
    half_v: float,
    directions_W: Points,
    ranges: Vector,
) -> None:
    """Shorten ``ranges`` to the hits on a patch of a sphere or cylinder.

    |o + t d|² = r² in S, without the part along y_S for a cylinder: a t² + 2 b t + c = 0.
    """
    keep_y = 1.0 if is_sphere else 0.0
    # |u| ≤ half_u read as z ≥ cos(half_u / r) · √(x² + z²): no arc tangent for each ray.
    least_cosine = np.cos(half_u / radius) if half_u < np.pi * radius else -2.0
    most_y = half_v
    if is_sphere:
        most_y = radius * np.sin(half_v / radius) if half_v < 0.5 * np.pi * radius else np.inf
    c = o[0] * o[0] + keep_y * o[1] * o[1] + o[2] * o[2] - radius * radius
    for k in range(ranges.size):
        d = _turned_back(R, directions_W[k, 0], directions_W[k, 1], directions_W[k, 2])
        a = d[0] * d[0] + keep_y * d[1] * d[1] + d[2] * d[2]
        b = o[0] * d[0] + keep_y * o[1] * d[1] + o[2] * d[2]
        discriminant = b * b - a * c
        if discriminant < 0.0 or a == 0.0:
            continue
        # Of the two ways to write each root, the one without cancellation.
        w = -b - np.copysign(np.sqrt(discriminant), b)
        t_1 = w / a
        t_2 = c / w if w != 0.0 else t_1
        for t in (min(t_1, t_2), max(t_1, t_2)):
            if not 0.0 <= t < ranges[k]:
                continue
            x, y, z = o[0] + t * d[0], o[1] + t * d[1], o[2] + t * d[2]
            if abs(y) <= most_y and z >= least_cosine * np.sqrt(x * x + z * z):
                ranges[k] = t
                break
