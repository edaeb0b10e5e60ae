"""The true surfaces as MuJoCo's geoms.

Planes and round surfaces seen from outside are geoms of their own, for everything that touches.
A surface that is hollow or irregular has no such geom: for each geom of a contact it is a *plate*
that ``simulation.plates`` keeps tangent below it, for the rest of the vehicle coarse *facets*,
boxes whose fronts are tangent to it in their middles. On a hollow sphere or cylinder facets stand
off by w²/4R or w²/8R, w their width: ``SHELL_SAGITTA_M`` or less until ``MOST_FACETS`` along a
coordinate make them wider. On a relief they are ``FACET_M`` wide, or wider for the same reason, and
miss what is smaller.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.primitives import CYLINDER, PLANE, normal_at, point_at
from inspect_cli.spatial.rotations import matrix_to_quaternion
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.relief import relief_covers
from inspect_cli.truth.solids import Solids, normal_on, point_on
from inspect_cli.vehicles.kinds import Bodies

WALL_THICKNESS_M = 0.2
SHELL_SAGITTA_M = 0.01
FACET_M = 0.3
MOST_FACETS = 12
OVERLAP = 1.1
"""Facets are so much wider than their share, since tangents of a hollow meet beyond it."""
PLATE_HALF_M = 0.25
"""Half the width of a plate; a contact slides less than a millimetre between two of its places."""
TOUCHABLE, SHELL_ONLY = 1, 2
"""Bits of MuJoCo's ``contype``: for all of the vehicle, for all but its contacts."""
CONCRETE = [0.75, 0.74, 0.72, 1.0]


def plate_name(surface: int, geom: str) -> str:
    """The mocap body and the geom of a surface's plate for one geom of a contact."""
    return f"plate:{surface}:{geom}"


def add_surfaces(
    spec: mujoco.MjSpec, structure: StructureTruth, touching: Sequence[str], bodies: Bodies
) -> dict[str, list[str]]:
    """Add every surface's geoms to the world; return the one of each that a geom meets.

    ``touching`` are the geoms of the vehicle's contacts; the result has a list for each of them.
    """
    prims = structure.solids.primitives
    met: dict[str, list[str]] = {geom: [] for geom in touching}
    plated = False
    for index, surface in enumerate(structure.surfaces):
        if index < len(prims) and prims["kind"][index] == PLANE:
            name = f"{surface.name}:0:0"
            _add_plane(spec, name, prims, index)
        elif index < len(prims) and prims["side"][index] > 0:
            name = surface.name
            _add_round(spec, name, prims[index : index + 1])
        else:
            plated, name = True, ""
            _add_facets(spec, surface.name, structure.solids, index)
        for geom in touching:
            met[geom].append(name or _add_plate(spec, index, geom))
    if plated:
        _let_others_meet_facets(spec, (*bodies.protected, *bodies.gear))
    return met


def _add_plane(spec: mujoco.MjSpec, name: str, prims: Structured, index: int) -> None:
    front = point_at(prims, index, 0.0, 0.0)
    ahead = point_at(prims, index, 1e-4, 0.0) - front
    n = normal_at(prims, index, 0.0, 0.0)
    _add_box(spec, name, front, n, ahead, prims["half_size"][index], TOUCHABLE)


def _add_round(spec: mujoco.MjSpec, name: str, prims: Structured) -> None:
    row = prims[0]
    is_cylinder = row["kind"] == CYLINDER
    # MuJoCo's cylinder lies along its z; the surface frame's axis is its y.
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER if is_cylinder else mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[row["radius"], row["half_size"][1] if is_cylinder else 0.0, 0.0],
        pos=row["p_WS"],
        quat=matrix_to_quaternion(np.ascontiguousarray(row["R_WS"] @ turn)),
        contype=TOUCHABLE,
        conaffinity=0,
    )


