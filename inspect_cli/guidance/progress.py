"""How far along a line the tool is at which time: from rest to rest at a steady speed.

The speed rises from 0 to v along a quintic, stays, and falls likewise:

    σ̇(t) = v (10 τ³ − 15 τ⁴ + 6 τ⁵),   τ = t / T_r,   T_r = 15/8 · v/a

so that speed and acceleration are continuous and the acceleration peaks at a. A line too short
for the speed, ℓ < v T_r, is gone along at the speed √(8 ℓ a / 15) that it allows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass


@dataclass(frozen=True)
class Progress:
    """The law σ(t) of a line of ``length_m``."""

    length_m: float
    speed_mps: float
    ramp_s: float

    @classmethod
    def along(cls, length_m: float, speed_mps: float, acceleration_mps2: float) -> Progress:
        """The fastest law within a speed and an acceleration."""
        most = math.sqrt(length_m * acceleration_mps2 / 1.875)
        speed = min(speed_mps, most)
        return cls(length_m, speed, 1.875 * speed / acceleration_mps2)

    @property
    def duration_s(self) -> float:
        """From rest to rest."""
        if self.length_m == 0.0:
            return 0.0
        return self.length_m / self.speed_mps + self.ramp_s

    def at(self, t_s: float) -> tuple[float, float, float]:
        """(σ m, σ̇ m/s, σ̈ m/s²) at ``t_s`` after the start."""
        if t_s <= 0.0 or self.length_m == 0.0:
            return 0.0, 0.0, 0.0
        if t_s >= self.duration_s:
            return self.length_m, 0.0, 0.0
        if t_s > self.duration_s - self.ramp_s:
            way, speed, change = self._rising(self.duration_s - t_s)
            return self.length_m - way, speed, -change
        if t_s >= self.ramp_s:
            return self.speed_mps * (t_s - 0.5 * self.ramp_s), self.speed_mps, 0.0
        return self._rising(t_s)

    def _rising(self, t_s: float) -> tuple[float, float, float]:
        x = t_s / self.ramp_s
        way = self.speed_mps * self.ramp_s * x**4 * (2.5 - 3.0 * x + x * x)
        speed = self.speed_mps * x**3 * (10.0 - 15.0 * x + 6.0 * x * x)
        change = self.speed_mps / self.ramp_s * 30.0 * x * x * (1.0 - x) ** 2
        return way, speed, change
