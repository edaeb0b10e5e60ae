"""A macro cell as a specimen: its field, its cache, its place under a true surface."""

from __future__ import annotations

import os
from pathlib import Path
from typing import Any

import numpy as np
import pytest
from cells import SITE, WALL, specimen
from meshes import graph_corners, write_mesh

from inspect_cli.errors import InputError
from inspect_cli.schema.geometry import CylinderShape, MeshShape, PlaneShape, TrueShape
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.specimens.macro_cell import ActiveSite
from inspect_cli.schema.truth import TrueSurface, TruthModel
from inspect_cli.truth import cache
from inspect_cli.truth.geometry import true_structure
from inspect_cli.truth.macro_cell.patch import Patch, patch_of
from inspect_cli.truth.macro_cell.solution import solve_cell
from inspect_cli.truth.specimens import load_specimen
from inspect_cli.truth.specimens import macro_cell as specimens
from inspect_cli.truth.specimens.fields import SpecimenField

PLANE = PlaneShape(center_m=(2, 0, 1.5), normal=(-1, 0, 0), size_m=(0.8, 0.8))
PIER = CylinderShape(
    center_m=(3, 0, 1.5), axis=(0, 0, 1), radius_m=0.4, facing=(-1, 0, 0), size_m=(0.8, 0.8)
)


def field(**entries: Any) -> SpecimenField:
    return load_specimen(specimen(**entries), Path(), WALL)


def test_the_field_goes_through_the_solutions_nodes() -> None:
    cell = solve_cell(specimen(), WALL)
    found = field()
    for row, column in [(0, 0), (16, 16), (3, 30), (32, 32), (20, 7)]:
        potential, resistivity = found.at(cell.concrete.u[column], cell.concrete.v[row])
        assert potential == pytest.approx(cell.potentials.concrete[0, row, column], abs=1e-9)
        warmth = 25e3 / 8.314 * (1.0 / 293.15 - 1.0 / 295.35)
        assert resistivity == pytest.approx(200.0 * np.exp(-warmth), rel=1e-4)


def test_between_nodes_it_follows_a_finer_solution() -> None:
    fine = load_specimen(specimen(resolution_m=0.0125), Path(), WALL)
    for u, v in [(0.0125, 0.0), (0.0375, 0.0125), (-0.0875, 0.0625)]:
        assert field().at(u, v)[0] == pytest.approx(fine.at(u, v)[0], abs=5e-3)


def test_v_runs_up_and_u_to_the_right() -> None:
    found = field(sites=(ActiveSite(at_m=(-0.2, 0.15), radius_m=0.05),))
    there = found.at(-0.2, 0.15)[0]
    assert there < -0.35
    assert all(found.at(*at)[0] > there + 0.1 for at in [(0.2, 0.15), (-0.2, -0.15), (0.15, -0.2)])


def test_outside_of_the_concrete_there_are_no_values() -> None:
    found = field(size_m=(0.4, 0.4), at_m=(0.1, 0.0))
    assert np.isfinite(found.at(0.3, -0.2)).all()
    for u, v in [(0.301, 0.0), (-0.101, 0.0), (0.0, 0.201), (0.0, -0.201), (np.nan, 0.0)]:
        assert np.isnan(found.at(u, v)).all()
        assert not found.active(np.array([[u, v]]))


def test_the_steel_is_active_in_its_sites_alone() -> None:
    found = field()
    places = np.array([[0.0, 0.0], [0.049, 0.0], [0.051, 0.0]])
    assert found.active(places).tolist() == [True, True, False]
    assert found.at(0.051, 0.0)[0] < -0.35, "negative, but passive: the site polarises it"


