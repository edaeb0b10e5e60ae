"""Writes the reference: flies plans, and corrects an approach by the surface that is seen.

Normal-tracking pursuit: at each estimate of the local surface the planned contact point is moved
along the estimated normal onto the estimated plane, the tool is turned so that z_T = −n̂, and the
trajectory is planned anew from the reference of that instant to the corrected set-point. That
lies ``depth_m`` behind the plane on its normal, so pressing needs no switch of mode (Bodie et
al., "An Omnidirectional Aerial Manipulation Platform for Contact-Based Inspection", RSS 2019).

A tool that slides is one whose ``_Surface.p_WC`` moves along the surface; nothing else changes.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.guidance.motion import MotionLimits
from inspect_cli.guidance.orientation import contact_orientation, heading_orientation
from inspect_cli.guidance.quintic import evaluate_motion
from inspect_cli.guidance.trajectory import (
    CORRECTION_S,
    Trajectory,
    through,
    to_goal,
    to_stop,
)
from inspect_cli.interfaces import Capabilities, Posture, at_origin
from inspect_cli.records import Reference, SurfaceEstimate
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import quaternion_to_matrix

MAX_TILT_RAD = float(np.radians(30.0))
MAX_SHIFT_M = 0.30
"""A plane turned or shifted by more than these from the planned one is taken for something else."""
ARRIVAL_M = 0.005
ARRIVAL_RAD = float(np.radians(2.0))
"""Corrections smaller than these do not put off the arrival."""


@dataclass(frozen=True)
class _Surface:
    """The surface at a target as it is believed, and how the tool is turned towards it."""

    p_WC: Vector
    n_W: Vector
    R_WT: Matrix

    @classmethod
    def planned(cls, target: Target) -> _Surface:
        """What the plan believes."""
        R_WT = quaternion_to_matrix(np.array(target.q_WT))
        return cls(np.array(target.p_WC), np.array(target.n_W), R_WT)

    @classmethod
    def seen(cls, target: Target, estimate: SurfaceEstimate) -> _Surface | None:
        """The planned contact point moved along n̂ onto the seen plane; None if implausible.

        y_T is level. Near the vertical a small error of n̂ would turn a level y axis by far, so
        where a plausible correction could bring n̂ there the planned heading is kept.
        """
        plan = cls.planned(target)
        n_W = estimate.n_W.copy()
        shift = float(n_W @ (estimate.p_WC - plan.p_WC))
        if not (n_W @ plan.n_W >= np.cos(MAX_TILT_RAD) and abs(shift) <= MAX_SHIFT_M):
            return None
        near_vertical = abs(plan.n_W[2]) > np.cos(MAX_TILT_RAD)
        orientation = heading_orientation if near_vertical else contact_orientation
        return cls(plan.p_WC + shift * n_W, n_W, orientation(n_W, plan.R_WT[:, 1]))

    def set_point(self, depth_m: float) -> Vector:
        """p_WT (3,) with the tip ``depth_m`` behind the surface."""
        return self.p_WC - depth_m * self.n_W

    def differs(self, other: _Surface, depth_m: float) -> bool:
        """Whether going from the other's set-point to this one's is worth waiting for."""
        way = np.linalg.norm(self.set_point(depth_m) - other.set_point(depth_m))
        return bool(way > ARRIVAL_M or self.n_W @ other.n_W < np.cos(ARRIVAL_RAD))


@dataclass
class _Approach:
    """What is being approached."""

    target: Target
    depth_m: float
    limits: MotionLimits
    surface: _Surface
    announced: _Surface
    """The surface for which the time of arrival was last set."""


class Pursuit:
    """Owns the reference and moves it smoothly: never a jump in p, v, a, q, ω or α."""

    def __init__(self, capabilities: Capabilities, posture: Posture) -> None:
        self.capabilities = capabilities
        self.reference = Reference.create(capabilities.lengths)
        self.reference.target = -1.0
        self.reference.arm_angle[:] = posture.arm_angle
        self.implausible = 0
        """Surface estimates that were not followed because they contradict the plan."""
        self._trajectory = Trajectory.resting(0.0, posture)
        self._approach: _Approach | None = None
        self._arrival_s = 0.0
        self._arm_angle = self.reference.arm_angle
        self._p_BT = self._tool_offset()
        views = self.reference.views
        self._written = (
            views["p_WB"],
            views["q_WB"],
            views["v_WB_W"],
            views["w_WB_B"],
            views["a_WB_W"],
            views["alpha_WB_B"],
            views["p_WT"],
        )
        self.write(0.0)

    def go_to(self, t_s: float, postures: Sequence[Posture], speed_mps: float) -> None:
        """Fly through ``postures``, at rest in each, from wherever the reference is."""
        limits = MotionLimits.of(self.capabilities, speed_mps)
        start = self._trajectory.motion(t_s)
        self._approach = None
        self._follow(Trajectory(through(t_s, start, postures, limits)))

    def approach(self, t_s: float, target: Target, depth_m: float, speed_mps: float) -> None:
        """Aim the tip ``depth_m`` behind the surface at the target's contact point.

        Negative depths are in front. A surface already seen at this target stays believed.
        Raises ValueError when no posture reaches that point.
        """
        limits = MotionLimits.of(self.capabilities, speed_mps)
        surface = _Surface.planned(target)
        if self._approach is not None and self._approach.target == target:
            surface = self._approach.surface
        aim = self._posture_for(target, surface, depth_m)
        if aim is None:
            raise ValueError(f"no posture puts the tool {depth_m} m behind {target.label}")
        self._approach = _Approach(target, depth_m, limits, surface, surface)
        start = self._trajectory.motion(t_s)
        self._follow(Trajectory(to_goal(t_s, start, aim, limits)))

    def observe(self, t_s: float, surface: SurfaceEstimate) -> None:
        """Correct the approach by an estimate of the local surface.

        Without a valid estimate, or without an approach, nothing changes. An estimate that is
        turned or shifted too far from the planned surface, or that cannot be reached, is counted
        in ``implausible`` and otherwise ignored.
        """
        approach = self._approach
        if approach is None or surface.valid != 1.0:
            return
        seen = _Surface.seen(approach.target, surface)
        aim = None if seen is None else self._posture_for(approach.target, seen, approach.depth_m)
        if seen is None or aim is None:
            self.implausible += 1
            return
        approach.surface = seen
        remaining = max(self._trajectory.end_s - t_s, CORRECTION_S)
        start = self._trajectory.motion(t_s)
        self._trajectory = Trajectory(to_goal(t_s, start, aim, approach.limits, remaining))
        if seen.differs(approach.announced, approach.depth_m):
            approach.announced = seen
            self._arrival_s = self._trajectory.end_s

    def contradicts(self, target: Target, surface: SurfaceEstimate) -> bool:
        """Whether an estimate is turned or shifted too far to be the target's surface."""
        return _Surface.seen(target, surface) is None

    def hold(self, t_s: float) -> None:
        """Brake within the limits and stay there."""
        start = self._trajectory.motion(t_s)
        self._approach = None
        self._follow(Trajectory([to_stop(t_s, start, MotionLimits.of(self.capabilities))]))

    def arrived(self, t_s: float) -> bool:
        """Whether the reference has come to rest where it was sent, small corrections apart."""
        return t_s >= self._arrival_s

    def write(self, t_s: float) -> None:
        """Write the motion of the instant into ``reference``."""
        stretch = self._trajectory.at(t_s)
        if self._arm_angle.size:
            self._arm_angle[:] = stretch.arm_motion(t_s)[0]
            self._p_BT = self._tool_offset()
        evaluate_motion(
            t_s - stretch.start_s,
            stretch.duration_s,
            stretch.turn_s,
            stretch.position,
            stretch.rotation,
            stretch.q_start,
            self._p_BT,
            *self._written,
        )
        self.reference.t_s = t_s

    def _follow(self, trajectory: Trajectory) -> None:
        self._trajectory = trajectory
        self._arrival_s = trajectory.end_s

    def _tool_offset(self) -> Vector:
        """p_BT (3,) with the arm as it is asked now."""
        p_BT, _ = self.capabilities.tool_pose(at_origin(self._arm_angle))
        return np.array(p_BT, dtype=np.float64)

    def _posture_for(self, target: Target, surface: _Surface, depth_m: float) -> Posture | None:
        """The posture with the tip ``depth_m`` behind the surface, the closest to the planned."""
        planned = Posture(
            np.array(target.contact.p_WB),
            np.array(target.contact.q_WB),
            np.array(target.contact.arm_angle_rad),
        )
        p_WT = surface.set_point(depth_m)
        return self.capabilities.posture_for_tool(p_WT, surface.R_WT, planned)
