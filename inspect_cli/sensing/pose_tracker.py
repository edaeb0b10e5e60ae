"""Simulated tracker: position and attitude of the body with white noise.

p_m = p_WB + σ_p n₁,    R_m = R_WB Exp(σ_θ n₂),    n_i standard normal
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.records import Pose, State
from inspect_cli.schema.vehicle import PoseTrackerModel
from inspect_cli.sensing.instrument import Noise, Surroundings
from inspect_cli.spatial.arrays import Indices, Matrix, Vector
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


@kernel
def track(
    t: Vector,
    p: Vector,
    q: Vector,
    noises: Matrix,
    row: Indices,
    sd: Vector,
    t_measured: Vector,
    p_measured: Vector,
    q_measured: Vector,
) -> None:
    """Write time (1,) and pose, measured with the noise ``noises[row[0]]``."""
    t_measured[0] = t[0]
    measure_pose(p, q, noises[row[0]], sd, p_measured, q_measured)


class PoseSensor:
    """Position and attitude of the body."""

    def __init__(self, model: PoseTrackerModel, rng: np.random.Generator) -> None:
        self.measurement = Pose.create()
        self._sd = np.array([model.position_noise_m, model.attitude_noise_rad])
        self._noise = Noise(rng, 6)
        self._seen: State | None = None

    def sample(self, truth: Truth) -> Pose:
        """Measure now."""
        if truth.state is not self._seen:
            self._seen = truth.state
            true, measured = truth.state.views, self.measurement.views
            self._track = bound(
                track,
                true["t_s"],
                true["p_WB"],
                true["q_WB"],
                self._noise.block,
                self._noise.row,
                self._sd,
                measured["t_s"],
                measured["p_WB"],
                measured["q_WB"],
            )
        self._noise.advance()
        self._track()
        return self.measurement


def pose_tracker(model: PoseTrackerModel, around: Surroundings) -> PoseSensor:
    """The tracker of a flight."""
    return PoseSensor(model, around.rng)
