"""A vehicle that leans to push: on a wall, along it, and under a ceiling."""

from __future__ import annotations

import numpy as np
import pytest
from crawler_flight import CEILING_Z, FRICTION, UPRIGHT, WALL_X, Flight
from pitching_crawler import PitchingCrawler
from pitching_crawler.mujoco_model import FOOT
from scipy.spatial.transform import Rotation

from inspect_cli.interfaces import Posture
from inspect_cli.vehicles.actuators import Drive, Rotor
from inspect_cli.vehicles.kinds import TOOL

pytestmark = pytest.mark.xdist_group("crawler")  # one flight for all

MASS, G = 2.3, 9.81
PUSH_N, PROP_N = 2.0, 3.0
CRAWL_MPS, CRAWL_S = 0.2, 6.0
"""One metre: a second to start, four at speed, a second to stop."""
HELD = slice(-750, None)
"""The last three seconds, 250 ticks each."""
TOUCHED_N = 0.2


def near(flight: Flight, direction: np.ndarray, contact: str) -> None:
    """Move until a contact is felt."""

    def lead(t_s, order):
        order.v_WB_W = 0.05 * direction
        order.p_WB = order.p_WB + order.v_WB_W / 250.0

    def touched():
        return bool(flight.plant.contacts[contact].f_W @ direction < -TOUCHED_N)

    flight.fly("nearing", 10.0, lead, touched)
    assert touched()
    flight.order.v_WB_W = np.zeros(3)
    flight.order.into_W = direction


@pytest.fixture(scope="module")
def flight():
    vehicle = PitchingCrawler()
    flight = Flight(vehicle)
    flight.fly("standing", 0.3)
    flight.go("climbing_out", np.array([0.0, 0.0, 1.0]), 3.0)
    flight.go("hovering", np.array([WALL_X - 0.7, 0.0, 1.0]), 4.0)
    near(flight, np.array([1.0, 0.0, 0.0]), "wheel")

    level = Posture(np.zeros(3), UPRIGHT, np.zeros(1))
    axes = vehicle.capabilities.frame_pose(level, TOOL)[1]
    load = np.array([-PUSH_N, 0.0, 0.0, 0.0, 0.0, 0.0])
    goal = (flight.plant.state.p_WT.copy(), axes)
    trimmed = vehicle.capabilities.solve({TOOL: goal}, {TOOL: load}, level)
    begun = flight.order.p_WB.copy()

    def lean(t_s, order):
        share = min(t_s, 1.0)
        order.force_n, order.p_WB = share * PUSH_N, begun + share * (trimmed.p_WB - begun)

    def crawl(t_s, order):
        order.roll_mps = CRAWL_MPS * min(t_s, 1.0, max(CRAWL_S - t_s, 0.0))
        order.v_WB_W = np.array([0.0, 0.0, order.roll_mps])
        order.p_WB = order.p_WB + order.v_WB_W / 250.0

    flight.fly("leaning", 5.0, lean)
    flight.fly("crawling", CRAWL_S + 1.0, crawl)
    flight.order.force_n = 0.0
    flight.order.p_WB = flight.order.p_WB - [0.3, 0.0, 0.0]
    flight.fly("hovering", 3.0)
    flight.go("hovering", np.array([-1.0, 0.0, CEILING_Z - 0.4]), 6.0)
    near(flight, np.array([0.0, 0.0, 1.0]), "foot")

    def prop(t_s, order):
        order.force_n = PROP_N * min(t_s, 1.0)

    flight.fly("propping", 4.0, prop)
    flight.trimmed = trimmed
    assert not flight.plant.diverged
    return flight


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
    assert pitch.mean() == pytest.approx(pitch_of(flight.trimmed.q_WB[None])[0], rel=0.1)
    hinge = flight.logged("leaning", "joint_angle")[HELD, 0]
    assert hinge.mean() == pytest.approx(flight.trimmed.arm_angle[0], abs=np.radians(1.0))
    p_WB = flight.logged("leaning", "p_WB")[-1]
    np.testing.assert_allclose(p_WB, flight.trimmed.p_WB, atol=0.02)


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