def _add_facets(spec: mujoco.MjSpec, name: str, solids: Solids, index: int) -> None:
    """Boxes in the middles of equal shares of the patch; none where a relief has a hole."""
    count = len(solids.primitives)
    is_relief = index >= count
    rows, local = (solids.reliefs, index - count) if is_relief else (solids.primitives, index)
    half = rows["half_size"][local]
    counts = _facet_counts(solids, index, half)
    size = half / counts
    for i in range(counts[0]):
        for j in range(counts[1]):
            uv = (-half[0] + (2 * i + 1) * size[0], -half[1] + (2 * j + 1) * size[1])
            if is_relief and not relief_covers(solids.reliefs, solids.nodes, local, *uv):
                continue
            # (u, v) of a relief are not arc lengths; those of a sphere are where they are longest.
            arcs = size * _stretch(solids, index, uv) if is_relief else size
            box = OVERLAP * arcs
            front, n = point_on(solids, index, *uv), normal_on(solids, index, *uv)
            ahead = point_on(solids, index, uv[0] + 1e-4, uv[1]) - front
            _add_box(spec, f"{name}:{i}:{j}", front, n, ahead, box, SHELL_ONLY)


def _facet_counts(solids: Solids, index: int, half: Vector) -> Vector:
    if index >= len(solids.primitives):
        wanted = 2.0 * half / FACET_M
    else:
        row = solids.primitives[index]
        is_cylinder = row["kind"] == CYLINDER
        # A facet's edge stands off by w²/8R, and on a sphere its corner by as much again.
        width = np.sqrt((8.0 if is_cylinder else 4.0) * row["radius"] * SHELL_SAGITTA_M)
        wanted = 2.0 * half / width
        if is_cylinder:
            wanted[1] = 1.0
    counts: Vector = np.clip(np.ceil(wanted), 1, MOST_FACETS).astype(int)
    return counts


def _stretch(solids: Solids, index: int, uv: tuple[float, float]) -> Vector:
    """Lengths (2,) along the surface per unit of u and of v."""
    step = 1e-4
    here = point_on(solids, index, *uv)
    along_u = point_on(solids, index, uv[0] + step, uv[1]) - here
    along_v = point_on(solids, index, uv[0], uv[1] + step) - here
    return np.array([np.linalg.norm(along_u), np.linalg.norm(along_v)]) / step


def _add_box(
    spec: mujoco.MjSpec,
    name: str,
    front: Vector,
    n: Vector,
    ahead: Vector,
    half: Vector,
    contype: int,
) -> None:
    """A box: the middle of its front, its normal ``n`` and a direction ``ahead`` along an edge."""
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[half[0], half[1], 0.5 * WALL_THICKNESS_M],
        pos=front - 0.5 * WALL_THICKNESS_M * n,
        quat=matrix_to_quaternion(_axes(n, ahead)),
        contype=contype,
        conaffinity=0,
        rgba=CONCRETE,
    )


def _axes(n: Vector, ahead: Vector) -> Matrix:
    x = ahead - n * (n @ ahead)
    x /= np.linalg.norm(x)
    return np.ascontiguousarray(np.column_stack([x, np.cross(n, x), n]))


def _add_plate(spec: mujoco.MjSpec, index: int, touching: str) -> str:
    """A box on a mocap body, which meets what an explicit pair names and nothing else."""
    name = plate_name(index, touching)
    body = spec.worldbody.add_body(name=name, mocap=True)
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[PLATE_HALF_M, PLATE_HALF_M, 0.5 * WALL_THICKNESS_M],
        contype=0,
        conaffinity=0,
        mass=0.0,
        rgba=[*CONCRETE[:3], 0.3],
    )
    return name


def _let_others_meet_facets(spec: mujoco.MjSpec, bodies: Sequence[str]) -> None:
    for name in bodies:
        for geom in spec.body(name).geoms:
            if geom.conaffinity:
                geom.conaffinity |= SHELL_ONLY
