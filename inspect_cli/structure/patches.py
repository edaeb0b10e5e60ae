"""From a fitted, unbounded surface to the bounded patch that its points cover."""

from __future__ import annotations

import numpy as np

from inspect_cli.schema.base import Triple
from inspect_cli.schema.geometry import CylinderShape, PlaneShape, Shape, Side, SphereShape
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import LEVEL_SINE, level_axes
from inspect_cli.structure.fit import Fit

COVERED = 0.99
"""A patch is the shortest stretch of each coordinate that holds this share of the points."""
WHOLE_TURN = 0.95
"""An arc of at least this share of the whole turn is the whole turn."""


def bounded_shape(fit: Fit, points: Points, start_W: Vector, side: Side | None) -> Shape:
    """The patch of ``fit`` that the ``points`` (n, 3) cover which decided on it.

    It is touched from ``side``, by default from the side on which ``start_W`` (3,) lies.
    """
    points = points[fit.used]
    if fit.kind == "plane":
        return _plane(fit, points, start_W)
    if fit.kind == "sphere":
        return _sphere(fit, points, start_W, side)
    return _cylinder(fit, points, start_W, side)


def shortest_span(values: Vector, share: float) -> tuple[float, float]:
    """(low, high) of the shortest stretch that holds ``share`` of the values."""
    ordered = np.sort(values)
    count = max(int(np.ceil(share * len(ordered))), 1)
    width = ordered[count - 1 :] - ordered[: len(ordered) - count + 1]
    first = int(np.argmin(width))
    return float(ordered[first]), float(ordered[first + count - 1])


def shortest_arc(angles: Vector, share: float) -> tuple[float, float]:
    """(middle, width) rad of the shortest arc that holds ``share`` of the angles.

    The width is 2π where the arc is nearly the whole turn.
    """
    turn = 2.0 * np.pi
    ordered = np.sort(angles % turn)
    count = max(int(np.ceil(share * len(ordered))), 1)
    unrolled = np.concatenate([ordered, ordered + turn])
    width = unrolled[count - 1 : count - 1 + len(ordered)] - ordered
    first = int(np.argmin(width))
    least = float(width[first])
    return float(ordered[first]) + 0.5 * least, turn if least > WHOLE_TURN * turn else least


def _plane(fit: Fit, points: Points, start_W: Vector) -> PlaneShape:
    normal = fit.direction
    if (start_W - fit.point_m) @ normal < 0.0:
        normal = -normal
    R_WS = level_axes(normal)
    along = (points - fit.point_m) @ R_WS[:, :2]
    spans = np.array([shortest_span(along[:, k], COVERED) for k in range(2)])
    center = fit.point_m + R_WS[:, :2] @ spans.mean(axis=1)
    return PlaneShape(
        center_m=_triple(center), normal=_triple(normal), size_m=_pair(np.ptp(spans, axis=1))
    )


def _cylinder(fit: Fit, points: Points, start_W: Vector, side: Side | None) -> CylinderShape:
    axis = _upward(fit.direction)
    to_start = _square_to(axis, start_W - fit.point_m)
    e1 = fit.frame[:, 0]
    e2 = np.cross(axis, e1)
    from_axis = points - fit.point_m
    middle, arc = shortest_arc(np.arctan2(from_axis @ e2, from_axis @ e1), COVERED)
    facing = np.cos(middle) * e1 + np.sin(middle) * e2
    if arc == 2.0 * np.pi and np.linalg.norm(to_start) > 1e-6:
        facing = to_start / np.linalg.norm(to_start)
    low, high = shortest_span(from_axis @ axis, COVERED)
    return CylinderShape(
        center_m=_triple(fit.point_m + 0.5 * (low + high) * axis),
        axis=_triple(axis),
        radius_m=fit.radius_m,
        facing=_triple(facing),
        size_m=(arc * fit.radius_m, high - low),
        side=side or ("inside" if np.linalg.norm(to_start) < fit.radius_m else "outside"),
    )


def _sphere(fit: Fit, points: Points, start_W: Vector, side: Side | None) -> SphereShape:
    radial = points - fit.point_m
    radial /= np.linalg.norm(radial, axis=1, keepdims=True)
    facing = radial.mean(axis=0)
    to_start = start_W - fit.point_m
    inside = np.linalg.norm(to_start) < fit.radius_m
    if np.linalg.norm(facing) < 1.0 - WHOLE_TURN:
        # All around: the mean direction says nothing.
        facing = to_start if np.linalg.norm(to_start) > 1e-6 else np.array([1.0, 0.0, 0.0])
    arc_u, arc_v = 2.0 * np.pi, np.pi
    for _ in range(2):
        # The second time in the frame of the patch's own middle.
        R_WS = level_axes(facing)
        x, y, z = (radial @ R_WS).T
        middle, arc_u = shortest_arc(np.arctan2(x, z), COVERED)
        low, high = shortest_span(np.arcsin(np.clip(y, -1.0, 1.0)), COVERED)
        arc_v = high - low
        if arc_u < 2.0 * np.pi:
            tilt = 0.5 * (low + high)
            local = [np.cos(tilt) * np.sin(middle), np.sin(tilt), np.cos(tilt) * np.cos(middle)]
            facing = R_WS @ np.array(local)
    return SphereShape(
        center_m=_triple(fit.point_m),
        radius_m=fit.radius_m,
        facing=_triple(facing),
        size_m=(arc_u * fit.radius_m, arc_v * fit.radius_m),
        side=side or ("inside" if inside else "outside"),
    )


def _upward(axis: Vector) -> Vector:
    """The axis with the sign that points up, or along its largest part where it is level."""
    k = 2 if abs(axis[2]) > LEVEL_SINE else int(np.argmax(np.abs(axis)))
    return axis if axis[k] > 0.0 else -axis


def _square_to(axis: Vector, x: Vector) -> Vector:
    square: Vector = x - (x @ axis) * axis
    return square


def _triple(a: Vector) -> Triple:
    return (float(a[0]), float(a[1]), float(a[2]))


def _pair(a: Vector) -> tuple[float, float]:
    return (float(a[0]), float(a[1]))
