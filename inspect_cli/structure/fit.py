"""A fitted surface, how it explains its points and how well it is known."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Literal

import numpy as np

from inspect_cli.errors import GeometryError
from inspect_cli.spatial.arrays import Mask, Matrix, Points, Vector
from inspect_cli.spatial.primitives import CYLINDER, PLANE, SPHERE, level_axes
from inspect_cli.structure.least_squares import PARAMETERS, frame_of, normal_equations

Kind = Literal["plane", "sphere", "cylinder"]
CODES: dict[Kind, int] = {"plane": PLANE, "sphere": SPHERE, "cylinder": CYLINDER}


MOST_RELATIVE_SD = 0.1
"""Largest standard deviation of a tilt, rad, and of a radius or centre as a share of the radius."""
STEP_NAMES: dict[Kind, tuple[str, ...]] = {
    "plane": ("offset_m", "tilt_1_rad", "tilt_2_rad"),
    "sphere": ("center_x_m", "center_y_m", "center_z_m", "radius_m"),
    "cylinder": ("center_1_m", "center_2_m", "tilt_1_rad", "tilt_2_rad", "radius_m"),
}


@dataclass(frozen=True)
class Fit:
    """An unbounded surface and how it explains its points.

    ``point_m`` (3,): on the plane, the centre, or on the axis, next to the points' middle.
    ``direction`` (3,): unit normal or axis, of arbitrary sign; z for a sphere.
    ``radius_m``: 0 for a plane.
    ``covariance``: σ² (JᵀJ)⁻¹ of the parameters named in ``parameter_sd``. Shifts and tilts 1
    and 2 are along the first two columns of ``frame`` (3, 3); its last column is ``direction``.
    ``residuals_m`` (n,): signed distances of all points.
    ``used_m``: the points within this distance decided on the parameters.
    """

    kind: Kind
    point_m: Vector
    direction: Vector
    radius_m: float
    frame: Matrix
    covariance: Matrix
    residuals_m: Vector
    inlier_m: float
    used_m: float

    @property
    def inliers(self) -> Mask:
        """The points within the inlier distance (n,)."""
        return np.abs(self.residuals_m) <= self.inlier_m

    @property
    def used(self) -> Mask:
        """The points that decided on the parameters (n,)."""
        return np.abs(self.residuals_m) < self.used_m

    @property
    def rms_m(self) -> float:
        """RMS residual of the points that decided on the parameters."""
        return float(np.sqrt(np.mean(self.residuals_m[self.used] ** 2)))

    @property
    def parameter_sd(self) -> dict[str, float]:
        """Standard deviation of each parameter."""
        sd = np.sqrt(np.diag(self.covariance))
        return {n: float(s) for n, s in zip(STEP_NAMES[self.kind], sd, strict=True)}


def described(
    kind: Kind,
    model: Vector,
    points: Points,
    distances: Vector,
    origin: Vector,
    inlier_m: float,
    used_m: float,
) -> Fit:
    """The fit with its covariance at the middle of the points that decided on it."""
    code = CODES[kind]
    used = np.abs(distances) < used_m
    count, k = int(np.count_nonzero(used)), PARAMETERS[code]
    if count <= k:
        raise GeometryError(f"only {count} points settle on a {kind}", hint="give more points")
    middle = used.astype(np.float64) @ points / count
    model = model.copy()
    frame = np.eye(3)
    if kind == "plane":
        model[:3] = middle - ((middle - model[:3]) @ model[3:6]) * model[3:6]
        frame = level_axes(model[3:6])
    elif kind == "cylinder":
        model[:3] += ((middle - model[:3]) @ model[3:6]) * model[3:6]
        frame = _facing_frame(model[3:6], middle - model[:3])
    A, _, _ = normal_equations(code, model, frame, points, used_m)
    variance = float(np.sum(distances[used] ** 2)) / (count - k)
    return Fit(
        kind=kind,
        point_m=model[:3] + origin,
        direction=model[3:6],
        radius_m=float(model[6]),
        frame=frame,
        covariance=_covariance(kind, A[:k, :k], variance),
        residuals_m=distances,
        inlier_m=inlier_m,
        used_m=used_m,
    )


def _covariance(kind: Kind, A: Matrix, variance: float) -> Matrix:
    """σ² (JᵀJ)⁻¹; GeometryError where the points leave a direction open."""
    scale = np.sqrt(np.diag(A))
    units = np.outer(scale, scale)
    try:
        covariance: Matrix = variance * np.linalg.inv(A / units) / units
    except np.linalg.LinAlgError as error:
        raise _open(kind) from error
    if not np.all(np.diag(covariance) >= 0.0):
        raise _open(kind)
    return covariance


def _open(kind: Kind, detail: str = "") -> GeometryError:
    return GeometryError(
        f"the points do not fix the {kind}{detail}",
        hint="fit a plane where they are flat, or give points that reach further around",
    )


def _facing_frame(axis: Vector, towards: Vector) -> Matrix:
    """[e1, e2, axis] with e1 from the axis towards the points' middle."""
    e1 = towards - (towards @ axis) * axis
    length = np.linalg.norm(e1)
    if length < 1e-9:
        return frame_of(axis)
    e1 /= length
    return np.column_stack([e1, np.cross(axis, e1), axis])


def require_determined(fit: Fit) -> None:
    """GeometryError where the points leave a direction, or a radius and centre, open."""
    for name, sd in fit.parameter_sd.items():
        if name.endswith("_m") and fit.kind == "plane":
            continue
        relative = sd if name.endswith("_rad") else sd / fit.radius_m
        if not relative <= MOST_RELATIVE_SD:
            raise _open(fit.kind, f"; {name} is known to ±{sd:.2g} only")
