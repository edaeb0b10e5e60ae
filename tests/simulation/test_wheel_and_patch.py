"""Wheels and foot plates in MuJoCo against rolling, Coulomb friction and the statics of a plate."""

from __future__ import annotations

import mujoco
import numpy as np
import pytest
from rigs import DRIVE, HALF, INERTIA, LEVER, MASS, RADIUS, G, Rig, foot_spec, wheel_spec
from scipy import signal

from inspect_cli.schema.geometry import CylinderShape

FRICTION = 0.5
LEVEL = 0.0
CREEP_MPS = 1e-4
"""What a braked wheel or a standing foot may creep."""
WEIGHT = MASS * G


def test_a_wheel_rolls_a_metre_as_its_joint_says() -> None:
    rig = Rig(wheel_spec(), LEVEL, FRICTION, RADIUS)
    rig.run(0.3, held=True)
    start, angle = rig.travel, float(rig.data.joint("wheel").qpos[0])
    rig.speed[0] = 5.0
    while rig.travel - start < 1.0:
        rig.run(0.01, held=True)
        assert rig.data.time < 10.0
    rolled = RADIUS * (float(rig.data.joint("wheel").qpos[0]) - angle)
    assert rig.travel - start == pytest.approx(rolled, rel=1e-3)


def test_a_drive_follows_its_speed_with_its_lag() -> None:
    rig = Rig(wheel_spec(), LEVEL, FRICTION, 1.0)  # in the air
    rig.model.opt.gravity[:] = 0.0
    rig.speed[0] = 5.0
    # First-order lag of 50 ms, then k/(I s² + d s + k) with I = 1.128e-3 kg·m².
    inertia = 1e-3 + 0.4 * 0.1 * MASS * RADIUS**2
    loop = np.polymul([0.05, 1.0], [inertia, DRIVE.damping_nmsprad, DRIVE.stiffness_nmprad])
    times = 0.02 * np.arange(1, 20)
    _, expected = signal.step(([DRIVE.stiffness_nmprad], loop), T=np.append(0.0, times))
    for rate in expected[1:]:
        rig.run(0.02, held=True)
        assert rig.data.joint("wheel").qvel[0] == pytest.approx(5.0 * rate, abs=0.3)


def test_a_blocked_drive_pushes_with_its_torque_and_does_not_catch_up() -> None:
    rig = Rig(wheel_spec(), LEVEL, FRICTION, 1.0)
    rig.model.opt.gravity[:] = 0.0
    rig.model.dof_damping[6] = 1e6
    rig.speed[0] = 100.0  # of which it gives 30
    rig.run(1.0, held=True)
    assert rig.data.actuator_force[0] == pytest.approx(2.0)
    assert rig.data.ctrl[0] - rig.data.joint("wheel").qpos[0] == pytest.approx(DRIVE.reach_rad)
    rig.model.dof_damping[6] = 0.0
    rig.speed[0] = 0.0
    rig.run(1.0, held=True)
    assert rig.data.joint("wheel").qpos[0] < DRIVE.reach_rad + 0.01


@pytest.mark.parametrize("friction", [0.4, 0.7])
def test_a_braked_wheel_stays_below_the_angle_of_friction_and_slides_above(
    friction: float,
) -> None:
    holds = Rig(wheel_spec(), np.arctan(0.9 * friction), friction, RADIUS)
    holds.run(0.5, held=True)
    start = holds.travel
    holds.run(2.0, held=True)
    assert abs(holds.travel - start) / 2.0 < CREEP_MPS

    slope = np.arctan(1.1 * friction)
    slides = Rig(wheel_spec(), slope, friction, RADIUS)
    slides.run(0.5, held=True)
    start, speed = slides.travel, float(slides.data.qvel[:3] @ slides.downhill)
    angle = float(slides.data.joint("wheel").qpos[0])
    slides.run(1.0, held=True)
    excess = G * (np.sin(slope) - friction * np.cos(slope))
    assert slides.travel - start == pytest.approx(speed + 0.5 * excess, rel=0.05)
    assert abs(slides.data.joint("wheel").qpos[0] - angle) < 0.01  # braked all the while


