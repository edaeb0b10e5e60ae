"""The structure as the planner believes it: shapes as given, clouds and meshes fitted."""

from __future__ import annotations

from dataclasses import replace
from pathlib import Path

import numpy as np

from inspect_cli.errors import GeometryError, Location, Problem
from inspect_cli.scans.clouds import read_cloud
from inspect_cli.scans.files import ReadPoints, confined, open3d
from inspect_cli.schema.mission import CropBox, Mission, StructureSurface, SurfaceSource
from inspect_cli.schema.plan import FitReport, PlannedSurface
from inspect_cli.schema.primitives import displaced, displaced_points
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.structure.fit import Fit
from inspect_cli.structure.fitting import fit_primitive
from inspect_cli.structure.meshes import read_mesh
from inspect_cli.structure.patches import bounded_shape

FIT_SEED = 20_251
"""Fits are part of the plan and do not depend on a flight's seed."""
MESH_SAMPLES = 20_000
FARTHEST_M = 1_000.0
"""A surface farther from the start than this stands in other coordinates than the mission."""
MOST_VOXELS = 1e9
"""Along an edge of the cloud; Open3D counts them in 32-bit integers."""


def believed_surfaces(mission: Mission, root: Path) -> tuple[PlannedSurface, ...]:
    """The mission's surfaces, in its order, with files read from the campaign folder ``root``.

    Raises GeometryError with every surface that cannot be read or fitted, and InputError for a
    file outside of ``root``.
    """
    start_W = np.array([*mission.start.position_m, mission.start.takeoff_height_m])
    surfaces: list[PlannedSurface] = []
    problems: list[Problem] = []
    for entry in mission.structure:
        try:
            surfaces.append(believed_surface(entry, root, start_W))
        except GeometryError as error:
            problems.extend(_located(problem, entry) for problem in error.problems)
    if problems:
        raise GeometryError(problems)
    return tuple(surfaces)


def believed_surface(entry: StructureSurface, root: Path, start_W: Vector) -> PlannedSurface:
    """One surface, touched from the side on which ``start_W`` (3,) lies."""
    given = entry.surface
    if given.shape is not None:
        shape = displaced(given.shape, given.placed)
        return PlannedSurface(name=entry.name, shape=shape, source="given as a shape")
    # Each surface draws from its own generator: adding one does not change the others.
    rng = np.random.default_rng(FIT_SEED)
    file = given.cloud or given.mesh or ""
    path = confined(root, file)
    if given.cloud is not None:
        read, source = read_cloud(path), f"cloud {file}"
    else:
        read, source = read_mesh(path, MESH_SAMPLES, rng), f"mesh {file}"
    points, history = _prepared(read, given)
    fit = fit_primitive(points, given.fit, given.options.inlier_m, rng)
    shape = bounded_shape(fit, points, start_W, given.options.side)
    _require_near(points[fit.used], start_W)
    return PlannedSurface(
        name=entry.name, shape=shape, source=f"{source}: {history}", fit=fit_report(fit)
    )


def fit_report(fit: Fit) -> FitReport:
    """What the plan keeps of a fit."""
    inliers = int(np.count_nonzero(fit.inliers))
    return FitReport(
        method=f"{fit.kind}: MSAC, then least squares on the "
        f"{np.count_nonzero(fit.used)} points within {fit.used_m * 1e3:.2g} mm",
        points=len(fit.residuals_m),
        inliers=inliers,
        inlier_share=inliers / len(fit.residuals_m),
        rms_m=fit.rms_m,
        parameter_sd=fit.parameter_sd,
    )


def _prepared(read: ReadPoints, given: SurfaceSource) -> tuple[Points, str]:
    """(points in the world, cropped and thinned out; what was done to them)."""
    points = displaced_points(read.points, given.placed)
    history = f"{len(points)} points"
    if read.dropped:
        history += f" ({read.dropped} invalid dropped)"
    if given.crop is not None:
        points = _cropped(points, given.crop)
        history += f", {len(points)} in the crop"
    if given.options.voxel_m > 0.0:
        points = _thinned(points, given.options.voxel_m)
        history += f", {len(points)} voxels of {given.options.voxel_m:g} m"
    return points, history


def _cropped(points: Points, crop: CropBox) -> Points:
    kept = points[np.all((points >= crop.min_m) & (points <= crop.max_m), axis=1)]
    if len(kept) == 0:
        low, high = np.round(points.min(axis=0), 3), np.round(points.max(axis=0), 3)
        raise GeometryError(
            f"the crop leaves none of the {len(points)} points",
            hint=f"in the world they reach from {low.tolist()} to {high.tolist()}",
        )
    return kept


def _require_near(points: Points, start_W: Vector) -> None:
    """GeometryError where a surface's points lie farther from the start than anything flies."""
    middle = np.median(points, axis=0)
    away_m = float(np.linalg.norm(middle - start_W))
    if away_m > FARTHEST_M:
        raise GeometryError(
            f"the surface lies {away_m / 1e3:.3g} km from the start, "
            f"about {np.round(middle, 1).tolist()}",
            hint="a geo-referenced scan is brought into the mission's world by 'placed', "
            f"e.g. placed: {{translate_m: {np.round(-middle).tolist()}}}",
        )


def _thinned(points: Points, voxel_m: float) -> Points:
    """One point, the mean, per occupied voxel."""
    extent_m = float(np.ptp(points, axis=0).max())
    if extent_m > MOST_VOXELS * voxel_m:
        raise GeometryError(
            f"options.voxel_m {voxel_m:g} is too small for points that reach over {extent_m:.3g} m",
            hint="a voxel of 0.005 to 0.05 m suits a scan of a structure; 0 keeps every point",
        )
    module = open3d()
    cloud = module.geometry.PointCloud(module.utility.Vector3dVector(points))
    return np.array(cloud.voxel_down_sample(voxel_m).points)


def _located(problem: Problem, entry: StructureSurface) -> Problem:
    """The problem with the file and the surface that it is about."""
    file = entry.surface.cloud or entry.surface.mesh or entry.name
    where = problem.where or Location(file)
    return replace(problem, where=replace(where, path=f"structure '{entry.name}'"))
