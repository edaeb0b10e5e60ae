"""Plates: what the tool's tip meets of a hollow or irregular surface.

A plate is a box on a mocap body. Before each stretch of physics it is placed so that its front is
the plane tangent to the true surface at the foot of the tip's middle, so that a tip at rest has
the very depth and normal that the surface gives. A mocap body has no velocity in MuJoCo's
constraints and friction there has no memory of places: a plate that is put elsewhere neither
carries nor kicks the tip.

Between two placings the tip slides s = v Δt and the surface leaves the plane by s²/2R: at 0.2 m/s,
4 ms and R = 1.5 m that is 0.2 μm. The normal lags by s/R = 0.5 mrad, so the damper sees v s/R
= 0.1 mm/s that are not there, 0.02 N at 190 N·s/m, just before the next placing.

A plate is engaged once the tip's middle is on the free side with its foot on the surface, and
parked when the foot leaves the surface, or the tip is farther than ``REACH_M`` away or deeper
than ``BEHIND_M``: so what slides off an edge is free at once, and what comes back from behind
meets nothing.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.simulation.surface_geoms import WALL_THICKNESS_M, plate_name
from inspect_cli.spatial.arrays import Indices, Mask, Points, Vector
from inspect_cli.truth.solids import Solids, foot_on, normal_on, point_on

REACH_M = 0.3
BEHIND_M = 0.05
PARKED_M = -1000.0
"""Height of a plate that is out of the way."""


@kernel
def place_plates(
    solids: Solids,
    surfaces: Indices,
    slots: Indices,
    p_W: Vector,
    thickness: float,
    engaged: Mask,
    mocap_pos: Points,
    mocap_quat: Points,
) -> None:
    """Put the plate in ``slots[k]`` below the point ``p_W`` (3,) on surface ``surfaces[k]``.

    A box has two fronts alike, so z of the box is n or −n, whichever is nearer to z_W: that turn,
    about (−m_y, m_x, 0), is well defined for every normal.
    """
    for k in range(surfaces.shape[0]):
        u, v, w, on = foot_on(solids, surfaces[k], p_W)
        engaged[k] = on and -BEHIND_M < w < REACH_M and (engaged[k] or w >= 0.0)
        slot = slots[k]
        if not engaged[k]:
            for m in range(3):
                mocap_pos[slot, m] = 0.0
            mocap_pos[slot, 2] = PARKED_M
            continue
        n = normal_on(solids, surfaces[k], u, v)
        front = point_on(solids, surfaces[k], u, v)
        for m in range(3):
            mocap_pos[slot, m] = front[m] - 0.5 * thickness * n[m]
        sign = 1.0 if n[2] >= 0.0 else -1.0
        q_w, q_x, q_y = 1.0 + sign * n[2], -sign * n[1], sign * n[0]
        size = np.sqrt(q_w * q_w + q_x * q_x + q_y * q_y)
        mocap_quat[slot, 0] = q_w / size
        mocap_quat[slot, 1] = q_x / size
        mocap_quat[slot, 2] = q_y / size
        mocap_quat[slot, 3] = 0.0


class Plates:
    """The plates of one world, following one tip."""

    def __init__(self, model: mujoco.MjModel, data: mujoco.MjData, solids: Solids) -> None:
        named = {model.body(b).name: int(model.body_mocapid[b]) for b in range(model.nbody)}
        count = len(solids.primitives) + len(solids.reliefs)
        plated = [i for i in range(count) if plate_name(i) in named]
        self._engaged = np.zeros(len(plated), np.bool_)
        self.any = bool(plated)
        """Whether there is anything to place."""
        if self.any:
            self._place = bound(
                place_plates,
                solids,
                np.array(plated, dtype=np.int32),
                np.array([named[plate_name(i)] for i in plated], dtype=np.int32),
                data.geom_xpos[model.geom("tip").id],
                WALL_THICKNESS_M,
                self._engaged,
                data.mocap_pos,
                data.mocap_quat,
            )

    def reset(self) -> None:
        """Forget what was touched."""
        self._engaged[:] = False

    def follow(self) -> None:
        """Place every plate below the tip, whose kinematics are up to date."""
        if self.any:
            self._place()
