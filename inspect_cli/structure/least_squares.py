"""Geometric least squares of planes, spheres and cylinders, and the kernels behind it.

A model is seven numbers [p, a, r]: a point (on the plane, the centre, on the axis), a unit
direction (normal, unused, axis) and a radius. The residual of a point x, d = x − p, is its
signed distance:

    plane     d·a                sphere    |d| − r          cylinder  |d − (d·a) a| − r

It is linearised in local steps δ of the model in a frame E = [e1, e2, a] (columns):

    plane     (shift along a, tilt of a to e1, tilt to e2)
    sphere    (shift along e1, e2, a, change of r)
    cylinder  (shift along e1, e2, tilt of a to e1, tilt to e2, change of r)

The distance functions and their derivatives are those of Lukács, Martin & Marshall, "Faithful
least-squares fitting of spheres, cylinders, cones and tori for reliable segmentation" (ECCV
1998); the damping is Levenberg–Marquardt's with Marquardt's scaling.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.primitives import CYLINDER, PLANE, SPHERE

PARAMETERS = {PLANE: 3, SPHERE: 4, CYLINDER: 5}

ON_AXIS = 1e-12
"""Least distance, m, from centre or axis at which the direction of the residual is defined."""
LEAST_DAMPING, MOST_DAMPING = 1e-13, 1e6
"""Centre and radius of a gently curved surface are almost the same parameter: the scaled normal
matrix has an eigenvalue of about (width / radius)⁴ / 500, which the damping must not hide."""
NEGLIGIBLE = 1e-6
"""Expected decrease of the cost, in units of τ², at which the iteration ends: with τ = 3σ, a
step of three thousandths of a standard deviation."""


@kernel
def residual(kind: int, model: Vector, x: float, y: float, z: float) -> float:
    """Signed distance, m, of a point from the unbounded surface."""
    dx, dy, dz = x - model[0], y - model[1], z - model[2]
    along = dx * model[3] + dy * model[4] + dz * model[5]
    if kind == PLANE:
        return float(along)
    square = dx * dx + dy * dy + dz * dz
    if kind == CYLINDER:
        square = max(square - along * along, 0.0)
    return float(np.sqrt(square) - model[6])


@kernel
def residuals(kind: int, model: Vector, points: Points) -> Vector:
    """Signed distances (n,), m, of points (n, 3)."""
    out = np.empty(points.shape[0])
    for k in range(points.shape[0]):
        out[k] = residual(kind, model, points[k, 0], points[k, 1], points[k, 2])
    return out


@kernel
def truncated_cost(
    kind: int, model: Vector, points: Points, threshold: float, limit: float
) -> float:
    """Σ min(rᵢ², τ²), m²; gives up with infinity as soon as the sum exceeds ``limit``."""
    cost = 0.0
    most = threshold * threshold
    for k in range(points.shape[0]):
        r = residual(kind, model, points[k, 0], points[k, 1], points[k, 2])
        cost += min(r * r, most)
        if cost > limit:
            return np.inf
    return cost


@kernel
def normal_equations(
    kind: int, model: Vector, frame: Matrix, points: Points, threshold: float
) -> tuple[Matrix, Vector, float]:
    """(JᵀJ (5, 5), Jᵀr (5,), Σ min(r², τ²)) over the points within ``threshold`` τ, m.

    Rows and columns that a kind does not use stay zero.
    """
    A = np.zeros((5, 5))
    g = np.zeros(5)
    J = np.zeros(5)
    used = 3 if kind == PLANE else (4 if kind == SPHERE else 5)
    cost = 0.0
    most = threshold * threshold
    for k in range(points.shape[0]):
        r = residual(kind, model, points[k, 0], points[k, 1], points[k, 2])
        if r * r >= most:
            cost += most
            continue
        cost += r * r
        dx, dy, dz = points[k, 0] - model[0], points[k, 1] - model[1], points[k, 2] - model[2]
        e1 = dx * frame[0, 0] + dy * frame[1, 0] + dz * frame[2, 0]
        e2 = dx * frame[0, 1] + dy * frame[1, 1] + dz * frame[2, 1]
        along = dx * frame[0, 2] + dy * frame[1, 2] + dz * frame[2, 2]
        if kind == PLANE:
            J[0], J[1], J[2] = -1.0, e1, e2
        elif kind == SPHERE:
            s = 1.0 / max(r + model[6], ON_AXIS)
            J[0], J[1], J[2], J[3] = -s * e1, -s * e2, -s * along, -1.0
        else:
            s = 1.0 / max(r + model[6], ON_AXIS)
            J[0], J[1], J[4] = -s * e1, -s * e2, -1.0
            J[2], J[3] = along * J[0], along * J[1]
        for i in range(used):
            g[i] += J[i] * r
            for j in range(i + 1):
                A[i, j] += J[i] * J[j]
    for i in range(5):
        for j in range(i):
            A[j, i] = A[i, j]
    return A, g, cost


@kernel
def frame_of(direction: Vector) -> Matrix:
    """A rotation (3, 3) whose last column is the unit ``direction``.

    Duff et al., "Building an orthonormal basis, revisited", JCGT 6 (2017).
    """
    x, y, z = direction[0], direction[1], direction[2]
    sign = np.copysign(1.0, z)
    a = -1.0 / (sign + z)
    b = x * y * a
    return np.array(
        [
            [1.0 + sign * x * x * a, b, x],
            [sign * b, sign + y * y * a, y],
            [-sign * x, -y, z],
        ]
    )


def stepped(kind: int, model: Vector, frame: Matrix, step: Vector) -> Vector:
    """The model after a local step δ in the frame E (see the page's head)."""
    out = model.copy()
    if kind == PLANE:
        out[:3] += step[0] * frame[:, 2]
        out[3:6] += frame[:, :2] @ step[1:3]
    elif kind == SPHERE:
        out[:3] += frame @ step[:3]
        out[6] += step[3]
    else:
        out[:3] += frame[:, :2] @ step[:2]
        out[3:6] += frame[:, :2] @ step[2:4]
        out[6] += step[4]
    out[3:6] /= np.linalg.norm(out[3:6])
    return out


def minimised(
    kind: int, model: Vector, points: Points, threshold: float, iterations: int
) -> tuple[Vector, float]:
    """(model, cost) at a minimum of Σ min(r², τ²) by Levenberg–Marquardt from ``model``.

    The points within the threshold are selected anew at every step.
    """
    k = PARAMETERS[kind]
    frame = frame_of(model[3:6])
    A, g, cost = normal_equations(kind, model, frame, points, threshold)
    damping = LEAST_DAMPING
    for _ in range(iterations):
        scale = np.sqrt(np.diag(A)[:k])
        if scale.min() <= 1e-9 * scale.max() or damping > MOST_DAMPING:
            break
        scaled = A[:k, :k] / np.outer(scale, scale) + damping * np.eye(k)
        try:
            step = -np.linalg.solve(scaled, g[:k] / scale) / scale
        except np.linalg.LinAlgError:
            damping *= 10.0
            continue
        if -(step @ g[:k]) <= NEGLIGIBLE * threshold * threshold:
            break
        trial = stepped(kind, model, frame, step)
        trial_frame = frame_of(trial[3:6])
        trial_system = normal_equations(kind, trial, trial_frame, points, threshold)
        if trial_system[2] > cost:
            damping *= 10.0
            continue
        model, frame = trial, trial_frame
        A, g, cost = trial_system
        damping = max(0.1 * damping, LEAST_DAMPING)
    return model, cost
