"""Small true worlds: one vehicle, a few surfaces, and a plant to play with."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import mujoco
import numpy as np

from inspect_cli.interfaces import Posture
from inspect_cli.records import Command
from inspect_cli.schema.disturbances import Disturbance
from inspect_cli.schema.geometry import Shape
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.truth import ProximityEffects, TruePlatform
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.world import build_world
from inspect_cli.truth import geometry
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import StructureTruth, SurfaceTruth
from inspect_cli.truth.proximity import Proximity
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.actuators import rotor_radii_m
from inspect_cli.vehicles.kinds import Vehicle

Array = np.ndarray
CALM = ProximityEffects(ground=False, ceiling=False, wall=False)
PLATFORM = Path(__file__).resolve().parents[2] / "platforms" / "tilt_rotor_hexarotor.yaml"
UPRIGHT = np.array([1.0, 0.0, 0.0, 0.0])


def vehicle_at(pitch_deg: float = 90.0, **tool: float) -> Vehicle:
    """The built-in vehicle with its arm at an angle, and a tip of 3 kN/m unless told otherwise."""
    platform = load_platform(PLATFORM)
    assert isinstance(platform, TiltRotorPlatform)
    tip = {"tip_stiffness_npm": 3000.0, "tip_damping_ratio": 0.8}
    changed = platform.tool.model_copy(update={"pitch_deg": pitch_deg, **tip, **tool})
    return build_vehicle(platform.model_copy(update={"tool": changed}))


def structure_of(shapes: Sequence[Shape], friction: float = 0.5) -> StructureTruth:
    surfaces = [SurfaceTruth(f"s{i}", shape, friction, None) for i, shape in enumerate(shapes)]
    return geometry.structure_of(surfaces)


def weightless(vehicle: Vehicle, structure: StructureTruth) -> mujoco.MjModel:
    """The true model without gravity, so that the tip alone is loaded."""
    model = build_world(vehicle, TruePlatform(), structure)
    model.opt.gravity[:] = 0.0
    return model


def plant_of(
    vehicle: Vehicle,
    structure: StructureTruth | None = None,
    disturbances: Sequence[Disturbance] = (),
    effects: ProximityEffects = CALM,
    truth: TruePlatform | None = None,
) -> Plant:
    structure = structure or structure_of([])
    model = build_world(vehicle, truth or TruePlatform(), structure)
    radii_m = rotor_radii_m(vehicle.actuators)
    control_hz = vehicle.platform.rates.control_hz
    return Plant(
        model,
        vehicle,
        vehicle.capabilities.lengths,
        structure.solids,
        Disturbances(disturbances, np.random.default_rng(0), control_hz),
        Proximity(effects, structure.solids, radii_m),
        control_hz,
    )


def command_of(vehicle: Vehicle) -> Command:
    return Command.create(vehicle.capabilities.lengths)


def hold_attitude(data: mujoco.MjData, q_WB: Array) -> None:
    """A stiff rotational spring about O_b, on top of what is applied already."""
    error = np.zeros(3)
    mujoco.mju_subQuat(error, data.qpos[3:7], q_WB)
    data.qfrc_applied[3:6] = -2000.0 * error - 40.0 * data.qvel[3:6]


def placed(plant: Plant, p_WB: Sequence[float], q_WB: Array = UPRIGHT) -> None:
    plant.place(Posture(np.array(p_WB, dtype=float), q_WB))
