"""Flies a pitching crawler by its own modes, with executive, stack and plant but without a log."""

from __future__ import annotations

import numpy as np
from pitching_crawler import PitchingCrawler
from pitching_crawler.foot_sensor import EncoderSensor, FootSensor
from pitching_crawler.modes import CrawlerPlan

from inspect_cli.autonomy.executive import Executive
from inspect_cli.interfaces import Posture
from inspect_cli.schema.geometry import PlaneShape
from inspect_cli.schema.truth import ProximityEffects, TruePlatform
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.pose_tracker import PoseSensor
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import SurfaceTruth, structure_of
from inspect_cli.truth.proximity import Proximity
from inspect_cli.truth.snapshot import Truth
from inspect_cli.vehicles.actuators import rotor_radii_m

Array = np.ndarray
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
WALL_X, CEILING_Z = 2.0, 3.0
WALL = PlaneShape(center_m=(WALL_X, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(3.0, 3.0))
CEILING = PlaneShape(center_m=(-1.0, 0.0, CEILING_Z), normal=(0.0, 0.0, -1.0), size_m=(3.0, 3.0))
FRICTION = 0.7
LIMIT_S = 60.0
TICKS_PER_DECISION = 5


class Flight:
    """Plant, sensors, stack, executive and a table of what was seen."""

    def __init__(self, vehicle: PitchingCrawler, plan: CrawlerPlan, seed: int = 1) -> None:
        numbers, lengths = vehicle.numbers, vehicle.capabilities.lengths
        surfaces = [SurfaceTruth(name, shape, FRICTION, None)
                    for name, shape in (("wall", WALL), ("ceiling", CEILING))]  # fmt: skip
        structure = structure_of(surfaces)
        rng = np.random.default_rng(seed)
        calm = ProximityEffects(ground=False, ceiling=False, wall=False)
        self.plant = Plant(
            build_world(vehicle, TruePlatform(), structure),
            vehicle,
            lengths,
            structure.solids,
            Disturbances((), rng, numbers.control_hz),
            Proximity(calm, structure.solids, rotor_radii_m(vehicle.actuators)),
            numbers.control_hz,
        )
        self.vehicle, self._truth = vehicle, Truth(self.plant.state)
        self._imu = ImuSensor(numbers.imu, rng)
        self._pose = PoseSensor(numbers.pose, rng)
        self._encoders = EncoderSensor(numbers, lengths)
        self._foot = FootSensor(numbers, rng)
        self._period_s = 1.0 / numbers.control_hz
        self._steps = numbers.physics_hz // numbers.control_hz
        self._ticks_per_pose = numbers.control_hz // numbers.pose.rate_hz
        self.rows: dict[str, list[Array]] = {}
        """By name of mode and quantity, one row per tick of control."""
        start = Posture(np.array([0.0, 0.0, numbers.gear_height_m]), UPRIGHT, np.zeros(1))
        self.plant.place(start)
        self.stack = vehicle.flight_stack(start)
        context = vehicle.behaviour.context(plan, self.stack, {})
        self.executive = Executive(vehicle.behaviour, context, LIMIT_S)

    def fly(self) -> None:
        """Fly all orders."""
        self._pose.sample(self._truth)
        self.stack.start(self._pose.measurement)
        tick = 0
        while not self.executive.finished:
            self._control(tick)
            tick += 1

    def logged(self, mode: str, name: str) -> Array:
        """The rows of a quantity while in a mode."""
        return np.array(self.rows[f"{mode}/{name}"])

    def _control(self, tick: int) -> None:
        t_s, plant, stack = tick * self._period_s, self.plant, self.stack
        state = plant.observe(t_s)
        plant.observe_contacts(t_s)
        self._imu.sample(self._truth)
        self._encoders.sample(state)
        self._foot.sample(state, plant.contacts["foot"])
        samples = [self._imu.measurement, self._encoders.measurement, self._foot.measurement]
        if tick % self._ticks_per_pose == 0:
            self._pose.sample(self._truth)
            samples.append(self._pose.measurement)
        for sample in samples:
            sample.t_s = t_s
            if (heard := stack.hear(sample)) is not None:
                self.executive.hear(heard)
        if tick % TICKS_PER_DECISION == 0:
            order = self.executive.update(t_s)
            if order is not None:
                stack.enter(t_s, order.mode, order.target)
            stack.armed = self.executive.armed
        stack.control(t_s)
        plant.apply(stack.command)
        self._log(self.executive.mode.name)
        plant.step(self._steps)

    def _log(self, mode: str) -> None:
        state = self.plant.state
        logged = {
            "p_WB": state.p_WB,
            "q_WB": state.q_WB,
            "p_WT": state.p_WT,
            "joint_angle": state.joint_angle,
            "f_tool_W": state.f_tool_W,
            "f_body": [state.f_body],
            "wheel": self.plant.contacts["wheel"].f_W,
            "foot": self._foot.measurement.f_B,
            "foot_true": self.plant.contacts["foot"].f_W,
            "encoders": self._encoders.measurement.angle,
            "thrust": self.stack.command.rotor_thrust,
        }
        for name, values in logged.items():
            self.rows.setdefault(f"{mode}/{name}", []).append(np.array(values))
