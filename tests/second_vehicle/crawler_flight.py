"""Flies a pitching crawler by a script, one mode after the other, on the plant itself."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from pitching_crawler import PitchingCrawler
from pitching_crawler.foot_sensor import EncoderSensor, FootSensor
from pitching_crawler.modes import MODES
from pitching_crawler.stack import Order

from inspect_cli.interfaces import Posture
from inspect_cli.schema.geometry import PlaneShape
from inspect_cli.schema.truth import ProximityEffects, TruePlatform
from inspect_cli.sensing.imu import ImuSensor
from inspect_cli.sensing.pose import PoseSensor
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import SurfaceTruth, structure_of
from inspect_cli.truth.proximity import Proximity
from inspect_cli.vehicles.actuators import rotor_radii_m

Array = np.ndarray
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])
WALL_X, CEILING_Z = 2.0, 3.0
WALL = PlaneShape(center_m=(WALL_X, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(3.0, 3.0))
CEILING = PlaneShape(center_m=(-1.0, 0.0, CEILING_Z), normal=(0.0, 0.0, -1.0), size_m=(3.0, 3.0))
FRICTION = 0.7
RAMP_S = 1.0
"""In which a reference's speed rises and falls."""


class Flight:
    """Plant, sensors, stack and a table of what was logged."""

    def __init__(self, vehicle: PitchingCrawler, seed: int = 1) -> None:
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
        self.vehicle, self.stack = vehicle, vehicle.flight_stack()
        self._imu = ImuSensor(numbers.imu, numbers.control_hz, rng)
        self._pose = PoseSensor(numbers.pose, rng)
        self._encoders = EncoderSensor(numbers, lengths)
        self._foot = FootSensor(numbers, rng)
        self._tick, self._period_s = 0, 1.0 / numbers.control_hz
        self._steps = numbers.physics_hz // numbers.control_hz
        self._ticks_per_pose = numbers.control_hz // numbers.pose_hz
        self.rows: dict[str, list[Array]] = {}
        """By name of mode and quantity, one row per tick of control."""
        start = Posture(np.array([0.0, 0.0, numbers.gear_height_m]), UPRIGHT, np.zeros(1))
        self.plant.place(start)
        self._pose.sample(self.plant.state)
        self.stack.start(self._pose.measurement)
        self.order = Order(start.p_WB.copy())

    def fly(
        self,
        mode: str,
        duration_s: float,
        lead: Callable[[float, Order], None] = lambda t_s, order: None,
        until: Callable[[], bool] = lambda: False,
    ) -> None:
        """Stay in a mode; ``lead`` moves the order, ``until`` ends it before its time."""
        self.stack.enter(MODES[mode])
        for tick in range(round(duration_s / self._period_s)):
            lead(tick * self._period_s, self.order)
            self._control(mode)
            if until():
                return

    def go(self, mode: str, p_WB: Array, duration_s: float) -> None:
        """Move the reference to a place, from rest to rest."""
        start = self.order.p_WB.copy()
        way = p_WB - start

        def lead(t_s: float, order: Order) -> None:
            s = min(t_s / duration_s, 1.0)
            order.p_WB = start + way * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
            order.v_WB_W = way * 30.0 * s**2 * (1.0 - s) ** 2 / duration_s

        self.fly(mode, duration_s + 1.0, lead)

    def logged(self, mode: str, name: str) -> Array:
        """The rows of a quantity while in a mode."""
        return np.array(self.rows[f"{mode}/{name}"])

    def _control(self, mode: str) -> None:
        t_s, plant, stack = self._tick * self._period_s, self.plant, self.stack
        state = plant.observe(t_s)
        plant.observe_contacts(t_s)
        self._imu.sample(state)
        self._imu.measurement.t_s = t_s
        self._encoders.sample(state)
        self._foot.sample(state, plant.contacts["foot"])
        stack.hear(self._imu.measurement)
        stack.hear(self._encoders.measurement)
        if self._tick % self._ticks_per_pose == 0:
            self._pose.sample(state)
            stack.hear(self._pose.measurement)
        stack.control(self.order)
        plant.apply(stack.command)
        self._log(mode)
        plant.step(self._steps)
        self._tick += 1

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
