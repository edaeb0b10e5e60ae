"""The simulated instruments of one flight, each with its own generator and its own faults."""

from __future__ import annotations

import numpy as np

from inspect_cli.interfaces import Sensor
from inspect_cli.records import Probe, State, TrueContact
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.sensing.half_cell import HalfCellProbe
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.pose import PoseSensor
from inspect_cli.sensing.tof import TofCamera
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.truth.faults import Faults, punch_holes, spoil
from inspect_cli.truth.solids import Solids, on_the_ground


class Instruments:
    """IMU, tracker, depth camera and half-cell probe. A call is False when nothing came."""

    def __init__(self, platform: PlatformBase, solids: Solids, faults: Faults, seed: int) -> None:
        sensors = platform.sensors
        self.imu = ImuSensor(sensors.imu, platform.rates.imu_hz, component_rng(seed, "imu"))
        self.pose = PoseSensor(sensors.pose, component_rng(seed, "pose"))
        self.tof = TofCamera(sensors.tof, on_the_ground(solids), component_rng(seed, "tof"))
        self.probe = HalfCellProbe(sensors.half_cell, component_rng(seed, "probe"))
        self._faults = faults
        self._holes = component_rng(seed, "tof holes")

    def sample_imu(self, state: State) -> bool:
        """An inertial sample."""
        return self._sample("imu", self.imu, state)

    def sample_pose(self, state: State) -> bool:
        """A pose measurement."""
        return self._sample("pose", self.pose, state)

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

    def _sample(self, name: str, sensor: Sensor, state: State) -> bool:
        fault = self._faults.active(name, state.t_s)
        if fault is not None and fault.fault == "off":
            return False
        sensor.sample(state)
        if fault is not None:
            spoil(sensor.measurement)
        return True
