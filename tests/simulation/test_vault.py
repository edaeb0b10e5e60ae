"""The built-in vault made again, and what its description says of it."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from inspect_cli.scans.meshes import doubled_normals, read_triangles
from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.simulation.vault import Vault, mesh_ply, vault_mesh
from inspect_cli.truth.heights import mesh_relief

FILE = Path("missions") / "scans" / "vault.ply"


def test_the_built_in_vault_is_what_it_says(root: Path) -> None:
    points, faces = vault_mesh(Vault(), np.random.default_rng(11))
    assert (root / FILE).stat().st_size == len(mesh_ply(points, faces)) < 1e6
    kept = read_triangles(root / FILE).corners
    # The file keeps single precision: 2⁻²⁴ of 4 m.
    np.testing.assert_allclose(kept, points[faces], rtol=0, atol=5e-7)


def test_its_unevenness_is_two_centimetres_and_its_faces_look_inside(root: Path) -> None:
    vault = Vault()
    points, faces = vault_mesh(vault, np.random.default_rng(11))
    right = points[:, 0] >= 0.0
    radius = np.where(right, vault.radius_right_m, vault.radius_left_m)
    away = np.hypot(points[:, 0], points[:, 2] - (vault.crown_m - radius)) - radius
    assert np.abs(away).max() == pytest.approx(0.02, rel=1e-9)
    assert np.std(away) > 0.004
    axis = np.array([0.0, 0.0, vault.crown_m - 2.5])
    middle = points[faces].mean(axis=1)
    inwards = (axis - middle) * [1.0, 0.0, 1.0]
    assert (np.sum(doubled_normals(points[faces]) * inwards, axis=1) > 0.0).all()
    assert 2.5 < points[:, 2].min() < 2.65
    assert 3.88 < points[:, 2].max() < 4.0


def test_it_is_a_relief_half_a_millimetre_from_its_mesh(root: Path) -> None:
    for normal in ((0.0, 0.0, -1.0), None):
        relief = mesh_relief(MeshShape(file=str(FILE), normal=normal), Displacement(), root)
        assert relief.deviation_m < 5e-4
        assert relief.row["R_WS"][0][2, 2] < -0.99
