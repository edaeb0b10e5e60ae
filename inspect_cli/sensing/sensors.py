"""The simulated sensor of each kind: one file and one row each.

A package outside this one adds a kind as an entry point of the group
``inspect_cli.simulated_sensors``, under the name that its model has in ``inspect_cli.sensors``.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

from inspect_cli.errors import EnvironmentFault
from inspect_cli.plugins import registered
from inspect_cli.schema.vehicle import SensorModel
from inspect_cli.sensing.depth_camera import depth_camera
from inspect_cli.sensing.half_cell import half_cell_probe
from inspect_cli.sensing.imu import imu_sensor
from inspect_cli.sensing.instrument import SimulatedSensor, Surroundings
from inspect_cli.sensing.odometry import odometry_sensor
from inspect_cli.sensing.pose_tracker import pose_tracker

SENSORS: dict[str, Callable[[Any, Surroundings], SimulatedSensor]] = registered(
    "inspect_cli.simulated_sensors",
    {
        "imu": imu_sensor,
        "pose_tracker": pose_tracker,
        "odometry": odometry_sensor,
        "depth_camera": depth_camera,
        "half_cell": half_cell_probe,
    },
    Callable,
)


def simulated(model: SensorModel, around: Surroundings) -> SimulatedSensor:
    """The simulated sensor of a model.

    Raises:
        EnvironmentFault: nothing simulates sensors of that kind.
    """
    if model.kind not in SENSORS:
        raise EnvironmentFault(
            f"nothing simulates a sensor of kind {model.kind}",
            hint=f"kinds that are simulated: {', '.join(SENSORS)}",
        )
    return SENSORS[model.kind](model, around)
