"""The simulated instruments of one flight, each with its own generator and its own faults."""

from __future__ import annotations

import numpy as np

from inspect_cli.interfaces import Sensor
from inspect_cli.records import Probe, State, TrueContact, WallForce
from inspect_cli.schema.base import Triple
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.sensing.half_cell import HalfCellProbe
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.odometry import OdometrySensor
from inspect_cli.sensing.pose import PoseSensor
from inspect_cli.sensing.tof import TofCamera
from inspect_cli.sensing.wall_force import WallForceSensor
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.spatial.arrays import Vector
from inspect_cli.truth.faults import Faults, punch_holes, spoil
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.solids import on_the_ground


class Instruments:
    """IMU, tracker or odometry, depth camera, half-cell probe, and a force sensor in the wall.

    A call is False when nothing came.
    """

    def __init__(
        self,
        platform: PlatformBase,
        structure: StructureTruth,
        faults: Faults,
        seed: int,
        estimation: Estimation = "external",
        odometry_drift_mps: Triple = (0.0, 0.0, 0.0),
    ) -> None:
        sensors = platform.sensors
        seen = on_the_ground(structure.solids)
        self.imu = ImuSensor(sensors.imu, platform.rates.imu_hz, component_rng(seed, "imu"))
        self.odometry: OdometrySensor | None = None
        self.pose: PoseSensor | OdometrySensor
        if estimation == "onboard" and sensors.odometry is not None:
            self.odometry = OdometrySensor(
                sensors.odometry, component_rng(seed, "odometry"), odometry_drift_mps
            )
            self.pose = self.odometry
        else:
            self.pose = PoseSensor(sensors.pose, component_rng(seed, "pose"))
        self._pose_name = "pose" if self.odometry is None else "odometry"
        self.tof = TofCamera(sensors.tof, seen, component_rng(seed, "tof"))
        self.probe = HalfCellProbe(
            sensors.half_cell, component_rng(seed, "probe"), structure.temperatures_c
        )
        self.wall = _wall_sensor(structure, seed)
        self._faults = faults
        self._holes = component_rng(seed, "tof holes")

    def sample_imu(self, state: State) -> bool:
        """An inertial sample."""
        return self._sample("imu", self.imu, state)

    def sample_pose(self, state: State) -> bool:
        """A pose of the tracker, or of the odometry if there is one, in ``pose.measurement``."""
        return self._sample(self._pose_name, self.pose, state)

    def sample_tof(self, state: State) -> bool:
        """A depth image, in ``tof.points_D``."""
        fault = self._faults.active("tof", state.t_s)
        if fault is not None and fault.fault == "off":
            return False
        self.tof.sample(state)
        if fault is None:
            return True
        if fault.share is not None:
            model = self.tof.model
            image = self.tof.points_D.reshape(model.rows, model.columns, 3)
            punch_holes(image, fault.share, self._holes)
        else:
            self.tof.points_D[...] = np.nan
        return True

    def sample_probe(self, state: State, contact: TrueContact) -> Probe | None:
        """A sample of the half-cell and its load cell."""
        fault = self._faults.active("probe", state.t_s)
        if fault is not None and fault.fault == "off":
            return None
        self.probe.sample(state, contact)
        if fault is not None:
            spoil(self.probe.measurement)
        return self.probe.measurement

    def sample_wall(self, t_s: float, wrench_W: Vector) -> WallForce | None:
        """A sample of what the tip does to the wall (6,); the block of samples once it is full."""
        full = self.wall is not None and self.wall.sample(t_s, wrench_W)
        return self.wall.measurement if self.wall is not None and full else None

    def _sample(self, name: str, sensor: Sensor, state: State) -> bool:
        fault = self._faults.active(name, state.t_s)
        if fault is not None and fault.fault == "off":
            return False
        sensor.sample(state)
        if fault is not None:
            spoil(sensor.measurement)
        return True


def _wall_sensor(structure: StructureTruth, seed: int) -> WallForceSensor | None:
    for index, surface in enumerate(structure.surfaces):
        if surface.force_sensor is not None:
            primitive = structure.solids.primitives[index : index + 1]
            return WallForceSensor(surface.force_sensor, primitive, component_rng(seed, "wall"))
    return None
