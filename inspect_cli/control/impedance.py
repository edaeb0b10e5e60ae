"""Selective impedance control (paper A, Eqs. 4–6).

The closed loop shall behave as M_v ṽ̇ + D_v ṽ + K_v x̃ = τ_e. With the apparent inertia
normalised by the system's, M̃ = M⁻¹ M_v, and stiffness and damping by the apparent inertia,
the law is

    τ_a = (R M̃⁻¹ Rᵀ − I) τ̂_e − D̃ ṽ − K̃ x̃ + M v̇_ref + C v + g

expressed in B about O_b. M̃ is diagonal in the tool's or the body's frame and R turns that
frame into B. The paper prints the product as Rᵀ M̃⁻¹ R; it is read here so that z_T is an
eigenvector of the apparent mass, which is what the text asks for and what differs only when the
arm is not along a body axis. The paper's state carries the reference's acceleration; M v̇_ref
is where it enters. At rest in contact τ_e = R M̃ Rᵀ K̃ x̃.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.compiled import Bound, bound, kernel
from inspect_cli.records import Command, Estimate, Reference
from inspect_cli.schema.vehicle import ControlModel, ImpedanceProfile
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import (
    cross,
    quaternion_conjugate,
    quaternion_log,
    quaternion_multiply,
    rotate_back,
    turned,
)


@kernel
def impedance_wrench(
    p: Vector,
    q: Vector,
    v: Vector,
    w: Vector,
    observed: Vector,
    p_ref: Vector,
    q_ref: Vector,
    v_ref: Vector,
    w_ref: Vector,
    a_ref: Vector,
    alpha_ref: Vector,
    mass: float,
    inertia_B: Matrix,
    com_B: Vector,
    shaping: Matrix,
    stiffness: Vector,
    damping: Vector,
    wrench_B: Vector,
    weight_B: Vector,
) -> None:
    """Write the law's wrench (6,) and, apart, the force (3,) that carries the weight, N, in B.

    Motion and reference are those of ``records.Estimate`` and ``Reference``, ``observed`` (6,) is
    τ̂_e. ``shaping`` (2, 3, 3) holds R M̃⁻¹ Rᵀ − I for force and for torque; ``stiffness`` and
    ``damping`` (6,) are the diagonals of K̃ and D̃ in B.
    """
    p_off, v_off, up = np.empty(3), np.empty(3), np.zeros(3)
    up[2] = GRAVITY_MPS2
    for k in range(3):
        p_off[k] = p[k] - p_ref[k]
        v_off[k] = v[k] - v_ref[k]
    p_error = rotate_back(q, p_off)
    v_error = rotate_back(q, v_off)
    # The rotation vector of the error is its own axis: the same in the reference's B and in B.
    q_error = quaternion_multiply(quaternion_conjugate(q_ref), q)
    theta = quaternion_log(q_error)
    w_ref_B = rotate_back(q_error, w_ref)
    alpha_ref_B = rotate_back(q_error, alpha_ref)
    a_ref_B = rotate_back(q, a_ref)
    up_B = rotate_back(q, up)

    # M v̇_ref + C v + g of a rigid body about O_b whose centre of mass is at com_B.
    centripetal = cross(w, cross(w, com_B))
    gyroscopic = cross(w, turned(inertia_B, w))
    angular = turned(inertia_B, alpha_ref_B)
    tangential = cross(alpha_ref_B, com_B)
    carried = np.empty(3)
    for k in range(3):
        carried[k] = a_ref_B[k] + up_B[k]
    lever = cross(com_B, carried)
    for k in range(3):
        weight_B[k] = mass * up_B[k]
        force = (
            mass * (a_ref_B[k] + up_B[k] + centripetal[k] + tangential[k])
            - stiffness[k] * p_error[k]
            - damping[k] * v_error[k]
        )
        torque = (
            angular[k]
            + gyroscopic[k]
            + mass * lever[k]
            - stiffness[3 + k] * theta[k]
            - damping[3 + k] * (w[k] - w_ref_B[k])
        )
        for j in range(3):
            force += shaping[0, k, j] * observed[j]
            torque += shaping[1, k, j] * observed[3 + j]
        wrench_B[k] = force
        wrench_B[3 + k] = torque


@dataclass(frozen=True)
class Impedance:
    """What one profile makes of the law: shaping (2, 3, 3), diagonals of K̃ and D̃ (6,) in B."""

    shaping: Matrix
    stiffness: Vector
    damping: Vector

    @classmethod
    def of(cls, model: ControlModel, profile: ImpedanceProfile, R_BT: Matrix) -> Impedance:
        """The impedance of a profile with the tool turned as ``R_BT`` in B."""
        stiffness = (profile.stiffness_npm or model.stiffness_npm) + model.stiffness_nmprad
        damping = (profile.damping_nspm or model.damping_nspm) + model.damping_nmsprad
        return cls(shaping_matrices(profile, R_BT), np.array(stiffness), np.array(damping))

    @classmethod
    def mixed(cls, all_of_them: Sequence[Impedance], shares: Vector) -> Impedance:
        """The mean of several, weighted by ``shares`` (n,) that add up to 1."""
        given = [(one, share) for one, share in zip(all_of_them, shares, strict=True) if share]
        return cls(
            sum((share * one.shaping for one, share in given), np.zeros((2, 3, 3))),
            sum((share * one.stiffness for one, share in given), np.zeros(6)),
            sum((share * one.damping for one, share in given), np.zeros(6)),
        )

    def become(self, other: Impedance) -> None:
        """Take the numbers of another, in place."""
        self.shaping[...] = other.shaping
        self.stiffness[:] = other.stiffness
        self.damping[:] = other.damping


def shaping_matrices(profile: ImpedanceProfile, R_BT: Matrix) -> Matrix:
    """R M̃⁻¹ Rᵀ − I of a profile, for force and torque; shape (2, 3, 3), in B."""
    R = R_BT if profile.frame == "tool" else np.eye(3)
    force = R @ np.diag(1.0 / np.array(profile.mass)) @ R.T - np.eye(3)
    torque = R @ np.diag(1.0 / np.array(profile.inertia)) @ R.T - np.eye(3)
    return np.ascontiguousarray(np.stack([force, torque]))


@dataclass(frozen=True)
class RigidBody:
    """Nominal inertia about O_b: mass kg, inertia (3, 3) kg·m², centre of mass (3,) m, in B."""

    mass_kg: float
    inertia_B: Matrix
    com_B: Vector


BLEND_S = 0.5
"""Over this time one profile gives way to another, so that the wrench does not jump."""


class ImpedanceController:
    """The law with the profiles of a platform.

    ``Reference.impedance`` says which profile holds, by its place in the platform's file. The
    first one that is asked for holds at once; a later change is blended in over ``BLEND_S``,
    also while an arm turns the tool.
    """

    def __init__(self, body: RigidBody, model: ControlModel, R_BT: Matrix, control_hz: int) -> None:
        self._body = body
        self._model = model
        self._profiles = tuple(model.profiles.values())
        self._blend_ticks = round(BLEND_S * control_hz)
        self._tick = self._blend_ticks
        self._chosen = -1
        self._shares = self._shares_before = np.zeros(len(self._profiles))
        self._now = Impedance(np.zeros((2, 3, 3)), np.zeros(6), np.zeros(6))
        self.turn_tool(R_BT)
        self.weight_B = np.zeros(3)

    def turn_tool(self, R_BT: Matrix) -> None:
        """Follow an arm that turned its tool in B."""
        self._all = [Impedance.of(self._model, profile, R_BT) for profile in self._profiles]
        self._now.become(Impedance.mixed(self._all, self._shares))

    def bind(self, estimate: Estimate, reference: Reference, command: Command) -> Bound:
        """The law: it writes ``command.wrench_B``; ``follow`` says with which profile."""
        body, now = self._body, self._now
        return bound(
            impedance_wrench,
            *(estimate.views[name] for name in ("p_WB", "q_WB", "v_WB_W", "w_WB_B", "wrench_B")),
            *(reference.views[name] for name in ("p_WB", "q_WB", "v_WB_W", "w_WB_B")),
            *(reference.views[name] for name in ("a_WB_W", "alpha_WB_B")),
            float(body.mass_kg),
            body.inertia_B,
            body.com_B,
            now.shaping,
            now.stiffness,
            now.damping,
            command.views["wrench_B"],
            self.weight_B,
        )

    def follow(self, profile: int) -> None:
        """Take the profile that the reference asks for; called at every control tick."""
        if profile != self._chosen:
            # The first is blended in, too: in the one step that is left of its blend.
            self._tick = self._blend_ticks - 1 if self._chosen < 0 else 0
            self._shares_before, self._chosen = self._shares, profile
        if self._tick == self._blend_ticks:
            return
        self._tick += 1
        asked = np.eye(len(self._profiles))[profile]
        if self._tick == self._blend_ticks:
            self._shares = asked
        else:
            share = self._tick / self._blend_ticks
            self._shares = (1.0 - share) * self._shares_before + share * asked
        self._now.become(Impedance.mixed(self._all, self._shares))


def steady_contact_force(
    profile: ImpedanceProfile, stiffness_npm: Vector, R_BT: Matrix, offset_B: Vector
) -> Vector:
    """τ_e = R M̃ Rᵀ K̃ x̃ in N, the force (3,) in B with the body held ``offset_B`` (3,) m off."""
    R = R_BT if profile.frame == "tool" else np.eye(3)
    force: Vector = R @ np.diag(profile.mass) @ R.T @ (stiffness_npm * offset_B)
    return force


def steady_press_force(
    model: ControlModel, profile: ImpedanceProfile, R_BT: Matrix, press_m: float
) -> float:
    """The steady normal force, N, with the set-point ``press_m`` behind the surface."""
    stiffness = np.array(profile.stiffness_npm or model.stiffness_npm)
    z_T = R_BT[:, 2]
    return float(-steady_contact_force(profile, stiffness, R_BT, -press_m * z_T) @ z_T)
