"""The allocation against MuJoCo's wrench, hand rules and bisection."""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.control.tilt_allocation import MIN_STEERING_THRUST_N, TiltAllocation
from inspect_cli.records import Command
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.tilt_rotor.model import build_spec, group_kappa_m

Pitched = Callable[[float], TiltRotorPlatform]
Array = np.ndarray
LIMIT_N = 20.0


class Bench:
    """An allocation, its command, and the model that shows what the command does."""

    def __init__(self, platform: TiltRotorPlatform) -> None:
        azimuth = np.radians([group.azimuth_deg for group in platform.groups])
        self.n = len(azimuth)
        self.allocation = TiltAllocation(
            azimuth,
            platform.unit.distance_m,
            group_kappa_m(platform),
            platform.unit.max_thrust_n,
        )
        self.command = Command.create({"n_rotors": 2 * self.n, "n_servos": self.n})
        self.weight_B = np.zeros(3)
        self.allocated = self.allocation.bind(self.weight_B, self.command)
        self.model = build_spec(platform).compile()
        self.data = mujoco.MjData(self.model)
        self.body = nominal_body(build_spec(platform))

    def allocate(self, wrench_B: Array, weight_B: Array | None = None) -> Array:
        """Allocate; return the granted wrench."""
        self.command.wrench_B[:] = wrench_B
        self.weight_B[:] = 0.0 if weight_B is None else weight_B
        self.allocated()
        return np.array(self.command.allocated_B)

    def produced(self, q_WB: Array) -> Array:
        """The wrench of the command's rotors on the model, about O_b in B."""
        return self.wrench_of(self.command.rotor_thrust, self.command.joint_angle, q_WB)

    def wrench_of(self, thrust: Array, tilt: Array, q_WB: Array) -> Array:
        data = self.data
        mujoco.mj_resetData(self.model, data)
        data.qpos[3:7], data.qpos[7:] = q_WB, tilt
        data.act[: 2 * self.n], data.act[2 * self.n :] = thrust, tilt
        mujoco.mj_forward(self.model, data)
        R = Rotation.from_quat(data.qpos[[4, 5, 6, 3]]).as_matrix()
        # A free joint's generalized force is the force in W and the torque about O_b in B.
        return np.concatenate([R.T @ data.qfrc_actuator[:3], data.qfrc_actuator[3:6]])

    def group_thrust(self) -> Array:
        return self.command.rotor_thrust.reshape(-1, 2).sum(axis=1)

    def needed(self, wrench_B: Array) -> Array:
        """(2n,) = (s, c) of the least-norm solution, by least squares on the model's columns."""
        columns = [
            self.wrench_of(np.repeat(unit, 2) * 0.5, np.full(self.n, tilt), np.eye(4)[0])
            for tilt in (0.5 * np.pi, 0.0)
            for unit in np.eye(self.n)
        ]
        return np.linalg.lstsq(np.array(columns).T, wrench_B, rcond=None)[0]


@pytest.fixture
def bench(pitched: Pitched) -> Bench:
    return Bench(pitched(90.0))


def random_attitude(rng: np.random.Generator) -> Array:
    return Rotation.random(rng=rng).as_quat()[[3, 0, 1, 2]]


def test_the_model_produces_what_was_asked(bench: Bench) -> None:
    rng = np.random.default_rng(1)
    for _ in range(200):
        force = rng.normal(size=3)
        force *= rng.uniform(5.0, 55.0) / np.linalg.norm(force)
        wrench = np.concatenate([force, rng.uniform(-1.0, 1.0, 3)])
        granted = bench.allocate(wrench, force)
        assert bench.command.saturated == 0.0
        np.testing.assert_allclose(granted, wrench, atol=1e-10)
        np.testing.assert_allclose(bench.produced(random_attitude(rng)), wrench, atol=1e-10)


def test_the_rotors_change_the_momentum_as_was_asked(bench: Bench) -> None:
    """The same by momentum alone: one free step without gravity, finite differences."""
    model, data = bench.model, bench.data
    model.opt.gravity[:] = 0.0
    q_WB = random_attitude(np.random.default_rng(2))
    wrench = np.array([12.0, -7.0, 30.0, 0.6, -0.4, 0.3])
    bench.allocate(wrench, wrench[:3])
    bench.produced(q_WB)  # sets attitude, tilts and thrusts
    origin = np.zeros(3)
    mujoco.mj_subtreeVel(model, data)
    mujoco.mj_step(model, data)
    mujoco.mj_forward(model, data)
    mujoco.mj_subtreeVel(model, data)
    core = model.body("core").id
    dt, mass = model.opt.timestep, bench.body.mass_kg
    linear = mass * data.subtree_linvel[core]
    angular = data.subtree_angmom[core] + np.cross(data.subtree_com[core] - origin, linear)
    R = Rotation.from_quat(np.roll(q_WB, -1)).as_matrix()
    np.testing.assert_allclose(R.T @ linear / dt, wrench[:3], atol=1e-3)
    np.testing.assert_allclose(R.T @ angular / dt, wrench[3:], atol=1e-3)


