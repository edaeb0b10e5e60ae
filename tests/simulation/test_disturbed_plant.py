"""Disturbances in the physics: where they act, on which joints, and what they do not cost."""

from __future__ import annotations

from types import SimpleNamespace

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from worlds import command_of, placed, plant_of, structure_of, vehicle_at

from inspect_cli.schema.disturbances import Cable, ConstantWrench, Pull, Rope, Wind
from inspect_cli.schema.geometry import PlaneShape
from inspect_cli.schema.truth import ProximityEffects, TruePlatform
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.proximity import Proximity
from inspect_cli.vehicles.kinds import Vehicle

Array = np.ndarray
TILTED = Rotation.from_euler("zyx", [40, -25, 70], degrees=True).as_quat()[[3, 0, 1, 2]]
WALL = PlaneShape(center_m=(1.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(4.0, 3.0))
PULL = Pull(start_s=0.0, rise_s=0.1, hold_s=2.0, fall_s=0.1, force_n=5.0)
ROPE = Rope(kind="rope", direction=(0.6, 0.0, 0.8), pulls=(PULL,))
CABLE = Cable(kind="cable", length_m=6.0, mass_kgpm=0.05)
WIND = Wind(kind="wind", mean_mps=(6.0, 2.0, 0.0), drag_area_m2=(0.1, 0.2, 0.3), ramp_s=0.0)


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return vehicle_at(90.0)


def held(plant: Plant, t_s: float) -> None:
    plant.observe(t_s)
    plant.disturb(t_s)


@pytest.mark.parametrize(("pitch_deg", "entry"), [(90.0, ROPE), (150.0, ROPE), (90.0, CABLE)])
def test_a_force_on_the_tip_is_a_force_and_a_torque_about_the_body(
    pitch_deg: float, entry: Rope | Cable
) -> None:
    plant = plant_of(vehicle_at(pitch_deg), disturbances=[entry])
    placed(plant, [1.0, 2.0, 5.0], TILTED)
    held(plant, 0.0)
    held(plant, 1.0)
    force_W = plant.disturbances.load.force_tip_W.copy()
    assert np.linalg.norm(force_W) > 1.0
    plant.step(1)
    state = plant.observe(1.001)
    turn = Rotation.from_quat(np.roll(TILTED, -1)).inv()
    arm_B = pitch_arm(pitch_deg)
    force_B = turn.apply(force_W)
    np.testing.assert_allclose(state.wrench_ext_B[:3], force_B, atol=5e-3)
    np.testing.assert_allclose(state.wrench_ext_B[3:], np.cross(arm_B, force_B), atol=5e-3)
    np.testing.assert_array_equal(plant.data.qfrc_applied[6:], 0.0)  # no joint on the way


def pitch_arm(pitch_deg: float) -> Array:
    """p_BT of the built-in vehicle."""
    phi = np.radians(pitch_deg)
    return 0.55 * np.array([np.sin(phi), 0.0, -np.cos(phi)])


def test_the_torque_is_that_of_where_the_tip_is_now(vehicle: Vehicle) -> None:
    """After a step at 20 m/s the axes that MuJoCo keeps are 2 cm behind."""
    plant = plant_of(vehicle, disturbances=[ROPE])
    placed(plant, [0.0, 0.0, 50.0])
    held(plant, 0.0)
    plant.data.qvel[:3] = [0.0, 20.0, -20.0]
    plant.step(1)
    held(plant, 1.0)
    force_W = plant.disturbances.load.force_tip_W
    arm_W = plant.state.p_WT - plant.state.p_WB
    turn = Rotation.from_quat(np.roll(plant.state.q_WB, -1)).inv()
    torque_B = turn.apply(np.cross(arm_W, force_W))
    np.testing.assert_allclose(plant.data.qfrc_applied[3:6], torque_B, atol=1e-9)


def test_wind_drags_at_the_origin_and_turns_nothing(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle, disturbances=[WIND])
    placed(plant, [0.0, 0.0, 5.0])
    held(plant, 0.0)
    wind = np.array([6.0, 2.0, 0.0])
    expected = 0.5 * 1.225 * np.linalg.norm(wind) * wind * [0.1, 0.2, 0.3]
    np.testing.assert_allclose(plant.data.qfrc_applied[:3], expected)
    np.testing.assert_array_equal(plant.data.qfrc_applied[3:], 0.0)


def test_wind_carries_a_falling_vehicle_along(vehicle: Vehicle) -> None:
    """m v̇ = −½ ρ C_d A (v − V)²: V − v = V / (1 + ρ C_d A V t / 2 m) without gravity."""
    area, speed, mass = 0.5, 12.0, 4.75
    wind = WIND.model_copy(
        update={"mean_mps": (speed, 0.0, 0.0), "drag_area_m2": (area, area, area)}
    )
    plant = plant_of(vehicle, disturbances=[wind])
    plant.model.opt.gravity[:] = 0.0
    placed(plant, [0.0, 0.0, 5.0])
    for tick in range(1000):
        held(plant, 0.004 * tick)
        plant.step(4)
    slip = speed / (1.0 + 0.5 * 1.225 * area * speed * 4.0 / mass)
    assert plant.observe(4.0).v_WB_W[0] == pytest.approx(speed - slip, rel=2e-3)


def hinged(vehicle: Vehicle) -> Vehicle:
    """The vehicle with a joint between body and tool, which its Capabilities know nothing of."""

    def spec() -> mujoco.MjSpec:
        built = vehicle.nominal_spec()
        built.body("tool").add_joint(
            name="arm", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0, 1, 0], pos=[0, 0, 0.15]
        )
        return built

    names = (
        "platform", "capabilities", "bodies", "frames", "contacts", "joints", "posture_joints",
        "actuators", "flight_stack",
    )  # fmt: skip
    return SimpleNamespace(nominal_spec=spec, **{name: getattr(vehicle, name) for name in names})


