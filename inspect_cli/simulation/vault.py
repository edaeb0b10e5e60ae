"""An uneven vault as a mesh: how the built-in ``missions/scans/vault.ply`` was made.

The intrados is two arcs that meet level at the crown, over arc length s and length y along it:

    p = [R sin(s/R), y, crown − R (1 − cos(s/R))] + e(s, y) [sin(s/R), 0, cos(s/R)],

R the left radius where s < 0 and the right one where s ≥ 0. The unevenness e, away from the axis,
is a sum of cosines of random directions, phases and wavelengths, scaled to the stated largest one.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.spatial.arrays import Indices, Matrix, Points

WAVES = 24


@dataclass(frozen=True)
class Vault:
    """Size, shape and roughness of a vault, m; the crown runs along y over x = 0."""

    radius_left_m: float = 2.45
    radius_right_m: float = 2.55
    arc_m: float = 5.4
    length_m: float = 3.0
    crown_m: float = 3.9
    unevenness_m: float = 0.02
    wavelength_m: tuple[float, float] = (0.5, 1.5)
    spacing_m: float = 0.03


def vault_mesh(vault: Vault, rng: np.random.Generator) -> tuple[Points, Indices]:
    """Corners (n, 3), m, in W and faces (m, 3), which turn to the inside of the vault."""
    columns = round(vault.arc_m / vault.spacing_m) + 1
    rows = round(vault.length_m / vault.spacing_m) + 1
    s, y = np.meshgrid(
        np.linspace(-0.5 * vault.arc_m, 0.5 * vault.arc_m, columns),
        np.linspace(-0.5 * vault.length_m, 0.5 * vault.length_m, rows),
    )
    radius = np.where(s < 0.0, vault.radius_left_m, vault.radius_right_m)
    out_x, out_z = np.sin(s / radius), np.cos(s / radius)
    away = radius + _unevenness(vault, s, y, rng)
    points = np.stack([away * out_x, y, vault.crown_m - radius + away * out_z], axis=-1)
    corner = np.arange(rows - 1)[:, None] * columns + np.arange(columns - 1)
    # Counter-clockwise seen from below, where x runs to the right and y towards the eye's feet.
    lower = np.stack([corner, corner + columns, corner + 1], axis=-1)
    upper = np.stack([corner + 1, corner + columns, corner + columns + 1], axis=-1)
    faces = np.concatenate([lower.reshape(-1, 3), upper.reshape(-1, 3)]).astype(np.int32)
    return points.reshape(-1, 3), faces


def _unevenness(vault: Vault, s: Matrix, y: Matrix, rng: np.random.Generator) -> Matrix:
    total = np.zeros_like(s)
    for length, turn, phase in zip(
        rng.uniform(*vault.wavelength_m, WAVES),
        rng.uniform(0.0, np.pi, WAVES),
        rng.uniform(0.0, 2.0 * np.pi, WAVES),
        strict=True,
    ):
        total += np.cos(2.0 * np.pi / length * (s * np.cos(turn) + y * np.sin(turn)) + phase)
    scaled: Matrix = vault.unevenness_m / np.abs(total).max() * total
    return scaled


def mesh_ply(points: Points, faces: Indices) -> bytes:
    """A mesh as a binary PLY file in single precision."""
    head = (
        "ply\nformat binary_little_endian 1.0\n"
        f"element vertex {len(points)}\n"
        "property float x\nproperty float y\nproperty float z\n"
        f"element face {len(faces)}\n"
        "property list uchar int vertex_indices\nend_header\n"
    )
    rows = np.empty(len(faces), [("count", "u1"), ("corners", "<i4", (3,))])
    rows["count"], rows["corners"] = 3, faces
    return head.encode("ascii") + points.astype("<f4").tobytes() + rows.tobytes()
