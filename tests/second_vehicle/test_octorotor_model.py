"""The second vehicle's kinematics and allocation against its MuJoCo model."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from canted_octorotor.fixed_allocation import FixedAllocation

from inspect_cli.interfaces import FramePose, Posture
from inspect_cli.records import Command
from inspect_cli.spatial.rotations import matrix_to_quaternion, roll_pitch_yaw_matrix


@pytest.fixture(scope="module")
def model(vehicle):
    return vehicle.nominal_spec().compile()


def random_posture(rng, level=True):
    roll, pitch = (0.0, 0.0) if level else rng.uniform(-0.5, 0.5, 2)
    R_WB = roll_pitch_yaw_matrix(roll, pitch, rng.uniform(-np.pi, np.pi))
    return Posture(rng.normal(size=3), matrix_to_quaternion(R_WB), rng.uniform(-1.0, 1.0, 1))


def test_tool_frame_is_that_of_the_model(vehicle, model):
    rng = np.random.default_rng(1)
    data = mujoco.MjData(model)
    for _ in range(20):
        posture = random_posture(rng, level=False)
        data.qpos[:] = [*posture.p_WB, *posture.q_WB, *posture.joint_angle]
        mujoco.mj_kinematics(model, data)
        p_WT, R_WT = vehicle.capabilities.frame_pose(posture, "tool")
        tip = model.site("tool").id
        assert np.allclose(p_WT, data.site_xpos[tip], atol=1e-12)
        assert np.allclose(R_WT.ravel(), data.site_xmat[tip], atol=1e-12)


def test_solving_brings_the_tool_there(vehicle):
    rng = np.random.default_rng(2)
    able = vehicle.capabilities
    for _ in range(20):
        asked = random_posture(rng)
        goals = {"tool": FramePose(*able.frame_pose(asked, "tool"))}
        found = able.solve(goals, {}, random_posture(rng))
        assert np.allclose(found.p_WB, asked.p_WB, atol=1e-12)
        assert np.allclose(found.q_WB, asked.q_WB * np.sign(asked.q_WB @ found.q_WB), atol=1e-12)
        assert np.allclose(found.joint_angle, asked.joint_angle, atol=1e-12)


def test_allocation_is_that_of_the_model(vehicle, model):
    data = mujoco.MjData(model)
    A = FixedAllocation(vehicle.platform.rotors).matrix
    for rotor in range(8):
        data.act[:] = 0.0
        data.act[rotor] = 1.0
        mujoco.mj_forward(model, data)
        assert np.allclose(data.qfrc_actuator[:6], A[:, rotor], atol=1e-12)
    assert np.linalg.matrix_rank(A) == 6


def test_allocation_keeps_attitude_and_weight_before_anything_else(vehicle):
    allocation = FixedAllocation(vehicle.platform.rotors)
    command = Command.create(vehicle.capabilities.lengths)
    allocate = allocation.bind(np.array([0.0, 0.0, 32.0]), command)
    command.wrench_B[:] = [0.5, -0.4, 33.0, 0.2, -0.1, 0.05]
    allocate()
    assert command.saturated == 0.0
    assert np.allclose(command.allocated_B, command.wrench_B, atol=1e-9)
    command.wrench_B[:] = [60.0, 0.0, 33.0, 0.2, -0.1, 0.05]
    allocate()
    assert command.saturated == 1.0
    assert np.allclose(command.allocated_B[3:], command.wrench_B[3:], atol=1e-9)
    assert 0.0 < command.allocated_B[0] < 60.0
    assert command.allocated_B[2] >= 32.0 - 1e-9
    assert command.rotor_thrust.min() >= -1e-12
    assert command.rotor_thrust.max() <= 12.0 + 1e-12
