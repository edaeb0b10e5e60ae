"""The flight loop. Every tick reads top to bottom in the same order:

sample the due sensors, which stack and executive hear → the stack's own loops →
the executive decides → the stack controls → apply → record → step and observe.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from inspect_cli.autonomy.executive import Executive
from inspect_cli.errors import InputError
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import (
    DepthImage,
    Imu,
    Measurement,
    Odometry,
    Pose,
    Record,
    SurfaceEstimate,
    WallForce,
)
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.result import Status
from inspect_cli.schema.truth import TruthModel
from inspect_cli.sensing.judges import judges_of
from inspect_cli.simulation.clock import Clock, Tick
from inspect_cli.simulation.mounts import Listener, Mount, mounts_of
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.simulation.recorder import Recorder
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.contact import ContactTruth
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.proximity import Proximity
from inspect_cli.truth.snapshot import Truth
from inspect_cli.vehicles.actuators import rotor_radii_m
from inspect_cli.vehicles.kinds import Vehicle

PROGRESS_S = 0.1
"""Between two calls of ``progress``."""


def _loop(name: str) -> str:
    """What a loop of the stack is called in the schedule, whatever sensors are called."""
    return f"loop {name}"


@dataclass(frozen=True)
class Ending:
    """How a flight ended, and what it took."""

    status: Status
    reason: str
    flight_s: float
    wall_s: float
    log_wall_s: float


class Flight:
    """One flight: the true world, the vehicle's stack, the executive, the log."""

    def __init__(
        self,
        vehicle: Vehicle,
        plan: Plan,
        truth: TruthModel,
        structure: StructureTruth,
        seed: int,
        log: LogWriter,
        estimation: Estimation = "external",
    ) -> None:
        platform, lengths = vehicle.platform, vehicle.capabilities.lengths
        rates = platform.rates
        model = build_world(vehicle, truth.platform, structure)
        radii_m = rotor_radii_m(vehicle.actuators)
        proximity = Proximity(truth.proximity, structure.solids, radii_m)
        gusts = component_rng(seed, "wind")
        disturbances = Disturbances(truth.disturbances, gusts, rates.control_hz)
        self.plant = Plant(
            model,
            vehicle,
            lengths,
            structure.solids,
            disturbances,
            proximity,
            rates.control_hz,
        )
        self.plan = plan
        self.contact = ContactTruth(structure)
        state = self.plant.state
        self.truth = Truth(
            state,
            partial(self.contact.update, state),
            self.plant.wall_wrench,
            self.plant.contact_wrench,
        )
        judges = judges_of(platform, plan.instruments)
        self.mounts = mounts_of(platform, lengths, structure, truth, seed, estimation, judges)
        self.stack = vehicle.flight_stack(plan, estimation)

        limit_s = 60.0 + 2.0 * plan.duration_s
        behaviour = vehicle.behaviour
        context = behaviour.context(plan, self.stack, judges)
        self.executive = Executive(behaviour, context, limit_s)
        self.recorder = Recorder(
            log,
            self.plant.state,
            (self.contact.contact, *self.plant.contacts.values()),
            self.stack,
            [m.sensor.measurement for m in self.mounts if isinstance(m.sensor.measurement, Imu)],
            disturbances.load.record if truth.loads_depend_on_the_flight else None,
        )
        for mount in self.mounts:
            if isinstance(mount.sensor.measurement, Record):
                log.declare(type(mount.sensor.measurement))
            if isinstance(mount.sensor.measurement, Imu):  # logged with the continuous channels
                heard = self.stack.propagation(mount.sensor.measurement)
                mount.heard_by(heard, self.truth)
            else:
                mount.listeners = self._listeners(mount)
        for judging in judges.values():
            log.declare(judging.reading)
        due = {mount.due: mount.rate_hz for mount in self.mounts} | {
            "mission": rates.mission_hz,
            "control": rates.control_hz,
            "log": rates.log_hz,
            **{_loop(name): rate_hz for name, rate_hz in self.stack.loops.items()},
        }
        self.clock = Clock(rates.physics_hz, due)
        self._limit_s = limit_s + 60.0

    def run(self, progress: Callable[[float], None] | None = None) -> Ending:
        """Fly to the end; ``progress`` is called with the time of flight ten times a second."""
        begun = perf_counter()
        self.plant.place(self.plan.start.posture)
        t_s = 0.0
        if not self._start_stack():
            self.executive.give_up("aborted", "no pose measurement to start from")
            return Ending("aborted", self.executive.reason, t_s, perf_counter() - begun, 0.0)
        report_s = 0.0
        for tick in self.clock.ticks(self._limit_s):
            t_s = tick.t_s
            self._tick(tick)
            if progress is not None and t_s >= report_s:
                report_s += PROGRESS_S
                progress(t_s)
            if self.executive.finished:
                break
            self.plant.step(tick.steps_to_next)
        self.recorder.decisions(self.executive.context)
        wall_s = perf_counter() - begun
        status, reason = self.executive.status, self.executive.reason
        return Ending(status, reason, t_s, wall_s, self.recorder.wall_s)

    def _start_stack(self) -> bool:
        """Begin the estimate at the first pose measurement, if there is one."""
        sources = (m for m in self.mounts if isinstance(m.sensor.measurement, Pose))
        pose = next((source.sample(self.truth) for source in sources), None)
        if not isinstance(pose, Pose):
            return False
        if not (np.isfinite(pose.p_WB).all() and np.isfinite(pose.q_WB).all()):
            return False
        self.stack.start(pose)
        return True

    def _tick(self, tick: Tick) -> None:
        due, plant, stack = tick.due, self.plant, self.stack
        for mount in self.mounts:
            if mount.due in due:
                mount.deliver(self.truth)
        for loop in stack.loops:
            if _loop(loop) in due:
                stack.run(loop, tick.t_s)
        if "mission" in due:
            self._decide(tick.t_s)
        if "control" in due:
            stack.control(tick.t_s)
            plant.disturb(tick.t_s)
            plant.apply(stack.command)
        if "log" in due:
            if "control" not in due:
                stack.refer(tick.t_s)
            self.contact.update(plant.state)
            plant.observe_contacts(tick.t_s)
            self.recorder.rows(tick.t_s)

    def _listeners(self, mount: Mount) -> tuple[Listener, ...]:
        """Who hears a sensor, by what it returns: unless it says otherwise, all and the log."""
        row = self.recorder.row
        heard_by: dict[type, tuple[Listener, ...]] = {
            Pose: (self._hear,),
            Odometry: (row, self._hear),
            DepthImage: (partial(self._see, mount.name),),
            WallForce: (row,),  # it measures the truth, which the vehicle must not know
        }
        return heard_by.get(type(mount.sensor.measurement), (self._hear, row))

    def _hear(self, measurement: Measurement) -> None:
        """Hand a measurement to the stack, and what it makes of it to the executive."""
        heard: object = self.stack.hear(measurement)
        if isinstance(heard, Record):
            self.executive.hear(heard)
        elif heard is not None:
            what = f"{type(self.stack).__name__}.hear returned {heard!r}"
            raise InputError(what, hint="a flight stack returns a Record, or None")

    def _see(self, camera: str, image: DepthImage) -> None:
        """Have the stack turn the image of a camera, given by its name, into a surface estimate."""
        surface = self.stack.hear(image)
        if isinstance(surface, SurfaceEstimate):
            self.executive.hear(surface)
            self.recorder.surface(surface, image, partial(self.stack.believed, camera))

    def _decide(self, t_s: float) -> None:
        """The mission rate: surroundings, divergence, executive."""
        self.plant.feel_surroundings()
        diverged = self.plant.diverged
        if diverged:
            self.executive.give_up("diverged", f"MuJoCo warned: {diverged}")
            return
        order = self.executive.update(t_s)
        if order is not None:
            self.stack.enter(t_s, order.mode, order.target)
        self.stack.armed = self.executive.armed
        self.recorder.decisions(self.executive.context)
