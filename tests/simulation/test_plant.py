"""The true State against independent readings, and what commands do to the actuators."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from scipy import signal
from scipy.spatial.transform import Rotation
from worlds import UPRIGHT, command_of, hold_attitude, placed, plant_of, structure_of, vehicle_at

from inspect_cli.schema.disturbances import ConstantWrench
from inspect_cli.schema.geometry import PlaneShape
from inspect_cli.schema.truth import ProximityEffects, TruePlatform
from inspect_cli.simulation.plant import Plant
from inspect_cli.vehicles.kinds import Vehicle

Array = np.ndarray
DT = 1e-3
TILTED = Rotation.from_euler("zyx", [40, -25, 70], degrees=True).as_quat()[[3, 0, 1, 2]]
WALL = PlaneShape(center_m=(1.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(4.0, 3.0))


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return vehicle_at(90.0)


def tumble(plant: Plant, vehicle: Vehicle, ticks: int = 50) -> None:
    """Fly wildly for a while: all twelve rotors and six tilts move."""
    command, rng = command_of(vehicle), np.random.default_rng(0)
    for tick in range(ticks):
        t_s = 4 * DT * tick
        plant.observe(t_s)
        plant.disturb(t_s)
        command.rotor_thrust[:] = rng.uniform(0.0, 8.0, 12)
        command.joint_angle[:] = np.sin(5.0 * t_s + np.arange(6))
        plant.apply(command)
        plant.step(4)


def test_pose_and_velocity_are_mujocos_own(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0], -TILTED)
    tumble(plant, vehicle)
    state, model = plant.observe(0.2), plant.model
    fresh = mujoco.MjData(model)
    fresh.qpos[:], fresh.qvel[:] = plant.data.qpos, plant.data.qvel
    mujoco.mj_forward(model, fresh)
    velocity, kind = np.zeros(6), mujoco.mjtObj.mjOBJ_XBODY
    mujoco.mj_objectVelocity(model, fresh, kind, model.body("core").id, velocity, 0)
    R_WB = fresh.body("core").xmat.reshape(3, 3)
    np.testing.assert_allclose(state.p_WB, fresh.body("core").xpos, atol=1e-12)
    np.testing.assert_allclose(state.v_WB_W, velocity[3:], atol=1e-9)
    np.testing.assert_allclose(R_WB @ state.w_WB_B, velocity[:3], atol=1e-9)
    np.testing.assert_allclose(
        Rotation.from_quat(np.roll(state.q_WB, -1)).as_matrix(), R_WB, atol=1e-12
    )
    assert state.q_WB[0] >= 0.0
    np.testing.assert_allclose(state.p_WT, fresh.site("tool").xpos, atol=1e-12)
    R_WT = Rotation.from_quat(np.roll(state.q_WT, -1)).as_matrix()
    np.testing.assert_allclose(R_WT, fresh.site("tool").xmat.reshape(3, 3), atol=1e-9)
    np.testing.assert_array_equal(state.joint_angle, plant.data.qpos[7:])
    np.testing.assert_array_equal(state.joint_rate, plant.data.qvel[6:])
    assert state.t_s == 0.2


def test_velocity_and_acceleration_are_derivatives(vehicle: Vehicle) -> None:
    """Over one step: exact for the acceleration but for the servos' implicit damping."""
    plant = plant_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0], TILTED)
    for _ in range(10):
        tumble(plant, vehicle, 5)
        before = np.array(plant.data.qpos), np.array(plant.data.qvel)
        plant.step(1)
        state = plant.observe(0.0)
        np.testing.assert_allclose((state.p_WB - before[0][:3]) / DT, state.v_WB_W, atol=1e-9)
        turn = Rotation.from_quat(np.roll(before[0][3:7], -1)).inv() * Rotation.from_quat(
            np.roll(state.q_WB, -1)
        )
        np.testing.assert_allclose(turn.as_rotvec() / DT, state.w_WB_B, atol=1e-6)
        np.testing.assert_allclose((state.v_WB_W - before[1][:3]) / DT, state.a_WB_W, atol=1e-5)
        np.testing.assert_allclose(
            (state.w_WB_B - before[1][3:6]) / DT, state.alpha_WB_B, atol=0.15
        )


