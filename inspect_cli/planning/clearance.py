"""How far the vehicle's body stays from the structure and the ground along a path.

The body is covered by spheres. A patch is an obstacle from both sides: a wall that is touched
from the front and from the back is two patches, and each lies behind the other. A path cannot
slip through one, because it is sampled in steps smaller than the spheres.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from itertools import pairwise

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.timing import extent
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.schema.primitives import primitives_of
from inspect_cli.spatial.arrays import Points, Structured, Vector
from inspect_cli.spatial.primitives import patch_distance, point_at
from inspect_cli.spatial.rotations import (
    quaternion_conjugate,
    quaternion_exp,
    quaternion_log,
    quaternion_multiply,
    quaternion_to_matrix,
    rotate,
)

STEP_M = 0.05
STEP_RAD = float(np.radians(5.0))
"""Largest steps of the body's translation and of its and the arm's turns between samples."""
BOX_SAMPLES = 9
STOOD_ON_M = 0.05
STOOD_ON_COSINE = float(np.cos(np.radians(30.0)))


@dataclass(frozen=True)
class Scene:
    """The believed surfaces as obstacles: PRIMITIVE array (n,), their names, their box in W."""

    prims: Structured
    names: tuple[str, ...]
    low_W: Vector
    high_W: Vector

    @classmethod
    def of(cls, surfaces: Sequence[PlannedSurface]) -> Scene:
        """The scene of all believed surfaces."""
        prims = primitives_of([surface.shape for surface in surfaces])
        corners = np.zeros((1, 3))  # with nothing to keep clear of, the origin will do
        if len(prims):
            corners = np.concatenate([_patch_points(prims, i) for i in range(len(prims))])
        names = tuple(surface.name for surface in surfaces)
        return cls(prims, names, corners.min(axis=0), corners.max(axis=0))

    def without_stood_on(self, standing: Posture, height_m: float) -> Scene:
        """The scene without the patches that the vehicle stands on, ``height_m`` below O_b."""
        foot = standing.p_WB - np.array([0.0, 0.0, height_m])
        kept = [i for i in range(len(self.prims)) if not _carries(self.prims, i, foot)]
        names = tuple(self.names[i] for i in kept)
        return Scene(self.prims[kept], names, self.low_W, self.high_W)


@dataclass(frozen=True)
class Gap:
    """The narrowest place of a path.

    ``structure_m`` and ``ground_m`` are the least distances of the body's spheres from the
    structure and over the ground, negative when they reach into it; ``surface`` names the
    nearest patch and ``p_W`` (3,) is where the sphere next to it has its centre.
    """

    structure_m: float
    ground_m: float
    surface: str
    p_W: Vector

    def clears(self, clearance_m: float) -> bool:
        """Whether the body keeps ``clearance_m`` from the structure and stays over the ground."""
        return self.structure_m >= clearance_m and self.ground_m >= 0.0


def gap_along(capabilities: Capabilities, scene: Scene, postures: Sequence[Posture]) -> Gap:
    """The narrowest place of the path through two or more postures.

    Between postures, positions and arm angles move linearly and the attitude along its
    geodesic, sampled in steps of at most 5 cm and 5°.
    """
    structure_m, ground_m, nearest = np.inf, np.inf, -1
    p_W = np.zeros(3)
    for a, b in pairwise(postures):
        distance_m, angle_rad = extent(a, b)
        steps = max(1, int(np.ceil(max(distance_m / STEP_M, angle_rad / STEP_RAD))))
        spheres = _spheres_B(capabilities, a, b, steps)
        ends = np.array([[*a.p_WB, *a.q_WB], [*b.p_WB, *b.q_WB]])
        found = narrowest(scene.prims, spheres, ends, steps)
        ground_m = min(ground_m, found[1])
        if found[0] < structure_m:
            structure_m, nearest, p_W = found[0], int(found[2]), found[3:].copy()
    surface = scene.names[nearest] if nearest >= 0 else ""
    return Gap(float(structure_m), float(ground_m), surface, p_W)


def body_reach_m(capabilities: Capabilities, posture: Posture) -> float:
    """Radius, m, of the ball about O_b that holds the body in this posture."""
    spheres = capabilities.collision_spheres(posture)
    from_body = np.linalg.norm(spheres[:, :3] - posture.p_WB, axis=1)
    return float((from_body + spheres[:, 3]).max())


def _spheres_B(capabilities: Capabilities, a: Posture, b: Posture, steps: int) -> Points:
    """Spheres (1, n, 4) in B, or (steps + 1, n, 4) where the arm moves on the way."""
    if np.array_equal(a.joint_angle, b.joint_angle):
        samples = [a]
    else:
        shares = np.linspace(0.0, 1.0, steps + 1)
        samples = [
            Posture(a.p_WB, a.q_WB, a.joint_angle + share * (b.joint_angle - a.joint_angle))
            for share in shares
        ]
    # A posture is all there is to the body's shape, so the spheres move rigidly with B.
    R_WB = quaternion_to_matrix(a.q_WB)
    spheres = np.array([capabilities.collision_spheres(sample) for sample in samples])
    spheres[:, :, :3] = (spheres[:, :, :3] - a.p_WB) @ R_WB
    return spheres


@kernel
def narrowest(prims: Structured, spheres_B: Points, ends: Points, steps: int) -> Vector:
    """The narrowest place between two postures: [structure, ground, primitive, centre (3)].

    ``spheres_B`` (1 or steps + 1, n, 4) are centres in B and radii, m; ``ends`` (2, 7) the
    body's poses p_WB, q_WB at both ends.
    """
    found = np.zeros(6)
    found[0] = found[1] = np.inf
    found[2] = -1.0
    q_a = ends[0, 3:]
    theta = quaternion_log(quaternion_multiply(quaternion_conjugate(q_a), ends[1, 3:]))
    for step in range(steps + 1):
        share = step / steps
        q = quaternion_multiply(q_a, quaternion_exp(share * theta))
        p = (1.0 - share) * ends[0, :3] + share * ends[1, :3]
        body = spheres_B[min(step, spheres_B.shape[0] - 1)]
        for k in range(body.shape[0]):
            center = p + rotate(q, body[k, :3])
            found[1] = min(found[1], center[2] - body[k, 3])
            for i in range(prims.shape[0]):
                gap = abs(patch_distance(prims, i, center)) - body[k, 3]
                if gap < found[0]:
                    found[0] = gap
                    found[2] = i
                    for axis in range(3):
                        found[3 + axis] = center[axis]
    return found


def _patch_points(prims: Structured, i: int) -> Points:
    """Points (81, 3) spread over a patch, its corners among them."""
    half_u, half_v = prims["half_size"][i]
    spread = np.linspace(-1.0, 1.0, BOX_SAMPLES)
    return np.array([point_at(prims, i, u * half_u, v * half_v) for u in spread for v in spread])


def _carries(prims: Structured, i: int, foot_W: Vector) -> bool:
    """Whether the patch lies under a foot at ``foot_W`` and is level enough to stand on."""
    if abs(patch_distance(prims, i, foot_W)) > STOOD_ON_M:
        return False
    above = patch_distance(prims, i, foot_W + np.array([0.0, 0.0, 2.0 * STOOD_ON_M]))
    return above > 2.0 * STOOD_ON_M * STOOD_ON_COSINE
