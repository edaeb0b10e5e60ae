"""The cable: the catenary by numerical integration, weights, continuity, the taut limit."""

from __future__ import annotations

import numpy as np
import pytest
from loads import disturbances, motion
from scipy.integrate import solve_ivp

from inspect_cli.schema.disturbances import Cable
from inspect_cli.truth.disturbances.cable import end_force

LENGTH, WEIGHT, STIFFNESS = 12.0, 0.03 * 9.81, 500.0


def at(x: float, z: float) -> tuple[float, float]:
    return end_force(x, z, LENGTH, WEIGHT, STIFFNESS)


def traced(x: float, z: float) -> tuple[float, float, float, float]:
    """Down the cable from its end: (reach, height, V, length) where it lies down or ends.

    A piece ds carries H all along and loses w ds of V: dx/ds = H/T, dz/ds = −V/T.
    """
    horizontal, down = at(x, z)
    stretched = LENGTH + horizontal * np.hypot(x, z) / x / STIFFNESS

    def slope(_: float, y: np.ndarray) -> list[float]:
        tension = np.hypot(horizontal, y[2])
        return [horizontal / tension, -y[2] / tension, -WEIGHT]

    def flat(_: float, y: np.ndarray) -> float:
        return float(y[2])

    flat.terminal = True
    line = solve_ivp(slope, (0.0, stretched), [0.0, z, down], events=flat, rtol=1e-10, atol=1e-12)
    reach, height, left = line.y[:, -1]
    return reach, height, left, stretched - line.t[-1]


@pytest.mark.parametrize(("x", "z"), [(0.0, 1.25), (3.0, 2.0), (10.7, 1.25), (0.0, 12.0)])
def test_slack_it_hangs_plumb_with_the_weight_of_what_it_lifts(x: float, z: float) -> None:
    assert at(x, z) == pytest.approx((0.0, WEIGHT * z))


@pytest.mark.parametrize(("x", "z"), [(10.8, 1.25), (11.5, 1.25), (11.9, 0.5), (8.0, 5.0)])
def test_lying_it_meets_the_ground_flat_and_the_rest_reaches_the_clamp(x: float, z: float) -> None:
    reach, height, left, lying = traced(x, z)
    assert left == pytest.approx(0.0, abs=1e-9)
    assert height == pytest.approx(0.0, abs=1e-6)
    assert lying > 0.0
    assert reach + lying == pytest.approx(x, abs=1e-6)


@pytest.mark.parametrize(("x", "z"), [(11.0, 4.5), (6.0, 10.0), (1.0, 11.9), (11.9, 1.7)])
def test_lifted_it_ends_at_the_clamp(x: float, z: float) -> None:
    reach, height, left, rest = traced(x, z)
    assert left > 0.0 or abs(rest) < 1e-9
    assert (reach, height, rest) == pytest.approx((x, 0.0, 0.0), abs=1e-6)


def test_lifted_its_weight_is_what_both_ends_carry() -> None:
    """And the clamp is pulled up by what is left of V: the end carries all of it at most."""
    horizontal, down = at(6.0, 10.0)
    stretched = LENGTH + horizontal * np.hypot(6.0, 10.0) / 6.0 / STIFFNESS
    assert WEIGHT * LENGTH < down < 2.0 * WEIGHT * LENGTH
    _, _, left, _ = traced(6.0, 10.0)
    assert down - left == pytest.approx(WEIGHT * stretched, rel=1e-9)


def boundary(inside: tuple[float, float], outside: tuple[float, float]) -> float:
    """The largest jump of (H, V) along the way, beyond what a smooth force does in a step."""
    way = np.linspace(inside, outside, 40001)
    forces = np.array([at(x, z) for x, z in way])
    return float(np.abs(np.diff(forces, 2, axis=0)).max())


@pytest.mark.parametrize(
    ("start", "end"),
    [((10.5, 1.25), (11.95, 1.25)), ((8.0, 2.0), (8.0, 9.5)), ((0.02, 11.0), (0.02, 12.3))],
)
def test_the_regimes_join_without_a_jump(
    start: tuple[float, float], end: tuple[float, float]
) -> None:
    assert boundary(start, end) < 2e-3


def test_without_a_reach_and_without_a_height_it_stays_finite() -> None:
    for x in (0.0, 1e-12, 1e-6):
        horizontal, down = at(x, 12.05)
        # The tension in its middle is k times the stretch, half of its weight hangs below; the
        # catenary's coth u is not 1/u by u/3 = 0.024 of that half weight.
        half_weight = 0.5 * WEIGHT * 12.05
        assert down == pytest.approx(STIFFNESS * 0.05 + half_weight, abs=0.03 * half_weight)
        assert horizontal < 1e-4
    assert at(5.0, 0.0) == (0.0, 0.0)
    assert at(5.0, -0.1) == (0.0, 0.0)
    horizontal, down = at(12.1, 1e-9)
    assert horizontal == pytest.approx(STIFFNESS * 0.1, rel=1e-2)
    assert 0.0 <= down < 1e-2


def test_stretched_out_it_pulls_along_its_chord_with_its_stiffness() -> None:
    for distance in (12.2, 15.0, 100.0):
        x, z = 0.8 * distance, 0.6 * distance
        horizontal, down = at(x, z)
        pull = STIFFNESS * (distance - LENGTH)
        assert horizontal == pytest.approx(0.8 * pull, rel=0.02)
        assert down - 0.5 * WEIGHT * LENGTH == pytest.approx(0.6 * pull, rel=0.02)


def test_it_never_pulls_less_further_out() -> None:
    distances = np.linspace(0.1, 14.0, 3000)
    forces = np.array([np.hypot(*at(0.98 * d, 0.2 * d)) for d in distances])
    assert np.isfinite(forces).all()
    assert (np.diff(forces) > -1e-9).all()


def test_it_pulls_the_tip_or_the_body_towards_the_clamp_and_down() -> None:
    cable = Cable(kind="cable", length_m=2.0, mass_kgpm=0.03, clamp_m=(3.55, 4.0))
    at_tip = disturbances(cable).act(0.0, motion(p_WT=(0.55, 0.0, 1.0)))
    horizontal, down = end_force(5.0, 1.0, 2.0, WEIGHT, STIFFNESS)
    expected = np.array([0.6 * horizontal, 0.8 * horizontal, -down])
    np.testing.assert_allclose(at_tip.force_tip_W, expected)
    np.testing.assert_array_equal(at_tip.record.f_cable_W, at_tip.force_tip_W)
    assert not at_tip.force_W.any()
    on_body = cable.model_copy(update={"attached": "body"})
    load = disturbances(on_body).act(0.0, motion(p_WB=(0.55, 0.0, 1.0), p_WT=(9.0, 9.0, 9.0)))
    np.testing.assert_allclose(load.force_W, expected)
    assert not load.force_tip_W.any()


def test_without_a_clamp_it_is_fixed_under_the_start() -> None:
    cable = disturbances(Cable(kind="cable", length_m=2.0, mass_kgpm=0.03, attached="body"))
    np.testing.assert_array_equal(cable.act(0.0, motion(p_WB=(1.0, 2.0, 0.2))).force_W[:2], 0.0)
    away = cable.act(0.004, motion(p_WB=(4.0, 2.0, 1.0))).force_W
    assert away[0] < -100.0
    assert away[1] == 0.0
