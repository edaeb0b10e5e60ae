"""The arithmetic of the error-state filter: propagation and correction of belief and covariance.

Error state δx (15,) = (δp, δv, δθ, δb_f, δb_w) with x_true = x ⊞ δx and the attitude error on the
right, R_true = R Exp(δθ). J. Solà, "Quaternion kinematics for the error-state Kalman filter"
(arXiv 1711.02508), sections 5 and 6. With f = f_m − b_f, w = w_m − b_w and the attitude
R̄ = R Exp(½ w Δt) half way through the step, a = R̄ f + g_W:

    p ← p + v Δt + ½ a Δt²,   v ← v + a Δt,   R ← R Exp(w Δt)

    F = | I  IΔt      0           0       0   |    what is left out is of order Δt²
        | 0   I  −[R̄f]× R Δt   −R̄ Δt     0   |
        | 0   0   Exp(−w Δt)      0     −I Δt |
        | 0   0       0           I       0   |
        | 0   0       0           0       I   |

Every kernel works in place. Shapes: ``p``, ``v`` (3,) in W; ``q`` (4,) wxyz; ``bias`` (6,) =
(b_f, b_w) in B; ``P`` (15, 15). A ``sample`` (6,) is a measured (f, w) in B.
"""

from __future__ import annotations

from typing import Final

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import (
    quaternion_conjugate,
    quaternion_exp,
    quaternion_log,
    quaternion_multiply,
    quaternion_normalize,
    quaternion_to_matrix,
    rotate,
)

STATES: Final = 15
MEASURED: Final = (0, 1, 2, 6, 7, 8)
"""Indices of the error state that a pose measures."""


@kernel
def transition(row: Vector, dt: float, A: Matrix, B: Matrix, E: Matrix) -> None:
    """F ``row`` with A = −[R̄f]× R Δt, B = −R̄ Δt and E = Exp(−w Δt)."""
    for i in range(3):
        row[i] += dt * row[3 + i]
    for i in range(3):
        for k in range(3):
            row[3 + i] += A[i, k] * row[6 + k] + B[i, k] * row[9 + k]
    t0, t1, t2 = row[6], row[7], row[8]
    for i in range(3):
        row[6 + i] = E[i, 0] * t0 + E[i, 1] * t1 + E[i, 2] * t2 - dt * row[12 + i]


@kernel
def turn_error(row: Vector, delta: Vector) -> None:
    """G ``row`` with G = I − ½[δθ]× on the attitude error, I elsewhere."""
    a, b, c = 0.5 * delta[6], 0.5 * delta[7], 0.5 * delta[8]
    t0, t1, t2 = row[6], row[7], row[8]
    row[6] = t0 + c * t1 - b * t2
    row[7] = t1 - c * t0 + a * t2
    row[8] = t2 + b * t0 - a * t1


@kernel
def transpose(P: Matrix) -> None:
    """P ← Pᵀ."""
    for i in range(STATES):
        for j in range(i):
            P[i, j], P[j, i] = P[j, i], P[i, j]


@kernel
def propagate(
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    sample: Vector,
    dt: float,
    noise: Vector,
) -> None:
    """Advance by ``dt`` s: the equations above and P ← F P Fᵀ + Q.

    ``noise`` (4,): variances that v, θ, b_f, b_w gain per second. F meets the 15 rows of the
    symmetric P, then those of its transpose, which is F P Fᵀ without a matrix product.
    """
    f = np.empty(3)
    half = np.empty(3)
    for i in range(3):
        f[i] = sample[i] - bias[i]
        half[i] = 0.5 * dt * (sample[3 + i] - bias[3 + i])
    half_turn = quaternion_exp(half)
    middle = quaternion_multiply(q, half_turn)
    f_W = rotate(middle, f)
    R = quaternion_to_matrix(q)
    B = quaternion_to_matrix(middle)
    E = quaternion_to_matrix(quaternion_conjugate(quaternion_multiply(half_turn, half_turn)))
    A = np.empty((3, 3))
    for k in range(3):
        A[0, k] = -dt * (f_W[1] * R[2, k] - f_W[2] * R[1, k])
        A[1, k] = -dt * (f_W[2] * R[0, k] - f_W[0] * R[2, k])
        A[2, k] = -dt * (f_W[0] * R[1, k] - f_W[1] * R[0, k])
        for i in range(3):
            B[i, k] *= -dt

    f_W[2] -= GRAVITY_MPS2
    for i in range(3):
        p[i] += dt * (v[i] + 0.5 * dt * f_W[i])
        v[i] += dt * f_W[i]
    turned = quaternion_normalize(quaternion_multiply(middle, half_turn))
    for i in range(4):
        q[i] = turned[i]

    for i in range(STATES):
        transition(P[i], dt, A, B, E)
    transpose(P)
    for i in range(STATES):
        transition(P[i], dt, A, B, E)
    for i in range(STATES):
        for j in range(i):
            P[i, j] = P[j, i] = 0.5 * (P[i, j] + P[j, i])
    for i in range(4):
        for k in range(3):
            P[3 + 3 * i + k, 3 + 3 * i + k] += noise[i] * dt


