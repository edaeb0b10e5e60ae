"""How long a motion takes and what it costs.

Every stretch from rest to rest follows the quintic s(τ) = 10τ³ − 15τ⁴ + 6τ⁵ of τ = t/T, whose
peaks over a distance d are 15/8 · d/T in speed and 10/√3 · d/T² in acceleration (Biagiotti &
Melchiorri, "Trajectory Planning for Automatic Machines and Robots", 2008).
"""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise

import numpy as np

from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.spatial.rotations import (
    quaternion_conjugate,
    quaternion_log,
    quaternion_multiply,
)

PEAK_SPEED = 15.0 / 8.0
PEAK_ACCELERATION = 10.0 / np.sqrt(3.0)


def extent(a: Posture, b: Posture) -> tuple[float, float]:
    """How far two postures are apart: (m of translation, rad of the largest turn).

    The turn is the larger of the body's rotation angle and any arm joint's motion.
    """
    turn = quaternion_log(quaternion_multiply(quaternion_conjugate(a.q_WB), b.q_WB))
    joints = np.abs(b.arm_angle - a.arm_angle)
    angle = max(float(np.linalg.norm(turn)), float(joints.max(initial=0.0)))
    return float(np.linalg.norm(b.p_WB - a.p_WB)), angle


def rest_to_rest_s(
    distance_m: float, angle_rad: float, speed_mps: float, capabilities: Capabilities
) -> float:
    """The shortest time, s, of a quintic stretch that keeps to all limits.

    T = max(15 d / 8 v, √(10 d / √3 a), 15 θ / 8 ω); ``speed_mps`` is the peak speed v, the
    vehicle's own limits are the acceleration a and the rate ω for body and arm joints.
    """
    return max(
        PEAK_SPEED * distance_m / speed_mps,
        float(np.sqrt(PEAK_ACCELERATION * distance_m / capabilities.max_acceleration_mps2)),
        PEAK_SPEED * angle_rad / capabilities.max_angular_rate_radps,
    )


def path_m(postures: Sequence[Posture]) -> float:
    """Length, m, of the body's path through the postures."""
    return sum(extent(a, b)[0] for a, b in pairwise(postures))


def duration_and_energy(
    postures: Sequence[Posture], speed_mps: float, dwell_s: float, capabilities: Capabilities
) -> tuple[float, float]:
    """(s, J) of flying through the postures, resting at each, and dwelling at the last.

    The power of a stretch is the mean of the hover powers at its ends: at the plan's
    accelerations the thrust is the weight's to a few percent.
    """
    powers = [capabilities.hover_power_w(posture) for posture in postures]
    time_s, energy_j = dwell_s, dwell_s * powers[-1]
    for k, (a, b) in enumerate(pairwise(postures)):
        distance_m, angle_rad = extent(a, b)
        stretch_s = rest_to_rest_s(distance_m, angle_rad, speed_mps, capabilities)
        time_s += stretch_s
        energy_j += stretch_s * 0.5 * (powers[k] + powers[k + 1])
    return time_s, energy_j