def test_a_foot_stands_on_its_four_corners() -> None:
    rig = Rig(foot_spec(0.01), LEVEL, FRICTION, 0.01)
    rig.run(0.5)
    corners = rig.data.contact.pos[:, :2]
    assert len(corners) == 4
    np.testing.assert_allclose(np.sort(np.abs(corners)), HALF, atol=1e-4)
    force, torque, _ = rig.data.sensor("contact:plate").data.reshape(3, 3)
    np.testing.assert_allclose(force, [0.0, 0.0, -WEIGHT], atol=0.01)
    np.testing.assert_allclose(torque, 0.0, atol=0.01)


@pytest.mark.parametrize(("share", "tips"), [(0.97, False), (1.03, True)])
def test_a_foot_tips_over_its_edge_at_the_load_that_statics_say(share: float, tips: bool) -> None:
    """F at the height h turns it over its edge where F h = N a."""
    height = 0.15
    rig = Rig(foot_spec(height), LEVEL, 0.9, height)
    rig.run(0.3)
    force = share * WEIGHT * HALF / height
    rig.run(1.2, np.array([force, 0.0, 0.0]))
    tilt = 2.0 * float(np.linalg.norm(rig.data.qpos[4:7]))
    assert (tilt > np.radians(3.0)) == tips
    if not tips:
        assert tilt < np.radians(0.1)


def test_a_foot_slips_at_the_limit_of_coulomb() -> None:
    limit, push = FRICTION * WEIGHT, np.array([1.0, 0.0, 0.0])
    rig = Rig(foot_spec(0.005), LEVEL, FRICTION, 0.005)
    rig.run(0.3)
    start = rig.travel
    rig.run(2.0, 0.95 * limit * push)
    assert abs(rig.travel - start) / 2.0 < CREEP_MPS
    start = rig.travel
    rig.run(1.0, 1.05 * limit * push)
    assert rig.travel - start == pytest.approx(0.5 * 0.05 * limit / MASS, rel=0.05)


def test_a_foot_twists_at_its_torsional_limit() -> None:
    """Four points at r with N/4 each hold μ N √(r² + lever²)."""
    limit = FRICTION * WEIGHT * np.hypot(np.sqrt(2.0) * HALF, LEVER)
    rig = Rig(foot_spec(0.005), LEVEL, FRICTION, 0.005)
    turned = []
    for share in (0.95, 1.05):
        mujoco.mj_resetData(rig.model, rig.data)
        rig.data.qpos[2] = 2.005
        rig.run(0.3)
        for _ in range(1000):
            rig.data.qfrc_applied[:6] = [0.0, 0.0, 0.0, 0.0, 0.0, share * limit]
            mujoco.mj_step(rig.model, rig.data)
        turned.append(2.0 * float(np.arcsin(rig.data.qpos[6])))
    assert abs(turned[0]) < 1e-3
    assert turned[1] == pytest.approx(0.5 * 0.05 * limit / INERTIA, rel=0.1)


def test_a_wheel_rolls_and_a_foot_stands_on_the_plates_of_a_hollow_cylinder() -> None:
    """Each contact has a plate of its own, tangent below it; the axis is along x."""
    pipe = CylinderShape(
        center_m=(0.0, 0.0, 2.0),
        axis=(1.0, 0.0, 0.0),
        radius_m=1.5,
        facing=(0.0, 0.0, -1.0),
        size_m=(3.0, 1.0),
        side="inside",
    )
    for spec, height in ((wheel_spec(), RADIUS), (foot_spec(0.01), 0.01)):
        rig = Rig(spec, LEVEL, FRICTION, height, pipe)
        rig.run(0.5, held=True)
        rig.speed[:] = 5.0
        rig.run(2.0, held=True)
        bottom = 0.5 + height
        assert rig.data.qpos[2] == pytest.approx(bottom, abs=1e-3)
        weight = np.array(rig.data.sensordata[:3])
        np.testing.assert_allclose(weight[2], -WEIGHT, atol=0.2)
        assert rig.plates == 1
        rolled = RADIUS * rig.data.qpos[7:].sum()
        assert rig.travel == pytest.approx(rolled, abs=2e-3)
        assert (rolled > 0.3) == (len(rig.speed) > 0)
