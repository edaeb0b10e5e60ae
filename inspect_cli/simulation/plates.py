"""Plates: the boxes that stand for a hollow or irregular surface at the vehicle's contacts.

A plate is a box on a mocap body, one for each surface and each geom of a contact. Before each
stretch of physics it is placed so that its front is the plane tangent to the true surface at the
foot of the geom's middle, so that a tip at rest has the very depth and normal that the surface
gives. The rest of this page says "tip" for every such geom. A mocap body has no velocity in
MuJoCo's constraints and friction there has no memory of places: a plate that is put elsewhere
neither carries nor kicks the tip.

Between two placings the tip slides s = v Δt and the surface leaves the plane by s²/2R: at 0.2 m/s,
4 ms and R = 1.5 m that is 0.2 μm. The normal lags by s/R = 0.5 mrad, so the damper sees v s/R
= 0.1 mm/s that are not there, 0.02 N at 190 N·s/m, just before the next placing.

A plate is engaged once the tip's middle is on the free side with its foot on the surface, and
parked when the foot leaves the surface, or the tip is farther than ``REACH_M`` away or deeper
than ``BEHIND_M``: so a tip that slides off an edge is free at once, and one that comes
back from behind touches nothing.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import mujoco
import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.simulation.surface_geoms import WALL_THICKNESS_M, plate_name
from inspect_cli.spatial.arrays import Indices, Mask, Points
from inspect_cli.truth.solids import Solids, foot_on, normal_on, point_on
from inspect_cli.vehicles.contacts import Contact

REACH_M = 0.3
BEHIND_M = 0.05
PARKED_M = -1000.0
"""Height of a plate that is out of the way."""


@kernel
def place_plates(
    solids: Solids,
    surfaces: Indices,
    slots: Indices,
    geoms: Indices,
    geom_xpos: Points,
    thickness: float,
    engaged: Mask,
    mocap_pos: Points,
    mocap_quat: Points,
) -> None:
    """Put the plate in ``slots[k]`` below the middle of ``geoms[k]`` on surface ``surfaces[k]``.

    ``geom_xpos`` (n, 3) are MuJoCo's places of all geoms, in W.

    A box has two fronts alike, so z of the box is n or −n, whichever is nearer to z_W: that turn,
    about (−m_y, m_x, 0), is well defined for every normal.
    """
    for k in range(surfaces.shape[0]):
        u, v, w, on = foot_on(solids, surfaces[k], geom_xpos[geoms[k]])
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
    """The plates of one world, each following one geom of a contact."""

    def __init__(
        self,
        model: mujoco.MjModel,
        data: mujoco.MjData,
        solids: Solids,
        contacts: Sequence[Contact],
    ) -> None:
        named = {model.body(b).name: int(model.body_mocapid[b]) for b in range(model.nbody)}
        count = len(solids.primitives) + len(solids.reliefs)
        touching = [geom for contact in contacts for geom in contact.geoms]
        plated = [(i, g) for i in range(count) for g in touching if plate_name(i, g) in named]
        self._engaged = np.zeros(len(plated), np.bool_)
        self.any = bool(plated)
        """Whether there is anything to place."""
        self.place: Callable[[], object] = lambda: None
        """Places every plate below its geom, whose kinematics are up to date."""
        if self.any:
            self.place = bound(
                place_plates,
                solids,
                np.array([i for i, _ in plated], dtype=np.int32),
                np.array([named[plate_name(i, g)] for i, g in plated], dtype=np.int32),
                np.array([model.geom(g).id for _, g in plated], dtype=np.int32),
                data.geom_xpos,
                WALL_THICKNESS_M,
                self._engaged,
                data.mocap_pos,
                data.mocap_quat,
            )

    def reset(self) -> None:
        """Park all plates until a tip is in front of them again."""
        self._engaged[:] = False
