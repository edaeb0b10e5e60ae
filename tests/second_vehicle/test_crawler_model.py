"""The crawler's kinematics, statics and allocation against its MuJoCo model."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from crawler_models import crawler
from pitching_crawler.file_model import FOOT

from inspect_cli.interfaces import FREE, TOOL, FramePose, Posture, Shortfall
from inspect_cli.spatial.rotations import matrix_to_quaternion, roll_pitch_yaw_matrix

MASS, G, N_ROTORS = 2.3, 9.81, 6
ANYWHERE = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(1))


@pytest.fixture(scope="module")
def vehicle():
    return crawler()


@pytest.fixture(scope="module")
def model(vehicle):
    return vehicle.nominal_spec().compile()


def data_at(model, posture):
    data = mujoco.MjData(model)
    data.qpos[:3], data.qpos[3:7] = posture.p_WB, posture.q_WB
    data.qpos[model.joint("hinge").qposadr[0]] = posture.joint_angle[0]
    mujoco.mj_forward(model, data)
    return data


def tool_at(p, heading=0.0, along=(1.0, 0.0, 0.0)):
    z = roll_pitch_yaw_matrix(0.0, 0.0, heading) @ along
    y = np.cross([0.0, 0.0, 1.0], z)
    return FramePose(np.array(p, dtype=float), np.column_stack([np.cross(y, z), y, z]))


def test_frames_are_where_the_model_has_them(vehicle, model):
    rng = np.random.default_rng(1)
    for _ in range(20):
        R_WB = roll_pitch_yaw_matrix(*rng.uniform(-0.6, 0.6, 3))
        posture = Posture(rng.normal(size=3), matrix_to_quaternion(R_WB), rng.uniform(-1, 1, 1))
        data = data_at(model, posture)
        for frame in (TOOL, FOOT):
            p, R = vehicle.capabilities.frame_pose(posture, frame)
            np.testing.assert_allclose(p, data.site(frame).xpos, atol=1e-12)
            np.testing.assert_allclose(R, data.site(frame).xmat.reshape(3, 3), atol=1e-12)


@pytest.mark.parametrize("push_n", [0.0, 2.0, 6.0])
@pytest.mark.parametrize("heading", [0.0, 2.1])
def test_a_trimmed_posture_is_in_balance_in_every_joint_of_the_model(
    vehicle, model, push_n, heading
):
    """Thrust along z_B, weight, load and the hinge's spring leave no acceleration."""
    goal = tool_at([1.0, 2.0, 3.0], heading)
    load = np.concatenate([-push_n * goal.R[:, 2], np.zeros(3)])
    able = vehicle.capabilities
    posture = able.solve({TOOL: goal}, {TOOL: load}, ANYWHERE)
    np.testing.assert_allclose(able.frame_pose(posture, TOOL)[0], goal.p, atol=1e-12)
    data = data_at(model, posture)
    z_B = data.body("hub").xmat.reshape(3, 3)[:, 2]
    assert np.hypot(z_B[0], z_B[1]) / z_B[2] == pytest.approx(push_n / (MASS * G), abs=1e-9)

    force = np.zeros(model.nv)
    body = int(model.site(TOOL).bodyid[0])
    mujoco.mj_applyFT(model, data, load[:3], np.zeros(3), data.site(TOOL).xpos, body, force)
    wanted = data.qfrc_bias - data.qfrc_passive - force
    # The rotors act on the free joint alone: the hinge must need nothing.
    assert wanted[model.joint("hinge").dofadr[0]] == pytest.approx(0.0, abs=1e-9)
    force_B = data.body("hub").xmat.reshape(3, 3).T @ wanted[:3]
    np.testing.assert_allclose(force_B[:2], 0.0, atol=1e-9)
    thrusts = np.linalg.pinv(able.allocation) @ [force_B[2], *wanted[3:6]]
    left = vehicle.platform.rotors.max_thrust_n - thrusts.max()
    assert able.margins(posture, {TOOL: load})["thrust"].value == pytest.approx(left, abs=1e-9)


def test_what_it_cannot_do_comes_with_the_reason(vehicle):
    able = vehicle.capabilities
    load = np.array([-80.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    refused = able.solve({TOOL: tool_at([1, 0, 2])}, {TOOL: load}, ANYWHERE)
    assert isinstance(refused, Shortfall)
    needed = np.hypot(80.0, MASS * G) - N_ROTORS * 12.0
    assert f"{needed:.2f} N more thrust" in refused.reason
    sideways = able.solve({FOOT: FramePose(np.zeros(3), np.eye(3))}, {FOOT: load / 40.0}, ANYWHERE)
    assert isinstance(sideways, Shortfall)
    assert "square" in sideways.reason
    upright = able.solve({TOOL: FramePose(np.zeros(3), np.eye(3))}, {}, ANYWHERE)
    assert isinstance(upright, Shortfall)


def test_the_foot_is_held_level_under_a_ceiling(vehicle):
    able, p = vehicle.capabilities, np.array([0.5, 0.0, 3.0])
    load = np.array([0.0, 0.0, -3.0, 0.0, 0.0, 0.0])
    posture = able.solve({FOOT: FramePose(p, np.eye(3))}, {FOOT: load}, ANYWHERE)
    np.testing.assert_allclose(posture.p_WB, p - [0.0, 0.0, 0.15], atol=1e-12)
    bare = able.margins(posture, FREE)["thrust"].value
    assert able.margins(posture, {FOOT: load})["thrust"].value == pytest.approx(
        bare - 3.0 / N_ROTORS
    )


def test_allocation_is_that_of_the_model(vehicle, model):
    data = mujoco.MjData(model)
    A = vehicle.capabilities.allocation
    for rotor in range(N_ROTORS):
        data.act[:] = 0.0
        data.act[model.actuator(f"rotor_{rotor}").actadr[0]] = 1.0
        mujoco.mj_forward(model, data)
        np.testing.assert_allclose(data.qfrc_actuator[2:6], A[:, rotor], atol=1e-12)
        np.testing.assert_allclose(data.qfrc_actuator[:2], 0.0, atol=1e-12)
        np.testing.assert_allclose(data.qfrc_actuator[6:], 0.0, atol=1e-12)
    assert np.linalg.matrix_rank(A) == 4


def test_the_level_arm_is_balanced_on_its_origin(model):
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    np.testing.assert_allclose(data.subtree_com[1], 0.0, atol=1e-9)
