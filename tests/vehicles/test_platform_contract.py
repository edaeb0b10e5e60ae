"""What every vehicle owes planner and simulator, for each built-in platform and profile."""

from __future__ import annotations

from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.errors import InputError
from inspect_cli.interfaces import FramePose, Posture
from inspect_cli.records import Pose
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.plan import Plan, PostureModel
from inspect_cli.schema.truth import TruePlatform
from inspect_cli.simulation.addresses import addresses_of
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.geometry import structure_of
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.kinds import Vehicle

PLATFORMS = sorted((Path(__file__).resolve().parents[2] / "platforms").glob("*.yaml"))


@pytest.fixture(params=PLATFORMS, ids=lambda path: path.stem, scope="module")
def vehicle(request: pytest.FixtureRequest) -> Vehicle:
    platform = load_platform(request.param)
    return build_vehicle(platform)


@pytest.fixture(scope="module")
def model(vehicle: Vehicle) -> mujoco.MjModel:
    return vehicle.nominal_spec().compile()


def random_posture(vehicle: Vehicle, rng: np.random.Generator) -> Posture:
    n_arm = vehicle.capabilities.lengths.get("n_arm", 0)
    q_WB = Rotation.random(rng=rng).as_quat()[[3, 0, 1, 2]]
    return Posture(rng.normal(size=3), q_WB, rng.uniform(-0.5, 0.5, n_arm))


def test_bodies_and_actuators_stand_where_the_plant_looks(
    vehicle: Vehicle, model: mujoco.MjModel
) -> None:
    lengths, bodies = vehicle.capabilities.lengths, vehicle.bodies
    addresses_of(build_world(vehicle, TruePlatform(), structure_of([])), vehicle, lengths)
    core = model.body(bodies.base).id
    assert core == 1
    for name in (*bodies.protected, *bodies.gear):
        assert model.body(name).rootid[0] == core
    for contact in vehicle.contacts:
        for name in contact.geoms:
            assert model.geom(name).conaffinity[0]
    assert model.nu == model.na == lengths["n_rotors"] + lengths["n_joints"]
    assert model.nv == 6 + lengths["n_joints"]
    transmissions = model.actuator_trntype
    assert (transmissions[: lengths["n_rotors"]] == mujoco.mjtTrn.mjTRN_SITE).all()
    joints = model.actuator_trnid[lengths["n_rotors"] :, 0]
    np.testing.assert_array_equal(joints, 1 + np.arange(lengths["n_joints"]))
    for actuator in vehicle.actuators:
        assert all(value > 0.0 for name, value in vars(actuator).items() if name.endswith("_s"))


def test_gravity_is_the_one_that_estimation_assumes(model: mujoco.MjModel) -> None:
    np.testing.assert_array_equal(model.opt.gravity, [0.0, 0.0, -9.81])


def test_the_tool_is_where_the_model_has_it(vehicle: Vehicle, model: mujoco.MjModel) -> None:
    data, rng = mujoco.MjData(model), np.random.default_rng(1)
    for _ in range(20):
        posture = random_posture(vehicle, rng)
        data.qpos[:3], data.qpos[3:7] = posture.p_WB, posture.q_WB
        data.qpos[7:] = rng.uniform(-1.0, 1.0, model.nq - 7)
        if posture.joint_angle.size:
            data.qpos[-posture.joint_angle.size :] = posture.joint_angle
        mujoco.mj_kinematics(model, data)
        p_WT, R_WT = vehicle.capabilities.frame_pose(posture, "tool")
        site = data.site("tool")
        np.testing.assert_allclose(p_WT, site.xpos, atol=1e-9)
        np.testing.assert_allclose(R_WT, site.xmat.reshape(3, 3), atol=1e-9)
        # The tip's sphere ends in the site, on the tool's axis.
        tip = data.geom("tip").xpos
        radius = model.geom("tip").size[0]
        np.testing.assert_allclose(tip + radius * R_WT[:, 2], p_WT, atol=1e-9)


def test_a_posture_for_a_tool_puts_it_there(vehicle: Vehicle) -> None:
    rng = np.random.default_rng(2)
    for _ in range(20):
        wanted = random_posture(vehicle, rng)
        p_WT, R_WT = vehicle.capabilities.frame_pose(wanted, "tool")
        found = vehicle.capabilities.solve({"tool": FramePose(p_WT, R_WT)}, {}, wanted)
        assert isinstance(found, Posture)
        p, R = vehicle.capabilities.frame_pose(found, "tool")
        np.testing.assert_allclose(p, p_WT, atol=1e-6)
        np.testing.assert_allclose(R, R_WT, atol=1e-6)


def test_it_balances_on_its_origin(vehicle: Vehicle, model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    assert np.linalg.norm(data.subtree_com[1]) < 1e-3


def test_it_stands_on_its_feet(vehicle: Vehicle, model: mujoco.MjModel) -> None:
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    gear = model.body("gear").id
    feet = [g for g in range(model.ngeom) if model.geom_bodyid[g] == gear]
    lowest = min(data.geom_xpos[g][2] - model.geom_size[g][0] for g in feet)
    assert lowest == pytest.approx(-vehicle.capabilities.standing_height_m, abs=1e-9)
    for name in ("shell", "tool"):
        body = model.body(name).id
        for g in np.flatnonzero((model.geom_bodyid == body) & (model.geom_conaffinity > 0)):
            assert data.geom_xpos[g][2] - model.geom_rbound[g] > lowest


def test_the_stack_starts_idle_and_hovers_when_it_flies(vehicle: Vehicle) -> None:
    """At rest on its reference, the thrusts carry the nominal weight."""
    start = PostureModel(p_WB=(1.0, 2.0, 3.0), q_WB=(1.0, 0.0, 0.0, 0.0))
    stack, pose = (
        vehicle.flight_stack(Plan.model_construct(surfaces=(), start=start)),
        Pose.create(),
    )
    pose.p_WB[:], pose.q_WB[:] = start.p_WB, start.q_WB
    stack.start(pose)
    stack.control(0.0)
    assert not stack.command.rotor_thrust.any()
    stack.armed = True
    stack.control(0.004)
    np.testing.assert_allclose(stack.reference.p_WB, start.p_WB)
    mass = float(vehicle.nominal_spec().compile().body_subtreemass[1])
    # The observer has seen one period of a vehicle that does not fall: a trace of support.
    assert stack.command.allocated_B[2] == pytest.approx(9.81 * mass, rel=0.01)
    assert stack.command.saturated == 0.0


def test_a_kind_that_nobody_knows_is_refused() -> None:
    platform = load_platform(PLATFORMS[0]).model_copy(update={"kind": "balloon"})
    with pytest.raises(InputError, match="balloon"):
        build_vehicle(platform)
