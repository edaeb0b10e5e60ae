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

from dataclasses import dataclass

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import Command, Estimate, Reference
from inspect_cli.schema.platform import ControlModel, ImpedanceProfile
from inspect_cli.spatial.rotations import (
    cross,
    quaternion_conjugate,
    quaternion_log,
    quaternion_multiply,
    rotate_back,
)
from inspect_cli.spatial.types import Matrix, Vector

GRAVITY_MPS2 = 9.81


@kernel
def impedance_wrench(
    p_WB: Vector,
    q_WB: Vector,
    v_WB_W: Vector,
    w_WB_B: Vector,
    tau_hat_B: Vector,
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
    """Write the law's wrench (6,) and, apart, the force that carries the weight (3,), in B.

    ``shaping`` (2, 3, 3) holds R M̃⁻¹ Rᵀ − I for force and for torque; ``stiffness`` and
    ``damping`` (6,) are the diagonals of K̃ and D̃ in B.
    """
    p_error = rotate_back(q_WB, p_WB - p_ref)
    v_error = rotate_back(q_WB, v_WB_W - v_ref)
    q_error = quaternion_multiply(quaternion_conjugate(q_ref), q_WB)
    # The same rotation vector in the reference's and in the body's frame: it is its own axis.
    theta = quaternion_log(q_error)
    w_ref_B = rotate_back(q_error, w_ref)
    alpha_ref_B = rotate_back(q_error, alpha_ref)
    a_ref_B = rotate_back(q_WB, a_ref)
    up_B = rotate_back(q_WB, np.array([0.0, 0.0, GRAVITY_MPS2]))
    for k in range(3):
        weight_B[k] = mass * up_B[k]

    # M v̇_ref + C v + g of a rigid body about O_b whose centre of mass is at com_B.
    w = w_WB_B
    centripetal = cross(w, cross(w, com_B))
    momentum = inertia_B @ w
    gyroscopic = cross(w, momentum)
    angular = inertia_B @ alpha_ref_B
    tangential = cross(alpha_ref_B, com_B)
    lever = cross(com_B, a_ref_B + up_B)
    for k in range(3):
        wrench_B[k] = (
            mass * (a_ref_B[k] + up_B[k] + centripetal[k] + tangential[k])
            - stiffness[k] * p_error[k]
            - damping[k] * v_error[k]
        )
        wrench_B[3 + k] = (
            angular[k]
            + gyroscopic[k]
            + mass * lever[k]
            - stiffness[3 + k] * theta[k]
            - damping[3 + k] * (w[k] - w_ref_B[k])
        )
        for j in range(3):
            wrench_B[k] += shaping[0, k, j] * tau_hat_B[j]
            wrench_B[3 + k] += shaping[1, k, j] * tau_hat_B[3 + j]


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


class ImpedanceController:
    """The law with its gains; one call writes the wrench into a Command."""

    def __init__(
        self, body: RigidBody, model: ControlModel, profile: ImpedanceProfile, R_BT: Matrix
    ) -> None:
        self._body = body
        self._shaping = shaping_matrices(profile, R_BT)
        self._stiffness = np.array(model.stiffness_npm + model.stiffness_nmprad)
        self._damping = np.array(model.damping_nspm + model.damping_nmsprad)
        self.weight_B = np.zeros(3)

    def update(self, estimate: Estimate, reference: Reference, command: Command) -> None:
        """Write ``command.wrench_B``."""
        e, r, body = estimate.views, reference.views, self._body
        impedance_wrench(
            e["p_WB"],
            e["q_WB"],
            e["v_WB_W"],
            e["w_WB_B"],
            e["wrench_B"],
            r["p_WB"],
            r["q_WB"],
            r["v_WB_W"],
            r["w_WB_B"],
            r["a_WB_W"],
            r["alpha_WB_B"],
            body.mass_kg,
            body.inertia_B,
            body.com_B,
            self._shaping,
            self._stiffness,
            self._damping,
            command.views["wrench_B"],
            self.weight_B,
        )


def steady_contact_force(
    profile: ImpedanceProfile, stiffness_npm: Vector, R_BT: Matrix, offset_B: Vector
) -> Vector:
    """τ_e = R M̃ Rᵀ K̃ x̃ in N, the force (3,) in B with the body held ``offset_B`` (3,) m off."""
    R = R_BT if profile.frame == "tool" else np.eye(3)
    force: Vector = R @ np.diag(profile.mass) @ R.T @ (stiffness_npm * offset_B)
    return force
