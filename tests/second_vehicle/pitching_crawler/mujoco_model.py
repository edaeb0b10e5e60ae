"""The nominal MuJoCo model of a pitching crawler, and the actuators in it."""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.vehicles.actuators import Actuator, Drive, Rotor, add_actuators
from pitching_crawler.numbers import CrawlerNumbers, rotor_geometry

FOOT = "foot"
JOINTS = ("hinge", "wheel")
TOUCHES = {"contype": 0, "conaffinity": 1, "mass": 0.0}
TOOL_AXES = [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]
"""z_T along the arm's x, y_T along its y."""


def build_spec(numbers: CrawlerNumbers) -> mujoco.MjSpec:
    """The vehicle in free space, the arm level."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1.0 / numbers.physics_hz
    spec.option.gravity = np.array([0.0, 0.0, -GRAVITY_MPS2])
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    hub = _body(spec.worldbody, "hub", numbers.body_mass_kg, numbers.body_inertia_kgm2)
    hub.add_freejoint(name="root")
    # The level arm's weight is balanced by a body whose centre lies behind O_b.
    arm_m = numbers.arm_mass_kg + numbers.wheel_mass_kg
    ahead = arm_m * numbers.hinge_B_m[0] + numbers.arm_moment_kgm
    hub.ipos = np.array([-ahead / numbers.body_mass_kg, 0.0, 0.0])
    positions, _ = rotor_geometry(numbers)
    guards = _body(hub, "guards", 1e-9, np.full(3, 1e-12))
    for index, position in enumerate(positions):
        hub.add_site(name=f"rotor_{index}", pos=position)
        _sphere(guards, f"guard_{index}", numbers.rotor_radius_m, position)
    legs = _body(hub, "legs", 1e-9, np.full(3, 1e-12))
    for index, (x, y) in enumerate([(0.15, 0.15), (-0.15, 0.15), (-0.15, -0.15), (0.15, -0.15)]):
        _sphere(legs, f"leg_{index}", 0.01, [x, y, 0.01 - numbers.gear_height_m])
    _add_foot(hub, numbers)
    _add_arm(hub, numbers)
    add_actuators(spec, actuators_of(numbers))
    return spec


def actuators_of(numbers: CrawlerNumbers) -> tuple[Actuator, ...]:
    """The wheel's drive, then the rotors; the hinge has none."""
    wheel = Drive(
        name="wheel_drive",
        joint="wheel",
        lag_s=numbers.wheel_lag_s,
        max_speed_radps=numbers.wheel_speed_radps,
        torque_nm=numbers.wheel_torque_nm,
        stiffness_nmprad=numbers.wheel_stiffness_nmprad,
        damping_nmsprad=numbers.wheel_damping_nmsprad,
    )
    _, spins = rotor_geometry(numbers)
    rotors = [
        Rotor(
            name=f"rotor_{index}",
            radius_m=numbers.rotor_radius_m,
            max_thrust_n=numbers.max_thrust_n,
            moment_m=-spin * numbers.moment_constant_m,
            time_up_s=numbers.rotor_lag_s,
            time_down_s=numbers.rotor_lag_s,
        )
        for index, spin in enumerate(spins)
    ]
    return (wheel, *rotors)


def _body(parent, name, mass, inertia, **place):
    body = parent.add_body(name=name, explicitinertial=True, **place)
    body.mass, body.inertia, body.ipos = mass, np.array(inertia), np.zeros(3)
    return body


def _sphere(body, name, radius, position):
    kind = mujoco.mjtGeom.mjGEOM_SPHERE
    body.add_geom(name=name, type=kind, size=[radius, 0, 0], pos=position, **TOUCHES)


def _add_foot(hub, numbers):
    half = numbers.foot_half_m
    hub.add_geom(
        name="sole",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[half, half, 0.5 * numbers.foot_thickness_m],
        pos=[0.0, 0.0, numbers.foot_height_m - 0.5 * numbers.foot_thickness_m],
        **TOUCHES,
    )
    hub.add_site(name=FOOT, pos=[0.0, 0.0, numbers.foot_height_m])


def _add_arm(hub, numbers):
    length = numbers.arm_length_m
    across = numbers.arm_mass_kg * length**2 / 12.0
    arm = _body(hub, "arm", numbers.arm_mass_kg, [1e-2 * across, across, across],
                pos=numbers.hinge_B_m)  # fmt: skip
    arm.ipos = np.array([0.5 * length, 0.0, 0.0])
    rest = -numbers.arm_moment_kgm * GRAVITY_MPS2 / numbers.hinge_stiffness_nmprad
    arm.add_joint(
        name="hinge",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        stiffness=[numbers.hinge_stiffness_nmprad, 0.0, 0.0],
        damping=[numbers.hinge_damping_nmsprad, 0.0, 0.0],
        springref=rest,
    )
    arm.add_site(name=TOOL, pos=[numbers.tip_length_m, 0.0, 0.0], quat=TOOL_AXES)
    ball = 0.4 * numbers.wheel_mass_kg * numbers.wheel_radius_m**2
    wheel = _body(arm, "wheel", numbers.wheel_mass_kg, np.full(3, ball), pos=[length, 0.0, 0.0])
    wheel.add_joint(
        name="wheel",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        armature=numbers.wheel_armature_kgm2,
    )
    _sphere(wheel, "tyre", numbers.wheel_radius_m, [0.0, 0.0, 0.0])