def test_the_external_wrench_is_what_was_applied(vehicle: Vehicle) -> None:
    applied = ConstantWrench(
        frame="body", force_n=(1.0, 2.0, 3.0), torque_nm=(0.1, 0.2, 0.3), ramp_s=0.0
    )
    plant = plant_of(vehicle, disturbances=[applied])
    placed(plant, [0.0, 0.0, 5.0], TILTED)
    plant.disturb(0.0)
    plant.step(1)
    state = plant.observe(DT)
    np.testing.assert_allclose(state.wrench_ext_B, [1, 2, 3, 0.1, 0.2, 0.3], atol=1e-2)
    # And it does what such a wrench does to a rigid body, beside gravity.
    R = Rotation.from_quat(np.roll(TILTED, -1)).as_matrix()
    np.testing.assert_allclose(state.a_WB_W, R @ [1, 2, 3] / 4.75 - [0, 0, 9.81], atol=2e-3)


def test_the_external_wrench_balances_the_momentum(vehicle: Vehicle) -> None:
    """Pressed on a wall: d(momentum)/dt = rotors + weight + what State calls external."""
    plant = plant_of(vehicle, structure_of([WALL]))
    model, data = plant.model, plant.data
    placed(plant, [0.449, 0.0, 1.5])
    command = command_of(vehicle)
    command.rotor_thrust[:] = 4.0
    command.joint_angle[:] = 0.1 * np.arange(6)
    core = model.body("core").id

    def momentum() -> Array:
        fresh = mujoco.MjData(model)
        fresh.qpos[:], fresh.qvel[:], fresh.act[:] = data.qpos, data.qvel, data.act
        mujoco.mj_forward(model, fresh)
        mujoco.mj_subtreeVel(model, fresh)
        p = model.body_subtreemass[core] * fresh.subtree_linvel[core]
        return np.concatenate([p, fresh.subtree_angmom[core], fresh.subtree_com[core]])

    touched = 0
    for _ in range(100):
        plant.apply(command)
        data.qfrc_applied[:6] = [20.0, 3.0, 0.0, 0.0, 0.0, 0.4]
        first = momentum()
        plant.step(1)
        last = momentum()
        state = plant.observe(0.0)
        R = data.body("core").xmat.reshape(3, 3)
        rotors = data.qfrc_actuator[:6]
        force_W = rotors[:3] + R @ state.wrench_ext_B[:3]
        weight = np.array([0.0, 0.0, -9.81 * model.body_subtreemass[core]])
        np.testing.assert_allclose((last - first)[:3] / DT, force_W + weight, atol=0.05)
        torque_O = R @ (rotors[3:6] + state.wrench_ext_B[3:])
        torque_com = torque_O - np.cross(first[6:] - state.p_WB, force_W)
        np.testing.assert_allclose((last - first)[3:6] / DT, torque_com, atol=0.02)
        touched += state.f_normal > 1.0
    assert touched > 20  # or the wall had no part in it


def test_the_force_on_the_tip_points_out_of_the_wall_and_pressing_is_positive(
    vehicle: Vehicle,
) -> None:
    plant = plant_of(vehicle, structure_of([WALL]))
    plant.model.opt.gravity[:] = 0.0
    placed(plant, [0.45, 0.0, 1.5])
    for _ in range(1500):
        plant.data.qfrc_applied[0] = 5.0
        hold_attitude(plant.data, UPRIGHT)
        plant.step(1)
    state = plant.observe(1.5)
    np.testing.assert_allclose(state.f_tool_W, [-5.0, 0.0, 0.0], atol=0.01)
    assert state.f_normal == pytest.approx(5.0, abs=0.01)
    assert state.f_body == 0.0


