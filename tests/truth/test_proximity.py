"""Ground, ceiling and wall effect: published numbers, geometry, switches."""

from __future__ import annotations

import numpy as np
import pytest
from meshes import graph_corners
from scipy.optimize import brentq
from scipy.spatial.transform import Rotation

from inspect_cli.schema.geometry import PlaneShape, Shape
from inspect_cli.schema.primitives import primitives_of
from inspect_cli.schema.truth import ProximityEffects
from inspect_cli.truth.heights import relief_of
from inspect_cli.truth.proximity import Proximity, ceiling_factor, ground_factor, wall_factor
from inspect_cli.truth.solids import Solids

R = 0.1143
OFF = {"ground": False, "ceiling": False, "wall": False}
SOFFIT = PlaneShape(center_m=(0.0, 0.0, 3.0), normal=(0.0, 0.0, -1.0), size_m=(2.0, 2.0))
WALL = PlaneShape(center_m=(2.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(3.0, 3.0))


@pytest.mark.parametrize(
    ("d_over_R", "power"), [(0.1, 0.43), (0.25, 0.73), (0.5, 0.90), (1.0, 0.97)]
)
def test_power_under_a_ceiling_at_constant_thrust(d_over_R: float, power: float) -> None:
    """P = T^1.5 / (γ √(2ρA)): the power that keeps the thrust, found by bisection."""
    factor = ceiling_factor(d_over_R * R, R)
    # In free air T ∝ P^(2/3); near the ceiling the factor comes on top.
    found = brentq(lambda p: factor * p ** (2.0 / 3.0) - 1.0, 0.1, 1.0)
    assert found == pytest.approx(power, abs=0.005)


def test_the_ceiling_is_clamped_at_a_tenth_of_the_radius_and_fades() -> None:
    assert ceiling_factor(0.0, R) == ceiling_factor(0.1 * R, R)
    assert ceiling_factor(-1.0, R) == ceiling_factor(0.1 * R, R)
    assert ceiling_factor(10.0 * R, R) == pytest.approx(1.0, abs=1e-3)


@pytest.mark.parametrize(("z_over_R", "factor"), [(0.5, 4 / 3), (1.0, 16 / 15), (2.0, 64 / 63)])
def test_ground_effect_of_cheeseman_and_bennett(z_over_R: float, factor: float) -> None:
    assert ground_factor(z_over_R * R, R) == pytest.approx(factor, rel=1e-12)


def test_the_ground_is_clamped_at_half_the_radius() -> None:
    for z in (-1.0, 0.0, 0.25 * R):  # at R/4 the formula has its pole
        assert ground_factor(z, R) == pytest.approx(4 / 3)


def test_a_wall_takes_three_per_cent_at_most_and_fades_within_a_radius() -> None:
    assert wall_factor(0.0, R) == pytest.approx(0.97)
    assert wall_factor(-0.01, R) == pytest.approx(0.97)
    assert wall_factor(R, R) == pytest.approx(1.0 - 0.03 / np.e)


def gain(
    effects: dict[str, bool], shapes: list[Shape], hub_W: list[float], thrust_W: list[float]
) -> float:
    """The gain that one rotor's actuator gets, in arrays shaped as MuJoCo's."""
    proximity = Proximity(
        ProximityEffects(**{**OFF, **effects}), Solids(primitives_of(shapes)), np.array([R])
    )
    up = np.array(thrust_W) / np.linalg.norm(thrust_W)
    rotation, _ = Rotation.align_vectors([up], [[0.0, 0.0, 1.0]])
    site_xpos = np.array([[9.0, 9.0, 9.0], hub_W])
    site_xmat = np.array([np.eye(3).ravel(), rotation.as_matrix().ravel()])
    gains = np.ones((1, 10))
    proximity.update(site_xpos, site_xmat, np.array([1], np.int32), np.array([0], np.int32), gains)
    assert (gains[0, 1:] == 1.0).all()
    return float(gains[0, 0])


def test_a_rotor_feels_the_ceiling_along_its_thrust() -> None:
    near = gain({"ceiling": True}, [SOFFIT], [0.3, 0.2, 3.0 - 0.5 * R], [0, 0, 1])
    assert near == pytest.approx(ceiling_factor(0.5 * R, R), rel=1e-9)
    slanted = gain({"ceiling": True}, [SOFFIT], [0.3, 0.2, 3.0 - 0.5 * R], [0, 1, 1])
    assert slanted == pytest.approx(ceiling_factor(0.5 * R * np.sqrt(2.0), R), rel=1e-6)
    beside = gain({"ceiling": True}, [SOFFIT], [1.5, 0.0, 3.0 - 0.5 * R], [0, 0, 1])
    assert beside == 1.0
    away = gain({"ceiling": True}, [SOFFIT], [0.3, 0.2, 3.0 - 0.5 * R], [1, 0, 0])
    assert away == 1.0


def test_a_rotor_feels_the_ground_against_its_thrust() -> None:
    assert gain({"ground": True}, [], [4.0, 5.0, R], [0, 0, 1]) == pytest.approx(16 / 15)
    assert gain({"ground": True}, [], [4.0, 5.0, R], [1, 0, 0]) == 1.0
    # A rotor that pushes away from a wall has the wall for its ground.
    wall = gain({"ground": True}, [WALL], [2.0 - R, 0.0, 1.5], [-1, 0, 0])
    assert wall == pytest.approx(16 / 15)


def test_a_rotor_feels_the_wall_beside_it_but_not_the_ground() -> None:
    beside = gain({"wall": True}, [WALL], [2.0 - R, 0.0, 1.5], [0, 0, 1])
    assert beside == pytest.approx(wall_factor(R, R), rel=1e-9)
    assert gain({"wall": True}, [WALL], [0.0, 0.0, 0.05], [0, 0, 1]) == pytest.approx(1.0, abs=1e-6)


def test_each_effect_is_switched_on_its_own_and_all_multiply() -> None:
    place: tuple[list[float], list[float]] = ([0.9, 0.0, 3.0 - R], [0, 0, 1])
    near_wall = PlaneShape(center_m=(1.0, 0.0, 2.0), normal=(-1.0, 0.0, 0.0), size_m=(2.0, 2.0))
    alone = {name: gain({name: True}, [SOFFIT, near_wall], *place) for name in OFF}
    assert alone["ground"] == 1.0  # three metres up
    assert alone["ceiling"] > 1.0
    assert alone["wall"] < 1.0
    everything = gain(dict.fromkeys(OFF, True), [SOFFIT, near_wall], *place)
    assert everything == pytest.approx(alone["ceiling"] * alone["wall"], rel=1e-12)
    assert gain({}, [SOFFIT, near_wall], *place) == 1.0
    assert not Proximity(ProximityEffects(**OFF), Solids(primitives_of([])), np.array([R])).any
    for name in OFF:
        assert Proximity(
            ProximityEffects(**{**OFF, name: True}), Solids(primitives_of([])), np.array([R])
        ).any


def test_a_relief_is_a_ceiling_and_a_wall_as_a_plane_is() -> None:
    """A level mesh at 3 m against the same rectangle, for rotors below, beside and above it."""
    level = relief_of(graph_corners(lambda x, y: 3.0 + 0.0 * x), np.array([0.0, 0.0, -1.0]), 0.02)
    rectangle = PlaneShape(center_m=(0.0, 0.0, 3.0), normal=(0.0, 0.0, -1.0), size_m=(2.0, 1.6))
    effects = ProximityEffects(ground=False)
    bare, radii = Solids(primitives_of([])), np.full(4, R)
    both = (
        Proximity(effects, bare._replace(reliefs=level.row, nodes=level.nodes), radii),
        Proximity(effects, Solids(primitives_of([rectangle])), radii),
    )
    mixed = Proximity(
        effects,
        Solids(primitives_of([WALL]), level.row, level.nodes),
        radii,
    )
    up = np.tile(np.eye(3).ravel(), (4, 1))
    hubs = np.array([[0.1, 0.2, 2.9], [0.5, 0.0, 2.7], [1.1, 0.0, 2.95], [1.9, 0.0, 2.9]])
    rotors, gains = np.arange(4, dtype=np.int32), np.ones((3, 4, 1))
    for proximity, gain in zip((*both, mixed), gains, strict=True):
        proximity.update(hubs, up, rotors, rotors, gain)
    np.testing.assert_allclose(gains[0], gains[1], atol=2e-5)  # beside it to the nearest node
    assert gains[0, 0] == pytest.approx(ceiling_factor(0.1, R) * wall_factor(0.1, R), rel=1e-6)
    assert gains[2, 0] == pytest.approx(gains[0, 0])
    assert gains[2, 3] == pytest.approx(wall_factor(0.1, R), rel=1e-3)
