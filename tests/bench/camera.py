"""One depth image of an irregular surface, as the loop takes it ten times a second."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

import numpy as np

from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.vehicle import DepthCameraModel
from inspect_cli.sensing.depth_camera import ray_directions
from inspect_cli.spatial.primitives import PRIMITIVE
from inspect_cli.truth.heights import mesh_relief
from inspect_cli.truth.solids import Solids, cast
from tests.bench.rows import Row

IMAGES = 50
VAULT = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))


def measure(root: Path) -> Iterator[Row]:
    """The rays of one image from 0.9 m under the crown of the built-in vault; the best of many."""
    camera = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml").sensor(
        DepthCameraModel
    )
    relief = mesh_relief(VAULT, Displacement(), root)
    solids = Solids(np.zeros(0, PRIMITIVE), relief.row, relief.nodes)
    rays, origin = ray_directions(camera), np.array([0.0, 0.0, 3.0])
    ranges = np.empty(len(rays))
    took = []
    for _ in range(1 + IMAGES):  # the first compiles
        begun = perf_counter()
        cast(solids, origin, rays, camera.range_m[1], ranges)
        took.append(perf_counter() - begun)
    yield Row("tof.relief_image_s", min(took), "s", 0.0015)
