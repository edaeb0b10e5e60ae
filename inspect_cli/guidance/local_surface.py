"""Normal and distance of the surface in front of the tool, from the depth camera's points.

Bodie et al., "An Omnidirectional Aerial Manipulation Platform for Contact-Based Inspection"
(RSS 2019), section IV-D: A′_t are the points within a radius of the z_T axis; their unweighted
mean is the contact point C′_t; the plane that fits them in the least-squares sense gives the
normal, flipped so that n · z_T ≤ 0.
"""

from __future__ import annotations

import math

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import SurfaceEstimate
from inspect_cli.schema.vehicle import DepthCameraModel
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.rotations import turned

MIN_POINTS = 30
"""Fewer points in A′_t are not trusted with a plane."""
RMS_NOISES = 3.0
RMS_MARGIN_M = 0.01
"""A′_t may depart from a plane by 3 noise deviations plus this. The margin lets a pipe of 0.15 m
radius pass (its RMS over 0.1 m is 8 mm) and refuses an edge with something behind it."""
MIN_SPREAD = 0.2
"""Least standard deviation of A′_t across the plane, as a share of its radius; 0.5 for a full
disc, 0.26 for half of one."""
MIN_COSINE = 0.26
"""A surface seen at more than 75° from its normal is not measured."""


class LocalSurface:
    """The least-squares plane through the points around the tool's axis."""

    def __init__(self, model: DepthCameraModel) -> None:
        self.model = model

    def update(
        self, points_D: Points, p_WD: Vector, p_WT: Vector, R_WT: Matrix, out: SurfaceEstimate
    ) -> None:
        """Fit ``points_D`` (n, 3), m (NaN for misses), and pose the plane in W.

        The points are from the camera's centre, along the tool's axes. ``p_WD`` (3,) m is where
        the camera is believed to be, ``p_WT`` (3,) m and ``R_WT`` (3, 3) the tool. ``out.valid``
        is 0 when there are too few points, when they are no plane or no more than a line, or when
        anything is not a number.
        """
        n_points, distance, rms, spread, cosine, range_ = fit_local_plane(
            points_D,
            R_WT.T @ (p_WT - p_WD),
            self.model.neighbourhood_m,
            p_WT,
            R_WT,
            out.p_WC,
            out.n_W,
        )
        noise = self.model.noise_floor_m + self.model.noise_m * range_ * range_
        # Written so that a NaN anywhere makes it false.
        valid = (
            n_points >= MIN_POINTS
            and rms <= RMS_NOISES * noise + RMS_MARGIN_M
            and spread >= MIN_SPREAD * self.model.neighbourhood_m
            and cosine >= MIN_COSINE
            and math.isfinite(distance + sum(out.p_WC) + sum(out.n_W))
        )
        out.distance = distance
        out.n_points = n_points
        out.rms = rms
        out.valid = float(valid)


@kernel
def fit_local_plane(
    points_D: Points,
    p_DT: Vector,
    radius: float,
    p_WT: Vector,
    R_WT: Matrix,
    p_WC: Vector,
    n_W: Vector,
) -> tuple[float, float, float, float, float, float]:
    """Write contact point and normal (3,), and return what tells whether they are any good.

    Returns (points, distance, rms, spread, cosine, range): the number of points in A′_t; the
    distance from the tip along z_T to the plane, m; the RMS distance of the points from the
    plane, m; their standard deviation in the plane's narrower direction, m; −n · z_T; and the
    distance of C′_t from the camera, m. Without three points everything but the first is NaN.
    """
    mean_T = np.zeros(3)
    scatter = np.zeros((3, 3))
    n = _gather(points_D, p_DT, radius, mean_T, scatter)
    if n < 3:
        for i in range(3):
            p_WC[i] = np.nan
            n_W[i] = np.nan
        return float(n), np.nan, np.nan, np.nan, np.nan, np.nan
    axes = _principal_axes(scatter)
    low = 0
    for i in range(1, 3):
        if scatter[i, i] < scatter[low, low]:
            low = i
    rms = np.sqrt(max(scatter[low, low], 0.0))
    spread = np.sqrt(min(scatter[low - 1, low - 1], scatter[low - 2, low - 2]))
    sign = -1.0 if axes[2, low] > 0.0 else 1.0
    n_T = np.array([sign * axes[0, low], sign * axes[1, low], sign * axes[2, low]])
    to_plane = n_T[0] * mean_T[0] + n_T[1] * mean_T[1] + n_T[2] * mean_T[2]
    p_TC_W, turned_n = turned(R_WT, mean_T), turned(R_WT, n_T)
    square = 0.0
    for i in range(3):
        square += (mean_T[i] + p_DT[i]) * (mean_T[i] + p_DT[i])
        p_WC[i] = p_WT[i] + p_TC_W[i]
        n_W[i] = turned_n[i]
    return float(n), to_plane / n_T[2], rms, spread, -n_T[2], np.sqrt(square)


