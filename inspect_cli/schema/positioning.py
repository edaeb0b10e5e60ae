"""Where a vehicle gets its poses from: the external tracker, or the odometry on board."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import NonNegative, Strict

Estimation = Literal["external", "onboard"]
"""Whether the vehicle knows its pose from the external tracker or from its own odometry."""


class PoseNoise(Strict):
    """What the filter is told of a pose measurement: its white noise, and whether it drifts."""

    position_noise_m: NonNegative
    attitude_noise_rad: NonNegative

    @property
    def walks(self) -> tuple[float, float, float]:
        """Random walks of the frame: position per √m, yaw per √m and per √rad; 0 for none."""
        return (0.0, 0.0, 0.0)
