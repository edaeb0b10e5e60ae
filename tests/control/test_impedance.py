"""The impedance law against plain matrices, its closed loop against a linear equation."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
import pytest
from scipy.integrate import solve_ivp
from scipy.linalg import block_diag, expm
from scipy.spatial.transform import Rotation

from inspect_cli.control.impedance import (
    ImpedanceController,
    RigidBody,
    shaping_matrices,
    steady_contact_force,
)
from inspect_cli.records import Command, Estimate, Reference
from inspect_cli.schema.vehicle import ControlModel, ImpedanceProfile, TiltRotorPlatform
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.tilt_rotor.model import build_spec, tool_transform

Pitched = Callable[[float], TiltRotorPlatform]
Array = np.ndarray
G = 9.81
LENGTHS = {"n_rotors": 12, "n_joints": 6, "n_servos": 6}
ANGLES = pytest.mark.parametrize("pitch_deg", [90.0, 150.0])

UNEVEN = ImpedanceProfile(frame="tool", mass=(5.0, 3.0, 0.25), inertia=(5.0, 2.0, 0.5))
UNEVEN_GAINS = ControlModel(
    stiffness_npm=(72.0, 50.0, 90.0),
    damping_nspm=(33.0, 20.0, 41.0),
    stiffness_nmprad=(5.5, 4.0, 10.0),
    damping_nmsprad=(1.4, 1.1, 2.6),
    observer_gain=(1.0, 1.0, 1.0),
    observer_gain_torque=(1.0, 1.0, 1.0),
    profiles={"uneven": UNEVEN},
)


def hat(a: Array) -> Array:
    return np.cross(np.eye(3), a)


def mass_matrix(body: RigidBody) -> Array:
    """M (6, 6) about O_b for twists (v_B, w_B)."""
    m, c = body.mass_kg, hat(body.com_B)
    return np.block([[m * np.eye(3), -m * c], [m * c, body.inertia_B]])


def bias_wrench(body: RigidBody, v_B: Array, w_B: Array) -> Array:
    """What M (dv/dt, dw/dt) in B needs besides: the momentum's turning (Kirchhoff)."""
    momentum = mass_matrix(body) @ np.concatenate([v_B, w_B])
    p, h = momentum[:3], momentum[3:]
    return np.concatenate([np.cross(w_B, p), np.cross(w_B, h) + np.cross(v_B, p)])


def weight_wrench(body: RigidBody, R_WB: Array) -> Array:
    """The wrench that gravity exerts, in B about O_b."""
    force = R_WB.T @ np.array([0.0, 0.0, -body.mass_kg * G])
    return np.concatenate([force, np.cross(body.com_B, force)])


def wxyz(rotation: Rotation) -> Array:
    x, y, z, w = rotation.as_quat()
    return np.array([w, x, y, z]) * (1.0 if w >= 0 else -1.0)


def apparent_inverse(profile: ImpedanceProfile, R_BT: Array) -> Array:
    """blockdiag(R M̃⁻¹ Rᵀ) (6, 6)."""
    R = R_BT if profile.frame == "tool" else np.eye(3)
    blocks = [R @ np.diag(1.0 / np.array(d)) @ R.T for d in (profile.mass, profile.inertia)]
    return block_diag(*blocks)


def gains(control: ControlModel) -> tuple[Array, Array]:
    K = np.diag(control.stiffness_npm + control.stiffness_nmprad)
    D = np.diag(control.damping_nspm + control.damping_nmsprad)
    return K, D


class Loop:
    """The controller with its records."""

    def __init__(
        self, body: RigidBody, control: ControlModel, profile: ImpedanceProfile, R_BT: Array
    ) -> None:
        self.estimate = Estimate.create(LENGTHS)
        self.reference = Reference.create({**LENGTHS, "n_arm": 0})
        self.command = Command.create(LENGTHS)
        self.estimate.q_WB[:] = self.reference.q_WB[:] = [1.0, 0.0, 0.0, 0.0]
        only = control.model_copy(update={"profiles": {"only": profile}})
        self.controller = ImpedanceController(body, only, R_BT, 250)
        self.law = self.controller.bind(self.estimate, self.reference, self.command)

    def wrench(self) -> Array:
        self.controller.follow(int(self.reference.impedance))
        self.law()
        return np.array(self.command.wrench_B)


