"""Times of legs against the quintic, differentiated numerically."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from rigid import ArmVehicle, RigidVehicle

from inspect_cli.guidance.motion import MotionLimits
from inspect_cli.interfaces import Posture
from inspect_cli.planning.timing import duration_and_energy, extent, path_m, rest_to_rest_s
from inspect_cli.spatial.rotations import quaternion_exp

VEHICLE = RigidVehicle(max_acceleration_mps2=0.8, max_angular_rate_radps=0.6)
REST = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]))
SAMPLES = 20001


def peaks(distance, time_s):
    """Largest speed and acceleration of the quintic by central differences."""
    t = np.linspace(0.0, time_s, SAMPLES)
    tau = t / time_s
    s = distance * (10.0 * tau**3 - 15.0 * tau**4 + 6.0 * tau**5)
    speed = np.gradient(s, t)
    return np.abs(speed).max(), np.abs(np.gradient(speed, t)[5:-5]).max()


@pytest.mark.parametrize("distance", [0.05, 0.3, 1.0, 8.0])
@pytest.mark.parametrize("speed", [0.1, 0.5, 0.9])
def test_translation_reaches_exactly_the_tighter_limit(distance, speed):
    limits = MotionLimits.of(VEHICLE, speed)
    goal = replace(REST, p_WB=distance * np.array([0.6, 0.0, 0.8]))
    time_s = rest_to_rest_s(REST, goal, limits)
    peak_speed, peak_acceleration = peaks(distance, time_s)
    share = max(peak_speed / speed, peak_acceleration / VEHICLE.max_acceleration_mps2)
    assert share == pytest.approx(1.0, rel=1e-4)


@pytest.mark.parametrize("angle", [0.1, 1.2, 3.0])
def test_rotation_reaches_exactly_the_tighter_limit(angle):
    limits = MotionLimits.of(VEHICLE, 0.5)
    goal = replace(REST, q_WB=quaternion_exp(angle * np.array([0.0, 0.6, 0.8])))
    peak_rate, peak_acceleration = peaks(angle, rest_to_rest_s(REST, goal, limits))
    share = max(
        peak_rate / limits.angular_rate_radps,
        peak_acceleration / limits.angular_acceleration_radps2,
    )
    assert share == pytest.approx(1.0, rel=1e-4)


def test_extent_takes_the_larger_of_turn_and_joint():
    a = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.array([0.0, 0.2]))
    b = Posture(
        np.array([3.0, 0.0, 4.0]), quaternion_exp(np.array([0.1, -0.2, 0.2])), np.array([0.0, 0.9])
    )
    assert extent(a, b) == pytest.approx((5.0, 0.7))
    c = replace(b, joint_angle=np.array([0.0, 0.3]))
    assert extent(a, c) == pytest.approx((5.0, 0.3))


def test_energy_is_power_times_time():
    a = Posture(np.zeros(3), np.array([1.0, 0.0, 0.0, 0.0]), np.array([1.5]))
    b = replace(a, p_WB=np.array([1.0, 0.0, 0.0]))
    c = replace(a, p_WB=np.array([1.0, 2.0, 0.0]))
    time_s, energy_j = duration_and_energy([a, b, c], 0.5, 3.0, ArmVehicle())
    legs_s = 15.0 / 8.0 * (1.0 + 2.0) / 0.5
    assert time_s == pytest.approx(legs_s + 3.0)
    assert energy_j == pytest.approx(300.0 * (legs_s + 3.0))
    assert path_m([a, b, c]) == pytest.approx(3.0)
