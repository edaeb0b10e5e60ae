"""The MuJoCo model of a scene: the visible vehicle and the structure as the planner believed it."""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from inspect_cli.scene.marks import Mark
from inspect_cli.scene.materials import CONCRETE, CONCRETE_TILE_M, DIMMED, HORIZON, add_materials
from inspect_cli.scene.visual_model import visual_model
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.arrays import Indices, Matrix, Points, Structured, Vector
from inspect_cli.spatial.patches import grid_triangles, patch_coordinates, patch_nodes
from inspect_cli.spatial.primitives import PLANE, level_axes, normal_at
from inspect_cli.spatial.rotations import matrix_to_quaternion
from inspect_cli.vehicles.kinds import Vehicle

THICKNESS_M = 0.15
SEGMENTS = 48
"""Segments of a curved patch along each of its coordinates."""
FIELD_OF_VIEW_DEG = 32.0
WIDEST, HIGHEST = 1280, 720
MARK_HALF_M = 0.004
SHADOW_REACH = 1.7
"""Distance in scene sizes beyond which nothing casts a shadow."""


def build_scene(
    vehicle: Vehicle,
    surfaces: Sequence[PlannedSurface],
    marks: Sequence[Mark],
    light_from: Vector,
    overhead: float,
    center_W: Vector,
    extent_m: float,
) -> mujoco.MjModel:
    """Compile the scene; mark k is the geom ``mark:k``, and none is visible yet.

    Args:
        vehicle: its nominal model gets visible parts.
        surfaces: the structure as the planner believed it.
        marks: shapes that will appear on the structure.
        light_from: direction (3,) towards the sun, W.
        overhead: from 0 for walls and floors to 1 for what is seen from below.
        center_W: middle (3,) of what is shown, W, m.
        extent_m: its size.
    """
    spec = visual_model(vehicle)
    add_materials(spec)
    _set_view(spec, center_W, extent_m)
    _add_lights(spec, light_from, overhead, center_W, extent_m)
    spec.worldbody.add_geom(
        name="floor",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[0.0, 0.0, 1.0],
        material="floor",
        contype=0,
        conaffinity=0,
    )
    for surface in surfaces:
        _add_surface(spec, surface.name, primitive_of(surface.shape))
    for index, mark in enumerate(marks):
        _add_mark(spec, f"mark:{index}", mark)
    return spec.compile()


def _set_view(spec: mujoco.MjSpec, center_W: Vector, extent_m: float) -> None:
    spec.stat.center = center_W
    spec.stat.extent = extent_m
    visual = spec.visual
    getattr(visual, "global").fovy = FIELD_OF_VIEW_DEG
    getattr(visual, "global").offwidth = WIDEST
    getattr(visual, "global").offheight = HIGHEST
    visual.quality.offsamples = 4
    visual.quality.numslices, visual.quality.numstacks, visual.quality.numquads = 20, 8, 2
    visual.map.znear = 0.02
    visual.map.zfar = 60.0
    visual.map.haze = 0.4
    visual.map.shadowclip = SHADOW_REACH
    visual.rgba.haze = [*HORIZON, 1.0]
    visual.headlight.ambient = [0.42, 0.42, 0.43]
    visual.headlight.diffuse = [0.18, 0.18, 0.18]
    visual.headlight.specular = [0.0, 0.0, 0.0]


def _add_lights(
    spec: mujoco.MjSpec, light_from: Vector, overhead: float, center_W: Vector, extent_m: float
) -> None:
    """A sun with shadows, and a fill light from below for overhead surfaces."""
    spec.worldbody.add_light(
        name="sun",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        pos=center_W + 2.0 * extent_m * light_from,
        dir=-light_from,
        diffuse=[0.48, 0.47, 0.45],
        specular=[0.15, 0.15, 0.15],
        castshadow=True,
    )
    spec.worldbody.add_light(
        name="fill",
        type=mujoco.mjtLightType.mjLIGHT_DIRECTIONAL,
        dir=[0.2, 0.3, 0.93],
        diffuse=np.array([0.15, 0.15, 0.16]) * (1.0 + 2.2 * overhead),
        specular=[0.0, 0.0, 0.0],
        castshadow=False,
    )