@kernel
def frame_drifts(P: Matrix, q: Vector, v: Vector, w: Vector, walks: Vector, dt: float) -> None:
    """Add what the frame of an odometry drifts in ``dt`` s at the speed v and the rate w (3,).

    With ``walks`` (3,) = (σ_p, σ_ψd, σ_ψθ) per √m, √m and √rad, the distance d = |v| Δt and the
    angle θ = |w| Δt, position gains σ_p² d on each axis and yaw gains σ_ψd² d + σ_ψθ² θ about z_W,
    which is Rᵀ z in the frame of the attitude error.
    """
    distance = dt * np.sqrt(v[0] ** 2 + v[1] ** 2 + v[2] ** 2)
    angle = dt * np.sqrt(w[0] ** 2 + w[1] ** 2 + w[2] ** 2)
    yaw = walks[1] ** 2 * distance + walks[2] ** 2 * angle
    R = quaternion_to_matrix(q)
    for i in range(3):
        P[i, i] += walks[0] ** 2 * distance
        for k in range(3):
            P[6 + i, 6 + k] += yaw * R[2, i] * R[2, k]


@kernel
def pose_innovation(p: Vector, q: Vector, p_measured: Vector, q_measured: Vector) -> Vector:
    """(6,) = (p_m − p, Log(q⁻¹ ⊗ q_m)); not finite where the measurement is not."""
    turn = quaternion_log(
        quaternion_multiply(quaternion_conjugate(q), quaternion_normalize(q_measured))
    )
    innovation = np.empty(6)
    for i in range(3):
        innovation[i] = p_measured[i] - p[i]
        innovation[3 + i] = turn[i]
    return innovation


@kernel
def whiten(P: Matrix, variance: Vector, innovation: Vector, y: Vector, W: Matrix) -> float:
    """y = L⁻¹ (innovation) and W (6, 15) = L⁻¹ H P, where L Lᵀ = H P Hᵀ + V; returns χ² = |y|²."""
    L = np.empty((6, 6))
    chi2 = 0.0
    for i in range(6):
        row = P[MEASURED[i]]
        for j in range(i):
            total = row[MEASURED[j]]
            for k in range(j):
                total -= L[i, k] * L[j, k]
            L[i, j] = total / L[j, j]
        square = row[MEASURED[i]] + variance[i]
        y[i] = innovation[i]
        for j in range(STATES):
            W[i, j] = row[j]
        for k in range(i):
            square -= L[i, k] * L[i, k]
            y[i] -= L[i, k] * y[k]
            for j in range(STATES):
                W[i, j] -= L[i, k] * W[k, j]
        L[i, i] = np.sqrt(square)
        y[i] /= L[i, i]
        for j in range(STATES):
            W[i, j] /= L[i, i]
        chi2 += y[i] * y[i]
    return chi2


@kernel
def correct_pose(
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    innovation: Vector,
    variance: Vector,
    gate: float,
) -> float:
    """Correct with a pose; return the innovation's χ² (6 degrees of freedom).

    ``variance`` (6,) is the measurement's. With y and W of ``whiten`` the correction is
    δx = Wᵀ y and P ← P − Wᵀ W, symmetric as it stands. Nothing changes when χ² is above ``gate``
    or not a number. At last the attitude error gets its new origin: P ← G P Gᵀ (Solà, 6.3).
    """
    y = np.empty(6)
    W = np.empty((6, STATES))
    chi2 = whiten(P, variance, innovation, y, W)
    if not chi2 <= gate:
        return chi2

    delta = np.zeros(STATES)
    for k in range(6):
        for i in range(STATES):
            delta[i] += W[k, i] * y[k]
            for j in range(STATES):
                P[i, j] -= W[k, i] * W[k, j]
    for i in range(3):
        p[i] += delta[i]
        v[i] += delta[3 + i]
        bias[i] += delta[9 + i]
        bias[3 + i] += delta[12 + i]
    turned = quaternion_normalize(quaternion_multiply(q, quaternion_exp(delta[6:9])))
    for i in range(4):
        q[i] = turned[i]
    for _ in range(2):
        for i in range(STATES):
            turn_error(P[i], delta)
        transpose(P)
    return chi2


@kernel
def take_sample(held: Vector, mean: Vector, f: Vector, w: Vector, share: float) -> bool:
    """mean ← share (f, w) + (1 − share) held, then held ← (f, w); False if not finite."""
    if not np.isfinite(f[0] + f[1] + f[2] + w[0] + w[1] + w[2]):
        return False
    for i in range(3):
        mean[i] = held[i] + share * (f[i] - held[i])
        mean[3 + i] = held[3 + i] + share * (w[i] - held[3 + i])
        held[i] = f[i]
        held[3 + i] = w[i]
    return True


@kernel
def publish(
    p: Vector,
    v: Vector,
    q: Vector,
    bias: Vector,
    P: Matrix,
    sample: Vector,
    times: Vector,
    estimate: Structured,
) -> None:
    """Write the belief at the time ``times[0]`` into an Estimate (1,)."""
    row = estimate[0]
    row["t_s"] = times[0]
    for i in range(3):
        row["p_WB"][i] = p[i]
        row["v_WB_W"][i] = v[i]
        row["w_WB_B"][i] = sample[3 + i] - bias[3 + i]
        row["bias_f_B"][i] = bias[i]
        row["bias_w_B"][i] = bias[3 + i]
    for i in range(4):
        row["q_WB"][i] = q[i]
    for i in range(STATES):
        row["sigma"][i] = np.sqrt(P[i, i])
