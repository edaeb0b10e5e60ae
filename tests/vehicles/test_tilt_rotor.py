"""The tilt-rotor vehicle's numbers, against sums over its bodies and MuJoCo's inverse dynamics."""

from __future__ import annotations

from collections.abc import Callable

import mujoco
import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from inspect_cli.interfaces import DepthLaw, FramePose, Posture, Shortfall
from inspect_cli.schema.tasks.base import Pressing
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.fully_actuated.rigid_body import nominal_body
from inspect_cli.vehicles.tilt_rotor.model import build_spec, tool_transform

Pitched = Callable[[float], TiltRotorPlatform]
Array = np.ndarray
LIMIT_N = 20.0


def summed(platform: TiltRotorPlatform) -> tuple[float, Array, Array]:
    """Mass, centre of mass and inertia about O_b, body by body with Steiner's theorem."""
    model = build_spec(platform).compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    mujoco.mj_comPos(model, data)
    total, moment, inertia = 0.0, np.zeros(3), np.zeros((3, 3))
    for body in range(1, model.nbody):
        m, c = model.body_mass[body], data.xipos[body]
        R = data.ximat[body].reshape(3, 3)
        total += m
        moment += m * c
        inertia += R @ np.diag(model.body_inertia[body]) @ R.T
        inertia += m * (c @ c * np.eye(3) - np.outer(c, c))
    return total, moment / total, inertia


@pytest.mark.parametrize("pitch_deg", [0.0, 90.0, 150.0])
def test_the_nominal_body_is_the_sum_of_the_bodies(pitched: Pitched, pitch_deg: float) -> None:
    platform = pitched(pitch_deg)
    # Off the plane of symmetry too, where a swapped or turned component shows.
    core = platform.core.model_copy(update={"com_m": (0.03, -0.05, 0.02)})
    platform = platform.model_copy(update={"core": core})
    body = nominal_body(build_spec(platform))
    mass, com, inertia = summed(platform)
    assert body.mass_kg == pytest.approx(mass, rel=1e-12)
    np.testing.assert_allclose(body.com_B, com, atol=1e-9)
    np.testing.assert_allclose(body.inertia_B, inertia, atol=1e-9)


def test_assembled_it_weighs_and_turns_like_the_published_vehicle(pitched: Pitched) -> None:
    body = nominal_body(build_spec(pitched(90.0)))
    assert body.mass_kg == pytest.approx(4.75, abs=1e-3)
    np.testing.assert_allclose(np.diag(body.inertia_B), [0.10, 0.11, 0.21], rtol=0.15)
    assert np.linalg.norm(body.com_B) < 1e-3


@pytest.mark.parametrize(
    ("pitch_deg", "z_B"),
    [(0.0, [0, 0, -1]), (90.0, [1, 0, 0]), (150.0, [0.5, 0, np.sqrt(0.75)]), (180.0, [0, 0, 1])],
)
def test_the_arms_angle_counts_from_straight_down(
    pitched: Pitched, pitch_deg: float, z_B: list[float]
) -> None:
    p_BT, R_BT = tool_transform(pitched(pitch_deg))
    np.testing.assert_allclose(R_BT[:, 2], z_B, atol=1e-12)
    np.testing.assert_allclose(p_BT, 0.55 * np.array(z_B), atol=1e-12)
    np.testing.assert_allclose(R_BT[:, 1], [0, 1, 0], atol=1e-12)
    assert np.linalg.det(R_BT) == pytest.approx(1.0)


@pytest.mark.parametrize("pitch_deg", [90.0, 150.0])
def test_press_force_of_the_contact_profile(pitched: Pitched, pitch_deg: float) -> None:
    capabilities = build_vehicle(pitched(pitch_deg)).capabilities
    # The stiffness is the same along all axes: 0.25 · 72 N/m · 0.10 m whatever the arm's angle.
    for press_m, force_n in ((0.10, 1.8), (0.05, 0.9)):
        law = capabilities.contact_law(Pressing(press_m=press_m), "contact_ndt")
        assert isinstance(law, DepthLaw)
        assert (law.depth_m, law.profile) == (press_m, "contact_ndt")
        assert law.expected_force_n == pytest.approx(force_n, rel=1e-9)


class Statics:
    """What the groups need at rest: MuJoCo's bias force, less the force on the tip."""

    def __init__(self, platform: TiltRotorPlatform) -> None:
        self.model = build_spec(platform).compile()
        self.data = mujoco.MjData(self.model)
        self.columns = self._columns(len(platform.groups))

    def _columns(self, n: int) -> Array:
        columns = []
        for tilt in (0.5 * np.pi, 0.0):
            for index in range(n):
                mujoco.mj_resetData(self.model, self.data)
                self.data.qpos[7 + index] = tilt
                self.data.act[2 * index : 2 * index + 2] = 0.5
                self.data.act[2 * n :] = self.data.qpos[7:]
                mujoco.mj_forward(self.model, self.data)
                columns.append(np.array(self.data.qfrc_actuator[:6]))
        return np.array(columns).T

    def groups(self, posture: Posture, wrench_W: Array) -> tuple[Array, Array]:
        """(thrusts, tilts) by least squares."""
        model, data = self.model, self.data
        mujoco.mj_resetData(model, data)
        data.qpos[:3], data.qpos[3:7] = posture.p_WB, posture.q_WB
        mujoco.mj_forward(model, data)
        pushed = np.zeros(model.nv)
        tip, body = data.site("tool").xpos, model.body("tool").id
        mujoco.mj_applyFT(model, data, wrench_W[:3], wrench_W[3:], tip, body, pushed)
        needed = data.qfrc_bias[:6] - pushed[:6]
        R = data.body("core").xmat.reshape(3, 3)
        needed[:3] = R.T @ needed[:3]
        s, c = np.split(np.linalg.lstsq(self.columns, needed, rcond=None)[0], 2)
        return np.hypot(s, c), np.arctan2(s, c)


