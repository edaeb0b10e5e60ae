"""The rope: its profile while the tip is held, its geometry when the tip yields."""

from __future__ import annotations

import numpy as np
import pytest
from loads import disturbances, motion
from scipy.spatial.transform import Rotation

from inspect_cli.schema.disturbances import Pull, Rope
from inspect_cli.truth.disturbances.rope import profile

TURN = Rotation.from_euler("zyx", [40, -25, 70], degrees=True)
Q_WB = TURN.as_quat()[[3, 0, 1, 2]]
PULL = Pull(start_s=2.0, rise_s=0.5, hold_s=1.0, fall_s=0.5, force_n=6.0)
TIP = np.array([0.55, 0.0, 1.0])


def moved(x: float, y: float, z: float) -> np.ndarray:
    """The tip elsewhere."""
    return TIP + np.array([x, y, z])


SOFT = Rope(
    kind="rope", direction=(0.0, 1.0, 0.0), stiffness_npm=200.0, length_m=2.0, pulls=(PULL,)
)


def test_a_tip_that_is_held_feels_the_profile() -> None:
    rope = disturbances(SOFT)
    for t_s in np.arange(1.9, 4.2, 0.004):
        load = rope.act(float(t_s), motion())
        inside = PULL.start_s <= t_s < PULL.end_s
        share = profile(float(t_s) - 2.0, 0.5, 1.0, 0.5) if inside else 0.0
        np.testing.assert_allclose(load.force_tip_W, [0.0, 6.0 * share, 0.0], atol=1e-9)
        np.testing.assert_array_equal(load.record.f_rope_W, load.force_tip_W)
        assert load.record.pull == float(inside)
        assert not load.force_W.any()


def test_the_profile_rises_and_falls_smoothly_and_holds_between() -> None:
    times = np.linspace(0.0, 2.0, 20001)
    share = np.array([profile(t, 0.5, 1.0, 0.5) for t in times])
    np.testing.assert_allclose(share, share[::-1], atol=1e-12)
    assert share[0] == 0.0
    assert profile(0.25, 0.5, 1.0, 0.5) == pytest.approx(0.5)
    np.testing.assert_allclose(share[(times >= 0.5) & (times <= 1.5)], 1.0, atol=1e-12)
    # Speed and acceleration are continuous: of s = t/0.5 at most 15/8 and 10/√3.
    rate = np.gradient(share, times)
    assert np.abs(rate).max() == pytest.approx(15.0 / 8.0 / 0.5, rel=1e-4)
    assert np.abs(np.gradient(rate, times)).max() < 10.0 / np.sqrt(3.0) / 0.25 * 1.001


def held_then(*tips: np.ndarray) -> list[np.ndarray]:
    """The cord's force in the middle of the hold with the tip elsewhere than at the start."""
    rope = disturbances(SOFT)
    rope.act(2.0, motion())
    return [rope.act(3.0, motion(p_WT=tip)).force_tip_W.copy() for tip in tips]


def test_a_tip_that_yields_takes_tension_away_and_a_cord_cannot_push() -> None:
    stretch = 6.0 / 200.0
    half, more = held_then(moved(0.0, 0.5 * stretch, 0.0), moved(0.0, 2.0 * stretch, 0.0))
    np.testing.assert_allclose(half, [0.0, 3.0, 0.0], atol=1e-12)
    np.testing.assert_array_equal(more, 0.0)


def test_a_tip_that_swings_is_pulled_towards_the_hand() -> None:
    tip = moved(0.3, 0.0, -0.2)
    (force,) = held_then(tip)
    apart = moved(0.0, 2.0 + 6.0 / 200.0, 0.0) - tip
    distance = np.linalg.norm(apart)
    np.testing.assert_allclose(force, 200.0 * (distance - 2.0) * apart / distance, rtol=1e-12)


def test_the_work_that_the_cord_does_is_its_loss_of_energy() -> None:
    """With the hand at rest the force is that of the potential k/2 (|h − p| − L)²."""
    rng = np.random.default_rng(3)
    hand = moved(0.0, 2.0 + 6.0 / 200.0, 0.0)
    path = [TIP + 0.02 * rng.standard_normal(3)]
    for _ in range(200):
        path.append(path[-1] + 2e-4 * rng.standard_normal(3))
    forces = held_then(*path)

    def energy(tip: np.ndarray) -> float:
        return 100.0 * max(0.0, float(np.linalg.norm(hand - tip)) - 2.0) ** 2

    work = sum(
        0.5 * (forces[k] + forces[k + 1]) @ (path[k + 1] - path[k]) for k in range(len(path) - 1)
    )
    assert work == pytest.approx(energy(path[0]) - energy(path[-1]), abs=1e-4)


@pytest.mark.parametrize(("frame", "turn"), [("world", Rotation.identity()), ("body", TURN)])
def test_the_direction_is_that_of_the_attitude_when_the_pull_starts(
    frame: str, turn: Rotation
) -> None:
    rope = disturbances(Rope(kind="rope", frame=frame, direction=(1, 2, -2), pulls=(PULL,)))
    rope.act(2.0, motion(q_WB=Q_WB))
    force = rope.act(3.0, motion()).force_tip_W
    np.testing.assert_allclose(force, 6.0 * turn.apply([1 / 3, 2 / 3, -2 / 3]), atol=1e-9)


def test_every_pull_begins_where_the_tip_then_is_and_has_its_number() -> None:
    later = PULL.model_copy(update={"start_s": 6.0, "force_n": 2.0})
    between = PULL.model_copy(update={"start_s": 4.0, "force_n": 1.0})
    one = SOFT.model_copy(update={"pulls": (PULL, later)})
    other = Rope(kind="rope", direction=(0.0, 0.0, 1.0), pulls=(between,))
    ropes, seen = disturbances(one, other), []
    for k, t_s in enumerate((2.0, 3.0, 4.0, 5.0, 6.0, 7.0, 8.0)):
        tip = TIP + np.array([0.0, 0.2 * (k // 2), 0.0])  # it has moved on between two pulls
        load = ropes.act(t_s, motion(p_WT=tip))
        seen.append((load.record.pull, *np.round(load.force_tip_W, 9)))
    assert seen == [
        (1, 0, 0, 0), (1, 0, 6, 0), (2, 0, 0, 0), (2, 0, 0, 1), (3, 0, 0, 0), (3, 0, 2, 0),
        (0, 0, 0, 0),
    ]  # fmt: skip
