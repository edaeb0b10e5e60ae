"""How long a motion takes and what it costs.

The stretches are those that guidance flies: quintics from rest to rest. Over a way d and a turn
θ such a stretch peaks at 15/8 · d/T in speed and 10/√3 · d/T² in acceleration, so it takes

    T = max(15 d / 8 v, √(10 d / √3 a), 15 θ / 8 ω, √(10 θ / √3 α))
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from inspect_cli.guidance.motion import Motion, MotionLimits
from inspect_cli.guidance.trajectory import to_goal, turn_between
from inspect_cli.interfaces import FREE, Capabilities, Posture

SAME = 1e-6
"""Metres and radians that no vehicle notices."""


def extent(a: Posture, b: Posture) -> tuple[float, float]:
    """How far two postures are apart: (m of translation, rad of the largest turn).

    The turn is the larger of the body's rotation angle and any arm joint's motion.
    """
    turn = float(np.linalg.norm(turn_between(a.q_WB, b.q_WB)))
    joints = np.abs(b.joint_angle - a.joint_angle)
    return float(np.linalg.norm(b.p_WB - a.p_WB)), max(turn, float(joints.max(initial=0.0)))


def same(a: Posture, b: Posture) -> bool:
    """Whether two postures differ by no more than rounding."""
    distance_m, angle_rad = extent(a, b)
    return distance_m < SAME and angle_rad < SAME


def path_m(postures: Sequence[Posture]) -> float:
    """Length, m, of the body's path through the postures."""
    return sum(extent(a, b)[0] for a, b in pairwise(postures))


def rest_to_rest_s(a: Posture, b: Posture, limits: MotionLimits) -> float:
    """The time, s, in which guidance goes from rest in ``a`` to rest in ``b``."""
    return to_goal(0.0, Motion.at_rest(a), b, limits)[-1].end_s


def duration_and_energy(
    postures: Sequence[Posture], speed_mps: float, dwell_s: float, capabilities: Capabilities
) -> tuple[float, float]:
    """(s, J) of flying through the postures, resting at each, and dwelling at the last.

    The power of a stretch is the mean of those of hovering at its ends: at the plan's
    accelerations the thrust is the weight's to a few percent.
    """
    limits = MotionLimits.of(capabilities, speed_mps)
    powers = [capabilities.power_w(posture, FREE) for posture in postures]
    time_s, energy_j = dwell_s, dwell_s * powers[-1]
    for k, (a, b) in enumerate(pairwise(postures)):
        stretch_s = rest_to_rest_s(a, b, limits)
        time_s += stretch_s
        energy_j += stretch_s * 0.5 * (powers[k] + powers[k + 1])
    return time_s, energy_j
