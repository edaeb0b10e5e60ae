"""Reliefs against analytic heights, scipy's minimum, a dense search and Open3D's ray caster."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest
from meshes import Array, box_corners, graph_corners, write_mesh
from scipy.optimize import minimize
from scipy.spatial.transform import Rotation

from inspect_cli.errors import GeometryError, InputError
from inspect_cli.scans.files import open3d
from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.spatial.primitives import PRIMITIVE
from inspect_cli.truth.heights import MeshRelief, mesh_relief, relief_of
from inspect_cli.truth.relief import height_at, relief_covers, relief_normal, relief_point
from inspect_cli.truth.solids import Solids, cast, foot_on, point_on

UP = np.array([0.0, 0.0, 1.0])


def waves(x: Array, y: Array) -> Array:
    """Wavelengths of 1 m and 1.4 m, 3 cm high, on a slope."""
    return 0.03 * np.sin(2.0 * np.pi * x) * np.cos(4.5 * y) + 0.1 * x + 2.0


def solids_of(relief: MeshRelief) -> Solids:
    return Solids(np.zeros(0, PRIMITIVE), relief.row, relief.nodes)


@pytest.fixture(scope="module")
def wavy() -> MeshRelief:
    return relief_of(graph_corners(waves), UP, 0.02)


@pytest.fixture(scope="module")
def vault(root: Path) -> MeshRelief:
    shape = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))
    return mesh_relief(shape, Displacement(), root)


def test_heights_and_slopes_are_those_of_the_mesh(wavy: MeshRelief) -> None:
    """The mesh's chords lie h²/8 · 1.2 /m = 15 μm off the waves, their slopes h/2 · 1.2 /m."""
    rng = np.random.default_rng(1)
    middle = wavy.row["p_WS"][0]
    for u, v in rng.uniform([-0.98, -0.78], [0.98, 0.78], (200, 2)):
        h, h_u, h_v = height_at(wavy.row, wavy.nodes, 0, u, v)
        assert middle[2] + h == pytest.approx(waves(u, v), abs=5e-5)
        step = 1e-4
        slope = (waves(u + step, v) - waves(u - step, v)) / (2.0 * step)
        assert h_u == pytest.approx(slope, abs=8e-3)
        ahead, behind = (height_at(wavy.row, wavy.nodes, 0, u, v + s)[0] for s in (1e-6, -1e-6))
        assert h_v == pytest.approx((ahead - behind) / 2e-6, abs=1e-7)
    assert wavy.deviation_m < 5e-5


def test_the_normal_is_square_to_the_surface_and_never_jumps(wavy: MeshRelief) -> None:
    previous = None
    for u in np.arange(-0.5, 0.5, 1e-3):
        n = relief_normal(wavy.row, wavy.nodes, 0, u, 0.123)
        along = relief_point(wavy.row, wavy.nodes, 0, u + 1e-6, 0.123)
        along = along - relief_point(wavy.row, wavy.nodes, 0, u - 1e-6, 0.123)
        assert n @ along == pytest.approx(0.0, abs=1e-10)
        assert n @ n == pytest.approx(1.0)
        if previous is not None:  # 1.5 /m of curvature over a millimetre, and the mesh's kinks
            assert np.linalg.norm(n - previous) < 4e-3
        previous = n


@pytest.mark.parametrize("away_m", [-0.05, -0.004, 0.0, 0.01, 0.2])
def test_the_foot_is_the_nearest_point(vault: MeshRelief, away_m: float) -> None:
    solids = solids_of(vault)
    rng = np.random.default_rng(3)
    half = vault.row["half_size"][0] - 0.15
    for u, v in rng.uniform(-half, half, (40, 2)):
        n = relief_normal(vault.row, vault.nodes, 0, u, v)
        p = point_on(solids, 0, u, v) + away_m * n
        found_u, found_v, w, on = foot_on(solids, 0, p)
        assert on
        foot = point_on(solids, 0, found_u, found_v)
        square = minimize(
            lambda uv, p=p: np.sum((point_on(solids, 0, *uv) - p) ** 2), [u, v], tol=1e-12
        ).fun
        assert abs(w) <= np.sqrt(square) + 1e-7
        assert np.sign(w) == np.sign(away_m) or abs(w) < 1e-7
        if abs(away_m) <= 0.01:  # within every radius of curvature the foot is where we set out
            np.testing.assert_allclose(foot, p - away_m * n, atol=1e-7)
            assert w == pytest.approx(away_m, abs=1e-9)


def test_beside_the_mesh_the_distance_is_to_its_nearest_node(wavy: MeshRelief) -> None:
    solids = solids_of(wavy)
    *_, w, on = foot_on(solids, 0, np.array([1.5, 0.0, waves(1.0, 0.0)]))
    assert not on
    assert w == pytest.approx(0.5, abs=1e-3)


