"""Smooth trajectories: sequences of quintic stretches from wherever the reference is.

Every stretch begins with the motion of the instant at which it was planned and ends at rest, so
that the reference is continuous up to its accelerations across any replanning. Its duration is
the shortest found at which the limits hold. From rest to rest over a distance d it is

    T = max(15 d / (8 v_max), √(10 d / (√3 a_max)))

because the minimum-jerk profile peaks at 15/8 d/T and 10/√3 d/T². Started in motion, a longer
stretch of the same kind is tried until the limits hold and the path stays near the straight
line; where none does, the vehicle brakes first and leaves from rest.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from inspect_cli.guidance.motion import Motion, MotionLimits
from inspect_cli.guidance.quintic import (
    evaluate_motion,
    evaluate_quintic,
    quintic_between,
    survey,
)
from inspect_cli.interfaces import Posture
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import (
    quaternion_conjugate,
    quaternion_log,
    quaternion_multiply,
)

SHORTEST_S = 0.1
"""No stretch is shorter, however near its goal."""
CORRECTION_S = 1.0
"""A correction takes at least this long. Planned anew at every estimate, it also smooths the noise
of the normals: the reference follows with about half of it."""
GROWTH = 1.1
TRIES = 30
"""Durations are tried in a geometric sequence; together up to 17 times the first."""
TOLERANCE = 1.02
"""A limit counts as kept within 2 %: a stretch that replans another at its peak touches it."""
STRAY_M = 0.005
STRAY_SHARE = 0.1
"""A stretch that starts in motion may leave its straight line by the way the vehicle needs to
brake plus 5 mm, and sideways by a tenth of the line's length more."""


@dataclass(frozen=True)
class Stretch:
    """One quintic from a motion to rest: coefficients (6, n) in s = (t − start_s) / duration_s.

    The turn has a duration of its own, ``turn_s`` ≤ ``duration_s``, and its s counts by that.
    """

    start_s: float
    duration_s: float
    turn_s: float
    position: Matrix
    rotation: Matrix
    q_start: Vector
    arm: Matrix

    @classmethod
    def to_rest(
        cls,
        start_s: float,
        start: Motion,
        p_WB: Vector,
        phi: Vector,
        arm: Vector,
        duration_s: float,
        turn_s: float,
    ) -> Stretch:
        """From ``start`` to rest at ``p_WB`` (3,), attitude R_0 Exp(``phi`` (3,)), ``arm`` (n,)."""
        still = np.zeros(3), np.zeros(3)
        turning = phi, np.zeros(3)
        return cls.to_motion(start_s, start, (p_WB, *still), turning, arm, duration_s, turn_s)

    @classmethod
    def to_motion(
        cls,
        start_s: float,
        start: Motion,
        goal: tuple[Vector, Vector, Vector],
        turning: tuple[Vector, Vector],
        arm: Vector,
        duration_s: float,
        turn_s: float,
    ) -> Stretch:
        """Like ``to_rest``, but the body passes its goal in motion.

        ``goal`` is (p_WB, v_WB_W, a_WB_W) there, ``turning`` the rotation vector φ and its rate.
        """
        position, rotation = np.empty((6, 3)), np.empty((6, 3))
        joints, none = np.empty((6, start.arm.shape[1])), np.zeros(start.arm.shape[1])
        still = np.zeros(3)
        quintic_between(
            start.p_WB, start.v_WB_W, start.a_WB_W, *goal, duration_s, position
        )  # fmt: skip
        quintic_between(
            still, start.w_WB_B, start.alpha_WB_B, *turning, still, turn_s, rotation
        )  # fmt: skip
        angle, rate, acceleration = start.arm
        quintic_between(angle, rate, acceleration, arm, none, none, duration_s, joints)
        return cls(start_s, duration_s, turn_s, position, rotation, start.q_WB, joints)

    @property
    def end_s(self) -> float:
        """When it comes to rest."""
        return self.start_s + self.duration_s

    def motion(self, t_s: float) -> Motion:
        """The motion at ``t_s``; at rest in the goal after the end."""
        p, v, a, w, alpha, tip = np.empty((6, 3))
        q = np.empty(4)
        evaluate_motion(
            self.duration_s,
            self.turn_s,
            self.position,
            self.rotation,
            self.q_start,
            np.zeros(3),
            p,
            q,
            v,
            w,
            a,
            alpha,
            tip,
            t_s - self.start_s,
        )
        return Motion(p, q, v, w, a, alpha, self.arm_motion(t_s))

    def arm_motion(self, t_s: float) -> Matrix:
        """Angles, rates and accelerations (3, n) of the arm at ``t_s``."""
        out = np.empty((3, self.arm.shape[1]))
        s = min(max((t_s - self.start_s) / self.duration_s, 0.0), 1.0)
        evaluate_quintic(self.arm, s, self.duration_s, *out)
        return out

    def survey(self, limits: MotionLimits) -> tuple[float, float, float]:
        """(largest share of a limit, way aside of the straight line, way beyond its ends)."""
        return survey(
            self.position,
            self.rotation,
            self.arm,
            self.duration_s,
            self.turn_s,
            limits.as_array(),
        )


