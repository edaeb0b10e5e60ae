"""Following a surface that only the depth camera knows: how far the set-point lies ahead.

Bodie et al. (RSS 2019), section IV-E: the set-point moves tangent to the currently estimated
surface in a direction of the tool, and estimate, set-point and trajectory are renewed at 5 Hz: a
pure pursuit that keeps contact and orientation. Here the set-point of each renewal is where the
law of progress will be ``HORIZON_S`` later, to be passed at the law's speed then; so the
reference moves steadily between renewals, and comes to rest behind the horizon if none follows.

The surface bends away from its tangent. What the normals of the past have turned per metre,
b = dn/ds, is carried on to the horizon: at the distance s ahead along the tangent t

    n(s) = n + s b,    p(s) = p + s t − ½ s² (t · b) n,    ω = n × b ṡ

without which the tool would lag behind a vault by half the horizon.
"""

from __future__ import annotations

from dataclasses import dataclass, field

import numpy as np

from inspect_cli.guidance.contact_frame import ContactFrame
from inspect_cli.guidance.motion import MotionLimits
from inspect_cli.guidance.progress import Progress
from inspect_cli.schema import plan
from inspect_cli.spatial.arrays import Matrix, Vector

HORIZON_S = 1.0
"""The renewals of a second smooth the noise of the normals, as corrections of an approach do."""
LONGEST_GAP_S = 0.4
"""While no estimate comes for longer, the law of progress waits."""
ACCELERATION_SHARE = 0.5
"""Of what the vehicle may: the tool starts gently on a surface that rubs."""
BEND_SHARE = 0.2
"""Of each new difference of normals in the bend: over a second's renewals noise averages out."""
LEAST_STEP_M = 0.01
"""Normals nearer to each other than this tell nothing of a bend."""


@dataclass
class SurfaceTracking:
    """The state of one slide."""

    progress: Progress
    axis: int
    sign: float
    last_s: float
    clock_s: float = 0.0
    """Time of the law of progress."""
    end_s: float = 0.0
    """When the reference will have come to rest at the end of the way."""
    bend_W: Vector = field(default_factory=lambda: np.zeros(3))
    """b = dn/ds (3,) in W, 1/m."""
    _normal: tuple[Vector, float] | None = None
    """The normal of the last difference, and where on the way it was seen."""

    @classmethod
    def begin(cls, t_s: float, model: plan.Following, limits: MotionLimits) -> SurfaceTracking:
        """From rest at ``t_s``."""
        acceleration = ACCELERATION_SHARE * limits.acceleration_mps2
        speed = min(model.speed_mps, limits.speed_mps)
        progress = Progress.along(model.distance_m, speed, acceleration)
        sign = -1.0 if model.direction.startswith("-") else 1.0
        axis = 0 if model.direction.endswith("x") else 1
        end_s = t_s + progress.duration_s + HORIZON_S
        return cls(progress, axis, sign, t_s, 0.0, end_s)

    def ahead(self, t_s: float) -> tuple[float, float, float]:
        """(m ahead of now, m/s and m/s² there) of the set-point to be aimed at from ``t_s`` on."""
        self.clock_s += min(t_s - self.last_s, LONGEST_GAP_S)
        self.last_s = t_s
        left_s = self.progress.duration_s - self.clock_s
        if left_s > 0.0:
            self.end_s = t_s + left_s + HORIZON_S
        here = self.progress.at(self.clock_s)[0]
        there, speed, change = self.progress.at(self.clock_s + HORIZON_S)
        return there - here, speed, change

    def learn(self, n_W: Vector) -> None:
        """Take a seen normal (3,) into the bend; where the way has not moved on, nothing."""
        here = self.progress.at(self.clock_s)[0]
        if self._normal is None:
            self._normal = n_W, here
            return
        before, there = self._normal
        if here - there < LEAST_STEP_M:
            return
        self.bend_W += BEND_SHARE * ((n_W - before) / (here - there) - self.bend_W)
        self._normal = n_W, here

    def surface_at(self, frame: ContactFrame, way_m: float) -> tuple[Vector, Vector]:
        """Point (3,) m and normal (3,) of the bent surface ``way_m`` ahead of a contact frame."""
        forward = self.direction(frame.R_WT)
        sag = 0.5 * way_m * way_m * float(forward @ self.bend_W)
        n_W = frame.n_W + way_m * self.bend_W
        return frame.p_WC + way_m * forward - sag * frame.n_W, n_W / np.linalg.norm(n_W)

    def direction(self, R_WT: Matrix) -> Vector:
        """The unit vector (3,) in W along which the tool slides."""
        along: Vector = self.sign * R_WT[:, self.axis]
        return along
