"""The simulated time-of-flight camera: a pinhole that returns one depth point per pixel.

Frame D is where the platform's ``mount`` puts it: origin at the camera's centre, optical axis z_D;
columns count along −y_D, rows along x_D. With the tool's axes the image is upright when the vehicle
looks ahead along a level tool: columns count to the right, rows downwards.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import DepthImage, Pixels
from inspect_cli.schema.vehicle import DepthCameraModel
from inspect_cli.sensing.instrument import Surroundings
from inspect_cli.spatial.arrays import Indices, Matrix, Points, Vector
from inspect_cli.spatial.mounting import Mounting
from inspect_cli.spatial.primitives import patch_distance
from inspect_cli.spatial.rotations import quaternion_to_matrix
from inspect_cli.truth.relief_rays import box_distance
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

    A sample takes the pose and draws the noise of every pixel. Rays are cast when their points
    are asked for: all of them, or those that may return a point near a line, and no farther than
    such a point can be. Either way gives the same points.
    """

    def __init__(self, model: DepthCameraModel, solids: Solids, rng: np.random.Generator) -> None:
        self.model = model
        self.solids = solids
        self._rng = rng
        self._mounting = Mounting(model.mount)
        self._rays_D = ray_directions(model)
        n_rays = self._rays_D.shape[0]
        self._rays_W, self._ranges = np.empty_like(self._rays_D), np.empty(n_rays)
        self._noise = np.zeros(n_rays)
        self._points_D, self._complete = np.full((n_rays, 3), np.nan), True
        self._every = np.arange(n_rays, dtype=np.int32)
        self._farthest = np.full(n_rays, model.range_m[1])
        self._selected, self._far_enough = self._every.copy(), self._farthest.copy()
        self._near_D = np.empty((n_rays, 3))
        self._p_WD, self._R_WD = np.zeros(3), np.eye(3)
        self._pixels = Pixels(self.all, self.near)
        self._image = DepthImage(0.0, self._pixels)

    @property
    def measurement(self) -> DepthImage:
        """The last image."""
        return self._image

    @property
    def points_D(self) -> Points:
        """The measured points (rows · columns, 3), m, in D; NaN for pixels without a return."""
        return self._image.points_D

    def sample(self, truth: Truth) -> DepthImage:
        """Take an image at the true pose of body and tool."""
        state = truth.state
        R_WT = quaternion_to_matrix(state.q_WT)
        p_WD, R_WD = self._mounting.pose(state.p_WB, state.q_WB, state.p_WT, R_WT)
        self._p_WD[:], self._R_WD[:] = p_WD, R_WD
        self._rng.standard_normal(out=self._noise)
        self._complete = False
        self._image = DepthImage(state.t_s, self._pixels)
        return self._image

    def all(self) -> Points:
        """All points of the last image (rows, columns, 3)."""
        if not self._complete:
            self._measure(self._every, self._farthest, self._points_D)
            self._complete = True
        return self._points_D.reshape(self.model.rows, self.model.columns, 3)

    def near(self, p_D: Vector, axis_D: Vector, radius_m: float) -> Points:
        """Points (n, 3) of the last image that may lie near a line; see ``records.Pixels``."""
        model = self.model
        farthest = model.range_m[1]
        n = _select(
            self._rays_D,
            self._noise,
            p_D,
            axis_D,
            radius_m,
            self._least_range(),
            farthest,
            model.noise_floor_m + model.noise_m * farthest * farthest,
            self._selected,
            self._far_enough,
        )
        if self._complete:
            return self._points_D[self._selected[:n]]
        near_D = self._near_D[:n]
        self._measure(self._selected[:n], self._far_enough[:n], near_D)
        return near_D

    def _measure(self, selected: Indices, farthest: Vector, points_D: Points) -> None:
        """Write the points (n, 3) of selected rays (n,), none of them behind ``farthest`` (n,)."""
        model, n = self.model, len(selected)
        rays_W, ranges = self._rays_W[:n], self._ranges[:n]
        _turn_rays(self._R_WD, self._rays_D, selected, rays_W)
        cast(self.solids, self._p_WD, rays_W, farthest, ranges)
        _measure(
            ranges,
            self._noise,
            selected,
            model.range_m[0],
            model.noise_floor_m,
            model.noise_m,
            self._rays_D,
            points_D,
        )

    def _least_range(self) -> float:
        """No pixel of the last image shows a smaller range, m.

        From the distance d of the nearest surface on: r + σ(r) n grows with r for the least n
        that was drawn, unless the noise is far beyond what a camera has.
        """
        model = self.model
        nearest, farthest = model.range_m
        least_noise = min(float(self._noise.min()), 0.0)
        if not 1.0 + 2.0 * model.noise_m * farthest * least_noise > 0.0:
            return -np.inf
        r = max(nearest, _nearest_distance(self.solids, self._p_WD))
        return float(r + (model.noise_floor_m + model.noise_m * r * r) * least_noise)