class Trajectory:
    """Stretches one after the other; between them, and after the last, the reference rests."""

    def __init__(self, stretches: Sequence[Stretch]) -> None:
        if not stretches:
            raise ValueError("a trajectory leads somewhere: it has at least one stretch")
        self._stretches = list(stretches)
        self._current = -1
        self._next()

    def _next(self) -> None:
        """Go on to the next stretch; the last one holds for ever."""
        self._current += 1
        self._stretch = self._stretches[self._current]
        is_last = self._current + 1 == len(self._stretches)
        self._until_s = math.inf if is_last else self._stretch.end_s

    @classmethod
    def resting(cls, t_s: float, posture: Posture) -> Trajectory:
        """The posture, held from ``t_s`` on."""
        motion = Motion.at_rest(posture)
        goal = motion.p_WB, np.zeros(3), motion.arm[0]
        return cls([Stretch.to_rest(t_s, motion, *goal, SHORTEST_S, SHORTEST_S)])

    @property
    def end_s(self) -> float:
        """When the last stretch comes to rest."""
        return self._stretches[-1].end_s

    def at(self, t_s: float) -> Stretch:
        """The stretch that holds at ``t_s``. Time is asked in order: it does not run back."""
        while t_s >= self._until_s:
            self._next()
        return self._stretch

    def motion(self, t_s: float) -> Motion:
        """The motion at ``t_s``."""
        return self.at(t_s).motion(t_s)


def to_goal(
    t_s: float, start: Motion, goal: Posture, limits: MotionLimits, at_least_s: float = 0.0
) -> list[Stretch]:
    """From ``start`` at ``t_s`` to rest at ``goal``: one stretch, or a braking one before it.

    It takes ``at_least_s``, and longer where the limits ask for it. Raises ValueError when the
    goal's arm has another number of joints.
    """
    p_goal = np.asarray(goal.p_WB, dtype=np.float64)
    phi = turn_between(start.q_WB, goal.q_WB)
    arm = np.asarray(goal.joint_angle, dtype=np.float64)
    if arm.shape != start.arm[0].shape:
        raise ValueError(f"the arm has {start.arm.shape[1]} joints, its goal {arm.size} angles")
    duration = max(at_least_s, SHORTEST_S)
    braking = _braking_time(start, limits)
    if braking == 0.0 or at_least_s == 0.0:
        way = float(np.linalg.norm(p_goal - start.p_WB))
        joint = float(np.abs(arm - start.arm[0]).max(initial=0.0))
        turn = max(float(np.linalg.norm(phi)), joint)
        duration = max(duration, _rest_time(way, turn, limits))
    turn_s = _turn_time(start, phi, limits, duration, CORRECTION_S)
    stray = 0.5 * float(np.linalg.norm(start.v_WB_W)) * braking + STRAY_M
    for _ in range(TRIES):
        stretch = Stretch.to_rest(t_s, start, p_goal, phi, arm, duration, turn_s)
        ratio, aside, beyond = stretch.survey(limits)
        aside -= STRAY_SHARE * float(np.linalg.norm(p_goal - start.p_WB))
        if ratio <= TOLERANCE and aside <= stray and beyond <= stray:
            return [stretch]
        duration *= GROWTH
        turn_s = _turn_time(start, phi, limits, duration, turn_s * GROWTH)
    brake = to_stop(t_s, start, limits)
    return [brake, *to_goal(brake.end_s, brake.motion(brake.end_s), goal, limits)]


