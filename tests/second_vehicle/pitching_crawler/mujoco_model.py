"""The nominal MuJoCo model of a pitching crawler, and the actuators in it."""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.vehicles.actuators import Actuator, Drive, Rotor, add_actuators
from pitching_crawler.file_model import FOOT, CrawlerPlatform, rotor_geometry

JOINTS = ("hinge", "wheel")
TOUCHES = {"contype": 0, "conaffinity": 1, "mass": 0.0}
TOOL_AXES = [np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0]
"""z_T along the arm's x, y_T along its y."""


def build_spec(platform: CrawlerPlatform) -> mujoco.MjSpec:
    """The vehicle in free space, the arm level."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1.0 / platform.rates.physics_hz
    spec.option.gravity = np.array([0.0, 0.0, -GRAVITY_MPS2])
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    hub = _body(spec.worldbody, "hub", platform.hub.mass_kg, platform.hub.inertia_kgm2)
    hub.add_freejoint(name="root")
    # The level arm's weight is balanced by a body whose centre lies behind O_b.
    arm_m = platform.arm.mass_kg + platform.wheel.mass_kg
    ahead = arm_m * platform.arm.hinge_B_m[0] + platform.arm_moment_kgm
    hub.ipos = np.array([-ahead / platform.hub.mass_kg, 0.0, 0.0])
    positions, _ = rotor_geometry(platform.rotors)
    guards = _body(hub, "guards", 1e-9, np.full(3, 1e-12))
    for index, position in enumerate(positions):
        hub.add_site(name=f"rotor_{index}", pos=position)
        _sphere(guards, f"guard_{index}", platform.rotors.radius_m, position)
    legs = _body(hub, "legs", 1e-9, np.full(3, 1e-12))
    for index, (x, y) in enumerate([(0.15, 0.15), (-0.15, 0.15), (-0.15, -0.15), (0.15, -0.15)]):
        _sphere(legs, f"leg_{index}", 0.01, [x, y, 0.01 - platform.hub.gear_height_m])
    _add_foot(hub, platform)
    _add_arm(hub, platform)
    add_actuators(spec, actuators_of(platform))
    return spec


def actuators_of(platform: CrawlerPlatform) -> tuple[Actuator, ...]:
    """The wheel's drive, then the rotors; the hinge has none."""
    wheel = Drive(
        name="wheel_drive",
        joint="wheel",
        lag_s=platform.wheel.lag_s,
        max_speed_radps=platform.wheel.max_speed_radps,
        torque_nm=platform.wheel.torque_nm,
        stiffness_nmprad=platform.wheel.stiffness_nmprad,
        damping_nmsprad=platform.wheel.damping_nmsprad,
    )
    _, spins = rotor_geometry(platform.rotors)
    rotors = [
        Rotor(
            name=f"rotor_{index}",
            radius_m=platform.rotors.radius_m,
            max_thrust_n=platform.rotors.max_thrust_n,
            moment_m=-spin * platform.rotors.moment_constant_m,
            time_up_s=platform.rotors.lag_s,
            time_down_s=platform.rotors.lag_s,
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


def _add_foot(hub, platform):
    half = platform.foot.half_m
    hub.add_geom(
        name="sole",
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[half, half, 0.5 * platform.foot.thickness_m],
        pos=[0.0, 0.0, platform.foot.height_m - 0.5 * platform.foot.thickness_m],
        **TOUCHES,
    )
    hub.add_site(name=FOOT, pos=[0.0, 0.0, platform.foot.height_m])


def _add_arm(hub, platform):
    length = platform.arm.length_m
    across = platform.arm.mass_kg * length**2 / 12.0
    arm = _body(hub, "arm", platform.arm.mass_kg, [1e-2 * across, across, across],
                pos=platform.arm.hinge_B_m)  # fmt: skip
    arm.ipos = np.array([0.5 * length, 0.0, 0.0])
    rest = -platform.arm_moment_kgm * GRAVITY_MPS2 / platform.arm.hinge_stiffness_nmprad
    arm.add_joint(
        name="hinge",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        stiffness=[platform.arm.hinge_stiffness_nmprad, 0.0, 0.0],
        damping=[platform.arm.hinge_damping_nmsprad, 0.0, 0.0],
        springref=rest,
    )
    arm.add_site(name=TOOL, pos=[platform.tip_length_m, 0.0, 0.0], quat=TOOL_AXES)
    ball = 0.4 * platform.wheel.mass_kg * platform.wheel.radius_m**2
    wheel = _body(arm, "wheel", platform.wheel.mass_kg, np.full(3, ball), pos=[length, 0.0, 0.0])
    wheel.add_joint(
        name="wheel",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        armature=platform.wheel.armature_kgm2,
    )
    _sphere(wheel, "tyre", platform.wheel.radius_m, [0.0, 0.0, 0.0])
