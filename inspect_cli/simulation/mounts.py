"""The sensors of one flight as mounts: each with a name, a rate, its faults and its listeners."""

from __future__ import annotations

from collections.abc import Callable, Collection, Iterator
from typing import TypeAlias

from inspect_cli.compiled.joined import joined
from inspect_cli.records import Lengths
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.truth import WALL, TruthModel
from inspect_cli.schema.vehicle import (
    InstrumentModel,
    PlatformBase,
    PoseSourceModel,
    SensorModel,
)
from inspect_cli.schema.vehicle.sensors import SENSORS
from inspect_cli.sensing.instrument import KernelSensor, SimulatedSensor, Surroundings
from inspect_cli.sensing.sensors import simulated
from inspect_cli.sensing.wall_force import WallForceSensor
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.truth.faults import Faults, Sample
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.snapshot import Truth

Listener: TypeAlias = Callable[..., object]
"""Takes a measurement of the type that its sensor returns."""


class Mount:
    """One sensor. The loop samples it at its rate and hands what it returns to the listeners."""

    def __init__(self, name: str, rate_hz: int, sensor: SimulatedSensor) -> None:
        self.name = name
        self.due = f"sensor {name}"
        """Its name in the schedule, where loops stand beside sensors."""
        self.rate_hz = rate_hz
        self.sensor = sensor
        self.listeners: tuple[Listener, ...] = ()
        self.sample: Sample = sensor.sample
        """What the sensor returns now; None when nothing came."""
        self.deliver: Callable[[Truth], object] = self._deliver
        """Samples the sensor and hands on what it returns."""

    def fail(self, faults: Faults, seed: int) -> None:
        """Let the sensor fail where the mission says so."""
        rng = component_rng(seed, f"{self.name} holes")
        self.sample = faults.applied_to(self.name, self.sample, rng)

    def _deliver(self, truth: Truth) -> None:
        measurement = self.sample(truth)
        if measurement is not None:
            for listener in self.listeners:
                listener(measurement)

    def heard_by(self, listener: Callable[[], object], truth: Truth) -> None:
        """Hand on to one call alone, joined with the sensor's kernel where it has one."""
        sensor = self.sensor
        if self.sample != sensor.sample or not isinstance(sensor, KernelSensor):
            self.listeners = (lambda measurement: listener(),)
            return
        measure_and_hear, advance = joined(sensor.bind(truth), listener), sensor.noise.advance

        def deliver(truth: Truth) -> None:
            advance()
            measure_and_hear()

        self.deliver = deliver


def mounts_of(
    platform: PlatformBase,
    lengths: Lengths,
    structure: StructureTruth,
    truth: TruthModel,
    seed: int,
    estimation: Estimation,
    reads_with: Collection[str],
) -> tuple[Mount, ...]:
    """The sensors that a flight needs, in the order in which they are sampled.

    The order is that of the kinds in ``SENSORS``, then a force sensor in a wall. Each sensor has a
    generator of its own, drawn from ``seed`` by the sensor's name. Of the pose sources only that
    of ``estimation`` is mounted, and of the instruments only those in ``reads_with``.
    """
    kinds = list(SENSORS)
    chosen = [
        (name, model)
        for name, model in platform.sensors.items()
        if _is_needed(model, estimation, reads_with)
    ]
    mounts = []
    for name, model in sorted(chosen, key=lambda item: kinds.index(item[1].kind)):
        around = Surroundings(structure, truth, lengths, component_rng(seed, name))
        mounts.append(Mount(name, model.rate_hz, simulated(model, around)))
    mounts += _wall_sensor(structure, seed)
    faults = Faults(truth.faults)
    for mount in mounts:
        mount.fail(faults, seed)
    return tuple(mounts)


def _is_needed(model: SensorModel, estimation: Estimation, reads_with: Collection[str]) -> bool:
    if isinstance(model, PoseSourceModel):
        return model.estimation == estimation
    return not isinstance(model, InstrumentModel) or model.kind in reads_with


def _wall_sensor(structure: StructureTruth, seed: int) -> Iterator[Mount]:
    for index, surface in enumerate(structure.surfaces):
        if surface.force_sensor is not None:
            primitive = structure.solids.primitives[index : index + 1]
            rng = component_rng(seed, WALL)
            sensor = WallForceSensor(surface.force_sensor, primitive, rng)
            yield Mount(WALL, surface.force_sensor.rate_hz, sensor)
            return