def test_a_blow_on_the_shell_is_a_force_on_the_body(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle, structure_of([WALL]))
    plant.model.opt.gravity[:] = 0.0
    turned_away = Rotation.from_euler("z", 180, degrees=True).as_quat()[[3, 0, 1, 2]]
    # The rearmost guards reach 0.26 m + 0.114 m behind O_b.
    placed(plant, [0.63, 0.0, 1.5], turned_away)
    for _ in range(1500):
        plant.data.qfrc_applied[0] = 5.0
        hold_attitude(plant.data, turned_away)
        plant.step(1)
    state = plant.observe(1.5)
    assert state.f_body == pytest.approx(5.0, abs=0.05)
    assert np.linalg.norm(state.f_tool_W) == 0.0
    np.testing.assert_allclose(state.wrench_ext_B[0], 0.0, atol=0.05)


def test_standing_on_the_gear_is_no_force_on_the_body(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle)
    placed(plant, [0.0, 0.0, vehicle.capabilities.standing_height_m])
    plant.step(1000)
    state = plant.observe(1.0)
    assert state.f_body == 0.0
    assert np.linalg.norm(state.f_tool_W) == 0.0
    assert state.p_WB[2] == pytest.approx(vehicle.capabilities.standing_height_m, abs=2e-3)
    np.testing.assert_allclose(state.wrench_ext_B[:3], [0.0, 0.0, 4.75 * 9.81], atol=0.05)


@pytest.mark.parametrize(("start", "goal", "lag_s"), [(0.0, 6.0, 0.0125), (6.0, 1.0, 0.025)])
def test_rotors_follow_with_the_lag_of_their_direction(
    vehicle: Vehicle, start: float, goal: float, lag_s: float
) -> None:
    plant, command = plant_of(vehicle), command_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    plant.data.act[:12] = start
    command.rotor_thrust[:] = goal
    for tick in range(1, 20):
        plant.apply(command)
        plant.step(4)
        expected = goal + (start - goal) * np.exp(-4 * DT * tick / lag_s)
        np.testing.assert_allclose(plant.observe(0.0).rotor_thrust, expected, rtol=1e-9)


def test_rotors_take_each_their_own_direction(vehicle: Vehicle) -> None:
    plant, command = plant_of(vehicle), command_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    plant.data.act[:12] = 5.0
    command.rotor_thrust[:6], command.rotor_thrust[6:] = 8.0, 2.0
    plant.apply(command)
    plant.step(4)
    thrust = plant.observe(0.0).rotor_thrust
    np.testing.assert_allclose(thrust[:6], 8.0 - 3.0 * np.exp(-0.004 / 0.0125))
    np.testing.assert_allclose(thrust[6:], 2.0 + 3.0 * np.exp(-0.004 / 0.025))


def test_no_rotor_pulls_or_exceeds_its_limit(vehicle: Vehicle) -> None:
    plant, command = plant_of(vehicle), command_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    command.rotor_thrust[:6], command.rotor_thrust[6:] = -5.0, 50.0
    for _ in range(100):
        plant.apply(command)
        plant.step(4)
    thrust = plant.observe(0.0).rotor_thrust
    np.testing.assert_allclose(thrust[:6], 0.0, atol=1e-9)
    np.testing.assert_allclose(thrust[6:], 20.0, atol=1e-6)


def turn(plant: Plant, vehicle: Vehicle, angle: float, ticks: int) -> tuple[Array, Array]:
    """Angles and rates (4 ticks, 6) of all tilts at every step."""
    command = command_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    plant.model.opt.gravity[:] = 0.0
    command.joint_angle[:] = angle
    angles, rates = [], []
    for _ in range(ticks):
        plant.apply(command)
        for _ in range(4):
            plant.step(1)
            angles.append(np.array(plant.data.qpos[7:]))
            rates.append(np.array(plant.data.qvel[6:]))
    return np.array(angles), np.array(rates)


