"""SO(3) in the two forms that the project uses: matrices and unit quaternions (w, x, y, z).

All functions are kernels, so that the same code serves the flight loop and the planner.
Formulas: Solà, Deray & Atchuthan, "A micro Lie theory for state estimation in robotics"
(arXiv 1812.01537), appendix B.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Vector

SMALL_ANGLE = 1e-7


@kernel
def skew(a: Vector) -> Matrix:
    """The matrix [a]× with [a]× b = a × b."""
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


@kernel
def cross(a: Vector, b: Vector) -> Vector:
    """a × b for two 3-vectors."""
    return np.array(
        [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
    )


@kernel
def turned(R: Matrix, x: Vector) -> Vector:
    """R x for a (3, 3) matrix; ``@`` would call BLAS, and compile for it."""
    return np.array(
        [
            R[0, 0] * x[0] + R[0, 1] * x[1] + R[0, 2] * x[2],
            R[1, 0] * x[0] + R[1, 1] * x[1] + R[1, 2] * x[2],
            R[2, 0] * x[0] + R[2, 1] * x[1] + R[2, 2] * x[2],
        ]
    )


@kernel
def quaternion_multiply(a: Vector, b: Vector) -> Vector:
    """The Hamilton product a ⊗ b: the rotation b, then a."""
    return np.array(
        [
            a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
            a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
            a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
            a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0],
        ]
    )


@kernel
def quaternion_conjugate(q: Vector) -> Vector:
    """The inverse rotation of a unit quaternion."""
    return np.array([q[0], -q[1], -q[2], -q[3]])


@kernel
def quaternion_normalize(q: Vector) -> Vector:
    """The unit quaternion of the same rotation, with w ≥ 0."""
    norm = np.sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if q[0] < 0.0:
        norm = -norm
    return np.array([q[0] / norm, q[1] / norm, q[2] / norm, q[3] / norm])


@kernel
def quaternion_exp(theta: Vector) -> Vector:
    """Exp: a rotation vector (rad) to its unit quaternion."""
    angle = np.sqrt(theta[0] * theta[0] + theta[1] * theta[1] + theta[2] * theta[2])
    half = 0.5 * angle
    scale = 0.5 - angle * angle / 48.0 if angle < SMALL_ANGLE else np.sin(half) / angle
    return np.array([np.cos(half), scale * theta[0], scale * theta[1], scale * theta[2]])


@kernel
def quaternion_log(q: Vector) -> Vector:
    """Log: a unit quaternion to its rotation vector (rad), of length at most π."""
    sign = -1.0 if q[0] < 0.0 else 1.0
    sine = np.sqrt(q[1] * q[1] + q[2] * q[2] + q[3] * q[3])
    if sine < SMALL_ANGLE:
        scale = 2.0 * sign
    else:
        scale = 2.0 * np.arctan2(sine, sign * q[0]) / sine * sign
    return np.array([scale * q[1], scale * q[2], scale * q[3]])


@kernel
def quaternion_to_matrix(q: Vector) -> Matrix:
    """R of a unit quaternion."""
    w, x, y, z = q[0], q[1], q[2], q[3]
    return np.array(
        [
            [1.0 - 2.0 * (y * y + z * z), 2.0 * (x * y - w * z), 2.0 * (x * z + w * y)],
            [2.0 * (x * y + w * z), 1.0 - 2.0 * (x * x + z * z), 2.0 * (y * z - w * x)],
            [2.0 * (x * z - w * y), 2.0 * (y * z + w * x), 1.0 - 2.0 * (x * x + y * y)],
        ]
    )


@kernel
def matrix_to_quaternion(R: Matrix) -> Vector:
    """The unit quaternion of a rotation matrix, w ≥ 0 (Shepperd's method)."""
    trace = R[0, 0] + R[1, 1] + R[2, 2]
    q = np.empty(4)
    if trace >= R[0, 0] and trace >= R[1, 1] and trace >= R[2, 2]:
        q[0] = 1.0 + trace
        q[1] = R[2, 1] - R[1, 2]
        q[2] = R[0, 2] - R[2, 0]
        q[3] = R[1, 0] - R[0, 1]
    elif R[0, 0] >= R[1, 1] and R[0, 0] >= R[2, 2]:
        q[0] = R[2, 1] - R[1, 2]
        q[1] = 1.0 + 2.0 * R[0, 0] - trace
        q[2] = R[0, 1] + R[1, 0]
        q[3] = R[0, 2] + R[2, 0]
    elif R[1, 1] >= R[2, 2]:
        q[0] = R[0, 2] - R[2, 0]
        q[1] = R[0, 1] + R[1, 0]
        q[2] = 1.0 + 2.0 * R[1, 1] - trace
        q[3] = R[1, 2] + R[2, 1]
    else:
        q[0] = R[1, 0] - R[0, 1]
        q[1] = R[0, 2] + R[2, 0]
        q[2] = R[1, 2] + R[2, 1]
        q[3] = 1.0 + 2.0 * R[2, 2] - trace
    return quaternion_normalize(q)


@kernel
def rotate(q: Vector, x: Vector) -> Vector:
    """R(q) x."""
    t0 = 2.0 * (q[2] * x[2] - q[3] * x[1])
    t1 = 2.0 * (q[3] * x[0] - q[1] * x[2])
    t2 = 2.0 * (q[1] * x[1] - q[2] * x[0])
    return np.array(
        [
            x[0] + q[0] * t0 + q[2] * t2 - q[3] * t1,
            x[1] + q[0] * t1 + q[3] * t0 - q[1] * t2,
            x[2] + q[0] * t2 + q[1] * t1 - q[2] * t0,
        ]
    )


@kernel
def rotate_back(q: Vector, x: Vector) -> Vector:
    """R(q)ᵀ x."""
    return rotate(quaternion_conjugate(q), x)


def roll_pitch_yaw_matrix(roll: float, pitch: float, yaw: float) -> Matrix:
    """R = R_z(yaw) R_y(pitch) R_x(roll); angles in rad."""
    cr, sr = np.cos(roll), np.sin(roll)
    cp, sp = np.cos(pitch), np.sin(pitch)
    cy, sy = np.cos(yaw), np.sin(yaw)
    return np.array(
        [
            [cy * cp, cy * sp * sr - sy * cr, cy * sp * cr + sy * sr],
            [sy * cp, sy * sp * sr + cy * cr, sy * sp * cr - cy * sr],
            [-sp, cp * sr, cp * cr],
        ]
    )
