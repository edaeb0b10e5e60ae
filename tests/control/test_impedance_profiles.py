"""Profiles of impedance: the first holds at once, a change is blended, whatever the arm does."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.control.impedance import (
    BLEND_S,
    Impedance,
    ImpedanceController,
    RigidBody,
    steady_press_force,
)
from inspect_cli.records import Command, Estimate, Reference
from inspect_cli.schema.vehicle import ControlModel, ImpedanceProfile

CONTROL_HZ = 250
TICKS = round(BLEND_S * CONTROL_HZ)
LENGTHS = {"n_rotors": 4, "n_servos": 4}
BODY = RigidBody(4.75, np.diag([0.08, 0.09, 0.15]), np.zeros(3))
SOFT = ImpedanceProfile(frame="tool", mass=(5.0, 5.0, 0.25), inertia=(5.0, 5.0, 5.0))
STIFF = ImpedanceProfile(
    frame="body",
    mass=(1.0, 2.0, 3.0),
    inertia=(1.0, 1.0, 1.0),
    stiffness_npm=(144.0, 100.0, 50.0),
    damping_nspm=(50.0, 40.0, 30.0),
)
THIRD = ImpedanceProfile(frame="tool", mass=(0.5, 0.5, 0.5), inertia=(0.5, 0.5, 0.5))
MODEL = ControlModel(
    stiffness_npm=(72.0, 72.0, 72.0),
    damping_nspm=(33.0, 33.0, 33.0),
    stiffness_nmprad=(5.5, 5.5, 10.0),
    damping_nmsprad=(1.4, 1.4, 2.6),
    observer_gain=(1.0, 1.0, 1.0),
    observer_gain_torque=(1.0, 1.0, 1.0),
    profiles={"soft": SOFT, "stiff": STIFF, "third": THIRD},
)
PROFILES = (SOFT, STIFF, THIRD)


def tool_at(pitch_deg: float) -> np.ndarray:
    pitch = np.radians(pitch_deg)
    z = np.array([np.sin(pitch), 0.0, -np.cos(pitch)])
    return np.column_stack([np.cross([0.0, 1.0, 0.0], z), [0.0, 1.0, 0.0], z])


class Law:
    """A vehicle held off its reference, in motion, with a wrench on it."""

    def __init__(self) -> None:
        self.estimate, self.command = Estimate.create(), Command.create(LENGTHS)
        self.reference = Reference.create(LENGTHS)
        self.estimate.q_WB[0] = self.reference.q_WB[0] = 1.0
        self.estimate.p_WB[:] = [0.1, -0.05, 0.03]
        self.estimate.v_WB_W[:] = [0.2, 0.1, -0.3]
        self.estimate.wrench_B[:] = [2.0, -1.0, 3.0, 0.2, 0.1, -0.1]
        self.R_BT = tool_at(90.0)
        self.controller = ImpedanceController(BODY, MODEL, self.R_BT, CONTROL_HZ)

    def wrench(self, profile: int) -> np.ndarray:
        self.reference.impedance = float(profile)
        self.controller.follow(int(self.reference.impedance))
        self.controller.bind(self.estimate, self.reference, self.command)()
        return np.array(self.command.wrench_B)

    def turn(self, pitch_deg: float) -> None:
        self.R_BT = tool_at(pitch_deg)
        self.controller.turn_tool(self.R_BT)

    def pure(self, profile: int) -> np.ndarray:
        """What a profile alone asks for, by the law on paper."""
        model, one = MODEL, PROFILES[profile]
        R = self.R_BT if one.frame == "tool" else np.eye(3)
        K = np.array(one.stiffness_npm or model.stiffness_npm)
        D = np.array(one.damping_nspm or model.damping_nspm)
        e, v, w = self.estimate.p_WB, self.estimate.v_WB_W, self.estimate.wrench_B
        shaping = R @ np.diag(1.0 / np.array(one.mass)) @ R.T - np.eye(3)
        force = shaping @ w[:3] - D * v - K * e + [0.0, 0.0, BODY.mass_kg * 9.81]
        turning = R @ np.diag(1.0 / np.array(one.inertia)) @ R.T - np.eye(3)
        return np.concatenate([force, turning @ w[3:]])


@pytest.mark.parametrize("profile", range(3))
def test_the_first_profile_holds_at_once(profile: int) -> None:
    law = Law()
    np.testing.assert_allclose(law.wrench(profile), law.pure(profile), atol=1e-12)
    np.testing.assert_allclose(law.wrench(profile), law.pure(profile), atol=1e-12)


def test_a_change_is_even_and_takes_half_a_second() -> None:
    law = Law()
    law.wrench(0)
    before, after = law.pure(0), law.pure(1)
    rows = np.array([law.wrench(1) for _ in range(TICKS + 5)])
    shares = np.minimum(np.arange(1, TICKS + 6) / TICKS, 1.0)[:, None]
    np.testing.assert_allclose(rows, before + shares * (after - before), atol=1e-10)
    np.testing.assert_array_equal(rows[-1], law.wrench(1))


def test_a_change_of_mind_goes_on_from_where_the_blend_is() -> None:
    law = Law()
    law.wrench(0)
    for _ in range(TICKS // 2):
        last = law.wrench(1)
    largest = max(np.abs(law.pure(a) - law.pure(b)).max() for a in range(3) for b in range(3))
    for k in range(TICKS):
        now = law.wrench(2 if k < TICKS // 4 else 0)
        assert np.abs(now - last).max() <= 1.001 * largest / TICKS
        last = now
    for _ in range(TICKS):
        last = law.wrench(0)
    np.testing.assert_allclose(last, law.pure(0), atol=1e-10)


def test_an_arm_that_turns_its_tool_does_not_cut_the_blend_short() -> None:
    law = Law()
    law.wrench(0)
    for k in range(1, TICKS + 1):
        law.turn(90.0 + 60.0 * k / TICKS)
        share = k / TICKS
        expected = (1.0 - share) * law.pure(0) + share * law.pure(1)
        np.testing.assert_allclose(law.wrench(1), expected, atol=1e-10)
    law.turn(160.0)
    np.testing.assert_allclose(law.wrench(1), law.pure(1), atol=1e-10)


def test_a_tool_that_turns_before_the_first_profile_is_followed() -> None:
    law = Law()
    law.turn(150.0)
    np.testing.assert_allclose(law.wrench(0), law.pure(0), atol=1e-12)


@pytest.mark.parametrize("share", [0.0, 0.3, 1.0])
def test_between_two_profiles_the_apparent_mass_stays_positive(share: float) -> None:
    both = [Impedance.of(MODEL, profile, tool_at(120.0)) for profile in (SOFT, STIFF)]
    mixed = Impedance.mixed(both, np.array([1.0 - share, share]))
    for block in mixed.shaping:
        inverse_mass = block + np.eye(3)
        np.testing.assert_allclose(inverse_mass, inverse_mass.T, atol=1e-12)
        assert np.linalg.eigvalsh(inverse_mass).min() >= 0.2 - 1e-12
    assert (mixed.stiffness > 0.0).all()
    assert (mixed.damping > 0.0).all()


def test_a_press_has_the_stiffness_of_its_own_profile() -> None:
    """A level tool along x_B: K̃ of the profile times its apparent mass there times the depth."""
    level = tool_at(90.0)
    assert steady_press_force(MODEL, SOFT, level, 0.1) == pytest.approx(0.25 * 72.0 * 0.1)
    assert steady_press_force(MODEL, STIFF, level, 0.1) == pytest.approx(1.0 * 144.0 * 0.1)