def _add_surface(spec: mujoco.MjSpec, name: str, patch: Structured) -> None:
    """A slab with the patch as its front: a mesh with sharp edges, grained in metres."""
    flat = patch["kind"][0] == PLANE
    segments = (1, 1) if flat else (SEGMENTS, SEGMENTS)
    vertices, normals, uv, faces = slab(patch, segments)
    spec.add_mesh(
        name=f"surface:{name}",
        uservert=vertices.ravel(),
        usernormal=normals.ravel(),
        usertexcoord=(uv / CONCRETE_TILE_M).ravel(),
        userface=faces.ravel(),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )
    spec.worldbody.add_geom(
        name=f"surface:{name}",
        type=mujoco.mjtGeom.mjGEOM_MESH,
        meshname=f"surface:{name}",
        material="concrete",
        rgba=CONCRETE,
        contype=0,
        conaffinity=0,
    )


def slab(patch: Structured, segments: tuple[int, int]) -> tuple[Points, Points, Points, Indices]:
    """(vertices (n, 3), normals (n, 3), texture coordinates (n, 2) m, triangles (m, 3)).

    The front is the patch, the back lies ``THICKNESS_M`` behind it, four rims close it. No two
    parts share vertices, so that edges are sharp.
    """
    u, v = patch_coordinates(patch, segments)
    front = patch_nodes(patch, segments)
    n = np.array([[normal_at(patch, 0, a, b) for a in u] for b in v])
    back = front - _thickness(patch) * n
    uv = np.stack(np.meshgrid(u, v), axis=-1)
    parts = [(front, n, uv), (back[:, ::-1], -n[:, ::-1], uv[:, ::-1])]
    parts += [_rim(front, back, uv, edge, float(patch["side"][0])) for edge in range(4)]
    vertices, normals, coordinates, faces = [], [], [], []
    count = 0
    for p, m, st in parts:
        rows, columns = p.shape[:2]
        vertices.append(p.reshape(-1, 3))
        normals.append(m.reshape(-1, 3))
        coordinates.append(st.reshape(-1, 2))
        faces.append(grid_triangles((columns - 1, rows - 1)) + count)
        count += rows * columns
    if patch["side"][0] < 0.0:  # (u, v, n) is then left-handed
        faces = [triangles[:, ::-1] for triangles in faces]
    return (
        np.concatenate(vertices),
        np.concatenate(normals),
        np.concatenate(coordinates),
        np.concatenate(faces).astype(np.int32),
    )


def _thickness(patch: Structured) -> float:
    """Thickness of the slab, m; of a solid cylinder or sphere at most half its radius."""
    radius, outside = float(patch["radius"][0]), patch["side"][0] > 0
    round_and_solid = patch["kind"][0] != PLANE and outside
    return min(THICKNESS_M, 0.5 * radius) if round_and_solid else THICKNESS_M


def _rim(
    front: Points, back: Points, uv: Points, which: int, side: float
) -> tuple[Points, Points, Points]:
    """One of the four edges as a grid of two rows: bottom, top, left, right."""
    edge = ((0, slice(None)), (-1, slice(None, None, -1)),
            (slice(None, None, -1), 0), (slice(None), -1))[which]  # fmt: skip
    outer, inner = front[edge], back[edge]
    along = np.gradient(outer, axis=0)
    across = np.cross(along, outer - inner)
    lengths = np.linalg.norm(across, axis=1, keepdims=True)
    normals = side * across / np.maximum(lengths, 1e-12)
    normals[lengths[:, 0] < 1e-12] = (0.0, 0.0, 1.0)  # an edge that is one point, a pole
    return (
        np.stack([inner, outer]),
        np.stack([normals, normals]),
        np.stack([uv[edge], uv[edge]]),
    )


def _add_mark(spec: mujoco.MjSpec, name: str, mark: Mark) -> None:
    kinds = {"square": mujoco.mjtGeom.mjGEOM_BOX, "diamond": mujoco.mjtGeom.mjGEOM_BOX}
    kind = kinds.get(mark.symbol, mujoco.mjtGeom.mjGEOM_CYLINDER)
    is_box = kind == mujoco.mjtGeom.mjGEOM_BOX
    half = mark.radius_m * (0.89 if is_box else 1.0)  # equal areas
    spec.worldbody.add_geom(
        name=name,
        type=kind,
        size=[half, half, MARK_HALF_M] if is_box else [half, MARK_HALF_M, 0.0],
        pos=mark.p_W,
        quat=matrix_to_quaternion(_mark_axes(mark)),
        material="mark",
        rgba=[*(DIMMED * np.array(mark.rgba[:3])), 0.0],
        contype=0,
        conaffinity=0,
    )


def _mark_axes(mark: Mark) -> Matrix:
    turn = np.radians(45.0 if mark.symbol == "diamond" else 0.0)
    c, s = np.cos(turn), np.sin(turn)
    axes: Matrix = level_axes(mark.n_W) @ np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
    return np.ascontiguousarray(axes)
