"""The kinds of sensors that a platform file may name: one file and one row each.

A package outside this one adds a kind as an entry point of the group ``inspect_cli.sensors``, from
a module that imports ``schema.vehicle.sensors.base`` and no platform. What measures in the
simulation stands in ``inspect_cli.sensing``.
"""

from __future__ import annotations

from typing import Annotated

from inspect_cli.plugins import registered
from inspect_cli.schema.registry import OneOf
from inspect_cli.schema.vehicle.sensors.base import (
    InstrumentModel,
    MountModel,
    PoseSourceModel,
    SensorModel,
)
from inspect_cli.schema.vehicle.sensors.depth_camera import DepthCameraModel
from inspect_cli.schema.vehicle.sensors.half_cell import HalfCellModel
from inspect_cli.schema.vehicle.sensors.imu import ImuModel
from inspect_cli.schema.vehicle.sensors.odometry import OdometryModel
from inspect_cli.schema.vehicle.sensors.pose_tracker import PoseTrackerModel

__all__ = [
    "INSTRUMENTS",
    "SENSORS",
    "AnySensor",
    "DepthCameraModel",
    "HalfCellModel",
    "ImuModel",
    "InstrumentModel",
    "MountModel",
    "OdometryModel",
    "PoseSourceModel",
    "PoseTrackerModel",
    "SensorModel",
]

SENSORS: dict[str, type[SensorModel]] = registered(
    "inspect_cli.sensors",
    {
        "imu": ImuModel,
        "pose_tracker": PoseTrackerModel,
        "odometry": OdometryModel,
        "depth_camera": DepthCameraModel,
        "half_cell": HalfCellModel,
    },
    SensorModel,
)
"""In the order in which a flight samples them: what corrects the estimate comes before what is
placed by it."""

INSTRUMENTS: dict[str, type[InstrumentModel]] = {
    name: model for name, model in SENSORS.items() if issubclass(model, InstrumentModel)
}
"""Those of them that read points. A task that names none reads with the first."""

AnySensor = Annotated[SensorModel, OneOf(SENSORS)]
