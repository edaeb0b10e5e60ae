"""The whole stack hovers in free air and is pulled at its tip: it gives way as its springs say."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import pytest
from scipy.spatial.transform import Rotation
from worlds import PLATFORM, Array, placed, plant_of

from inspect_cli.compiled.joined import joined
from inspect_cli.records import Pose, Reference
from inspect_cli.schema.disturbances import Pull, Rope
from inspect_cli.schema.loading import load_platform
from inspect_cli.vehicles import build_vehicle

DT, CONTROL_STEPS = 1e-3, 4
HELD_S = 15.0
START = np.array([0.0, 0.0, 2.0])
STIFFNESS, CORD_NPM, ARM_M = 72.0, 10.0, 0.55
YAW_STIFFNESS = 10.0


class Held(NamedTuple):
    """At the end of a long pull, and 10 s after it."""

    force_W: Array
    moved: Array
    turn: Array
    """Rotation vector, rad."""
    moved_after: Array
    turn_after: Array


def pull(profile: str, direction: tuple[float, float, float], force_n: float) -> Held:
    """Hover level with the given profile while somebody pulls for 15 s.

    The stack is given the true motion; it observes the wrench itself.
    """
    vehicle = build_vehicle(load_platform(PLATFORM))
    one = Pull(start_s=1.0, hold_s=HELD_S, force_n=force_n)
    rope = Rope(kind="rope", direction=direction, stiffness_npm=CORD_NPM, pulls=(one,))
    plant = plant_of(vehicle, disturbances=[rope])
    placed(plant, START.tolist())
    stack, pose = vehicle.flight_control(), Pose.create()
    reference = Reference.create(vehicle.capabilities.lengths)
    reference.impedance = float(vehicle.capabilities.impedances.index(profile))
    for record in (pose, reference):
        record.p_WB[:], record.q_WB[:] = START, [1.0, 0.0, 0.0, 0.0]
    stack.start(pose)
    control = joined(*stack.bind(reference))
    seen = []
    for tick in range(round((one.end_s + 10.0) / (CONTROL_STEPS * DT))):
        t_s = tick * CONTROL_STEPS * DT
        state = plant.observe(t_s)
        for name in ("p_WB", "q_WB", "v_WB_W", "w_WB_B"):
            stack.estimate.views[name][:] = state.views[name]
        assert stack.prepare(reference, True)
        control()
        plant.disturb(t_s)
        plant.apply(stack.command)
        plant.step(CONTROL_STEPS)
        if abs(t_s - (one.end_s - one.fall_s)) < 1e-6:
            force_W = plant.disturbances.load.record.f_rope_W.copy()
            seen = [force_W, *offset(state.p_WB, state.q_WB)]
    assert not plant.diverged
    last = plant.observe(one.end_s + 10.0)
    return Held(*seen, *offset(last.p_WB, last.q_WB))


def offset(p_WB: Array, q_WB: Array) -> tuple[Array, Array]:
    return p_WB - START, Rotation.from_quat(np.roll(q_WB, -1)).as_rotvec()


@pytest.mark.parametrize(
    ("profile", "share", "force_n"),
    [("rope_pull_1", 0.25, 5.0), ("rope_pull_2", 0.1, 2.5), ("rope_pull_3", 5.0, 25.0)],
)
def test_pulled_along_x_it_moves_by_the_force_over_its_shaped_stiffness(
    profile: str, share: float, force_n: float
) -> None:
    """The cord goes through O_b: x = F/(k + M̃ K), T = M̃ K x; nothing else moves."""
    held = pull(profile, (1.0, 0.0, 0.0), force_n)
    shaped = share * STIFFNESS
    assert held.moved[0] == pytest.approx(force_n / (CORD_NPM + shaped), rel=0.02)
    assert held.force_W[0] == pytest.approx(shaped * held.moved[0], rel=0.02)
    assert np.abs(held.moved[1:]).max() < 0.02 * held.moved[0]
    assert np.abs(held.turn).max() * ARM_M < 0.1 * held.moved[0]
    np.testing.assert_allclose(held.moved_after, 0.0, atol=5e-3)
    np.testing.assert_allclose(held.turn_after, 0.0, atol=5e-3)


@pytest.mark.parametrize(
    ("profile", "inertia", "force_n"), [("rope_pull_5", 5.0, 5.0), ("rope_pull_4", 0.25, 1.0)]
)
def test_pulled_sideways_at_the_tip_it_yaws(profile: str, inertia: float, force_n: float) -> None:
    """The tip stands off by 0.55 m: about z_B the moment is balanced by M̃ K ψ.

    The cord keeps pointing at a hand 2 m away, the arm turns: T acts at the angle ψ less that of
    the cord to the arm's normal.
    """
    held = pull(profile, (0.0, 1.0, 0.0), force_n)
    yaw = held.turn[2]
    tip = held.moved + START + Rotation.from_rotvec(held.turn).apply([ARM_M, 0.0, 0.0])
    torque = np.cross(tip - START - held.moved, held.force_W)[2]
    assert torque == pytest.approx(inertia * YAW_STIFFNESS * yaw, rel=0.03)
    assert held.force_W[1] == pytest.approx(5.0 * STIFFNESS * held.moved[1], rel=0.03)
    stretch = np.linalg.norm([ARM_M, 2.0 + force_n / CORD_NPM, 2.0] - tip) - 2.0
    assert np.linalg.norm(held.force_W) == pytest.approx(CORD_NPM * stretch, rel=0.01)
    np.testing.assert_allclose(held.turn_after, 0.0, atol=0.01)