def test_far_behind_the_distance_is_negative_and_the_least_there_is(wavy: MeshRelief) -> None:
    far = np.array([0.1, 0.2, 1.0])
    x, y = np.meshgrid(np.linspace(-1.0, 1.0, 401), np.linspace(-0.8, 0.8, 321))
    least = np.sqrt(((np.stack([x, y, waves(x, y)], axis=-1) - far) ** 2).sum(axis=-1).min())
    assert foot_on(solids_of(wavy), 0, far)[2] == pytest.approx(-least, abs=1e-4)


def directions(rng: np.random.Generator, count: int) -> Array:
    d = rng.standard_normal((count, 3))
    return d / np.linalg.norm(d, axis=1, keepdims=True)


def test_rays_meet_what_a_dense_search_meets(wavy: MeshRelief) -> None:
    """Every first crossing along 2 mm steps, refined; grazing tips thinner than that may differ."""
    solids, rng = solids_of(wavy), np.random.default_rng(5)
    origin = np.array([0.1, -0.2, 2.4])
    rays = directions(rng, 400)
    ranges = np.empty(len(rays))
    cast(solids, origin, rays, np.full(len(rays), 3.0), ranges)
    hits = 0
    for ray, found in zip(rays, ranges, strict=True):
        t = np.arange(0.0, 3.0, 0.002)
        p = origin + t[:, None] * ray - wavy.row["p_WS"][0]
        inside = (np.abs(p[:, 0]) <= 1.0) & (np.abs(p[:, 1]) <= 0.8)
        g = np.array(
            [
                q[2] - height_at(wavy.row, wavy.nodes, 0, q[0], q[1])[0] if there else np.nan
                for q, there in zip(p, inside, strict=True)
            ]
        )
        crossing = np.flatnonzero(g[:-1] * g[1:] < 0.0)
        if len(crossing) == 0:
            # At the edge, or grazing between two samples.
            end = origin + found * ray - wavy.row["p_WS"][0]
            assert np.isnan(found) or abs(end[:2]).max() > 0.79
            continue
        hits += 1
        k = crossing[0]
        assert t[k] - 1e-6 <= found <= t[k + 1] + 1e-6
        q = origin + found * ray - wavy.row["p_WS"][0]
        assert q[2] == pytest.approx(height_at(wavy.row, wavy.nodes, 0, q[0], q[1])[0], abs=2e-6)
    assert hits > 100


@pytest.mark.parametrize("origin", [(0.0, 0.0, 2.5), (1.3, 0.4, 2.8), (-1.5, -1.0, 3.0)])
def test_rays_in_the_vault_meet_what_open3d_meets(
    vault: MeshRelief, root: Path, origin: tuple[float, float, float]
) -> None:
    module = open3d()
    mesh = module.io.read_triangle_mesh(str(root / "missions" / "scans" / "vault.ply"))
    scene = module.t.geometry.RaycastingScene()
    scene.add_triangles(module.t.geometry.TriangleMesh.from_legacy(mesh))
    rays = directions(np.random.default_rng(6), 3000)
    rows = np.hstack([np.tile(origin, (len(rays), 1)), rays]).astype(np.float32)
    expected = scene.cast_rays(module.core.Tensor(rows))["t_hit"].numpy().astype(float)
    found = np.empty(len(rays))
    cast(solids_of(vault), np.array(origin), rays, np.full(len(rays), 10.0), found)
    # Up to a pitch is lost along the rim.
    ends = origin + expected[:, None] * rays
    inner = np.isfinite(expected) & (abs(ends[:, 1]) < 1.47) & (ends[:, 2] > 2.7)
    assert inner.sum() > 500
    assert np.isfinite(found[inner]).all()
    # The mesh lies within its deviation; a ray at 75° sees four times that.
    np.testing.assert_allclose(found[inner], expected[inner], atol=4.0 * vault.deviation_m)
    outside = ~np.isfinite(expected)
    assert np.isnan(found[outside]).all()


def test_a_plain_mesh_is_a_plane_for_rays_from_both_sides() -> None:
    relief = relief_of(graph_corners(lambda x, y: 0.0 * x + 1.0), UP, 0.02)
    solids = solids_of(relief)
    for z, toward in ((3.0, -1.0), (0.0, 1.0)):
        rays = np.array([[0.3, 0.1, toward], [0.0, 0.0, toward], [0.9, 0.0, 0.1 * toward]])
        rays /= np.linalg.norm(rays, axis=1, keepdims=True)
        found = np.empty(3)
        cast(solids, np.array([0.0, 0.0, z]), rays, np.full(len(rays), 9.0), found)
        np.testing.assert_allclose(found[:2], abs(z - 1.0) / abs(rays[:2, 2]), atol=1e-6)
        assert np.isnan(found[2])  # passes beside
        cast(solids, np.array([0.0, 0.0, z]), rays, np.full(len(rays), 0.9), found)
        assert np.isnan(found).all()


