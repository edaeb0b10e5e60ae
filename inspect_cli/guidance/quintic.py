"""Kernels of the quintic trajectories: coefficients, evaluation, and the check of limits.

A stretch of duration T is a polynomial of degree five in s = t / T for each axis of the body's
position p(s), and for the rotation vector φ(s) of the attitude R(s) = R_0 Exp(φ(s)). It leaves
and arrives with given rates and accelerations. From rest to rest it is the minimum-jerk
profile (Flash & Hogan, J. Neurosci. 5 (1985) 1688): a straight line and a single-axis turn.

Rates of rotation (Solà, Deray & Atchuthan, arXiv 1812.01537, eq. 143): ω = J_r(φ) φ̇ with
J_r(φ) = I − A [φ]× + B [φ]×², A = (1 − cos θ)/θ², B = (θ − sin θ)/θ³, θ = |φ|; and by
differentiation α = J_r φ̈ + J̇_r φ̇, in the body frame of R(s). Since J_r(0) = I and
J̇_r φ̇ = 0 at φ = 0, the start has φ̇ = ω_0 and φ̈ = α_0 exactly.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import cross, quaternion_exp, quaternion_multiply, rotate

SAMPLES = 24
"""Interior points at which a stretch is held against the limits; its peaks are flat enough that
the largest sample is within 1 % of them."""


@kernel
def quintic_between(
    x: Vector,
    rate: Vector,
    acceleration: Vector,
    goal: Vector,
    goal_rate: Vector,
    goal_acceleration: Vector,
    duration: float,
    c: Matrix,
) -> None:
    """Write the coefficients c (6, n) in s of x(s) = Σ c_k s^k between two motions (x, ẋ, ẍ)."""
    half_square = 0.5 * duration * duration
    for i in range(x.size):
        v, w = rate[i] * duration, goal_rate[i] * duration
        a, b = acceleration[i] * half_square, goal_acceleration[i] * half_square
        d = goal[i] - x[i]
        c[0, i] = x[i]
        c[1, i] = v
        c[2, i] = a
        c[3, i] = 10.0 * d - 6.0 * v - 4.0 * w - 3.0 * a + b
        c[4, i] = -15.0 * d + 8.0 * v + 7.0 * w + 3.0 * a - 2.0 * b
        c[5, i] = 6.0 * d - 3.0 * v - 3.0 * w - a + b


@kernel
def evaluate_quintic(
    c: Matrix, s: float, duration: float, x: Vector, rate: Vector, acceleration: Vector
) -> None:
    """Write value, rate and acceleration (n,) of coefficients c (6, n) at s in [0, 1]."""
    for i in range(x.size):
        x[i] = c[0, i] + s * (c[1, i] + s * (c[2, i] + s * (c[3, i] + s * (c[4, i] + s * c[5, i]))))
        rate[i] = (
            c[1, i]
            + s * (2.0 * c[2, i] + s * (3.0 * c[3, i] + s * (4.0 * c[4, i] + s * 5.0 * c[5, i])))
        ) / duration
        acceleration[i] = (
            2.0 * c[2, i] + s * (6.0 * c[3, i] + s * (12.0 * c[4, i] + s * 20.0 * c[5, i]))
        ) / (duration * duration)


@kernel
def body_rates(
    phi: Vector, phi_rate: Vector, phi_acceleration: Vector, w: Vector, alpha: Vector
) -> None:
    """Write ω and α (3,), body frame, of R = R_0 Exp(φ) from φ and its derivatives (exact)."""
    square = phi[0] * phi[0] + phi[1] * phi[1] + phi[2] * phi[2]
    along = phi[0] * phi_rate[0] + phi[1] * phi_rate[1] + phi[2] * phi_rate[2]
    if square < 2.5e-3:  # series; the next terms are below 1e-9
        a = 0.5 - square / 24.0 + square * square / 720.0
        b = 1.0 / 6.0 - square / 120.0 + square * square / 5040.0
        a_rate = along * (-1.0 / 12.0 + square / 180.0)
        b_rate = along * (-1.0 / 60.0 + square / 1260.0)
    else:
        theta = np.sqrt(square)
        sinc = np.sin(theta) / theta
        a = (1.0 - np.cos(theta)) / square
        b = (1.0 - sinc) / square
        a_rate = along * (sinc - 2.0 * a) / square
        b_rate = along * (a - 3.0 * b) / square
    # [φ]×² x = φ (φ · x) − |φ|² x, and φ̇ × (φ × φ̇) = φ |φ̇|² − φ̇ (φ · φ̇).
    once = cross(phi, phi_rate)
    once_acceleration = cross(phi, phi_acceleration)
    along_acceleration, speed_square = 0.0, 0.0
    for i in range(3):
        along_acceleration += phi[i] * phi_acceleration[i]
        speed_square += phi_rate[i] * phi_rate[i]
    for i in range(3):
        twice = phi[i] * along - square * phi_rate[i]
        twice_acceleration = phi[i] * along_acceleration - square * phi_acceleration[i]
        mixed = phi[i] * speed_square - phi_rate[i] * along
        w[i] = phi_rate[i] - a * once[i] + b * twice
        alpha[i] = phi_acceleration[i] - a * once_acceleration[i] - a_rate * once[i]
        alpha[i] += b * (twice_acceleration + mixed) + b_rate * twice


@kernel
def evaluate_motion(
    duration: float,
    turn_duration: float,
    position: Matrix,
    rotation: Matrix,
    q_start: Vector,
    p_BT: Vector,
    p_WB: Vector,
    q_WB: Vector,
    v_WB_W: Vector,
    w_WB_B: Vector,
    a_WB_W: Vector,
    alpha_WB_B: Vector,
    p_WT: Vector,
    t: float,
) -> None:
    """Write the body's motion ``t`` s after the start of a stretch; it rests after the end.

    The turn may come to rest before the way does. ``position``, ``rotation`` (6, 3) are the
    coefficients of p and φ, ``q_start`` (4,) is R_0, ``p_BT`` (3,) m the tool's tip in B. The
    other arrays are written: m, m/s, m/s² in W; rad/s, rad/s² in B.
    """
    s = min(max(t / duration, 0.0), 1.0)
    evaluate_quintic(position, s, duration, p_WB, v_WB_W, a_WB_W)
    phi = np.empty(3)
    phi_rate = np.empty(3)
    phi_acceleration = np.empty(3)
    s = min(max(t / turn_duration, 0.0), 1.0)
    evaluate_quintic(rotation, s, turn_duration, phi, phi_rate, phi_acceleration)
    body_rates(phi, phi_rate, phi_acceleration, w_WB_B, alpha_WB_B)
    q = quaternion_multiply(q_start, quaternion_exp(phi))
    tip = rotate(q, p_BT)
    for i in range(4):
        q_WB[i] = q[i]
    for i in range(3):
        p_WT[i] = p_WB[i] + tip[i]


@kernel
def write_motion(
    timing: Vector,
    position: Matrix,
    rotation: Matrix,
    q_start: Vector,
    p_BT: Vector,
    t_s: Vector,
    p_WB: Vector,
    q_WB: Vector,
    v_WB_W: Vector,
    w_WB_B: Vector,
    a_WB_W: Vector,
    alpha_WB_B: Vector,
    p_WT: Vector,
) -> None:
    """``evaluate_motion`` at ``t_s`` (1,) of a stretch with ``timing`` (3,) s.

    That is its start, its duration and the duration of its turn.
    """
    evaluate_motion(
        timing[1],
        timing[2],
        position,
        rotation,
        q_start,
        p_BT,
        p_WB,
        q_WB,
        v_WB_W,
        w_WB_B,
        a_WB_W,
        alpha_WB_B,
        p_WT,
        t_s[0] - timing[0],
    )


@kernel
def survey(
    position: Matrix,
    rotation: Matrix,
    arm: Matrix,
    duration: float,
    turn_duration: float,
    limits: Vector,
) -> tuple[float, float, float]:
    """How a stretch stands against its limits, at sampled instants.

    ``limits`` (4,) = speed m/s, acceleration m/s², angular rate rad/s, angular acceleration
    rad/s²; arm joints (6, n) obey the angular ones each. Returns the largest ratio of a value to
    its limit, and how far the path leaves the straight stretch between its ends: aside of it and
    beyond its ends, m.
    """
    n_arm = arm.shape[1]
    x, v, a, w, alpha = np.empty(3), np.empty(3), np.empty(3), np.empty(3), np.empty(3)
    joint, joint_rate, joint_acceleration = np.empty(n_arm), np.empty(n_arm), np.empty(n_arm)
    ratio, aside, beyond = 0.0, 0.0, 0.0
    for k in range(SAMPLES + 1):
        s = k / SAMPLES
        evaluate_quintic(rotation, s, turn_duration, x, v, a)
        body_rates(x, v, a, w, alpha)
        ratio = max(ratio, _norm(w) / limits[2], _norm(alpha) / limits[3])
        evaluate_quintic(position, s, duration, x, v, a)
        ratio = max(ratio, _norm(v) / limits[0], _norm(a) / limits[1])
        off = _departure(position, x)
        aside = max(aside, off[0])
        beyond = max(beyond, off[1])
        evaluate_quintic(arm, s, duration, joint, joint_rate, joint_acceleration)
        for i in range(n_arm):
            ratio = max(ratio, abs(joint_rate[i]) / limits[2])
            ratio = max(ratio, abs(joint_acceleration[i]) / limits[3])
    return ratio, aside, beyond


@kernel
def _norm(a: Vector) -> float:
    return float(np.sqrt(a[0] * a[0] + a[1] * a[1] + a[2] * a[2]))


@kernel
def _departure(position: Matrix, x: Vector) -> tuple[float, float]:
    """(aside, beyond) m of a point (3,) from the straight stretch between a quintic's ends."""
    square, product, from_start = 0.0, 0.0, 0.0
    for i in range(3):
        line = 0.0
        for k in range(1, 6):
            line += position[k, i]
        step = x[i] - position[0, i]
        square += line * line
        product += line * step
        from_start += step * step
    if square < 1e-12:  # the ends are one point
        return 0.0, np.sqrt(from_start)
    length = np.sqrt(square)
    along = product / length
    return np.sqrt(max(from_start - along * along, 0.0)), max(along - length, -along, 0.0)