def test_tilts_turn_at_most_at_their_rate(vehicle: Vehicle) -> None:
    angles, rates = turn(plant_of(vehicle), vehicle, 3.0, 150)
    assert rates.max() == pytest.approx(8.0, rel=0.01)
    # Three radians at 8 rad/s and the lags of servo and inner loop: 20 ms + 2/120 s.
    arrival = np.argmax(angles[:, 0] > 1.5) * DT
    assert arrival == pytest.approx(1.5 / 8.0 + 0.020 + 2.0 / 120.0, abs=0.006)
    np.testing.assert_allclose(angles[-1], 3.0, atol=1e-3)
    assert angles.max() < 3.01


def test_a_small_tilt_follows_the_servos_lag(vehicle: Vehicle) -> None:
    angles, _ = turn(plant_of(vehicle), vehicle, 0.02, 40)
    # First-order lag of 20 ms, then a critically damped loop of 120 rad/s.
    loop = np.polymul([0.020, 1.0], [1.0, 240.0, 120.0**2])
    times = np.arange(1, len(angles) + 1) * DT
    _, expected = signal.step(([120.0**2], loop), T=times)
    np.testing.assert_allclose(angles[:, 0] / 0.02, expected, atol=0.03)


def test_the_true_mass_is_the_nominal_times_its_factor(vehicle: Vehicle) -> None:
    nominal = plant_of(vehicle).model
    heavy = plant_of(vehicle, truth=TruePlatform(mass_factor=1.1)).model
    for body in ("core", "tool", "group_0", "group_5"):
        assert heavy.body(body).mass[0] == pytest.approx(1.1 * nominal.body(body).mass[0])
        np.testing.assert_allclose(heavy.body(body).inertia, 1.1 * nominal.body(body).inertia)
    assert heavy.body_subtreemass[0] == pytest.approx(1.1 * 4.75, rel=1e-6)


def test_the_true_centre_of_mass_is_shifted(vehicle: Vehicle) -> None:
    nominal = plant_of(vehicle).model
    shifted = plant_of(vehicle, truth=TruePlatform(com_offset_m=(0.01, -0.02, 0.03))).model
    offset = shifted.body("core").ipos - nominal.body("core").ipos
    np.testing.assert_allclose(offset, [0.01, -0.02, 0.03], atol=1e-12)


def test_near_surfaces_change_the_thrust_that_acts(vehicle: Vehicle) -> None:
    soffit = PlaneShape(center_m=(0.0, 0.0, 3.0), normal=(0.0, 0.0, -1.0), size_m=(4.0, 4.0))
    ceiling = ProximityEffects(ground=False, wall=False)
    pushed = []
    for effects in (ProximityEffects(ground=False, ceiling=False, wall=False), ceiling):
        plant = plant_of(vehicle, structure_of([soffit]), effects=effects)
        placed(plant, [0.0, 0.0, 2.85])
        plant.data.act[:12] = 4.0
        plant.feel_surroundings()
        mujoco.mj_forward(plant.model, plant.data)
        pushed.append(plant.data.qfrc_actuator[2])
    assert pushed[0] == pytest.approx(48.0)
    # Upper rotors 0.12 m and lower ones 0.18 m below it: γ^(2/3) by hand.
    gamma = [0.5 + 0.5 * np.sqrt(1.0 + (0.1143 / d) ** 2 / 8.0) for d in (0.12, 0.18)]
    assert pushed[1] == pytest.approx(24.0 * sum(g ** (2.0 / 3.0) for g in gamma), rel=1e-9)


def test_a_warning_of_mujoco_is_divergence(vehicle: Vehicle) -> None:
    plant, command = plant_of(vehicle), command_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    assert plant.diverged == ""
    command.rotor_thrust[3] = np.nan
    plant.apply(command)
    plant.step(1)
    assert "BADCTRL" in plant.diverged


def test_placing_starts_afresh(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle)
    placed(plant, [0.0, 0.0, 5.0])
    tumble(plant, vehicle)
    placed(plant, [1.0, 2.0, 3.0], TILTED)
    state = plant.observe(0.0)
    np.testing.assert_array_equal(state.p_WB, [1.0, 2.0, 3.0])
    for motion in (state.v_WB_W, state.w_WB_B, state.joint_angle, state.rotor_thrust):
        np.testing.assert_array_equal(motion, 0.0)
