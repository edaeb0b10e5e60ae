"""Rasters of the truth: cell by cell the specimen's own values, seen from the believed surface."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.schema.geometry import Displacement, PlaneShape, SphereShape
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.specimens import AnalyticSpecimen, AnalyticSpot
from inspect_cli.schema.truth import TrueSurface, TruthModel
from inspect_cli.truth.geometry import true_structure
from inspect_cli.truth.rasters import (
    MOST_ALONG,
    MOST_CELLS,
    UnderSurface,
    all_under_surfaces,
    true_rasters,
)
from inspect_cli.truth.specimens import load_specimen

SPECIMEN = AnalyticSpecimen(
    model="analytic",
    potential_v=-0.12,
    resistivity_ohm_m=220.0,
    spots=(AnalyticSpot(at_m=(0.3, -0.2), depth_v=0.38, radius_m=0.2, resistivity_factor=0.15),),
)
WALL = PlaneShape(
    kind="plane", center_m=(2.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(2.0, 1.5)
)


def believed(shape=WALL, name: str = "wall") -> PlannedSurface:
    return PlannedSurface(name=name, shape=shape, source="given")


def beneath(tmp_path, entry: TrueSurface, surface: PlannedSurface) -> UnderSurface:
    structure = true_structure(TruthModel(structure={surface.name: entry}), [surface], tmp_path)
    (found,) = all_under_surfaces(structure, [surface])
    return found


def test_each_cell_holds_what_the_specimen_says_at_its_middle(tmp_path) -> None:
    field = load_specimen(SPECIMEN, tmp_path)
    structure = true_structure(
        TruthModel(structure={"wall": TrueSurface(specimen=SPECIMEN)}), [believed()], tmp_path
    )
    (raster,) = true_rasters(structure, [believed()])
    rows, columns = raster.potential_v.shape
    assert (rows, columns) == (len(raster.v_m), len(raster.u_m))
    assert rows * columns <= MOST_CELLS
    assert max(rows, columns) <= MOST_ALONG
    # Cells tile the whole wall and are about square.
    du, dv = raster.step_m
    assert (columns * du, rows * dv) == pytest.approx((2.0, 1.5))
    assert du == pytest.approx(dv, rel=0.03)
    assert raster.u_m[0] == pytest.approx(-1.0 + du / 2)
    assert raster.v_m[-1] == pytest.approx(0.75 - dv / 2)
    for row, column in np.random.default_rng(3).integers(0, (rows, columns), (200, 2)):
        u, v = raster.u_m[column], raster.v_m[row]
        values = raster.potential_v[row, column], raster.resistivity_ohm_m[row, column]
        assert values == pytest.approx(field.at(u, v))
        assert raster.active[row, column] == field.active(np.array([[u, v]]))
    # Active where −350 mV and 100 Ω·m are passed: −2 ln(120/187) of σ² around the spot.
    radius_m = 0.2 * np.sqrt(-2.0 * np.log(120.0 / 187.0))
    assert raster.active.sum() * du * dv == pytest.approx(np.pi * radius_m**2, rel=0.01)


def test_a_specimen_that_moved_with_its_surface_is_seen_where_it_is(tmp_path) -> None:
    """10 cm to the right seen from the free side, which is −y here, and 4 cm away."""
    moved = Displacement(translate_m=(0.04, -0.1, 0.0))
    found = beneath(tmp_path, TrueSurface(specimen=SPECIMEN, moved=moved), believed())
    field = load_specimen(SPECIMEN, tmp_path)
    places = np.array([[0.4, -0.2], [0.3, -0.2], [-0.95, 0.0]])
    potential, rho, active = found.at(places)
    assert (potential[0], rho[0]) == pytest.approx(field.at(0.3, -0.2))
    assert (potential[1], rho[1]) == pytest.approx(field.at(0.2, -0.2))
    assert active.tolist() == [True, True, False]
    # The true wall ends 10 cm further right: at its left end the belief has nothing beneath it.
    assert np.isnan(potential[2])
    raster = found.raster()
    assert np.isnan(raster.potential_v[:, raster.u_m < -0.9]).all()
    assert np.isfinite(raster.potential_v[:, raster.u_m > -0.9]).all()
    assert not raster.active[np.isnan(raster.potential_v)].any()


def test_only_what_is_believed_and_has_a_specimen_has_a_raster(tmp_path) -> None:
    surfaces = [believed(), believed(name="other"), believed(name="gone")]
    truth = TruthModel(
        structure={
            "wall": TrueSurface(specimen=SPECIMEN),
            "gone": TrueSurface(specimen=SPECIMEN, absent=True),
            "unknown": TrueSurface(geometry=WALL, specimen=SPECIMEN),
        }
    )
    structure = true_structure(truth, surfaces, tmp_path)
    assert [raster.surface for raster in true_rasters(structure, surfaces)] == ["wall"]
    assert true_rasters(true_structure(TruthModel(), surfaces, tmp_path), surfaces) == ()


def test_several_surfaces_share_the_cells(tmp_path) -> None:
    surfaces = [believed(), believed(name="other")]
    truth = TruthModel(structure={s.name: TrueSurface(specimen=SPECIMEN) for s in surfaces})
    rasters = true_rasters(true_structure(truth, surfaces, tmp_path), surfaces)
    assert sum(raster.active.size for raster in rasters) <= MOST_CELLS
    assert rasters[0].potential_v == pytest.approx(rasters[1].potential_v)


def test_a_whole_sphere_is_closed_and_narrows_towards_its_poles(tmp_path) -> None:
    ball = SphereShape(
        kind="sphere",
        center_m=(2.0, 0.0, 2.0),
        radius_m=0.5,
        facing=(-1.0, 0.0, 0.0),
        size_m=(np.pi, 0.5 * np.pi),
        side="outside",
    )
    raster = beneath(tmp_path, TrueSurface(specimen=SPECIMEN), believed(ball)).raster()
    assert raster.turn_m == pytest.approx(np.pi)
    du, dv = raster.step_m
    area_m2 = raster.across(raster.v_m).sum() * len(raster.u_m) * du * dv
    assert area_m2 == pytest.approx(4.0 * np.pi * 0.25, rel=0.001)
