"""Dryden turbulence at low altitude: three Gaussian processes with rational spectra.

Along the mean wind (u), across it (v) and upwards (w), with Ω the spatial frequency and
∫₀^∞ Φ dΩ = σ²,

    Φ_u = σ_u² (2 L_u/π) / (1 + (L_u Ω)²)
    Φ_v = σ_v² (L_v/π) (1 + 3 (L_v Ω)²) / (1 + (L_v Ω)²)²,        Φ_w likewise.

Scales and strengths at the height h in feet, 10 ft ≤ h ≤ 1000 ft (MIL-F-8785C, 3.7.3.4):

    L_w = h,           L_u = L_v = h / (0.177 + 0.000823 h)^1.2
    σ_w = 0.1 W₂₀,     σ_u = σ_v = σ_w / (0.177 + 0.000823 h)^0.4

MIL-HDBK-1797 halves L_v and L_w and doubles them in the spectra: the same.

Frozen turbulence is carried past the vehicle at the speed V, which turns Ω into ω/V and a scale
into a time τ = L/V. Unit white noise n through the filters

    u: σ √(2τ) / (1 + τ s)             v, w: σ √τ (1 + √3 τ s) / (1 + τ s)²

has those spectra. With z₁ = √τ/(1 + τ s) n and z₂ = z₁/(1 + τ s) they are u = σ √2 z₁ and
v = σ (√3 z₁ + (1 − √3) z₂). The stationary covariance of (z₁, z₂) is P = ¼ [2, 1; 1, 1], and
over a step of δ = Δt/τ

    z ← Φ z + √Q n,       Φ = e^(−δ) [1, 0; δ, 1],       Q = P − Φ P Φᵀ,

exactly, for any step: the samples have the continuous process's covariance.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.spatial.arrays import Matrix, Vector

FOOT_M = 0.3048
SQRT3 = 3.0**0.5


class Scales(NamedTuple):
    """Lengths, m, and standard deviations, m/s, along, across and upwards, (3,) each."""

    length_m: Vector
    sigma_mps: Vector


def scales(w20_mps: float, altitude_m: float) -> Scales:
    """Of the standard's low-altitude model, 3.048 m to 304.8 m."""
    h = altitude_m / FOOT_M
    shape = 0.177 + 0.000823 * h
    along, upwards = h / shape**1.2 * FOOT_M, altitude_m
    sigma_w = 0.1 * w20_mps
    sigma_u = sigma_w / shape**0.4
    return Scales(np.array([along, along, upwards]), np.array([sigma_u, sigma_u, sigma_w]))


@kernel
def advance(z: Matrix, delta: Vector, noise: Matrix) -> None:
    """Step the states z (3, 2) of the three processes by ``delta`` (3,) time constants."""
    for i in range(3):
        d = delta[i]
        a = np.exp(-d)
        # Q, and its Cholesky factor; expm1 keeps the small numbers' digits.
        lost = -np.expm1(-2.0 * d)
        q11 = 0.5 * lost
        q12 = 0.25 * lost - 0.5 * d * a * a
        q22 = 0.25 * lost - 0.5 * d * a * a * (1.0 + d)
        l11 = np.sqrt(q11)
        l12 = q12 / l11
        l22 = np.sqrt(max(0.0, q22 - l12 * l12))
        z[i, 1] = a * (d * z[i, 0] + z[i, 1]) + l12 * noise[i, 0] + l22 * noise[i, 1]
        z[i, 0] = a * z[i, 0] + l11 * noise[i, 0]


@kernel
def velocity(z: Matrix, sigma: Vector) -> Vector:
    """(u, v, w) in m/s of the states."""
    out = np.empty(3)
    out[0] = sigma[0] * np.sqrt(2.0) * z[0, 0]
    for i in range(1, 3):
        out[i] = sigma[i] * (SQRT3 * z[i, 0] + (1.0 - SQRT3) * z[i, 1])
    return out


class Turbulence:
    """The gusts at one place, step by step; it starts in its stationary distribution."""

    def __init__(
        self, scales: Scales, speed_mps: float, step_s: float, rng: np.random.Generator
    ) -> None:
        self._rng = rng
        self._sigma = scales.sigma_mps
        self._delta = step_s * speed_mps / scales.length_m
        root = np.array([[np.sqrt(0.5), 0.0], [np.sqrt(0.125), np.sqrt(0.125)]])
        self._z: Matrix = rng.standard_normal((3, 2)) @ root.T

    def step(self) -> Vector:
        """(u, v, w) in m/s one step later."""
        advance(self._z, self._delta, self._rng.standard_normal((3, 2)))
        return velocity(self._z, self._sigma)