@kernel
def _gather(points_D: Points, p_DT: Vector, radius: float, mean_T: Vector, scatter: Matrix) -> int:
    """Mean (3,) and scatter (3, 3) in T of the points within ``radius`` of the z_T axis.

    Returns their number; mean and scatter stay as they are when there is none.
    """
    n = 0
    for k in range(points_D.shape[0]):
        x = points_D[k, 0] - p_DT[0]
        y = points_D[k, 1] - p_DT[1]
        if not x * x + y * y <= radius * radius:  # NaN is not within
            continue
        z = points_D[k, 2] - p_DT[2]
        n += 1
        mean_T[0] += x
        mean_T[1] += y
        mean_T[2] += z
        scatter[0, 0] += x * x
        scatter[0, 1] += x * y
        scatter[0, 2] += x * z
        scatter[1, 1] += y * y
        scatter[1, 2] += y * z
        scatter[2, 2] += z * z
    if n == 0:
        return n
    for i in range(3):
        mean_T[i] /= n
    for i in range(3):
        for j in range(i, 3):
            scatter[i, j] = scatter[i, j] / n - mean_T[i] * mean_T[j]
            scatter[j, i] = scatter[i, j]
    return n


@kernel
def _principal_axes(A: Matrix) -> Matrix:
    """Eigenvectors (columns) of a symmetric (3, 3) matrix, which is left diagonal.

    Cyclic Jacobi rotations (Golub & Van Loan, Matrix Computations, 8.5), which keep small
    eigenvalues accurate where closed forms by the cubic's roots lose them.
    """
    V = np.zeros((3, 3))
    V[0, 0] = V[1, 1] = V[2, 2] = 1.0
    for _ in range(8):
        off = A[0, 1] * A[0, 1] + A[0, 2] * A[0, 2] + A[1, 2] * A[1, 2]
        scale = A[0, 0] * A[0, 0] + A[1, 1] * A[1, 1] + A[2, 2] * A[2, 2]
        if off <= 1e-30 * scale:
            break
        for i in range(2):
            for j in range(i + 1, 3):
                if A[i, j] == 0.0:
                    continue
                tau = 0.5 * (A[j, j] - A[i, i]) / A[i, j]
                sign = 1.0 if tau >= 0.0 else -1.0
                t = sign / (abs(tau) + np.sqrt(1.0 + tau * tau))
                c = 1.0 / np.sqrt(1.0 + t * t)
                s = t * c
                for k in range(3):
                    a, b = A[k, i], A[k, j]
                    A[k, i], A[k, j] = c * a - s * b, s * a + c * b
                    a, b = V[k, i], V[k, j]
                    V[k, i], V[k, j] = c * a - s * b, s * a + c * b
                for k in range(3):
                    a, b = A[i, k], A[j, k]
                    A[i, k], A[j, k] = c * a - s * b, s * a + c * b
    return V
