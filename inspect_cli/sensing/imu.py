"""Simulated inertial unit at O_b: white noise and bias random walks.

    f_m = R_WBᵀ (a_WB_W − g_W) + b_f + σ_f/√Δt n₁        b_f ← b_f + σ_bf √Δt n₃
    w_m = w_WB_B            + b_w + σ_w/√Δt n₂        b_w ← b_w + σ_bw √Δt n₄

n_i standard normal, Δt = 1 / rate: the discrete form of the continuous noise model in
N. Trawny & S. Roumeliotis, "Indirect Kalman filter for 3D attitude estimation" (University of
Minnesota, TR 2005-002), section 1.2.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import Bound, bound, kernel
from inspect_cli.records import Imu, State
from inspect_cli.schema.vehicle import ImuModel
from inspect_cli.sensing.instrument import Noise, Surroundings
from inspect_cli.spatial.arrays import Indices, Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import rotate_back
from inspect_cli.truth.snapshot import Truth


@kernel
def measure_motion(
    t: Vector,
    q: Vector,
    a_W: Vector,
    w_B: Vector,
    noises: Matrix,
    row: Indices,
    sd: Vector,
    bias: Vector,
    t_measured: Vector,
    f_measured: Vector,
    w_measured: Vector,
) -> None:
    """Write the time (1,), specific force and rate, and let the biases walk.

    ``noises[row[0]]`` (12,) is standard normal for f, w, b_f, b_w; ``sd`` (4,) are their standard
    deviations per sample; ``bias`` (6,) = (b_f, b_w) is changed in place.
    """
    noise = noises[row[0]]
    push = np.empty(3)
    for i in range(3):
        push[i] = a_W[i]
    push[2] += GRAVITY_MPS2
    f_B = rotate_back(q, push)
    t_measured[0] = t[0]
    for i in range(3):
        f_measured[i] = f_B[i] + bias[i] + sd[0] * noise[i]
        w_measured[i] = w_B[i] + bias[3 + i] + sd[1] * noise[3 + i]
        bias[i] += sd[2] * noise[6 + i]
        bias[3 + i] += sd[3] * noise[9 + i]


class ImuSensor:
    """Specific force and angular rate of the body."""

    def __init__(self, model: ImuModel, rng: np.random.Generator) -> None:
        self.measurement = Imu.create()
        root = np.sqrt(model.rate_hz)
        self._sd = np.array(
            [
                model.accel_noise * root,
                model.gyro_noise * root,
                model.accel_bias_walk / root,
                model.gyro_bias_walk / root,
            ]
        )
        initial = [model.accel_bias_initial_mps2, model.gyro_bias_initial_radps]
        self._bias = np.repeat(initial, 3) * rng.standard_normal(6)
        self.noise = Noise(rng, 12)
        self._seen: State | None = None

    def sample(self, truth: Truth) -> Imu:
        """Measure now."""
        if truth.state is not self._seen:
            self._seen, self._measure = truth.state, self.bind(truth)
        self.noise.advance()
        self._measure()
        return self.measurement

    def bind(self, truth: Truth) -> Bound:
        """The measurement as a kernel; ``noise`` has to be advanced before each call."""
        true, measured = truth.state.views, self.measurement.views
        return bound(
            measure_motion,
            true["t_s"],
            true["q_WB"],
            true["a_WB_W"],
            true["w_WB_B"],
            self.noise.block,
            self.noise.row,
            self._sd,
            self._bias,
            measured["t_s"],
            measured["f_B"],
            measured["w_B"],
        )


def imu_sensor(model: ImuModel, around: Surroundings) -> ImuSensor:
    """The inertial unit of a flight."""
    return ImuSensor(model, around.rng)
