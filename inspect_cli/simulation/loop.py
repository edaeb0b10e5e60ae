"""The flight loop. Every tick reads top to bottom in the same order:

observe → sample the due sensors → estimate → autonomy and guidance write the reference →
control and allocation write the command → apply → record → step.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from time import perf_counter

import numpy as np

from inspect_cli.autonomy.executive import Executive, posture_of
from inspect_cli.guidance.local_surface import LocalSurface
from inspect_cli.guidance.pursuit import Pursuit
from inspect_cli.interfaces import Posture
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import DepthImage, Imu, Odometry, Pose, Probe, Record, SurfaceEstimate
from inspect_cli.schema.plan import Plan, Target
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.result import Status
from inspect_cli.schema.truth import TruthModel
from inspect_cli.schema.vehicle import DepthCameraModel, HalfCellModel
from inspect_cli.sensing.reading import ReadingJudge
from inspect_cli.simulation.clock import Clock, Tick
from inspect_cli.simulation.mounts import Listener, Mount, mounts_of
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.simulation.recorder import Recorder
from inspect_cli.simulation.world import build_world
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.truth.contact import ContactTruth
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.proximity import Proximity
from inspect_cli.truth.snapshot import Truth
from inspect_cli.vehicles.kinds import Vehicle

PROGRESS_S = 0.1
"""Between two calls of ``progress``."""


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
        state = self.plant.state
        self.truth = Truth(state, partial(self.contact.update, state), self.plant.wall_wrench)
        reads_with = {target.sensor for target in plan.targets if target.sensor is not None}
        self.mounts = mounts_of(platform, structure, truth, seed, estimation, reads_with)
        self.stack = vehicle.flight_stack(estimation)
        believed = {surface.name: primitive_of(surface.shape) for surface in plan.surfaces}
        self.guidance = Pursuit(vehicle.capabilities, posture_of(plan.start), believed)
        self.surface = SurfaceEstimate.create()
        self._capabilities = vehicle.capabilities
        self._camera = platform.find(DepthCameraModel)

        def judge(target: Target) -> ReadingJudge:
            return ReadingJudge(platform.sensor(HalfCellModel), target.dwell_s)

        limit_s = 60.0 + 2.0 * plan.duration_s
        self.executive = Executive(plan, self.guidance, judge, self.stack.estimate, limit_s)
        self.recorder = Recorder(
            log,
            self.plant.state,
            self.contact.contact,
            self.guidance.reference,
            self.stack,
            [m.sensor.measurement for m in self.mounts if isinstance(m.sensor.measurement, Imu)],
            disturbances.load.record if truth.loads_depend_on_the_flight else None,
        )
        for mount in self.mounts:
            if isinstance(mount.sensor.measurement, Record):
                log.declare(type(mount.sensor.measurement))
            mount.listeners = self._listeners(mount)
        due = {mount.name: mount.rate_hz for mount in self.mounts} | {
            "mission": rates.mission_hz,
            "guidance": rates.guidance_hz,
            "control": rates.control_hz,
            "log": rates.log_hz,
        }
        self.clock = Clock(rates.physics_hz, due)
        self._limit_s = limit_s + 60.0

    def run(self, progress: Callable[[float], None] | None = None) -> Ending:
        """Fly to the end; ``progress`` is called with the time of flight ten times a second."""
        begun = perf_counter()
        self.plant.place(posture_of(self.plan.start))
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
        self.recorder.decisions(self.executive)
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
        state = plant.observe(tick.t_s)
        for mount in self.mounts:
            if mount.name in due and (measurement := mount.sample(self.truth)) is not None:
                for listener in mount.listeners:
                    listener(measurement)
        if "guidance" in due and self.executive.watches_surface:
            self.guidance.observe(tick.t_s, self.surface)
        if "mission" in due:
            self._decide(tick.t_s)
        if "control" in due:
            self.guidance.write(tick.t_s)
            stack.control(self.guidance.reference, self.executive.flying)
            plant.disturb(tick.t_s)
            plant.apply(stack.command)
        if "log" in due:
            if "control" not in due:
                self.guidance.write(tick.t_s)
            self.contact.update(state)
            self.recorder.rows(tick.t_s)

    def _listeners(self, mount: Mount) -> tuple[Listener, ...]:
        """Who hears a sensor, by what it returns; what nobody here knows is logged."""
        heard_by: dict[type, tuple[Listener, ...]] = {
            Imu: (self.stack.on_imu,),  # logged with the other channels at the log's rate
            Pose: (self._correct_estimate,),
            Odometry: (self.recorder.row, self._correct_estimate),
            Probe: (self._take_probe_sample, self.recorder.row),
        }
        if self._camera is not None:
            heard_by[DepthImage] = (self._surface_seen_by(self._camera),)
        return heard_by.get(type(mount.sensor.measurement), (self.recorder.row,))

    def _correct_estimate(self, pose: Pose) -> None:
        if self.stack.on_pose(pose):
            self.executive.heard_pose(pose.t_s)

    def _surface_seen_by(self, camera: DepthCameraModel) -> Callable[[DepthImage], None]:
        """What turns an image of the camera into a surface estimate."""
        mounting, local_surface = camera.mount.mounting(), LocalSurface(camera)
        estimate = self.stack.estimate

        def see(image: DepthImage) -> None:
            p_WT, R_WT = self._believed_tool()
            p_WD, R_WD = mounting.pose(estimate.p_WB, estimate.q_WB, p_WT, R_WT)
            points_D = image.points_D
            along_T = points_D if R_WD is R_WT else points_D @ (R_WT.T @ R_WD).T
            local_surface.update(along_T, p_WD, p_WT, R_WT, self.surface)
            self.surface.t_s = image.t_s
            self.executive.saw_surface(self.surface)
            self.recorder.surface(self.surface, points_D, p_WD, R_WD)

        return see

    def _take_probe_sample(self, probe: Probe) -> None:
        p_WT, _ = self._believed_tool()
        self.executive.probe_sampled(probe, p_WT)

    def _believed_tool(self) -> tuple[Vector, Matrix]:
        """(p_WT, R_WT) by the estimate, with the arm where it was asked to be."""
        estimate, arm_angle = self.stack.estimate, self.guidance.reference.arm_angle
        posture = Posture(estimate.p_WB, estimate.q_WB, arm_angle)
        return self._capabilities.tool_pose(posture)

    def _decide(self, t_s: float) -> None:
        """The mission rate: surroundings, divergence, executive."""
        self.plant.feel_surroundings()
        diverged = self.plant.diverged
        if diverged:
            self.executive.give_up("diverged", f"MuJoCo warned: {diverged}")
            return
        self.executive.update(t_s)
        self.recorder.decisions(self.executive)
