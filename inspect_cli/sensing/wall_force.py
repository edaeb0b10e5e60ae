"""Simulated six-axis force and torque sensor that carries a surface of the structure.

Its frame S is the surface's (``inspect_cli.spatial.primitives``): the origin in the middle of a
plane, z_S along its outward normal, so that pressing is negative along z_S. For the force f and
the torque t (about O_W) of the tool on the surface, both in W,

    f_S = q(R_WSᵀ f + σ_f n₁, r_f)      t_S = q(R_WSᵀ (t − p_WS × f) + σ_t n₂, r_t)

with n_i standard normal and q(x, r) = r round(x / r) the output's resolution, q(x, 0) = x. The
mounting is rigid and the wall's own mass is not felt: the surface does not move.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.records import WALL_SAMPLES, WallForce
from inspect_cli.schema.truth import ForceSensorModel
from inspect_cli.sensing.instrument import Noise
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.rotations import cross, matrix_to_quaternion, quaternion_conjugate, rotate
from inspect_cli.truth.snapshot import Truth


class WallForceSensor:
    """Force and torque of the tool on one surface, collected in blocks.

    ``surface`` is its PRIMITIVE (1,). ``measurement`` is the block that is being filled.
    """

    def __init__(
        self, model: ForceSensorModel, surface: Structured, rng: np.random.Generator
    ) -> None:
        self.measurement = WallForce.create()
        self.measurement.period = 1.0 / model.rate_hz
        self.measurement.p_WS = surface["p_WS"][0]
        q_WS = matrix_to_quaternion(np.ascontiguousarray(surface["R_WS"][0]))
        self.measurement.q_WS = q_WS
        self._p_WS = self.measurement.p_WS
        self._q_SW = quaternion_conjugate(q_WS)
        self._sd = np.repeat([model.noise_n, model.torque_noise_nm], 3)
        self._resolution = np.repeat([model.resolution_n, model.torque_resolution_nm], 3)
        self._noise = Noise(rng, 6)
        self._filled = 0

    def sample(self, truth: Truth) -> WallForce | None:
        """Measure the wrench of the tool; the block of samples once it is full."""
        wrench_W = truth.wall_wrench()
        self._filled %= WALL_SAMPLES
        force = wrench_W[:3]
        ideal = np.empty(6)
        ideal[:3] = rotate(self._q_SW, force)
        ideal[3:] = rotate(self._q_SW, wrench_W[3:] - cross(self._p_WS, force))
        output = rounded(ideal + self._sd * self._noise.draw(), self._resolution)
        block = self.measurement
        block.f_S[self._filled], block.t_S[self._filled] = output[:3], output[3:]
        block.t_s = truth.state.t_s
        self._filled += 1
        return block if self._filled == WALL_SAMPLES else None


def rounded(values: Vector, steps: Vector) -> Vector:
    """The nearest multiple of each step; the value itself where the step is 0."""
    safe = np.where(steps > 0.0, steps, 1.0)
    nearest: Vector = np.where(steps > 0.0, safe * np.round(values / safe), values)
    return nearest
