"""The simulated time-of-flight camera: a pinhole that returns one depth point per pixel.

Frame D is where the platform's ``mount`` puts it: origin at the camera's centre, optical axis z_D;
columns count along −y_D, rows along x_D. With the tool's axes the image is upright when the vehicle
looks ahead along a level tool: columns count to the right, rows downwards.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import DepthImage
from inspect_cli.schema.vehicle import DepthCameraModel
from inspect_cli.sensing.instrument import Surroundings
from inspect_cli.spatial.arrays import Matrix, Points, Vector
from inspect_cli.spatial.mounting import Mounting
from inspect_cli.spatial.rotations import quaternion_to_matrix
from inspect_cli.truth.snapshot import Truth
from inspect_cli.truth.solids import Solids, cast, on_the_ground


def ray_directions(model: DepthCameraModel) -> Points:
    """Unit vectors (rows · columns, 3) in D through the middles of the pixels, row by row."""
    half_x, half_y = np.tan(0.5 * np.radians(model.field_of_view_deg))
    right = half_x * ((2.0 * np.arange(model.columns) + 1.0) / model.columns - 1.0)
    down = half_y * ((2.0 * np.arange(model.rows) + 1.0) / model.rows - 1.0)
    rays = np.empty((model.rows, model.columns, 3))
    rays[:, :, 0] = down[:, None]
    rays[:, :, 1] = -right
    rays[:, :, 2] = 1.0
    rays /= np.linalg.norm(rays, axis=2, keepdims=True)
    return rays.reshape(-1, 3)


class DepthCamera:
    """Casts the camera's rays at the true surfaces and adds range noise.

    ``solids`` are the true surfaces (any number). The noise of a range r is Gaussian along the
    ray with standard deviation ``noise_floor_m + noise_m · r²``, r in metres.
    """

    def __init__(self, model: DepthCameraModel, solids: Solids, rng: np.random.Generator) -> None:
        self.model = model
        self.solids = solids
        self._rng = rng
        self._mounting = Mounting(model.mount)
        self._rays_D = ray_directions(model)
        self._rays_W = np.empty_like(self._rays_D)
        n_rays = self._rays_D.shape[0]
        self._ranges = np.empty(n_rays)
        self._noise = np.empty(n_rays)
        self.points_D = np.full((n_rays, 3), np.nan)
        """The measured points (rows · columns, 3), m, in D; NaN for pixels without a return."""
        self._image = DepthImage(0.0, self.points_D.reshape(model.rows, model.columns, 3))

    @property
    def measurement(self) -> DepthImage:
        """The last image."""
        return self._image

    def sample(self, truth: Truth) -> DepthImage:
        """Fill ``points_D`` from the true pose of body and tool."""
        state = truth.state
        R_WT = quaternion_to_matrix(state.q_WT)
        p_WD, R_WD = self._mounting.pose(state.p_WB, state.q_WB, state.p_WT, R_WT)
        _turn_rays(R_WD, self._rays_D, self._rays_W)
        nearest, farthest = self.model.range_m
        cast(self.solids, p_WD, self._rays_W, farthest, self._ranges)
        self._rng.standard_normal(out=self._noise)
        _measure(
            self._ranges,
            self._noise,
            nearest,
            self.model.noise_floor_m,
            self.model.noise_m,
            self._rays_D,
            self.points_D,
        )
        self._image = replace(self._image, t_s=state.t_s)
        return self._image


def depth_camera(model: DepthCameraModel, around: Surroundings) -> DepthCamera:
    """The depth camera of a flight. It sees the ground, too."""
    return DepthCamera(model, on_the_ground(around.structure.solids), around.rng)


@kernel
def _turn_rays(R: Matrix, rays_D: Points, rays_W: Points) -> None:
    """Turn the rays from D into W."""
    for k in range(rays_D.shape[0]):
        x, y, z = rays_D[k, 0], rays_D[k, 1], rays_D[k, 2]
        rays_W[k, 0] = R[0, 0] * x + R[0, 1] * y + R[0, 2] * z
        rays_W[k, 1] = R[1, 0] * x + R[1, 1] * y + R[1, 2] * z
        rays_W[k, 2] = R[2, 0] * x + R[2, 1] * y + R[2, 2] * z


@kernel
def _measure(
    ranges: Vector,
    noise: Vector,
    nearest: float,
    noise_floor: float,
    noise_at_1m: float,
    rays_D: Points,
    points_D: Points,
) -> None:
    """Write the noisy points; a range below ``nearest`` is lost, a NaN range stays NaN."""
    for k in range(ranges.size):
        r = ranges[k]
        measured = r + (noise_floor + noise_at_1m * r * r) * noise[k]
        if r < nearest:
            measured = np.nan
        points_D[k, 0] = measured * rays_D[k, 0]
        points_D[k, 1] = measured * rays_D[k, 1]
        points_D[k, 2] = measured * rays_D[k, 2]
