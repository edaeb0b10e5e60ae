"""One depth image of an irregular surface, as the loop takes it ten times a second.

The yardstick is Open3D's ray casting of the same rays on the same mesh, on one thread.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import process_time

import numpy as np

from inspect_cli.scans.files import open3d
from inspect_cli.schema.geometry import Displacement, MeshShape
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.vehicle import DepthCameraModel
from inspect_cli.sensing.depth_camera import ray_directions
from inspect_cli.spatial.primitives import PRIMITIVE
from inspect_cli.truth.heights import mesh_relief
from inspect_cli.truth.solids import Solids, cast
from tests.bench.rows import Row, ratio

IMAGES = 50
VAULT = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))


def measure(root: Path) -> Iterator[Row]:
    """The rays of one image from 0.9 m under the crown of the built-in vault."""
    platform = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml")
    camera = platform.sensor(DepthCameraModel)
    relief = mesh_relief(VAULT, Displacement(), root)
    solids = Solids(np.zeros(0, PRIMITIVE), relief.row, relief.nodes)
    rays, origin = ray_directions(camera), np.array([0.0, 0.0, 3.0])
    ranges, farthest = np.empty(len(rays)), np.full(len(rays), camera.range_m[1])

    def ours_s(k: int) -> float:
        begun = process_time()
        cast(solids, origin, rays, farthest, ranges)
        return process_time() - begun

    library = open3d()
    mesh = library.t.io.read_triangle_mesh(str(root / VAULT.file))
    scene = library.t.geometry.RaycastingScene(nthreads=1)
    scene.add_triangles(mesh)
    origins = np.broadcast_to(origin, rays.shape)
    six = library.core.Tensor(np.hstack([origins, rays]).astype(np.float32))

    def open3d_s(k: int) -> float:
        begun = process_time()
        scene.cast_rays(six, nthreads=1)
        return process_time() - begun

    what = "Open3D's ray casting of the same rays on the mesh"
    yield ratio("tof.relief_image_over_open3d", 2.4, what, ours_s, open3d_s, IMAGES)
