"""The sensors of one flight as mounts: each with a name, a rate, its faults and its listeners."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from typing import TypeAlias

from inspect_cli.records import Measurement
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.truth import TruthModel
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.sensing.half_cell import HalfCellProbe
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.instrument import SimulatedSensor
from inspect_cli.sensing.odometry import OdometrySensor
from inspect_cli.sensing.pose import PoseSensor
from inspect_cli.sensing.tof import TofCamera
from inspect_cli.sensing.wall_force import WallForceSensor
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.truth.faults import Faults
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.snapshot import Truth
from inspect_cli.truth.solids import on_the_ground

Listener: TypeAlias = Callable[..., None]
"""Takes a measurement of the type that its sensor returns."""

WALL = "wall"
"""Name of the force sensor that a surface is mounted on."""


class Mount:
    """One sensor. The loop samples it at its rate and hands what it returns to the listeners."""

    def __init__(self, name: str, rate_hz: int, sensor: SimulatedSensor) -> None:
        self.name = name
        self.rate_hz = rate_hz
        self.sensor = sensor
        self.listeners: tuple[Listener, ...] = ()
        self._sample = sensor.sample

    def fail(self, faults: Faults, seed: int) -> None:
        """Let the sensor fail where the mission says so."""
        rng = component_rng(seed, f"{self.name} holes")
        self._sample = faults.applied_to(self.name, self._sample, rng)

    def sample(self, truth: Truth) -> Measurement | None:
        """What the sensor returns now; None when nothing came."""
        return self._sample(truth)


def mounts_of(
    platform: PlatformBase,
    structure: StructureTruth,
    truth: TruthModel,
    seed: int,
    estimation: Estimation,
    reads: bool,
) -> tuple[Mount, ...]:
    """The sensors that a flight needs, in the order in which they are sampled.

    Each has a generator of its own, drawn from ``seed`` by the sensor's name. Of tracker and
    odometry, only the one that ``estimation`` names is mounted; the probe only if the plan
    ``reads`` any point.
    """
    mounts = [
        *_motion_sensors(platform, truth, seed, estimation),
        *_wall_sensor(structure, seed),
        *_tool_sensors(platform, structure, seed, reads),
    ]
    faults = Faults(truth.faults)
    for mount in mounts:
        mount.fail(faults, seed)
    return tuple(mounts)


def _motion_sensors(
    platform: PlatformBase, truth: TruthModel, seed: int, estimation: Estimation
) -> Iterator[Mount]:
    sensors, rates = platform.sensors, platform.rates
    imu = ImuSensor(sensors.imu, rates.imu_hz, component_rng(seed, "imu"))
    yield Mount("imu", rates.imu_hz, imu)
    if estimation == "onboard" and sensors.odometry is not None:
        drift_mps = truth.platform.odometry_drift_mps
        odometry = OdometrySensor(sensors.odometry, component_rng(seed, "odometry"), drift_mps)
        yield Mount("odometry", rates.odometry_hz, odometry)
    else:
        pose = PoseSensor(sensors.pose, component_rng(seed, "pose"))
        yield Mount("pose", rates.pose_hz, pose)


def _tool_sensors(
    platform: PlatformBase, structure: StructureTruth, seed: int, reads: bool
) -> Iterator[Mount]:
    sensors, rates = platform.sensors, platform.rates
    seen = on_the_ground(structure.solids)
    yield Mount("tof", rates.tof_hz, TofCamera(sensors.tof, seen, component_rng(seed, "tof")))
    if reads:
        rng = component_rng(seed, "probe")
        probe = HalfCellProbe(sensors.half_cell, rng, structure.temperatures_c)
        yield Mount("probe", rates.probe_hz, probe)


def _wall_sensor(structure: StructureTruth, seed: int) -> Iterator[Mount]:
    for index, surface in enumerate(structure.surfaces):
        if surface.force_sensor is not None:
            primitive = structure.solids.primitives[index : index + 1]
            rng = component_rng(seed, "wall")
            sensor = WallForceSensor(surface.force_sensor, primitive, rng)
            yield Mount(WALL, surface.force_sensor.rate_hz, sensor)
            return


def named(mounts: Sequence[Mount], *names: str) -> Mount:
    """The first mount with one of these names."""
    return next(mount for mount in mounts if mount.name in names)