def depth_camera(model: DepthCameraModel, around: Surroundings) -> DepthCamera:
    """The depth camera of a flight. It sees the ground, too."""
    return DepthCamera(model, on_the_ground(around.structure.solids), around.rng)


@kernel
def _nearest_distance(solids: Solids, p_W: Vector) -> float:
    """A distance from a point, m, within which there is no surface."""
    nearest = np.inf
    for i in range(solids.primitives.shape[0]):
        nearest = min(nearest, abs(patch_distance(solids.primitives, i, p_W)))
    for i in range(solids.reliefs.shape[0]):
        nearest = min(nearest, box_distance(solids.reliefs, i, p_W))
    return nearest if nearest > 0.0 else 0.0  # NaN is no distance


@kernel
def _select(
    rays_D: Points,
    noise: Vector,
    p_D: Vector,
    axis_D: Vector,
    radius: float,
    least: float,
    farthest: float,
    deviation: float,
    selected: Indices,
    far_enough: Vector,
) -> int:
    """Write the rays that may return a point within ``radius`` of a line, and how far they must go.

    Across the line a ray's point at the range r is r s off the camera and r s − p off the line, so
    it is within the radius between the zeros of s² r² − 2 s · p r + p² − radius². No range below
    ``least`` is measured, and none is shortened by more than ``deviation`` times its noise. The
    last zero is where the search may end. Returns the number of rays.
    """
    along = p_D[0] * axis_D[0] + p_D[1] * axis_D[1] + p_D[2] * axis_D[2]
    p = np.empty(3)
    for m in range(3):
        p[m] = p_D[m] - along * axis_D[m]
    outside = p[0] * p[0] + p[1] * p[1] + p[2] * p[2] - radius * radius
    n = 0
    for k in range(rays_D.shape[0]):
        ray = rays_D[k]
        along = ray[0] * axis_D[0] + ray[1] * axis_D[1] + ray[2] * axis_D[2]
        square, product = 0.0, 0.0
        for m in range(3):
            s = ray[m] - along * axis_D[m]
            square += s * s
            product += s * p[m]
        discriminant = product * product - square * outside
        if discriminant < 0.0:
            continue
        last = (product + np.sqrt(discriminant)) / square if square > 0.0 else np.inf
        last += 1e-6 * abs(last)  # rounding shall not leave a point out
        if last < least:
            continue
        end = last + deviation * max(-noise[k], 0.0)
        selected[n] = k
        far_enough[n] = end if end < farthest else farthest  # NaN: all the way
        n += 1
    return n


@kernel
def _turn_rays(R: Matrix, rays_D: Points, selected: Indices, rays_W: Points) -> None:
    """Turn the selected rays from D into W."""
    for k in range(selected.size):
        ray = rays_D[selected[k]]
        x, y, z = ray[0], ray[1], ray[2]
        rays_W[k, 0] = R[0, 0] * x + R[0, 1] * y + R[0, 2] * z
        rays_W[k, 1] = R[1, 0] * x + R[1, 1] * y + R[1, 2] * z
        rays_W[k, 2] = R[2, 0] * x + R[2, 1] * y + R[2, 2] * z


@kernel
def _measure(
    ranges: Vector,
    noise: Vector,
    selected: Indices,
    nearest: float,
    noise_floor: float,
    noise_at_1m: float,
    rays_D: Points,
    points_D: Points,
) -> None:
    """Write the noisy points (n, 3) of the selected rays (n,).

    A range below ``nearest`` is lost, a NaN range stays NaN.
    """
    for k in range(ranges.size):
        ray, r = selected[k], ranges[k]
        measured = r + (noise_floor + noise_at_1m * r * r) * noise[ray]
        if r < nearest:
            measured = np.nan
        for m in range(3):
            points_D[k, m] = measured * rays_D[ray, m]