def postures(count: int) -> list[Posture]:
    rng = np.random.default_rng(3)
    return [
        Posture(rng.normal(size=3), Rotation.random(rng=rng).as_quat()[[3, 0, 1, 2]])
        for _ in range(count)
    ]


@pytest.mark.parametrize("pitch_deg", [90.0, 150.0])
def test_margins_are_what_statics_leaves(pitched: Pitched, pitch_deg: float) -> None:
    platform = pitched(pitch_deg)
    unit = platform.unit.model_copy(update={"range_deg": 170.0})
    limited = platform.model_copy(update={"unit": unit})
    free = build_vehicle(platform).capabilities
    stopped = build_vehicle(limited).capabilities
    statics, rng = Statics(platform), np.random.default_rng(4)
    for posture in postures(30):
        wrench_W = rng.normal(size=6) * [5.0, 5.0, 5.0, 0.3, 0.3, 0.3]
        thrusts, tilts = statics.groups(posture, wrench_W)
        loads = {"tool": wrench_W}
        margins = free.margins(posture, loads)
        assert margins["thrust"].value == pytest.approx(LIMIT_N - thrusts.max(), abs=1e-6)
        assert set(margins) == {"thrust"}
        left = np.radians(170.0) - np.abs(tilts).max()
        tilt = stopped.margins(posture, loads)["tilt"]
        assert (tilt.value, tilt.unit) == (pytest.approx(left, abs=1e-6), "rad")


def test_too_much_is_not_feasible(pitched: Pitched) -> None:
    capabilities = build_vehicle(pitched(90.0)).capabilities
    level = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
    assert capabilities.margins(level, {})["thrust"].holds
    # Six groups of 20 N cannot push 120 N forward beside carrying the weight.
    pushed_back = np.array([-120.0, 0.0, 0.0, 0.0, 0.0, 0.0])
    margin = capabilities.margins(level, {"tool": pushed_back})["thrust"]
    assert not margin.holds
    assert margin.lack == f"asks for {-margin.value:.2f} N more than a rotor group can give"


def test_a_frame_or_a_goal_that_is_not_there_is_refused(pitched: Pitched) -> None:
    capabilities = build_vehicle(pitched(90.0)).capabilities
    level = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
    with pytest.raises(ValueError, match="'foot'; there are: body, tool"):
        capabilities.frame_pose(level, "foot")
    goals = {name: FramePose(*capabilities.frame_pose(level, name)) for name in ("body", "tool")}
    both = capabilities.solve(goals, {}, level)
    assert isinstance(both, Shortfall)
    assert not both
    assert "one frame" in both.reason
    for name, goal in goals.items():
        found = capabilities.solve({name: goal}, {}, level)
        assert isinstance(found, Posture)
        np.testing.assert_allclose(found.p_WB, level.p_WB, atol=1e-12)


def test_hover_power_by_momentum_theory(pitched: Pitched) -> None:
    platform = pitched(90.0)
    capabilities, statics = build_vehicle(platform).capabilities, Statics(platform)
    for posture in postures(5):
        rotor = 0.5 * np.repeat(statics.groups(posture, np.zeros(6))[0], 2)
        induced_speed = np.sqrt(rotor / (2.0 * 1.225 * np.pi * platform.rotor.radius_m**2))
        power = (rotor @ induced_speed) / platform.battery.figure_of_merit
        power += platform.battery.avionics_w
        assert capabilities.power_w(posture, {}) == pytest.approx(power, rel=1e-6)


def test_the_spheres_cover_core_rotors_and_arm_but_not_the_tip(pitched: Pitched) -> None:
    """Up to the corners of discs and hull, which stand out by less than the least clearance."""
    platform = pitched(150.0)
    capabilities = build_vehicle(platform).capabilities
    posture = postures(1)[0]
    spheres = capabilities.collision_spheres(posture)
    R = Rotation.from_quat(np.roll(posture.q_WB, -1)).as_matrix()
    rng = np.random.default_rng(6)

    def outside(points_B: Array) -> Array:
        points = posture.p_WB + points_B @ R.T
        distances = np.linalg.norm(points[:, None] - spheres[None, :, :3], axis=2)
        return (distances - spheres[:, 3]).min(axis=1)

    around = rng.uniform(0.0, 2.0 * np.pi, 500)
    core, unit = platform.core, platform.unit
    hull = np.column_stack(
        [
            core.radius_m * np.cos(around),
            core.radius_m * np.sin(around),
            rng.uniform(-0.5, 0.5, 500) * core.height_m,
        ]
    )
    assert outside(hull).max() < 0.012
    p_BT, _ = tool_transform(platform)
    for group in platform.groups:
        psi = np.radians(group.azimuth_deg)
        arm = np.array([np.cos(psi), np.sin(psi), 0.0])
        tilt = Rotation.from_rotvec(rng.uniform(-np.pi, np.pi, (500, 1)) * arm)
        rim = platform.rotor.radius_m * (
            np.outer(np.cos(around), arm) + np.outer(np.sin(around), np.cross([0, 0, 1], arm))
        )
        rim[:, 2] = rng.choice([-0.5, 0.5], 500) * unit.coaxial_offset_m
        assert outside(unit.distance_m * arm + tilt.apply(rim)).max() < 0.005
    along = np.linspace(0.0, 0.6, 100)[:, None] * p_BT
    assert outside(along).max() < 0.0
    # The last part may come as close as it must.
    assert outside(p_BT[None]).min() > 0.10
