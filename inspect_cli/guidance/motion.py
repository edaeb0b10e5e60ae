"""The state of a moving reference, and the bounds that it obeys."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.rotations import quaternion_normalize


@dataclass(frozen=True)
class MotionLimits:
    """Bounds on the norms of the body's motion; joints of an arm obey the angular ones."""

    speed_mps: float
    acceleration_mps2: float
    angular_rate_radps: float
    angular_acceleration_radps2: float

    @classmethod
    def of(cls, capabilities: Capabilities, speed_mps: float | None = None) -> MotionLimits:
        """The vehicle's limits with the speed lowered to ``speed_mps``.

        Vehicles state no angular acceleration; they are given the one that reaches the largest
        rate in the time in which the largest acceleration reaches the largest speed.
        """
        fastest = capabilities.max_speed_mps
        turn = capabilities.max_angular_rate_radps
        return cls(
            fastest if speed_mps is None else min(speed_mps, fastest),
            capabilities.max_acceleration_mps2,
            turn,
            turn * capabilities.max_acceleration_mps2 / fastest,
        )

    def as_array(self) -> Vector:
        """The four bounds (4,) in the order in which they are declared."""
        return np.array(
            [
                self.speed_mps,
                self.acceleration_mps2,
                self.angular_rate_radps,
                self.angular_acceleration_radps2,
            ]
        )


@dataclass(frozen=True)
class Motion:
    """Where the reference is and how it moves; ``arm`` (3, n) holds angles, rates, accelerations.

    The other names, units and frames are those of ``records.Reference``.
    """

    p_WB: Vector
    q_WB: Vector
    v_WB_W: Vector
    w_WB_B: Vector
    a_WB_W: Vector
    alpha_WB_B: Vector
    arm: Matrix

    @classmethod
    def at_rest(cls, posture: Posture) -> Motion:
        """The posture, held."""
        arm = np.zeros((3, len(posture.joint_angle)))
        arm[0] = posture.joint_angle
        return cls(
            np.array(posture.p_WB, dtype=np.float64),
            quaternion_normalize(np.array(posture.q_WB, dtype=np.float64)),
            np.zeros(3),
            np.zeros(3),
            np.zeros(3),
            np.zeros(3),
            arm,
        )