def test_every_rotor_by_hand(bench: Bench, pitched: Pitched) -> None:
    """Level, one newton from one rotor: up, about the hub's lever, and against its spin."""
    platform = pitched(90.0)
    d, unit = platform.unit.distance_m, platform.unit
    for index, group in enumerate(platform.groups):
        psi = np.radians(group.azimuth_deg)
        hub = np.array([d * np.cos(psi), d * np.sin(psi), 0.0])
        upper_is_ccw = group.upper_spin == "ccw"
        for lower, constant in (
            (0, unit.moment_constant_upper_m),
            (1, unit.moment_constant_lower_m),
        ):
            thrust = np.zeros(12)
            thrust[2 * index + lower] = 1.0
            wrench = bench.wrench_of(thrust, np.zeros(6), np.eye(4)[0])
            ccw = upper_is_ccw if lower == 0 else not upper_is_ccw
            # The air turns with the rotor, the body against it: clockwise is negative yaw.
            yaw = -constant if ccw else constant
            np.testing.assert_allclose(wrench[:3], [0.0, 0.0, 1.0], atol=1e-12)
            np.testing.assert_allclose(wrench[3:], [hub[1], -hub[0], yaw], atol=1e-12)
            assert bench.model.actuator(2 * index + lower).name.endswith(("upper", "lower")[lower])


def test_a_positive_tilt_of_the_right_group_pushes_backwards(bench: Bench) -> None:
    """Right-handed about the arm that points to −y: z turns towards −x."""
    thrust, tilt = np.zeros(12), np.zeros(6)
    thrust[:2], tilt[0] = 0.5, np.radians(90.0)
    wrench = bench.wrench_of(thrust, tilt, np.eye(4)[0])
    np.testing.assert_allclose(wrench[:3], [-1.0, 0.0, 0.0], atol=1e-12)
    # Pushing backwards on the right turns the nose to the right, which is negative yaw.
    assert wrench[5] == pytest.approx(-0.3, abs=0.01)


def test_yaw_torque_tilts_all_groups_the_same_way_round(bench: Bench) -> None:
    bench.allocate(np.array([0.0, 0.0, 46.6, 0.0, 0.0, 1.0]), np.array([0.0, 0.0, 46.6]))
    for group, tilt in enumerate(bench.command.joint_angle):
        # From above, every thrust leans counter-clockwise about the body: against a × z.
        assert tilt < 0.0, group


def test_the_matrix_is_the_models(bench: Bench) -> None:
    """Column by column: s_i is a group's thrust at 90°, c_i upright."""
    for index in range(6):
        for column, tilt in ((index, 0.5 * np.pi), (6 + index, 0.0)):
            thrust = np.repeat(np.eye(6)[index], 2) * 0.5
            wrench = bench.wrench_of(thrust, np.full(6, tilt), np.eye(4)[0])
            np.testing.assert_allclose(bench.allocation.matrix[:, column], wrench, atol=1e-12)


def test_hover_thrust_carries_the_weight_in_every_attitude(bench: Bench) -> None:
    mass, com = bench.body.mass_kg, bench.body.com_B
    rng = np.random.default_rng(3)
    largest = 0.0
    for _ in range(200):
        q_WB = random_attitude(rng)
        R = Rotation.from_quat(np.roll(q_WB, -1)).as_matrix()
        up = R.T @ np.array([0.0, 0.0, mass * 9.81])
        bench.allocate(np.concatenate([up, np.cross(com, up)]), up)
        wrench = bench.produced(q_WB)
        np.testing.assert_allclose(R @ wrench[:3], [0.0, 0.0, mass * 9.81], atol=1e-9)
        # The model's own gravity is balanced: nothing accelerates.
        np.testing.assert_allclose(bench.data.qacc, 0.0, atol=1e-6)
        largest = max(largest, float(bench.group_thrust().max()))
    assert largest < LIMIT_N  # it hovers in any attitude
    level = np.array([0.0, 0.0, mass * 9.81, 0.0, 0.0, 0.0])
    bench.allocate(level, level[:3])
    assert bench.command.rotor_thrust.sum() == pytest.approx(mass * 9.81, rel=1e-9)