def test_the_same_with_and_without_the_cache(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("INSPECT_CACHE_DIR", str(tmp_path / "new" / "folder"))
    at = [(0.01 * k, 0.007 * k) for k in range(-50, 51)]
    computed = [field().at(*p) for p in at]
    (file,) = (tmp_path / "new" / "folder").iterdir()
    whole = file.read_bytes()
    monkeypatch.setattr(specimens, "surface_reading", must_not_run)
    np.testing.assert_array_equal([field().at(*p) for p in at], computed)
    monkeypatch.undo()
    monkeypatch.setenv("INSPECT_CACHE_DIR", str(tmp_path / "new" / "folder"))
    for damaged in (b"", whole[:100], whole[:-1], whole[:500] + b"x" + whole[501:]):
        file.write_bytes(damaged)
        np.testing.assert_array_equal([field().at(*p) for p in at], computed)
        assert file.read_bytes() == whole


def must_not_run(*_: object) -> None:
    raise AssertionError("it was in the cache")


def test_a_cache_that_cannot_be_written_does_no_harm(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    blocked = tmp_path / "a file"
    blocked.write_text("")
    for folder in (blocked, blocked / "under it"):
        monkeypatch.setenv("INSPECT_CACHE_DIR", str(folder))
        assert field().at(0.0, 0.0)[0] < -0.35
    assert os.listdir(tmp_path) == ["a file"]


def test_other_inputs_are_other_entries(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("INSPECT_CACHE_DIR", str(tmp_path))
    field()
    field(temperature_c=10.0)
    load_specimen(specimen(), Path(), Patch(WALL.size_m, "cylinder", 2.0))
    assert len(os.listdir(tmp_path)) == 3


def test_where_the_cache_is(monkeypatch: pytest.MonkeyPatch) -> None:
    both = {"INSPECT_CACHE_DIR": "/a", "XDG_CACHE_HOME": "/b"}
    assert cache.cache_folder(both) == Path("/a")
    assert cache.cache_folder({**both, "INSPECT_CACHE_DIR": ""}) == Path("/b/inspect")
    assert cache.cache_folder({}) == Path.home() / ".cache" / "inspect"

    def homeless() -> Path:
        raise RuntimeError("no home")

    monkeypatch.setattr(Path, "home", homeless)
    assert cache.cache_folder({}) is None


def placed(shape: TrueShape, root: Path = Path(), **entries: Any) -> SpecimenField:
    truth = TruthModel(structure={"s": TrueSurface(specimen=specimen(**entries), geometry=shape)})
    found = true_structure(truth, (), root).surfaces[0].specimen
    assert found is not None
    return found


def test_it_lies_under_the_true_shape(tmp_path: Path) -> None:
    flat, round_ = placed(PLANE), placed(PIER, thickness_m=0.2)
    assert flat.at(0.1, 0.0) == field().at(0.1, 0.0)
    assert abs(round_.at(0.1, 0.0)[0] - flat.at(0.1, 0.0)[0]) > 1e-3
    corners = graph_corners(lambda x, y: 0.01 * np.sin(6 * x))
    write_mesh(tmp_path / "relief.ply", corners)
    mesh = placed(MeshShape(file="relief.ply", normal=(0, 0, 1)), tmp_path, size_m=(0.8, 0.8))
    assert mesh.at(0.1, 0.0) == flat.at(0.1, 0.0)


def test_patches_take_the_side_that_is_touched() -> None:
    assert patch_of(PLANE, (0, 0)) == Patch((0.8, 0.8))
    assert patch_of(PIER, (0, 0)) == Patch((0.8, 0.8), "cylinder", 2.5)
    hollow = PIER.model_copy(update={"side": "inside"})
    assert patch_of(hollow, (0, 0)).curvature == -2.5
    assert patch_of(MeshShape(file="a.ply"), (1.0, 2.0)) == Patch((1.0, 2.0))


def test_a_belief_that_it_does_not_fit_is_refused() -> None:
    def structure(shape: CylinderShape | PlaneShape, **entries: Any) -> None:
        truth = TruthModel(structure={"s": TrueSurface(specimen=specimen(**entries))})
        true_structure(truth, [PlannedSurface(name="s", shape=shape, source="shape")], Path())

    with pytest.raises(InputError, match=r"truth\.structure\.s\.specimen: thickness_m 0\.5 must"):
        structure(PIER, thickness_m=0.5)
    with pytest.raises(InputError, match=r"lies outside of the modelled 0\.8 m × 0\.8 m"):
        structure(PLANE, sites=(SITE.model_copy(update={"at_m": (0.5, 0.0)}),))
    with pytest.raises(InputError, match="has to state its size_m"):
        load_specimen(specimen(), Path())
    assert load_specimen(specimen(size_m=(0.8, 0.8)), Path()).active(np.zeros((1, 2)))


def test_it_knows_its_temperature() -> None:
    assert field(temperature_c=35.0).temperature_c == 35.0
