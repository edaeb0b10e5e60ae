"""Sensors that inspect does not have, as a platform file states them."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import Name, NonNegative, Positive
from inspect_cli.schema.vehicle.sensors.base import SensorModel


class EncodersModel(SensorModel):
    """Encoders of all joints, driven or not."""

    kind: Literal["joint_encoders"]
    step_rad: Positive


class WrenchSensorModel(SensorModel):
    """A six-axis force and torque sensor under one of the vehicle's contacts."""

    kind: Literal["wrench_sensor"]
    contact: Name
    force_noise_n: NonNegative
    torque_noise_nm: NonNegative
