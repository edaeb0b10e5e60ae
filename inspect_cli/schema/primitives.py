"""From the shapes of the file models to the arrays that kernels read.

Apart from the models because arrays need NumPy and Numba, which reading a file does not.
"""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.schema.base import Triple
from inspect_cli.schema.geometry import CylinderShape, Displacement, PlaneShape, Shape
from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.primitives import PRIMITIVE, cylinder, plane, sphere
from inspect_cli.spatial.rotations import roll_pitch_yaw_matrix


def primitive_of(shape: Shape) -> Structured:
    """The shape as a PRIMITIVE array of length 1."""
    if isinstance(shape, PlaneShape):
        return plane(shape.center_m, shape.normal, shape.size_m)
    side = 1.0 if shape.side == "outside" else -1.0
    if isinstance(shape, CylinderShape):
        return cylinder(
            shape.center_m, shape.axis, shape.radius_m, shape.facing, shape.size_m, side
        )
    return sphere(shape.center_m, shape.radius_m, shape.facing, shape.size_m, side)


def primitives_of(shapes: Sequence[Shape]) -> Structured:
    """The shapes as a PRIMITIVE array of length n, in their order."""
    if not shapes:
        return np.zeros(0, PRIMITIVE)
    return np.concatenate([primitive_of(shape) for shape in shapes])


def rotation_of(displacement: Displacement) -> Matrix:
    """R = R_z R_y R_x of a displacement."""
    roll, pitch, yaw = np.radians(displacement.rotate_deg)
    return roll_pitch_yaw_matrix(roll, pitch, yaw)


def displaced_points(points: Vector, displacement: Displacement) -> Vector:
    """p′ = a + R (p − a) + t for points (..., 3), with a = ``about_m``, t = ``translate_m``."""
    about = np.asarray(displacement.about_m)
    shift = about + np.asarray(displacement.translate_m)
    moved: Vector = (points - about) @ rotation_of(displacement).T + shift
    return moved


def displaced(shape: Shape, displacement: Displacement) -> Shape:
    """The shape after a rigid motion.

    A shape states no turn of a plane about its normal or of a sphere about ``facing``: there
    the patch's edges stay level.
    """
    if displacement == Displacement():
        return shape
    R = rotation_of(displacement)
    center = displaced_points(np.asarray(shape.center_m), displacement)
    moved = {"center_m": _triple(center)}
    for direction in ("normal", "axis", "facing"):
        if hasattr(shape, direction):
            moved[direction] = _triple(R @ np.asarray(getattr(shape, direction)))
    return shape.model_copy(update=moved)


def _triple(a: Vector) -> Triple:
    return (float(a[0]), float(a[1]), float(a[2]))