def test_an_articulated_arm_is_turned_by_what_pulls_at_its_tip(vehicle: Vehicle) -> None:
    """The applied generalized force is Jᵀ f, J the finite differences of the tip's position."""
    structure = structure_of([])
    jointed = hinged(vehicle)
    model = build_world(jointed, TruePlatform(), structure)
    load = Disturbances([ROPE, WIND], np.random.default_rng(0), 250)
    calm = Proximity(
        ProximityEffects(ground=False, ceiling=False, wall=False),
        structure.solids,
        np.full(12, 0.1),
    )
    plant = Plant(model, jointed, vehicle.capabilities.lengths, structure.solids, load, calm, 250)
    placed(plant, [0.0, 0.0, 5.0], TILTED)
    plant.data.joint("arm").qpos[:] = 0.4
    held(plant, 0.0)
    held(plant, 1.0)
    base, tip = plant.data.qpos.copy(), plant.state.p_WT.copy()
    fresh = mujoco.MjData(model)
    jacobian = np.empty((3, model.nv))
    for k, nudge in enumerate(1e-6 * np.eye(model.nv)):
        fresh.qpos[:] = base
        mujoco.mj_integratePos(model, fresh.qpos, nudge, 1.0)
        mujoco.mj_kinematics(model, fresh)
        jacobian[:, k] = (fresh.site("tool").xpos - tip) / 1e-6
    expected = jacobian.T @ load.load.force_tip_W
    expected[:3] += load.load.force_W
    np.testing.assert_allclose(plant.data.qfrc_applied, expected, atol=1e-4)
    arm = model.joint("arm").dofadr[0]
    assert abs(expected[arm]) > 0.5
    # And it lets go again.
    held(plant, 9.0)
    np.testing.assert_array_equal(plant.data.qfrc_applied[6:], 0.0)


def test_a_shifted_centre_of_mass_turns_the_vehicle_that_hangs_on_its_rotors(
    vehicle: Vehicle,
) -> None:
    """All rotors up: the thrust through O_b turns about the centre of mass."""
    offset = np.array([0.0, 0.03, 0.0])
    rates = []
    for truth in (TruePlatform(), TruePlatform(com_offset_m=tuple(offset))):
        plant, command = plant_of(vehicle, truth=truth), command_of(vehicle)
        placed(plant, [0.0, 0.0, 5.0])
        plant.data.act[:12] = command.rotor_thrust[:] = 4.0
        plant.apply(command)
        plant.step(20)
        rates.append(plant.observe(0.0).w_WB_B.copy())
        model, data = plant.model, plant.data
        com = data.subtree_com[model.body("core").id] - data.qpos[:3]
    # The core is 2.76 kg of 4.75 kg. About x: the core itself, six groups of 0.29 kg at 0.30 m
    # and 0.15 m to the sides, and the core and the rest about their common centre.
    inertia = 0.009 + 0.29 * (2 * 0.30**2 + 4 * 0.15**2) + 0.03**2 * 2.76 * 1.99 / 4.75
    assert com[1] == pytest.approx(0.03 * 2.76 / 4.75, rel=0.02)
    turned = rates[1] - rates[0]
    assert turned[0] == pytest.approx(-com[1] * 48.0 * 0.020 / inertia, rel=0.03)
    assert np.abs(turned[1:]).max() < 0.1 * abs(turned[0])


def test_a_near_wall_takes_thrust_off_the_rotors_beside_it(vehicle: Vehicle) -> None:
    lifts = []
    for wall in (False, True):
        effects = ProximityEffects(ground=False, ceiling=False, wall=wall)
        plant = plant_of(vehicle, structure_of([WALL]), effects=effects)
        placed(plant, [0.55, 0.0, 1.5])
        plant.data.act[:12] = 4.0
        plant.feel_surroundings()
        mujoco.mj_forward(plant.model, plant.data)
        lifts.append(plant.data.qfrc_actuator[2])
    distances = 0.45 - 0.3 * np.cos(np.radians([-90, 90, 30, -150, -30, 150]))
    lost = 8.0 * np.sum(0.03 * np.exp(-distances / 0.1143))
    assert lifts[0] - lifts[1] == pytest.approx(lost, rel=1e-6)


def test_constant_loads_alone_leave_the_joints_alone(vehicle: Vehicle) -> None:
    wrench = ConstantWrench(force_n=(1.0, 2.0, 3.0), torque_nm=(0.1, 0.2, 0.3), ramp_s=0.0)
    plant = plant_of(vehicle, disturbances=[wrench])
    placed(plant, [0.0, 0.0, 5.0])
    held(plant, 0.0)
    np.testing.assert_allclose(plant.data.qfrc_applied[:6], [1, 2, 3, 0.1, 0.2, 0.3], atol=1e-12)
    np.testing.assert_array_equal(plant.data.qfrc_applied[6:], 0.0)
