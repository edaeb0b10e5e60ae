"""The true surfaces that follow from belief and truth, and what is so at the tip."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from meshes import graph_corners, write_mesh

from inspect_cli.records import State
from inspect_cli.schema.geometry import (
    CylinderShape,
    Displacement,
    MeshShape,
    PlaneShape,
    Shape,
    SphereShape,
)
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.specimens import AnalyticSpecimen, AnalyticSpot
from inspect_cli.schema.truth import TrueSurface, TruthModel
from inspect_cli.truth.contact import ContactTruth
from inspect_cli.truth.geometry import StructureTruth, true_structure

WALL = PlaneShape(center_m=(2.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(3.0, 2.0))
BALL = SphereShape(
    center_m=(0.0, 5.0, 1.5), radius_m=1.0, facing=(0.0, -1.0, 0.0), size_m=(2.0, 2.0)
)
VAULT = CylinderShape(
    center_m=(-6.0, 0.0, 1.5),
    axis=(0.0, 1.0, 0.0),
    radius_m=2.0,
    facing=(0.0, 0.0, 1.0),
    size_m=(2.0, 4.0),
    side="inside",
)
SPECIMEN = AnalyticSpecimen(
    model="analytic",
    potential_v=-0.1,
    resistivity_ohm_m=200.0,
    spots=(AnalyticSpot(at_m=(0.3, 0.1), depth_v=0.3, radius_m=0.2, resistivity_factor=0.5),),
)
SPOT = (pytest.approx(-0.4), pytest.approx(100.0))


def believed(*shapes: Shape) -> tuple[PlannedSurface, ...]:
    return tuple(
        PlannedSurface(name=f"s{i}", shape=shape, source="shape") for i, shape in enumerate(shapes)
    )


def structure(truth: dict[str, TrueSurface], *shapes: Shape) -> StructureTruth:
    return true_structure(TruthModel(structure=truth), believed(*shapes), Path())


def test_without_a_truth_the_belief_holds() -> None:
    found = structure({}, WALL, BALL)
    assert [s.shape for s in found.surfaces] == [WALL, BALL]
    assert [s.friction for s in found.surfaces] == [0.5, 0.5]
    assert found.solids.primitives.shape == (2,)


def test_a_true_geometry_replaces_the_belief_and_a_displacement_moves_either() -> None:
    other = WALL.model_copy(update={"center_m": (2.2, 0.0, 1.5)})
    moved = Displacement(translate_m=(0.1, 0.0, 0.0))
    shapes = [
        structure({"s0": entry}, WALL).surfaces[0].shape
        for entry in (
            TrueSurface(geometry=other),
            TrueSurface(moved=moved),
            TrueSurface(geometry=other, moved=moved),
        )
    ]
    centers = [shape.center_m[0] for shape in shapes]
    np.testing.assert_allclose(centers, [2.2, 2.1, 2.3])


def test_an_absent_surface_is_not_there() -> None:
    found = structure({"s0": TrueSurface(absent=True)}, WALL, BALL)
    assert [s.name for s in found.surfaces] == ["s1"]
    assert found.solids.primitives.shape == (1,)
    assert structure({"s0": TrueSurface(absent=True)}, WALL).solids.primitives.shape == (0,)


def at(truth: StructureTruth, p_WT: list[float]) -> ContactTruth:
    contact, state = ContactTruth(truth), State.create({"n_rotors": 0, "n_joints": 0, "n_arm": 0})
    state.t_s, state.p_WT[:] = 7.0, p_WT
    contact.update(state)
    assert contact.contact.t_s == 7.0
    return contact


@pytest.mark.parametrize(
    ("p_WT", "surface", "distance", "n_W"),
    [
        ([1.9, 0.2, 1.4], 0, 0.1, [-1, 0, 0]),
        ([2.004, 0.2, 1.4], 0, -0.004, [-1, 0, 0]),
        ([0.0, 3.9, 1.5], 1, 0.1, [0, -1, 0]),
        ([0.0, 4.1, 1.5], 1, -0.1, [0, -1, 0]),
        ([-6.0, 1.0, 3.4], 2, 0.1, [0, 0, -1]),
        ([-6.0, 1.0, 3.6], 2, -0.1, [0, 0, -1]),
    ],
)
def test_the_nearest_surface_its_distance_and_its_normal(
    p_WT: list[float], surface: int, distance: float, n_W: list[float]
) -> None:
    contact = at(structure({}, WALL, BALL, VAULT), p_WT).contact
    assert contact.surface == surface
    assert contact.distance == pytest.approx(distance, abs=1e-9)
    np.testing.assert_allclose(contact.n_W, n_W, atol=1e-9)


def test_beside_a_patch_the_distance_is_to_its_edge() -> None:
    """Half a metre beyond the edge and level with the wall, nothing is touched."""
    contact = at(structure({}, WALL), [2.0, 2.0, 1.5]).contact
    assert contact.distance == pytest.approx(0.5)


def test_the_specimen_is_asked_where_the_tip_is() -> None:
    """In front of the wall that faces −x, u runs to the right: towards −y."""
    truth = structure({"s0": TrueSurface(specimen=SPECIMEN)}, WALL, BALL)
    contact = at(truth, [1.99, -0.3, 1.6]).contact
    np.testing.assert_allclose(contact.uv, [0.3, 0.1], atol=1e-9)
    assert (contact.potential, contact.resistivity) == SPOT
    bare = at(truth, [0.0, 3.9, 1.5]).contact
    assert np.isnan([bare.potential, bare.resistivity]).all()


def test_the_specimen_moves_with_its_surface() -> None:
    turned = Displacement(
        rotate_deg=(0.0, 0.0, 30.0), about_m=(2.0, 0.0, 1.5), translate_m=(0.1, 0.2, 0.3)
    )
    truth = structure({"s0": TrueSurface(specimen=SPECIMEN, moved=turned)}, WALL)
    c, s = np.cos(np.radians(30)), np.sin(np.radians(30))
    # The spot sat at −0.3 along y and 0.1 up from the middle of the wall.
    spot = [2.1 + 0.3 * s, 0.2 - 0.3 * c, 1.9]
    contact = at(truth, spot).contact
    assert contact.distance == pytest.approx(0.0, abs=1e-9)
    assert (contact.potential, contact.resistivity) == SPOT


def test_without_any_surface_there_is_no_contact() -> None:
    contact = at(structure({}), [1.0, 2.0, 3.0]).contact
    assert contact.surface == -1
    unknown = [contact.distance, *contact.n_W, *contact.uv, contact.potential, contact.resistivity]
    assert np.isnan(unknown).all()


def test_a_surface_that_only_the_truth_knows_comes_after_the_believed_ones() -> None:
    found = structure(
        {"pipe": TrueSurface(geometry=BALL, friction=0.2), "gone": TrueSurface(absent=True)}, WALL
    )
    assert [s.name for s in found.surfaces] == ["s0", "pipe"]
    assert found.surfaces[1].friction == 0.2
    hidden = structure({"pipe": TrueSurface(geometry=BALL, absent=True)}, WALL)
    assert [s.name for s in hidden.surfaces] == ["s0"]


def test_a_mesh_comes_last_and_carries_its_specimen_and_its_displacement(tmp_path: Path) -> None:
    """A level ceiling at 3 m, 2 m × 1.6 m, shifted: the specimen is asked at its own (u, v)."""
    write_mesh(tmp_path / "ceiling.ply", graph_corners(lambda x, y: 3.0 + 0.0 * x))
    mesh = MeshShape(file="ceiling.ply", normal=(0.0, 0.0, -1.0))
    moved = Displacement(translate_m=(-0.3, 6.1, 0.0))
    entry = TrueSurface(geometry=mesh, moved=moved, specimen=SPECIMEN, friction=0.7)
    truth = TruthModel(structure={"s0": entry, "late": TrueSurface(geometry=VAULT)})
    found = true_structure(truth, believed(WALL, BALL), tmp_path)
    assert [s.name for s in found.surfaces] == ["s1", "late", "s0"]
    assert found.surfaces[2].friction == 0.7
    assert found.solids.primitives.shape == (2,)
    assert found.solids.reliefs.shape == (1,)
    # u runs along x_W, v = n × u along −y_W: the spot at (0.3, 0.1) is at (0, 6).
    contact = at(found, [0.0, 6.0, 2.99]).contact
    assert contact.surface == 2
    assert contact.distance == pytest.approx(0.01, abs=1e-6)
    np.testing.assert_allclose(contact.n_W, [0.0, 0.0, -1.0], atol=1e-9)
    np.testing.assert_allclose(contact.uv, [0.3, 0.1], atol=1e-6)
    assert (contact.potential, contact.resistivity) == SPOT
    assert at(found, [0.0, 6.0, 3.004]).contact.distance == pytest.approx(-0.004, abs=1e-6)
    assert at(found, [0.0, 4.5, 1.5]).contact.surface == 0


def test_the_temperature_of_each_surface() -> None:
    warm = SPECIMEN.model_copy(update={"temperature_c": 35.0})
    truth = {"s0": TrueSurface(specimen=warm), "s2": TrueSurface(specimen=SPECIMEN)}
    assert structure(truth, WALL, BALL, VAULT).temperatures_c == [35.0, 22.2, 22.2]