def test_a_hole_lets_rays_through_and_is_no_surface() -> None:
    corners = graph_corners(waves)
    middle = corners.mean(axis=1)
    holed = corners[~((abs(middle[:, 0]) < 0.1) & (abs(middle[:, 1]) < 0.1))]
    relief = relief_of(holed, UP, 0.02)
    solids = solids_of(relief)
    assert not relief_covers(relief.row, relief.nodes, 0, 0.0, 0.0)
    assert relief_covers(relief.row, relief.nodes, 0, 0.15, 0.0)
    found = np.empty(2)
    down = np.array([[0.0, 0.0, -1.0], [0.2, 0.0, -1.0]])
    down /= np.linalg.norm(down, axis=1, keepdims=True)
    cast(solids, np.array([0.0, 0.0, 3.0]), down, np.full(len(down), 9.0), found)
    assert np.isnan(found[0])
    assert np.isfinite(found[1])
    *_, w, on = foot_on(solids, 0, np.array([0.0, 0.0, 2.0]))
    assert not on
    assert w == pytest.approx(0.1, abs=0.025)
    # Beside the hole the surface is what it would be without it.
    whole = relief_of(corners, UP, 0.02)
    for u in (0.13, 0.15, 0.2):
        with_hole = height_at(relief.row, relief.nodes, 0, u, 0.0)[0]
        assert with_hole == pytest.approx(height_at(whole.row, whole.nodes, 0, u, 0.0)[0], abs=1e-4)


def test_a_displaced_mesh_is_the_displaced_relief(tmp_path: Path) -> None:
    write_mesh(tmp_path / "w.ply", graph_corners(waves))
    moved = Displacement(rotate_deg=(170.0, 20.0, 30.0), translate_m=(0.5, -0.3, 4.0))
    shape = MeshShape(file="w.ply", normal=(0.0, 0.0, 1.0))
    still, gone = (mesh_relief(shape, m, tmp_path) for m in (Displacement(), moved))
    turn = Rotation.from_euler("xyz", (170.0, 20.0, 30.0), degrees=True)
    rng = np.random.default_rng(2)
    for p in rng.uniform([-0.8, -0.6, 1.9], [0.8, 0.6, 2.3], (50, 3)):
        expected = foot_on(solids_of(still), 0, p)[2]
        there = turn.apply(p) + np.array([0.5, -0.3, 4.0])
        assert foot_on(solids_of(gone), 0, there)[2] == pytest.approx(expected, abs=2e-4)


def test_without_a_normal_the_plane_fits_and_faces_say_which_side_is_free(tmp_path: Path) -> None:
    corners = graph_corners(waves)
    write_mesh(tmp_path / "up.ply", corners)
    write_mesh(tmp_path / "down.ply", corners[:, ::-1])
    up, down = (
        mesh_relief(MeshShape(file=name), Displacement(), tmp_path)
        for name in ("up.ply", "down.ply")
    )
    z_up, z_down = up.row["R_WS"][0][:, 2], down.row["R_WS"][0][:, 2]
    # The best plane has the waves' slope of 0.1, or a little more where they lean.
    assert z_up == pytest.approx(np.array([-0.1, 0.0, 1.0]) / np.hypot(0.1, 1.0), abs=0.03)
    np.testing.assert_allclose(z_down, -z_up, atol=1e-9)


REFUSED = {
    "a closed body": (box_corners(), UP, "no graph over its plane.*two heights, 1 m apart"),
    "two floors": (
        np.concatenate([graph_corners(waves), graph_corners(lambda x, y: waves(x, y) + 0.3)]),
        UP,
        "no graph over its plane.*two heights, 0.3 m apart",
    ),
    "a step": (
        graph_corners(lambda x, y: np.where(x + 0.003 > 0.0, 0.2, 0.0)),
        UP,
        "departs by 0.* m from the smooth heights",
    ),
    "too small": (graph_corners(waves, (0.03, 0.8)), UP, "less than 4 cells of 0.02 m"),
    "seen from its edge": (graph_corners(waves), np.array([0.0, 1.0, 0.0]), "two heights"),
}


@pytest.mark.parametrize("name", sorted(REFUSED))
def test_what_is_no_graph_is_refused(name: str) -> None:
    corners, normal, message = REFUSED[name]
    with pytest.raises(GeometryError, match=message):
        relief_of(corners, normal, 0.02)


def test_too_fine_a_grid_is_refused() -> None:
    with pytest.raises(GeometryError, match=r"more than 1000000 nodes at 0\.0011 m"):
        relief_of(graph_corners(waves), UP, 0.0011)


def test_a_refusal_names_the_file_and_says_what_to_do(tmp_path: Path) -> None:
    write_mesh(tmp_path / "box.ply", box_corners())
    with pytest.raises(GeometryError, match=r"box\.ply: its faces do not agree.*\n.*'normal'"):
        mesh_relief(MeshShape(file="box.ply"), Displacement(), tmp_path)
    with pytest.raises(GeometryError, match=r"none\.ply: there is no such file"):
        mesh_relief(MeshShape(file="none.ply"), Displacement(), tmp_path)
    with pytest.raises(InputError, match="outside of the campaign"):
        mesh_relief(MeshShape(file="../box.ply"), Displacement(), tmp_path / "missions")
