"""Static allocation of a wrench to tilting rotor groups.

Kamel et al., "The Voliro omniorientational hexacopter" (arXiv 1801.04581): with
s_i = T_i sin α_i and c_i = T_i cos α_i the wrench is linear, [F; τ] = A [s; c] with a constant A,
so [s; c] = A⁺ [F; τ], T_i = √(s_i² + c_i²) and α_i = atan2(s_i, c_i).

Group i sits at p_i = d (cos ψ, sin ψ, 0) and tilts about its arm a_i = (cos ψ, sin ψ, 0): its
thrust points along c_i z + s_i (a_i × z). Its rotors share the thrust equally and turn against
each other, so their reaction moments leave κ_i T_i about the thrust's axis, where
κ_i = −σ_i (k_upper − k_lower) / 2 and σ_i = +1 for an upper rotor that turns ccw from above.

When a group would exceed its thrust, forces give way first: torque is granted, then the weight,
then the rest, each scaled by the largest factor in [0, 1] that keeps every group within limits.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import Bound, bound, kernel
from inspect_cli.records import Command
from inspect_cli.spatial.arrays import Matrix, Vector

MIN_STEERING_THRUST_N = 0.1
"""Below this a group's direction is ill-defined and its tilt stays where it was."""


def allocation_matrix(azimuth_rad: Vector, distance_m: float, kappa_m: Vector) -> Matrix:
    """A (6, 2n) with [F; τ] = A [s; c] in B about O_b."""
    n = len(azimuth_rad)
    A = np.zeros((6, 2 * n))
    up = np.array([0.0, 0.0, 1.0])
    for i, psi in enumerate(azimuth_rad):
        arm = np.array([np.cos(psi), np.sin(psi), 0.0])
        for column, direction in ((i, np.cross(arm, up)), (n + i, up)):
            A[:3, column] = direction
            A[3:, column] = distance_m * np.cross(arm, direction) + kappa_m[i] * direction
    return A


@kernel
def _largest_share(base: Vector, extra: Vector, n: int, limit: float) -> float:
    """The largest λ in [0, 1] with |base_i + λ extra_i| ≤ limit for every group i."""
    share = 1.0
    for i in range(n):
        a = extra[i] * extra[i] + extra[n + i] * extra[n + i]
        if a == 0.0:
            continue
        b = base[i] * extra[i] + base[n + i] * extra[n + i]
        c = base[i] * base[i] + base[n + i] * base[n + i] - limit * limit
        root = (-b + np.sqrt(max(b * b - a * c, 0.0))) / a
        share = min(share, max(root, 0.0))
    return share


@kernel
def allocate(
    wrench_B: Vector,
    weight_B: Vector,
    A: Matrix,
    A_pinv: Matrix,
    limit: float,
    tilt: Vector,
    rotor_thrust: Vector,
    granted_B: Vector,
    saturated: Vector,
) -> None:
    """Write tilts (n,) rad (updated in place), thrusts (2n,) N and the granted wrench (6,).

    ``weight_B`` (3,) is the part of the force that carries the weight. Rotors come in pairs
    (upper, lower) per group. ``saturated`` (1,) is 1 if anything had to be scaled down, else 0.
    """
    n = tilt.shape[0]
    total = np.zeros(2 * n)
    part = np.zeros(2 * n)
    saturated[0] = 0.0
    for stage in range(3):
        for row in range(2 * n):
            value = 0.0
            for k in range(3):
                if stage == 0:
                    value += A_pinv[row, 3 + k] * wrench_B[3 + k]
                elif stage == 1:
                    value += A_pinv[row, k] * weight_B[k]
                else:
                    value += A_pinv[row, k] * (wrench_B[k] - weight_B[k])
            part[row] = value
        share = _largest_share(total, part, n, limit)
        if share < 1.0:
            saturated[0] = 1.0
        for row in range(2 * n):
            total[row] += share * part[row]
    for i in range(n):
        thrust = np.sqrt(total[i] * total[i] + total[n + i] * total[n + i])
        rotor_thrust[2 * i] = 0.5 * thrust
        rotor_thrust[2 * i + 1] = 0.5 * thrust
        if thrust > MIN_STEERING_THRUST_N:
            turn = np.arctan2(total[i], total[n + i]) - tilt[i]
            tilt[i] += turn - 2.0 * np.pi * np.round(turn / (2.0 * np.pi))
    for k in range(6):
        value = 0.0
        for row in range(2 * n):
            value += A[k, row] * total[row]
        granted_B[k] = value


class TiltAllocation:
    """The allocation of one vehicle; keeps the tilts unwrapped from call to call."""

    def __init__(self, azimuth_rad: Vector, distance_m: float, kappa_m: Vector, limit_n: float):
        self.matrix = allocation_matrix(azimuth_rad, distance_m, kappa_m)
        self._inverse = np.ascontiguousarray(np.linalg.pinv(self.matrix))
        self._limit_n = float(limit_n)

    def group_thrusts(self, wrench_B: Vector) -> Vector:
        """Thrust (n,) that each group would need for a wrench (6,), without limits, N."""
        solution = self._inverse @ wrench_B
        n = len(solution) // 2
        return np.hypot(solution[:n], solution[n:])

    def group_tilts(self, wrench_B: Vector) -> Vector:
        """Tilt (n,) that each group would need for a wrench (6,), rad in (−π, π]."""
        solution = self._inverse @ wrench_B
        n = len(solution) // 2
        return np.arctan2(solution[:n], solution[n:])

    def bind(self, weight_B: Vector, command: Command) -> Bound:
        """The call that turns ``command.wrench_B`` into thrusts, tilts and the granted wrench."""
        c = command.views
        return bound(
            allocate,
            c["wrench_B"],
            weight_B,
            self.matrix,
            self._inverse,
            self._limit_n,
            c["joint_angle"],
            c["rotor_thrust"],
            c["allocated_B"],
            c["saturated"],
        )