@ANGLES
@pytest.mark.parametrize("seed", range(5))
def test_the_law_is_the_one_of_plain_matrices(
    pitched: Pitched, pitch_deg: float, seed: int
) -> None:
    platform = pitched(pitch_deg)
    body, R_BT = nominal_body(build_spec(platform)), tool_transform(platform)[1]
    # A centre of mass far off, so that no coupling can hide.
    body = RigidBody(body.mass_kg, body.inertia_B, np.array([0.05, -0.08, 0.11]))
    loop = Loop(body, UNEVEN_GAINS, UNEVEN, R_BT)
    rng = np.random.default_rng(seed)
    R_WB, R_ref = Rotation.random(rng=rng), Rotation.random(rng=rng)
    p, p_ref, v, v_ref, a_ref, w, w_ref, alpha_ref = rng.normal(size=(8, 3))
    external = rng.normal(size=6)

    estimate, reference = loop.estimate, loop.reference
    estimate.p_WB[:], estimate.v_WB_W[:], estimate.w_WB_B[:] = p, v, w
    estimate.q_WB[:], estimate.wrench_B[:] = wxyz(R_WB), external
    reference.p_WB[:], reference.v_WB_W[:], reference.w_WB_B[:] = p_ref, v_ref, w_ref
    reference.q_WB[:], reference.a_WB_W[:], reference.alpha_WB_B[:] = (
        wxyz(R_ref),
        a_ref,
        alpha_ref,
    )

    K, D = gains(UNEVEN_GAINS)
    R = R_WB.as_matrix()
    turn = R_ref.inv() * R_WB
    back = turn.as_matrix().T
    x = np.concatenate([R.T @ (p - p_ref), turn.as_rotvec()])
    x_dot = np.concatenate([R.T @ (v - v_ref), w - back @ w_ref])
    # In B's coordinates the reference's acceleration is the derivative of v_B plus w × v_B.
    wanted = np.concatenate([R.T @ a_ref - np.cross(w, R.T @ v), back @ alpha_ref])
    expected = (
        (apparent_inverse(UNEVEN, R_BT) - np.eye(6)) @ external
        - D @ x_dot
        - K @ x
        + mass_matrix(body) @ wanted
        + bias_wrench(body, R.T @ v, w)
        - weight_wrench(body, R)
    )
    np.testing.assert_allclose(loop.wrench(), expected, rtol=1e-11, atol=1e-11)
    up = R.T @ np.array([0.0, 0.0, body.mass_kg * G])
    np.testing.assert_allclose(loop.controller.weight_B, up, rtol=1e-12)


def linear_response(M: Array, D: Array, K: Array, wrench: Array, times: Array) -> Array:
    """x(t) (n, 6) of M ẍ + D ẋ + K x = wrench from rest, by the matrix exponential."""
    A = np.block([[np.zeros((6, 6)), np.eye(6)], [-np.linalg.solve(M, K), -np.linalg.solve(M, D)]])
    b = np.concatenate([np.zeros(6), np.linalg.solve(M, wrench)])
    steady = np.linalg.solve(A, b)
    return np.array([((expm(A * t) - np.eye(12)) @ steady)[:6] for t in times])


def body_motion(
    loop: Loop, body: RigidBody, wrench_B: Array, times: Array, moving: bool
) -> tuple[Array, Array]:
    """Errors (n, 6) of a free body with the exact τ̂_e, and its R_WB's; SciPy integrates."""
    M = mass_matrix(body)

    def reference_at(t: float) -> None:
        if not moving:
            return
        loop.reference.p_WB[:] = [0.3 * np.sin(t), 0.0, 0.2 * t * t]
        loop.reference.v_WB_W[:] = [0.3 * np.cos(t), 0.0, 0.4 * t]
        loop.reference.a_WB_W[:] = [-0.3 * np.sin(t), 0.0, 0.4]

    def derivative(t: float, y: Array) -> Array:
        reference_at(t)
        p, rotvec, v_B, w_B = y.reshape(4, 3)
        R_WB = Rotation.from_rotvec(rotvec)
        R = R_WB.as_matrix()
        loop.estimate.p_WB[:], loop.estimate.q_WB[:] = p, wxyz(R_WB)
        loop.estimate.v_WB_W[:], loop.estimate.w_WB_B[:] = R @ v_B, w_B
        loop.estimate.wrench_B[:] = wrench_B
        total = loop.wrench() + wrench_B + weight_wrench(body, R) - bias_wrench(body, v_B, w_B)
        # The rotation vector stays so small that its rate is the angular velocity.
        return np.concatenate([R @ v_B, w_B, np.linalg.solve(M, total)])

    reference_at(0.0)
    start = np.concatenate([loop.reference.p_WB, np.zeros(3), loop.reference.v_WB_W, np.zeros(3)])
    span = (0.0, times[-1])
    solution = solve_ivp(derivative, span, start, t_eval=times, rtol=1e-9, atol=1e-13)
    errors = []
    for t, y in zip(times, solution.y.T, strict=True):
        reference_at(t)
        R = Rotation.from_rotvec(y[3:6]).as_matrix()
        errors.append(np.concatenate([R.T @ (y[:3] - loop.reference.p_WB), y[3:6]]))
    return np.array(errors), solution.y


