"""Simulated tracker: position and attitude of the body with white noise.

p_m = p_WB + σ_p n₁,    R_m = R_WB Exp(σ_θ n₂),    n_i standard normal
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.records import Pose
from inspect_cli.schema.vehicle import PoseTrackerModel
from inspect_cli.sensing.instrument import Noise, Surroundings
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import (
    quaternion_exp,
    quaternion_multiply,
    quaternion_normalize,
)
from inspect_cli.truth.snapshot import Truth


@kernel
def measure_pose(
    p: Vector, q: Vector, noise: Vector, sd: Vector, p_measured: Vector, q_measured: Vector
) -> None:
    """Write the measured pose; ``noise`` (6,) standard normal, ``sd`` (2,) = (σ_p, σ_θ)."""
    turn = np.empty(3)
    for i in range(3):
        p_measured[i] = p[i] + sd[0] * noise[i]
        turn[i] = sd[1] * noise[3 + i]
    measured = quaternion_normalize(quaternion_multiply(q, quaternion_exp(turn)))
    for i in range(4):
        q_measured[i] = measured[i]


class PoseSensor:
    """Position and attitude of the body."""

    def __init__(self, model: PoseTrackerModel, rng: np.random.Generator) -> None:
        self.measurement = Pose.create()
        self._sd = np.array([model.position_noise_m, model.attitude_noise_rad])
        self._noise = Noise(rng, 6)

    def sample(self, truth: Truth) -> Pose:
        """Measure now."""
        state, measurement = truth.state, self.measurement
        measurement.t_s = state.t_s
        measure_pose(
            state.p_WB,
            state.q_WB,
            self._noise.draw(),
            self._sd,
            measurement.p_WB,
            measurement.q_WB,
        )
        return measurement


def pose_tracker(model: PoseTrackerModel, around: Surroundings) -> PoseSensor:
    """The tracker of a flight."""
    return PoseSensor(model, around.rng)
