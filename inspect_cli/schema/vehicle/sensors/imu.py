"""``kind: imu``: the inertial unit at O_b."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import NonNegative
from inspect_cli.schema.vehicle.sensors.base import SensorModel


class ImuModel(SensorModel):
    """White noise densities and bias random walks of the inertial unit."""

    kind: Literal["imu"]
    accel_noise: NonNegative
    """m/s²/√Hz."""
    gyro_noise: NonNegative
    """rad/s/√Hz."""
    accel_bias_walk: NonNegative
    """m/s³/√Hz."""
    gyro_bias_walk: NonNegative
    """rad/s²/√Hz."""
    accel_bias_initial_mps2: NonNegative
    """Standard deviation of the bias at the start."""
    gyro_bias_initial_radps: NonNegative
