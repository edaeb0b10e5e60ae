"""The flight loop. Every tick reads top to bottom in the same order:

observe → sample the due sensors, which stack and executive hear → the stack's own loops →
the executive decides → the stack controls → apply → record → step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from time import perf_counter

import numpy as np

from inspect_cli.autonomy.executive import Executive
from inspect_cli.interfaces import DepthImage
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import State, SurfaceEstimate
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.result import Status
from inspect_cli.schema.truth import TruthModel
from inspect_cli.sensing.reading import ReadingJudge
from inspect_cli.simulation.clock import Clock, Tick
from inspect_cli.simulation.instruments import Instruments
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.simulation.recorder import Recorder
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.contact import ContactTruth
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.faults import Faults
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.proximity import Proximity
from inspect_cli.vehicles.kinds import Vehicle


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
        radius_m = vehicle.actuators.rotor_radius_m
        proximity = Proximity(truth.proximity, structure.solids, radius_m)
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
        faults = Faults(truth.faults)
        self.instruments = Instruments(
            platform,
            structure,
            faults,
            seed,
            estimation,
            truth.platform.odometry_drift_mps,
        )
        self.stack = vehicle.flight_stack(plan, estimation)

        def judge(target: Target) -> ReadingJudge:
            return ReadingJudge(platform.sensors.half_cell, target.dwell_s)

        limit_s = 60.0 + 2.0 * plan.duration_s
        behaviour = vehicle.behaviour
        context = behaviour.context(plan, self.stack, {"half_cell": judge})
        self.executive = Executive(behaviour, context, limit_s)
        self.recorder = Recorder(
            log,
            self.plant.state,
            self.contact.contact,
            self.stack,
            self.instruments,
            disturbances.load.record if truth.loads_depend_on_the_flight else None,
        )
        _, pose_hz = platform.positioning(estimation)
        due = {
            "imu": rates.imu_hz,
            "pose": pose_hz,
            "tof": rates.tof_hz,
            "mission": rates.mission_hz,
            "control": rates.control_hz,
            "log": rates.log_hz,
            **self.stack.loops,
        }
        if any(target.sensor is not None for target in plan.targets):
            due["probe"] = rates.probe_hz
        for surface in structure.surfaces:
            if surface.force_sensor is not None:
                due["wall"] = surface.force_sensor.rate_hz
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
        for tick in self.clock.ticks(self._limit_s):
            t_s = tick.t_s
            self._tick(tick)
            if progress is not None and "tof" in tick.due:
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
        heard = self.instruments.sample_pose(self.plant.state)
        pose = self.instruments.pose.measurement
        if not (heard and np.isfinite(pose.p_WB).all() and np.isfinite(pose.q_WB).all()):
            return False
        self.stack.start(pose)
        return True

    def _tick(self, tick: Tick) -> None:
        due, plant, stack = tick.due, self.plant, self.stack
        state = plant.observe(tick.t_s)
        if "imu" in due and self.instruments.sample_imu(state):
            stack.hear(self.instruments.imu.measurement)
        if "pose" in due:
            self._correct_estimate(tick.t_s, state)
        if "wall" in due:
            self._feel_wall(tick.t_s)
        if "tof" in due and self.instruments.sample_tof(state):
            self._see_surface(tick.t_s)
        if "probe" in due:
            self._sample_probe()
        for loop in stack.loops:
            if loop in due:
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
            self.contact.update(state)
            self.recorder.rows(tick.t_s)

    def _feel_wall(self, t_s: float) -> None:
        block = self.instruments.sample_wall(t_s, self.plant.wall_wrench())
        if block is not None:
            self.recorder.row(block)

    def _correct_estimate(self, t_s: float, state: State) -> None:
        heard = self.instruments.sample_pose(state)
        if heard and self.instruments.odometry is not None:
            self.recorder.row(self.instruments.odometry.measurement)
        if heard and (pose := self.stack.hear(self.instruments.pose.measurement)) is not None:
            self.executive.hear(pose)

    def _see_surface(self, t_s: float) -> None:
        """Have the stack turn the depth image into a surface estimate."""
        image = DepthImage(t_s, self.instruments.tof.points_D)
        surface = self.stack.hear(image)
        if isinstance(surface, SurfaceEstimate):
            self.executive.hear(surface)
            self.recorder.surface(surface, image, *self.stack.believed("tof"))

    def _sample_probe(self) -> None:
        contact = self.contact.update(self.plant.state)
        probe = self.instruments.sample_probe(self.plant.state, contact)
        if probe is None:
            return
        self.executive.hear(probe)
        self.recorder.row(probe)

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