def through(
    t_s: float, start: Motion, goals: Sequence[Posture], limits: MotionLimits
) -> list[Stretch]:
    """From ``start`` at ``t_s`` to each goal in turn, at rest in every one of them."""
    stretches: list[Stretch] = []
    for goal in goals:
        stretches += to_goal(t_s, start, goal, limits)
        t_s = stretches[-1].end_s
        start = stretches[-1].motion(t_s)
    return stretches


def to_stop(t_s: float, start: Motion, limits: MotionLimits) -> Stretch:
    """From ``start`` at ``t_s`` to rest as soon as the limits allow, wherever that is.

    With the end left free, at x_0 + v_0 T/2 + a_0 T²/12, the quintic loses its highest power and
    the speed falls along a cubic without overshoot: v(s) = v_0 (1 − 3s² + 2s³) from a_0 = 0.
    """
    present = MotionLimits(
        max(limits.speed_mps, float(np.linalg.norm(start.v_WB_W))),
        limits.acceleration_mps2,
        max(limits.angular_rate_radps, float(np.linalg.norm(start.w_WB_B))),
        limits.angular_acceleration_radps2,
    )
    duration = max(SHORTEST_S, _braking_time(start, limits))
    best = _free_stop(t_s, start, duration)
    least = best.survey(present)[0]
    for _ in range(TRIES):
        if least <= TOLERANCE:
            break
        duration *= GROWTH
        stretch = _free_stop(t_s, start, duration)
        ratio = stretch.survey(present)[0]
        if ratio < least:
            best, least = stretch, ratio
    return best


def _free_stop(t_s: float, start: Motion, T: float) -> Stretch:
    p_end = start.p_WB + 0.5 * T * start.v_WB_W + T * T / 12.0 * start.a_WB_W
    phi = 0.5 * T * start.w_WB_B + T * T / 12.0 * start.alpha_WB_B
    arm = start.arm[0] + 0.5 * T * start.arm[1] + T * T / 12.0 * start.arm[2]
    return Stretch.to_rest(t_s, start, p_end, phi, arm, T, T)


def turn_between(q_from: Vector, q_to: Vector) -> Vector:
    """The rotation vector φ (3,), of length at most π, with R_to = R_from Exp(φ)."""
    relative = quaternion_multiply(quaternion_conjugate(q_from), np.asarray(q_to, dtype=np.float64))
    return quaternion_log(relative)


def _rest_time(way: float, turn: float, limits: MotionLimits) -> float:
    """Least duration from rest to rest over a way in m and a turn in rad."""
    peak = 10.0 / math.sqrt(3.0)
    return max(
        15.0 / 8.0 * way / limits.speed_mps,
        math.sqrt(peak * way / limits.acceleration_mps2),
        15.0 / 8.0 * turn / limits.angular_rate_radps,
        math.sqrt(peak * turn / limits.angular_acceleration_radps2),
    )


def _turn_time(
    start: Motion, phi: Vector, limits: MotionLimits, duration_s: float, least_s: float
) -> float:
    """How long the turn takes within a stretch of ``duration_s``; ``least_s`` if it may.

    From rest, as long as the way: then both follow one profile. A turn that is already under way
    is a correction; stretched over a long way its small rate would carry it far off its goal.
    """
    if not start.w_WB_B.any():
        return duration_s
    angle = float(np.linalg.norm(phi))
    return min(duration_s, max(least_s, _rest_time(0.0, angle, limits)))


def _braking_time(start: Motion, limits: MotionLimits) -> float:
    """Duration of a stop without initial acceleration: v falls along a cubic, peak 3/2 v_0/T."""
    speed = float(np.linalg.norm(start.v_WB_W))
    turn = max(float(np.linalg.norm(start.w_WB_B)), float(np.abs(start.arm[1]).max(initial=0.0)))
    return 1.5 * max(
        speed / limits.acceleration_mps2,
        turn / limits.angular_acceleration_radps2,
    )
