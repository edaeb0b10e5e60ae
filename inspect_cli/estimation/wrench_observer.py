"""External wrench from the generalized momentum, without accelerations.

Bodie et al., "An Omnidirectional Aerial Manipulation Platform for Contact-Based Inspection"
(RSS 2019), Eqs. 2 and 3:

    τ̂_e = K_I (M v − ∫ (τ_a − C v − g + τ̂_e) dt)    which obeys    dτ̂_e/dt = K_I (τ_e − τ̂_e)

M v has one consistent reading for a body whose centre of mass (c, in B) is not at O_b: linear
momentum p and angular momentum L about the centre of mass,

    p = m (v_WB_W + R (w × c)) in W,     dp/dt = R f_a + m g_W + f_e
    L = J_c w                  in B,     dL/dt = t_a − c × f_a − w × L + t_e

with J_c = J_O − m (|c|² 1 − c cᵀ), f_a, t_a the applied wrench about O_b in B and t_e taken about
the centre of mass. Gravity enters p alone and the Coriolis term is the turning of L. In W a
steady wind or contact force is a constant input, however the body turns; torques stay in B.
The result is handed out about O_b in B: (Rᵀ f̂_e, t̂_e + c × Rᵀ f̂_e).

Over a step Δt the integral is solved exactly for an external wrench that is constant during it:

    τ̂ ← e^(−K_I Δt) τ̂ + (1 − e^(−K_I Δt)) (Δmomentum / Δt − mean of the known terms)

so the response to a step is 1 − e^(−K_I t) whatever Δt is. The means of R f_a and of w × L
are taken between the two ends of the step (error of order Δt²).
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import Bound, bound, kernel
from inspect_cli.records import Estimate
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import cross, rotate, rotate_back


@kernel
def momentum(
    mass: float, inertia_com: Matrix, com: Vector, q: Vector, v_W: Vector, w_B: Vector
) -> Vector:
    """(6,) = p in W (N·s) and L about the centre of mass in B (N·m·s)."""
    turning = rotate(q, cross(w_B, com))
    total = np.empty(6)
    for i in range(3):
        total[i] = mass * (v_W[i] + turning[i])
        total[3 + i] = (
            inertia_com[i, 0] * w_B[0] + inertia_com[i, 1] * w_B[1] + inertia_com[i, 2] * w_B[2]
        )
    return total


@kernel
def observe(
    mass: float,
    inertia_com: Matrix,
    com: Vector,
    decay: Vector,
    dt: float,
    last: Vector,
    observed: Vector,
    q: Vector,
    v_W: Vector,
    w_B: Vector,
    applied: Vector,
    wrench: Vector,
) -> None:
    """One step: update ``observed`` and ``last``, write ``wrench`` (6,) about O_b in B.

    ``last`` (13,) = (p, L, w, q) at the previous step; ``observed`` (6,) = (f̂_e in W, t̂_e about the
    centre of mass in B); ``decay`` (6,) = e^(−K_I Δt); ``applied`` (6,) about O_b in B, constant
    during the step.
    """
    now = momentum(mass, inertia_com, com, q, v_W, w_B)
    turn_before = cross(last[6:9], last[3:6])
    turn_now = cross(w_B, now[3:6])
    push_before = rotate(last[9:13], applied[0:3])
    push_now = rotate(q, applied[0:3])
    lever = cross(com, applied[0:3])
    for i in range(3):
        known = 0.5 * (push_before[i] + push_now[i])
        if i == 2:
            known -= mass * GRAVITY_MPS2
        force = (now[i] - last[i]) / dt - known
        observed[i] = force + decay[i] * (observed[i] - force)
        k = 3 + i
        known = applied[k] - lever[i] - 0.5 * (turn_before[i] + turn_now[i])
        torque = (now[k] - last[k]) / dt - known
        observed[k] = torque + decay[k] * (observed[k] - torque)
        last[i], last[k], last[6 + i] = now[i], now[k], w_B[i]
    for i in range(4):
        last[9 + i] = q[i]
    force_B = rotate_back(q, observed[0:3])
    moment = cross(com, force_B)
    for i in range(3):
        wrench[i] = force_B[i]
        wrench[3 + i] = observed[3 + i] + moment[i]


class WrenchObserver:
    """Holds momentum and observed wrench between steps.

    ``inertia_kgm2`` (3, 3) about O_b in B; ``com_B`` (3,) m; ``gain`` (6,) = diagonal of K_I, 1/s,
    for forces along W's axes and torques about B's; ``dt`` s between updates.
    """

    def __init__(
        self, mass_kg: float, inertia_kgm2: Matrix, com_B: Vector, gain: Vector, dt: float
    ) -> None:
        self._mass = float(mass_kg)
        self._com = np.array(com_B, dtype=np.float64)
        steiner = self._com @ self._com * np.eye(3) - np.outer(self._com, self._com)
        self._inertia_com = np.array(inertia_kgm2, dtype=np.float64) - mass_kg * steiner
        self._decay = np.exp(-np.asarray(gain, dtype=np.float64) * dt)
        self._dt = dt
        self._last = np.zeros(13)
        self._observed = np.zeros(6)

    def reset(self, estimate: Estimate) -> None:
        """Begin with no external wrench at the estimated motion."""
        q, v, w = estimate.q_WB, estimate.v_WB_W, estimate.w_WB_B
        self._last[0:6] = momentum(self._mass, self._inertia_com, self._com, q, v, w)
        self._last[6:9], self._last[9:13] = w, q
        self._observed[:] = 0.0
        estimate.wrench_B[:] = 0.0

    def bind(self, estimate: Estimate, applied_wrench_B: Vector) -> Bound:
        """The update: it writes ``estimate.wrench_B``.

        At its call ``applied_wrench_B`` (6,) holds the wrench applied since the last one.
        """
        return bound(
            observe,
            self._mass,
            self._inertia_com,
            self._com,
            self._decay,
            self._dt,
            self._last,
            self._observed,
            estimate.q_WB,
            estimate.v_WB_W,
            estimate.w_WB_B,
            applied_wrench_B,
            estimate.wrench_B,
        )
