"""The nominal MuJoCo model of a canted octorotor; see the contract in ``vehicles.kinds``."""

from __future__ import annotations

import mujoco
import numpy as np

from canted_octorotor.file_model import CantedOctorotorPlatform, rotor_geometry, tool_in_body
from inspect_cli.interfaces import TOOL
from inspect_cli.spatial.rotations import matrix_to_quaternion
from inspect_cli.vehicles.actuators import Actuator, Rotor, Servo, add_actuators

SERVO_RADPS = 120.0
SERVO_ARMATURE_KGM2 = 1e-3


def build_spec(platform: CantedOctorotorPlatform) -> mujoco.MjSpec:
    """The vehicle in free space."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1.0 / platform.rates.physics_hz
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    core = _body(spec.worldbody, "core", platform.core.mass_kg, platform.core.inertia_kgm2)
    core.ipos = np.array(platform.core.com_m)
    core.add_freejoint(name="root")
    _add_shell(core, platform)
    _add_gear(core, platform)
    _add_rotors(core, platform)
    _add_wrist(core, platform)
    add_actuators(spec, actuators_of(platform))
    return spec


def _body(parent, name, mass, inertia, **place):
    body = parent.add_body(name=name, explicitinertial=True, **place)
    body.mass, body.inertia, body.ipos = mass, np.array(inertia), np.zeros(3)
    return body


def _add_sphere(body, name, radius, position):
    body.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[radius, 0.0, 0.0],
        pos=position,
        contype=0,
        conaffinity=1,
    )


def _add_shell(core, platform):
    shell = _body(core, "shell", 1e-9, np.full(3, 1e-12))
    _add_sphere(shell, "hull", platform.core.radius_m, np.zeros(3))
    positions, _, _ = rotor_geometry(platform.rotors)
    for index, position in enumerate(positions):
        _add_sphere(shell, f"guard_{index}", platform.rotors.radius_m, position)


def _add_gear(core, platform):
    gear = _body(core, "gear", 1e-9, np.full(3, 1e-12))
    foot, reach = 0.01, platform.core.radius_m
    for index, (x, y) in enumerate([(reach, 0), (0, reach), (-reach, 0), (0, -reach)]):
        height = foot - platform.core.gear_height_m
        _add_sphere(gear, f"foot_{index}", foot, [x, y, height])


def _add_rotors(core, platform):
    rotors = platform.rotors
    geometry = zip(*rotor_geometry(rotors), strict=True)
    for index, (position, direction, _) in enumerate(geometry):
        across = np.cross(direction, position / np.linalg.norm(position))
        R = np.column_stack([np.cross(across, direction), across, direction])
        core.add_site(name=f"rotor_{index}", pos=position, quat=matrix_to_quaternion(R))


def _add_wrist(core, platform):
    wrist = platform.wrist
    across = wrist.mass_kg * wrist.length_m**2 / 12.0
    tool = _body(
        core,
        "tool",
        wrist.mass_kg,
        [across, across, 0.01 * across],
        pos=wrist.position_B_m,
        quat=matrix_to_quaternion(tool_in_body(wrist, 0.0)[1]),
    )
    tool.ipos = np.array([0.0, 0.0, 0.5 * wrist.length_m])
    reach = np.radians(wrist.range_deg)
    tool.add_joint(
        name="wrist",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[0.0, 1.0, 0.0],
        armature=SERVO_ARMATURE_KGM2,
        limited=True,
        range=[-reach, reach],
    )
    _add_sphere(tool, "tip", wrist.tip_radius_m, [0.0, 0.0, wrist.length_m - wrist.tip_radius_m])
    tool.add_site(name=TOOL, pos=[0.0, 0.0, wrist.length_m])


def actuators_of(platform: CantedOctorotorPlatform) -> tuple[Actuator, ...]:
    """Eight rotors, and the wrist's servo."""
    rotors, wrist = platform.rotors, platform.wrist
    _, _, spins = rotor_geometry(rotors)
    pushing = [
        Rotor(
            name=f"rotor_{index}",
            radius_m=rotors.radius_m,
            max_thrust_n=rotors.max_thrust_n,
            moment_m=-spin * rotors.moment_constant_m,
            time_up_s=rotors.time_up_s,
            time_down_s=rotors.time_down_s,
        )
        for index, spin in enumerate(spins)
    ]
    inertia = wrist.mass_kg * wrist.length_m**2 / 3.0 + SERVO_ARMATURE_KGM2
    servo = Servo(
        name="wrist",
        joint="wrist",
        lag_s=wrist.servo_lag_s,
        rate_radps=wrist.servo_rate_radps,
        torque_nm=wrist.servo_torque_nm,
        stiffness_nmprad=inertia * SERVO_RADPS**2,
        damping_nmsprad=2.0 * inertia * SERVO_RADPS,
    )
    return (*pushing, servo)
