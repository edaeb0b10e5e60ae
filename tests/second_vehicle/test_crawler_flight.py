"""A vehicle that leans to push: on a wall, along it, and under a ceiling."""

from __future__ import annotations

import numpy as np
import pytest
from crawler_flight import CEILING_Z, FRICTION, UPRIGHT, WALL_X, Flight
from pitching_crawler import PitchingCrawler
from pitching_crawler.modes import MODES, CrawlerPlan, PushTarget
from pitching_crawler.mujoco_model import FOOT
from scipy.spatial.transform import Rotation

from inspect_cli.autonomy.modes import Order
from inspect_cli.interfaces import TOOL, FramePose, Posture
from inspect_cli.vehicles import tilt_rotor
from inspect_cli.vehicles.actuators import Drive, Rotor

pytestmark = pytest.mark.xdist_group("crawler")  # one flight for all

MASS, G = 2.3, 9.81
PUSH_N, PROP_N = 2.0, 3.0
CRAWL_M = 1.0
HELD = slice(-750, None)
"""The last three seconds, 250 ticks each."""
WALL_TARGET = PushTarget(0, "wall", TOOL, np.array([1.0, 0.0, 0.0]), PUSH_N, 3.0, CRAWL_M)
CEILING_TARGET = PushTarget(1, "ceiling", FOOT, np.array([0.0, 0.0, 1.0]), PROP_N, 3.0)


def at(x: float, z: float) -> Posture:
    return Posture(np.array([x, 0.0, z]), UPRIGHT, np.zeros(1))


PLAN = CrawlerPlan(
    targets=(WALL_TARGET, CEILING_TARGET),
    orders=(
        Order("climbing_out", postures=(at(0.0, 1.0),), speed_mps=0.6),
        Order("hovering", postures=(at(WALL_X - 0.7, 1.0),), speed_mps=0.6),
        Order("nearing", target=0),
        Order("leaning", target=0),
        Order("crawling", target=0),
        Order("hovering", postures=(at(WALL_X - 1.0, 2.0),), speed_mps=0.6),
        Order("hovering", postures=(at(-1.0, CEILING_Z - 0.4),), speed_mps=0.6),
        Order("nearing", target=1),
        Order("propping", target=1),
        Order("hovering", postures=(at(-1.0, CEILING_Z - 0.8),), speed_mps=0.6),
    ),
)


@pytest.fixture(scope="module")
def flight():
    flight = Flight(PitchingCrawler(), PLAN)
    flight.fly()
    assert not flight.plant.diverged
    assert (flight.executive.status, flight.executive.reason) == ("completed", "")
    return flight


def trimmed(flight: Flight) -> Posture:
    """The planned posture at the place that is touched."""
    able = flight.vehicle.capabilities
    load = np.array([-PUSH_N, 0.0, 0.0, 0.0, 0.0, 0.0])
    axes = able.frame_pose(at(0.0, 0.0), TOOL)[1]
    goal = FramePose(flight.logged("nearing", "p_WT")[0], axes)
    return able.solve({TOOL: goal}, {TOOL: load}, at(0.0, 0.0))


def pitch_of(q_WB: np.ndarray) -> np.ndarray:
    turned = Rotation.from_quat(np.roll(q_WB, -1, axis=1))
    return turned.as_euler("zyx")[:, 1]


def test_it_presses_the_wall_with_two_newtons_for_three_seconds(flight):
    force = -flight.logged("leaning", "f_tool_W")[HELD, 0]
    assert len(force) == 750
    assert force.mean() == pytest.approx(PUSH_N, rel=0.1)
    assert force.min() > 0.5 * PUSH_N


def test_it_leans_as_statics_say(flight):
    """m g tan θ is the force on the wall, and the whole posture is the planned one."""
    pitch = pitch_of(flight.logged("leaning", "q_WB")[HELD])
    assert MASS * G * np.tan(pitch.mean()) == pytest.approx(PUSH_N, rel=0.1)
    assert pitch.mean() == pytest.approx(pitch_of(trimmed(flight).q_WB[None])[0], rel=0.1)
    hinge = flight.logged("leaning", "joint_angle")[HELD, 0]
    assert hinge.mean() == pytest.approx(trimmed(flight).joint_angle[0], abs=np.radians(1.0))
    height = flight.logged("leaning", "p_WB")[-1, 2]
    assert height == pytest.approx(trimmed(flight).p_WB[2], abs=0.03)


def test_the_hinge_is_measured_and_never_commanded(flight):
    vehicle = flight.vehicle
    assert vehicle.joints == ("hinge", "wheel")
    commanded = [a.joint for a in vehicle.actuators if not isinstance(a, Rotor)]
    assert commanded == ["wheel"]
    assert flight.stack.command.joint_angle.size == 0
    # It moves by itself, and its encoder follows to half a step.
    angle = flight.logged("crawling", "joint_angle")
    assert np.ptp(angle[:, 0]) > np.radians(0.5)
    error = flight.logged("crawling", "encoders") - angle
    assert np.abs(error).max() <= 0.5 * vehicle.numbers.encoder_step_rad + 1e-12


def test_the_wheel_rolls_a_metre_along_the_wall(flight):
    angle = flight.logged("crawling", "joint_angle")[:, 1]
    climbed = np.ptp(flight.logged("crawling", "p_WT")[:, 2])
    assert climbed == pytest.approx(1.0, abs=0.01)
    [drive] = [a for a in flight.vehicle.actuators if isinstance(a, Drive)]
    assert drive.joint == "wheel"
    rolled = flight.vehicle.numbers.wheel_radius_m * (angle[-1] - angle[0])
    assert rolled == pytest.approx(climbed, rel=1e-3)
    wheel = flight.logged("crawling", "wheel")
    assert (-wheel[:, 0]).min() > 0.5 * PUSH_N  # it never lost the wall
    assert (np.hypot(wheel[:, 1], wheel[:, 2]) < -FRICTION * wheel[:, 0]).all()
    assert not flight.logged("crawling", "f_body").any()


def test_the_state_has_the_force_of_the_contact_whose_frame_is_the_tools(flight):
    np.testing.assert_array_equal(
        flight.logged("crawling", "wheel"), flight.logged("crawling", "f_tool_W")
    )


def test_the_foot_is_pressed_under_the_ceiling_and_its_wrench_is_logged(flight):
    true, measured = (flight.logged("propping", name)[HELD] for name in ("foot_true", "foot"))
    assert -true[:, 2].mean() == pytest.approx(PROP_N, rel=0.1)
    noise = (measured - true)[:, 2].std()
    assert noise == pytest.approx(flight.vehicle.numbers.foot_force_noise_n, rel=0.15)
    p_WB = flight.logged("propping", "p_WB")[-1]
    assert p_WB[2] + flight.vehicle.numbers.foot_height_m == pytest.approx(CEILING_Z, abs=1e-3)
    assert FOOT in flight.plant.contacts


def test_its_modes_are_its_own_and_a_lost_vehicle_gives_up(flight):
    assert not set(MODES) & set(tilt_rotor.TiltRotor.behaviour.modes)
    assert [mode.phase for mode in MODES.values() if mode.slides] == ["contact"]
    far = Order("hovering", postures=(at(0.0, 1.0),), speed_mps=100.0)
    lost = Flight(PitchingCrawler(), CrawlerPlan((), (far,)))
    lost.stack.point.p_WB = np.array([5.0, 0.0, 1.0])
    lost.fly()
    assert lost.executive.status == "aborted"
    assert lost.executive.reason == "far from where it shall be"