@ANGLES
@pytest.mark.parametrize("moving", [False, True])
def test_the_closed_loop_has_the_apparent_inertia_damping_and_stiffness(
    pitched: Pitched, pitch_deg: float, moving: bool
) -> None:
    platform = pitched(pitch_deg)
    body, R_BT = nominal_body(build_spec(platform)), tool_transform(platform)[1]
    loop = Loop(body, UNEVEN_GAINS, UNEVEN, R_BT)
    K, D = gains(UNEVEN_GAINS)
    shaped = np.linalg.inv(apparent_inverse(UNEVEN, R_BT))
    # M_v = R M̃ Rᵀ M and likewise D_v, K_v; so small that turning does not couple.
    wrench = 1e-3 * np.array([0.7, -0.4, 1.0, 0.02, 0.05, -0.03])
    times = np.linspace(0.0, 3.0, 31)
    expected = linear_response(shaped @ mass_matrix(body), shaped @ D, shaped @ K, wrench, times)
    errors, _ = body_motion(loop, body, wrench, times, moving)
    scale = np.abs(expected).max(axis=0)
    np.testing.assert_array_less(np.abs(errors - expected).max(axis=0), 2e-3 * scale)


@ANGLES
def test_the_tool_axis_is_an_eigenvector_of_the_apparent_mass(
    pitched: Pitched, pitch_deg: float
) -> None:
    platform = pitched(pitch_deg)
    body, R_BT = nominal_body(build_spec(platform)), tool_transform(platform)[1]
    profile = platform.control.profiles["contact_ndt"]
    loop = Loop(body, platform.control, profile, R_BT)
    hover = loop.wrench()
    for axis, multiplier in zip(R_BT.T, profile.mass, strict=True):
        loop.estimate.wrench_B[:3] = axis  # one newton of external force
        acceleration = (loop.wrench() - hover)[:3] + axis
        np.testing.assert_allclose(acceleration, axis / multiplier, atol=1e-12)


def test_a_profile_in_the_body_frame_is_not_turned_by_the_arm(pitched: Pitched) -> None:
    profile = UNEVEN.model_copy(update={"frame": "body"})
    shaping = shaping_matrices(profile, tool_transform(pitched(150.0))[1])
    np.testing.assert_allclose(shaping[0], np.diag(1.0 / np.array(UNEVEN.mass) - 1.0))
    np.testing.assert_allclose(shaping[1], np.diag(1.0 / np.array(UNEVEN.inertia) - 1.0))


@ANGLES
def test_at_rest_in_contact_the_force_is_the_shaped_spring(
    pitched: Pitched, pitch_deg: float
) -> None:
    platform = pitched(pitch_deg)
    body, R_BT = nominal_body(build_spec(platform)), tool_transform(platform)[1]
    R, M_shaped = R_BT, np.diag(UNEVEN.mass)
    K = np.diag(UNEVEN_GAINS.stiffness_npm)
    offset_B = -0.10 * R_BT[:, 2] + 0.02 * R_BT[:, 0]
    expected = R @ M_shaped @ R.T @ K @ offset_B
    stiffness = np.array(UNEVEN_GAINS.stiffness_npm)
    np.testing.assert_allclose(
        steady_contact_force(UNEVEN, stiffness, R_BT, offset_B), expected, rtol=1e-12
    )
    # Nothing moves: what the law asks for, that force and the weight are in balance.
    loop = Loop(body, UNEVEN_GAINS, UNEVEN, R_BT)
    loop.estimate.p_WB[:] = offset_B
    loop.estimate.wrench_B[:3] = expected
    total = loop.wrench() + loop.estimate.wrench_B + weight_wrench(body, np.eye(3))
    np.testing.assert_allclose(total[:3], 0.0, atol=1e-11)


def test_the_shorter_way_round_is_taken(pitched: Pitched) -> None:
    platform = pitched(90.0)
    body, R_BT = nominal_body(build_spec(platform)), tool_transform(platform)[1]
    loop = Loop(body, platform.control, platform.control.profiles["contact_ndt"], R_BT)
    hover = loop.wrench()
    turned = wxyz(Rotation.from_euler("z", 30, degrees=True))
    loop.estimate.q_WB[:] = turned
    torque = (loop.wrench() - hover)[5]
    assert torque == pytest.approx(-10.0 * np.radians(30), rel=1e-9)
    loop.estimate.q_WB[:] = -turned  # the same attitude
    assert (loop.wrench() - hover)[5] == pytest.approx(torque, rel=1e-9)