def test_tilts_follow_two_whole_turns_without_a_jump(bench: Bench) -> None:
    mass = bench.body.mass_kg
    angles = np.linspace(0.0, 4.0 * np.pi, 2001)
    tilts = []
    for pitch in angles:
        up = Rotation.from_euler("y", pitch).inv().apply([0.0, 0.0, mass * 9.81])
        wrench = np.concatenate([up, [0.02, 0.05, -0.1]])
        bench.allocate(wrench, up)
        np.testing.assert_allclose(bench.produced(np.eye(4)[0]), wrench, atol=1e-9)
        tilts.append(np.array(bench.command.joint_angle))
    # A tilt moves at most a few times as fast as the body: 4π/2000 rad per sample.
    assert np.abs(np.diff(tilts, axis=0)).max() < 0.1
    assert abs(tilts[-1][0]) == pytest.approx(4.0 * np.pi, abs=0.1)  # the right arm, along −y
    np.testing.assert_allclose(
        np.cos(tilts[-1]), np.cos(tilts[0]), atol=1e-6
    )  # the same wrench, whole turns later


def test_tilts_stay_where_they_are_near_zero_thrust(bench: Bench) -> None:
    up = np.array([5.0, 3.0, 40.0])
    bench.allocate(np.concatenate([up, np.zeros(3)]), up)
    before = np.array(bench.command.joint_angle)
    rng = np.random.default_rng(4)
    for _ in range(100):
        wrench = rng.normal(size=6) * [0.05, 0.05, 0.05, 0.003, 0.003, 0.003]
        bench.allocate(wrench)
        assert bench.group_thrust().max() < MIN_STEERING_THRUST_N  # or this test says nothing
        np.testing.assert_array_equal(bench.command.joint_angle, before)
    bench.allocate(np.zeros(6))
    np.testing.assert_array_equal(bench.command.joint_angle, before)
    np.testing.assert_array_equal(bench.command.rotor_thrust, 0.0)


def largest_share(base: Array, extra: Array) -> float:
    """The largest λ in [0, 1] that keeps base + λ extra within the limit, by bisection."""

    def fits(share: float) -> bool:
        s, c = np.split(base + share * extra, 2)
        return bool(np.hypot(s, c).max() <= LIMIT_N * (1.0 + 1e-12))

    if fits(1.0):
        return 1.0
    low, high = 0.0, 1.0
    for _ in range(60):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if fits(middle) else (low, middle)
    return low


def test_torque_is_granted_first_then_the_weight_then_the_rest(bench: Bench) -> None:
    rng = np.random.default_rng(5)
    partly = {"torque": 0, "weight": 0, "rest": 0}
    for _ in range(300):
        torque = rng.normal(size=3) * rng.choice([0.5, 5.0, 20.0])
        weight = rng.normal(size=3)
        weight *= 46.6 / np.linalg.norm(weight)
        rest = rng.normal(size=3) * rng.choice([1.0, 20.0, 100.0])
        zero = np.zeros(3)
        parts = [
            np.concatenate([zero, torque]),
            np.concatenate([weight, zero]),
            np.concatenate([rest, zero]),
        ]
        total, expected, shares = np.zeros(12), np.zeros(6), []
        for part in parts:
            solution = bench.needed(part)
            shares.append(largest_share(total, solution))
            total = total + shares[-1] * solution
            expected = expected + shares[-1] * part
        granted = bench.allocate(np.concatenate([weight + rest, torque]), weight)
        np.testing.assert_allclose(granted, expected, atol=1e-6)
        np.testing.assert_allclose(bench.produced(random_attitude(rng)), granted, atol=1e-9)
        assert bench.group_thrust().max() <= LIMIT_N * (1.0 + 1e-9)
        assert bench.command.saturated == float(min(shares) < 1.0)
        for name, share in zip(partly, shares, strict=True):
            partly[name] += share < 1.0
    assert min(partly.values()) > 10  # every stage had something to give up


def test_two_rotors_of_a_group_share_its_thrust(bench: Bench) -> None:
    up = np.array([5.0, 3.0, 60.0])
    bench.allocate(np.concatenate([up, [0.3, 0.2, 0.5]]), up)
    pairs = bench.command.rotor_thrust.reshape(-1, 2)
    np.testing.assert_array_equal(pairs[:, 0], pairs[:, 1])
    assert (pairs >= 0.0).all()
