"""The contact frame: the surface at a target as it is believed, and the tool's attitude to it."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.guidance.orientation import contact_orientation, heading_orientation
from inspect_cli.records import SurfaceEstimate
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import quaternion_to_matrix

MIN_COSINE = float(np.cos(np.radians(30.0)))
MAX_SHIFT_M = 0.30
"""A plane turned (30°) or shifted by more than these from the believed one is taken for another
thing."""
MIN_FIRST_COSINE = float(np.cos(np.radians(60.0)))
"""A surface that nobody described may be turned by 60° when it is first seen."""
ARRIVAL_M = 0.005
ARRIVAL_RAD = float(np.radians(2.0))
"""Corrections smaller than these do not put off the arrival."""


@dataclass(frozen=True)
class ContactFrame:
    """A contact point (3,) m with its outward normal (3,) in W, and R_WT (3, 3) with z_T = −n.

    ``level`` says whether y_T is kept level. Near the vertical a small error of n̂ would turn a
    level y axis by far: where a plausible correction could bring n̂ there, the heading is kept.
    ``found`` is False as long as nothing is known of the surface but the direction to look in.
    """

    p_WC: Vector
    n_W: Vector
    R_WT: Matrix
    level: bool
    found: bool = True

    @classmethod
    def planned(cls, target: Target) -> ContactFrame:
        """What the plan believes."""
        R_WT = quaternion_to_matrix(np.array(target.q_WT))
        n_W = np.array(target.n_W)
        return cls(np.array(target.p_WC), n_W, R_WT, _is_level(n_W), target.following is None)

    @classmethod
    def of_set_point(cls, p_WT: Vector, R_WT: Matrix, depth_m: float, level: bool) -> ContactFrame:
        """The contact frame of a tool whose set-point lies ``depth_m`` behind the surface."""
        n_W = -R_WT[:, 2]
        return cls(p_WT + depth_m * n_W, n_W, R_WT, level)

    def seen(self, estimate: SurfaceEstimate) -> ContactFrame | None:
        """The contact point moved along n̂ onto the seen plane; None if that is implausible.

        A surface that was not found yet is found where the tool's axis meets it.
        """
        if self.contradicts(estimate):
            return None
        n_W = estimate.n_W.copy()
        if not self.found:
            level, p_WC = _is_level(n_W), estimate.p_WC.copy()
            return ContactFrame(p_WC, n_W, _orientation(n_W, self.R_WT[:, 1], level), level)
        return self.at(self.p_WC + self._shift(estimate) * n_W, n_W)

    def contradicts(self, estimate: SurfaceEstimate) -> bool:
        """Whether a plane is turned or shifted too far to be this surface, or not a number."""
        n_W = estimate.views["n_W"]
        if not self.found:
            return not float(n_W @ self.n_W) >= MIN_FIRST_COSINE
        if not float(n_W @ self.n_W) >= MIN_COSINE:
            return True
        return not abs(self._shift(estimate)) <= MAX_SHIFT_M

    def _shift(self, estimate: SurfaceEstimate) -> float:
        """How far the contact point moves along n̂ onto the seen plane, m."""
        return float(estimate.views["n_W"] @ (estimate.views["p_WC"] - self.p_WC))

    def at(self, p_WC: Vector, n_W: Vector) -> ContactFrame:
        """The frame at another point and normal, with the tool turned by the same rule."""
        return ContactFrame(p_WC, n_W, _orientation(n_W, self.R_WT[:, 1], self.level), self.level)

    def set_point(self, depth_m: float) -> Vector:
        """p_WT (3,) with the tip ``depth_m`` behind the surface."""
        point: Vector = self.p_WC - depth_m * self.n_W
        return point

    def differs(self, other: ContactFrame, depth_m: float) -> bool:
        """Whether going from the other's set-point to this one's is worth waiting for."""
        way = np.linalg.norm(self.set_point(depth_m) - other.set_point(depth_m))
        return bool(way > ARRIVAL_M or self.n_W @ other.n_W < np.cos(ARRIVAL_RAD))


def _is_level(n_W: Vector) -> bool:
    return bool(abs(n_W[2]) <= MIN_COSINE)


def _orientation(n_W: Vector, hint_W: Vector, level: bool) -> Matrix:
    return contact_orientation(n_W, hint_W) if level else heading_orientation(n_W, hint_W)
