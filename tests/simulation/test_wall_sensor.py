"""What the force sensor in the wall is told by the plant, and contact at a faster physics rate."""

from __future__ import annotations

from dataclasses import replace

import mujoco
import numpy as np
import pytest
from worlds import (
    CALM,
    Array,
    hold_attitude,
    placed,
    structure_of,
    vehicle_at,
)

from inspect_cli.schema.geometry import CylinderShape, PlaneShape, Shape
from inspect_cli.schema.truth import ForceSensorModel, TruePlatform
from inspect_cli.simulation.plant import Plant
from inspect_cli.simulation.world import build_world
from inspect_cli.truth.disturbances import Disturbances
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.proximity import Proximity
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.actuators import rotor_radii_m
from inspect_cli.vehicles.tilt_rotor import TiltRotor

REACH, K, MASS = 0.55, 3000.0, 4.75
WALL = PlaneShape(center_m=(1.0, 0.2, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(4.0, 3.0))
VAULT = CylinderShape(
    center_m=(-0.5, 0.0, 1.5),
    axis=(0.0, 0.0, 1.0),
    radius_m=1.5,
    facing=(1.0, 0.0, 0.0),
    size_m=(1.5, 2.0),
    side="inside",
)


def vehicle_with_physics_at(physics_hz: int) -> TiltRotor:
    platform = vehicle_at(90.0).platform
    rates = platform.rates.model_copy(update={"physics_hz": physics_hz})
    vehicle = build_vehicle(platform.model_copy(update={"rates": rates}))
    assert isinstance(vehicle, TiltRotor)
    return vehicle


def measured(shape: Shape) -> StructureTruth:
    """One surface with a force sensor."""
    plain = structure_of([shape])
    (surface,) = plain.surfaces
    return StructureTruth((replace(surface, force_sensor=ForceSensorModel()),), plain.solids)


def plant_before(structure: StructureTruth, physics_hz: int = 1000) -> Plant:
    """Without gravity, so that the tip alone is loaded."""
    vehicle = vehicle_with_physics_at(physics_hz)
    model = build_world(vehicle, TruePlatform(), structure)
    model.opt.gravity[:] = 0.0
    proximity = Proximity(CALM, structure.solids, rotor_radii_m(vehicle.actuators))
    calm = Disturbances((), np.random.default_rng(0), 250)
    lengths = vehicle.capabilities.lengths
    return Plant(model, vehicle, lengths, structure.solids, calm, proximity, 250)


def push(plant: Plant, force_W: Array, steps: int) -> None:
    for _ in range(steps):
        plant.data.qfrc_applied[:3] = force_W
        hold_attitude(plant.data, np.array([1.0, 0.0, 0.0, 0.0]))
        plant.step(1)


@pytest.mark.parametrize("shape", [WALL, VAULT], ids=["plane", "facets"])
def test_the_wall_feels_what_the_tip_feels_at_the_place_where_it_touches(shape: Shape) -> None:
    plant = plant_before(measured(shape))
    placed(plant, [1.0 - REACH - 0.001, 0.03, 1.5])
    push(plant, np.array([8.0, 1.0, -0.5]), 1500)
    state, wrench = plant.observe(1.5), plant.wall_wrench()
    np.testing.assert_allclose(wrench[:3], -state.f_tool_W, atol=1e-9)
    assert wrench[0] == pytest.approx(8.0, rel=0.02)
    # The sphere touches in its foremost point, which the tip is, up to the depth and a facet.
    lever = np.cross(state.p_WT, wrench[:3])
    np.testing.assert_allclose(wrench[3:], lever, atol=8.0 * 0.005)


def test_in_free_air_it_feels_nothing_and_without_a_sensor_there_is_none() -> None:
    plant = plant_before(measured(WALL))
    placed(plant, [0.0, 0.0, 1.5])
    push(plant, np.zeros(3), 20)
    np.testing.assert_array_equal(plant.wall_wrench(), 0.0)
    bare = plant_before(structure_of([WALL])).model
    assert bare.nsensor == plant.model.nsensor - 1


def touch(physics_hz: int) -> tuple[float, float, float]:
    """(peak force, force at rest, depth at rest) of a touch at 0.1 m/s that 6 N keep pressing."""
    plant = plant_before(structure_of([WALL]), physics_hz)
    placed(plant, [1.0 - REACH - 0.005, 0.0, 1.5])
    plant.data.qvel[0] = 0.1
    peak = 0.0
    for _ in range(100):
        push(plant, np.array([6.0, 0.0, 0.0]), physics_hz // 50)
        peak = max(peak, -plant.data.sensordata[0], plant.data.sensordata[0])
    state = plant.observe(2.0)
    return peak, state.f_normal, float(state.p_WT[0] - 1.0)


def test_contact_is_the_same_at_four_kilohertz() -> None:
    peak, force, depth = touch(1000)
    fast_peak, fast_force, fast_depth = touch(4000)
    assert fast_force == pytest.approx(force, rel=1e-3)
    assert fast_depth == pytest.approx(depth, rel=0.01)
    assert fast_force == pytest.approx(6.0, rel=0.01)
    # The tick in which the tip arrives is 0.1 mm long at 1 kHz; that is 0.3 N of spring.
    assert fast_peak == pytest.approx(peak, abs=0.3 + 0.02 * peak)


def test_mujoco_samples_the_force_at_every_step() -> None:
    model = plant_before(measured(WALL), 4000).model
    assert model.opt.timestep == pytest.approx(2.5e-4)
    (wall,) = [k for k in range(model.nsensor) if model.sensor(k).name.startswith("wall_sensor:")]
    assert model.sensor_type[wall] == mujoco.mjtSensor.mjSENS_CONTACT
