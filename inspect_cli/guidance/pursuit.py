"""Writes the reference: flies plans, and corrects an approach by the surface that is seen.

Normal-tracking pursuit: at each estimate of the local surface the believed contact point is moved
along the estimated normal onto the estimated plane, the tool is turned so that z_T = −n̂, and the
trajectory is planned anew from the reference of that instant to the corrected set-point. That
lies ``depth_m`` behind the plane on its normal, so pressing needs no switch of mode (Bodie et
al., "An Omnidirectional Aerial Manipulation Platform for Contact-Based Inspection", RSS 2019).

A surface that nobody described is faced first: the tool turns about the point that it looks at,
as far away as it is, and goes there once it stands square to it. Turned on the way, it would look
elsewhere before it arrives.

Sliding moves that contact point: along a stroke of the plan, whose surface is corrected once by
what was seen before, or along the seen surface itself, corrected by every estimate (section IV-E).
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence

import numpy as np

from inspect_cli.compiled import bound
from inspect_cli.guidance.approach import Approach
from inspect_cli.guidance.contact_frame import ContactFrame
from inspect_cli.guidance.motion import Motion, MotionLimits
from inspect_cli.guidance.quintic import write_motion
from inspect_cli.guidance.stroke import StrokePath, along, corrected
from inspect_cli.guidance.surface_tracking import HORIZON_S, SurfaceTracking
from inspect_cli.guidance.trajectory import (
    CORRECTION_S,
    Stretch,
    Trajectory,
    through,
    to_goal,
    to_stop,
    turn_between,
)
from inspect_cli.interfaces import (
    FREE,
    TOOL,
    Capabilities,
    FramePose,
    Posture,
    at_origin,
    pushed_along,
)
from inspect_cli.records import Reference, SurfaceEstimate
from inspect_cli.schema.plan import Target
from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.rotations import rotate_back

FACING_MPS = 0.5
"""The fastest way around a point that the tool turns to."""

NO_SURFACES: Mapping[str, Structured] = {}


class Pursuit:
    """Owns the reference and moves it smoothly: never a jump in p, v, a, q, ω or α.

    ``surfaces`` are the believed ones by name, PRIMITIVE arrays of length 1: strokes lie on them.
    """

    def __init__(
        self,
        capabilities: Capabilities,
        posture: Posture,
        surfaces: Mapping[str, Structured] = NO_SURFACES,
    ) -> None:
        self.capabilities = capabilities
        self.reference = Reference.create(capabilities.lengths)
        self.reference.target = -1.0
        self.reference.arm_angle[:] = posture.joint_angle
        self.implausible = 0
        """Surface estimates that were not followed because they contradict what is believed."""
        self.tracks_surface = False
        """Whether the surface that is seen corrects the reference; see ``track``."""
        self._surfaces = surfaces
        self._trajectory = Trajectory.resting(0.0, posture)
        self._approach: Approach | None = None
        self._planned_for: Target | None = None
        self._arrival_s = 0.0
        self._arm_angle = self.reference.arm_angle
        self._has_arm = bool(self._arm_angle.size)
        self._p_BT = self._tool_offset()
        self._stretch: Stretch | None = None
        views = self.reference.views
        self._t_s = views["t_s"]
        self._timing, self._q_start = np.zeros(3), np.zeros(4)
        self._position, self._rotation = np.zeros((6, 3)), np.zeros((6, 3))
        self.evaluate = bound(
            write_motion,
            self._timing,
            self._position,
            self._rotation,
            self._q_start,
            self._p_BT,
            self._t_s,
            views["p_WB"],
            views["q_WB"],
            views["v_WB_W"],
            views["w_WB_B"],
            views["a_WB_W"],
            views["alpha_WB_B"],
            views["p_WT"],
        )
        """Writes the motion into ``reference``, after ``prepare``."""
        self.write(0.0)

    def take_impedance(self, name: str) -> None:
        """Fly with a profile of the platform from now on."""
        self.reference.impedance = float(self.capabilities.impedances.index(name))

    def go_to(self, t_s: float, postures: Sequence[Posture], speed_mps: float) -> None:
        """Fly through ``postures``, at rest in each, from wherever the reference is."""
        limits = MotionLimits.of(self.capabilities, speed_mps)
        start = self._trajectory.motion(t_s)
        self._approach = None
        self._follow(Trajectory(through(t_s, start, postures, limits)))

    def approach(self, t_s: float, target: Target, depth_m: float, speed_mps: float) -> None:
        """Aim the tip ``depth_m`` behind the surface at the target's contact point.

        Negative depths are in front. A surface already seen at this target stays believed, and
        so does the place to which the tool has slid. Raises ValueError when no posture reaches
        that point.
        """
        limits = MotionLimits.of(self.capabilities, speed_mps)
        start = self._trajectory.motion(t_s)
        frame = self._believed(target, start)
        goal = self._posture_for(target, frame, depth_m)
        if goal is None:
            raise ValueError(f"no posture puts the tool {depth_m} m behind {target.label}")
        self._approach = Approach(target, depth_m, limits, frame, frame)
        self._follow(Trajectory(to_goal(t_s, start, goal, limits)))

    def slide(self, t_s: float, target: Target) -> None:
        """Move the contact point: along the target's stroke, or along what the camera sees.

        Begins where ``approach`` pressed the tool to. Raises ValueError when a posture along the
        stroke cannot be reached.
        """
        approach = self._approach
        if approach is None or approach.target != target:
            raise ValueError(f"{target.label} has to be touched before the tool can slide")
        approach.sliding = True
        limits = MotionLimits.of(self.capabilities)
        if target.following is not None:
            approach.tracking = SurfaceTracking.begin(t_s, target.following, limits)
            self._arrival_s = approach.tracking.end_s
            return
        self._follow(Trajectory(self._along_stroke(t_s, approach, limits)))

    def track(self, t_s: float, surface: SurfaceEstimate) -> None:
        """``observe`` the surface if the mode asks for that."""
        if self.tracks_surface:
            self.observe(t_s, surface)

    def observe(self, t_s: float, surface: SurfaceEstimate) -> None:
        """Correct the approach by an estimate of the local surface.

        Without a valid estimate, or without an approach, nothing changes. An estimate that is
        turned or shifted too far from the believed surface, or that cannot be reached, is
        counted in ``implausible`` and otherwise ignored.
        """
        approach = self._approach
        if approach is None or surface.valid != 1.0:
            return
        if approach.tracking is not None:
            self._advance(t_s, approach, approach.tracking, surface)
            return
        seen = self._expected(approach).seen(surface)
        if seen is None:
            self.implausible += 1
            return
        if not approach.frame.found:
            approach.facing_m = max(surface.distance, approach.target.standoff_m)
            self._correct(t_s, approach, seen, anew=True)
            approach.faced_s = self._trajectory.end_s
            return
        faced = approach.facing_m is not None and t_s >= approach.faced_s
        if faced:
            approach.facing_m = None
        self._correct(t_s, approach, seen, anew=faced)

    def _correct(self, t_s: float, approach: Approach, seen: ContactFrame, anew: bool) -> None:
        """Plan anew from the reference of this instant to the set-point of a contact frame."""
        facing = approach.facing_m
        depth_m = approach.depth_m if facing is None else -facing
        goal = self._posture_for(approach.target, seen, depth_m)
        if goal is None:
            self.implausible += 1
            return
        approach.frame = seen
        limits = approach.limits
        if facing is not None:
            limits = MotionLimits.of(self.capabilities, FACING_MPS)
        remaining = 0.0 if anew else max(self._trajectory.end_s - t_s, CORRECTION_S)
        start = self._trajectory.motion(t_s)
        self._trajectory = Trajectory(to_goal(t_s, start, goal, limits, remaining))
        if facing is not None:
            self._arrival_s = math.inf
        elif anew or seen.differs(approach.announced, approach.depth_m):
            approach.announced = seen
            self._arrival_s = self._trajectory.end_s

    def contradicts(self, t_s: float, target: Target, surface: SurfaceEstimate) -> bool:
        """Whether an estimate is turned or shifted too far to be the target's surface."""
        approach = self._approach
        if approach is not None and approach.sliding and approach.target == target:
            return self._believed(target, self._trajectory.motion(t_s)).contradicts(surface)
        if target.following is not None:
            return self._believed(target, None).contradicts(surface)
        return self._planned(target).contradicts(surface)

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
        self.prepare(t_s)
        self.evaluate()

    def prepare(self, t_s: float) -> None:
        """Look up what ``evaluate`` needs for the instant ``t_s``."""
        self._t_s[0] = t_s
        stretch = self._trajectory.at(t_s)
        if self._has_arm:
            self._arm_angle[:] = stretch.arm_motion(t_s)[0]
            self._p_BT[:] = self._tool_offset()
        if stretch is not self._stretch:
            self._stretch = stretch
            self._timing[:] = stretch.start_s, stretch.duration_s, stretch.turn_s
            self._position[:], self._rotation[:] = stretch.position, stretch.rotation
            self._q_start[:] = stretch.q_start

    def _follow(self, trajectory: Trajectory) -> None:
        self._trajectory = trajectory
        self._arrival_s = trajectory.end_s

    def _planned(self, target: Target) -> ContactFrame:
        """The contact frame of a target as planned; the last one is kept."""
        if self._planned_for is not target:
            self._planned_for, self._plan_frame = target, ContactFrame.planned(target)
        return self._plan_frame

    def _believed(self, target: Target, now: Motion | None) -> ContactFrame:
        """The contact frame of a target as believed; once the tool slides, the one where it is."""
        approach = self._approach
        if approach is None or approach.target != target:
            return self._planned(target)
        if not approach.sliding or now is None:
            return approach.frame
        p_WT, R_WT = self._tool(now)
        return ContactFrame.of_set_point(p_WT, R_WT, approach.depth_m, approach.frame.level)

    def _expected(self, approach: Approach) -> ContactFrame:
        """What an estimate is held against: the plan where there is one, else what was found.

        Against the plan, so that a chain of plausible steps cannot walk off it.
        """
        return approach.frame if approach.target.following else self._planned(approach.target)

    def _along_stroke(self, t_s: float, approach: Approach, limits: MotionLimits) -> list[Stretch]:
        """The set-points of the target's stroke, on the surface as it was last corrected."""
        target, stroke = approach.target, approach.target.stroke
        if stroke is None or target.surface is None:
            raise ValueError(f"{target.label} has no line to slide along")
        prim = self._surfaces[target.surface]
        aim_at = corrected(prim, self._planned(target), approach.frame)

        def posture_at(u: float, v: float) -> Posture:
            posture = self._posture_for(target, aim_at(u, v), approach.depth_m)
            if posture is None:
                raise ValueError(f"no posture puts the tool on {target.label} at ({u:g}, {v:g})")
            return posture

        first = posture_at(*stroke.pieces_m[0][0])
        stretches = to_goal(t_s, self._trajectory.motion(t_s), first, approach.limits)
        for piece in stroke.pieces_m:
            path = StrokePath(np.array(piece), stroke.speed_mps, limits.acceleration_mps2)
            stretches += along(stretches[-1].end_s, path, posture_at)
        return stretches

    def _advance(
        self, t_s: float, approach: Approach, tracking: SurfaceTracking, surface: SurfaceEstimate
    ) -> None:
        """Aim ahead along the plane that is seen where the reference is now."""
        now = self._trajectory.motion(t_s)
        seen = self._believed(approach.target, now).seen(surface)
        if seen is None:
            self.implausible += 1
            return
        way_m, speed_mps, change_mps2 = tracking.ahead(t_s)
        tracking.learn(seen.n_W)
        ahead = seen.at(*tracking.surface_at(seen, way_m))
        goal = self._posture_for(approach.target, ahead, approach.depth_m)
        if goal is None:
            self.implausible += 1
            return
        approach.frame = seen
        forward = tracking.direction(ahead.R_WT)
        w_W = speed_mps * np.cross(ahead.n_W, tracking.bend_W)
        v_WT_W = speed_mps * (forward - approach.depth_m * tracking.bend_W)
        v_WB_W = v_WT_W - np.cross(w_W, ahead.set_point(approach.depth_m) - goal.p_WB)
        passing = goal.p_WB, v_WB_W, change_mps2 * forward
        # Over a horizon the tool turns by so little that the rate of φ is the body's.
        turning = turn_between(now.q_WB, goal.q_WB), rotate_back(np.asarray(goal.q_WB), w_W)
        stretch = Stretch.to_motion(
            t_s, now, passing, turning, np.asarray(goal.joint_angle), HORIZON_S, HORIZON_S
        )
        limits = MotionLimits.of(self.capabilities)
        braking = to_stop(stretch.end_s, stretch.motion(stretch.end_s), limits)
        self._trajectory = Trajectory([stretch, braking] if speed_mps > 0.0 else [stretch])
        self._arrival_s = tracking.end_s

    def _tool(self, motion: Motion) -> tuple[Vector, Matrix]:
        """(p_WT, R_WT) of the reference in a motion."""
        posture = Posture(motion.p_WB, motion.q_WB, motion.arm[0])
        return self.capabilities.frame_pose(posture, TOOL)

    def _tool_offset(self) -> Vector:
        """p_BT (3,) with the arm as it is asked now."""
        p_BT, _ = self.capabilities.frame_pose(at_origin(self._arm_angle), TOOL)
        return np.array(p_BT, dtype=np.float64)

    def _posture_for(self, target: Target, frame: ContactFrame, depth_m: float) -> Posture | None:
        """The posture with the tip ``depth_m`` behind the surface, the closest to the planned.

        Where the set-point lies behind it, the surface pushes with the force that the plan
        expects.
        """
        goals = {TOOL: FramePose(frame.set_point(depth_m), frame.R_WT)}
        loads = pushed_along(frame.n_W, target.expected_force_n) if depth_m > 0.0 else FREE
        return self.capabilities.solve(goals, loads, target.contact.posture) or None
