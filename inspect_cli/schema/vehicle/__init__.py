"""Platform files: the models of the kinds of platform, and of what they have in common.

A package outside this one adds a kind as an entry point of the group ``inspect_cli.platforms``,
and its vehicle as one of ``inspect_cli.vehicles``.
"""

from __future__ import annotations

from inspect_cli.plugins import registered
from inspect_cli.schema.vehicle.base import Battery, Limits, PlatformBase, Rates, RotorDrive
from inspect_cli.schema.vehicle.control import ControlModel, ImpedancePlatform, ImpedanceProfile
from inspect_cli.schema.vehicle.core import Core
from inspect_cli.schema.vehicle.sensors import (
    DepthCameraModel,
    HalfCellModel,
    ImuModel,
    InstrumentModel,
    MountModel,
    OdometryModel,
    PoseSourceModel,
    PoseTrackerModel,
    SensorModel,
)
from inspect_cli.schema.vehicle.tilt_rotor import TiltArm, TiltRotorPlatform

__all__ = [
    "PLATFORM_KINDS",
    "Battery",
    "ControlModel",
    "Core",
    "DepthCameraModel",
    "HalfCellModel",
    "ImpedancePlatform",
    "ImpedanceProfile",
    "ImuModel",
    "InstrumentModel",
    "Limits",
    "MountModel",
    "OdometryModel",
    "PlatformBase",
    "PoseSourceModel",
    "PoseTrackerModel",
    "Rates",
    "RotorDrive",
    "SensorModel",
    "TiltArm",
    "TiltRotorPlatform",
]

PLATFORM_KINDS: dict[str, type[PlatformBase]] = registered(
    "inspect_cli.platforms",
    {"tilt_rotor": TiltRotorPlatform},
    PlatformBase,
)
