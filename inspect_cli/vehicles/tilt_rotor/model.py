"""The nominal MuJoCo model of a tilt-rotor vehicle, built from its platform's numbers.

Rotors push along their site's z and react about it with −σ k_m per newton. Their thrust
follows the command with a first-order lag; for small changes of speed that is the lag of the
speed itself, since δT = 2 k_f ω δω. Tilt joints are position servos behind a first-order lag
with a torque limit; the plant limits the rate of their set-points.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.schema.vehicle import TiltArm, TiltRotorPlatform
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import GRAVITY_MPS2
from inspect_cli.spatial.rotations import matrix_to_quaternion
from inspect_cli.vehicles.actuators import Actuator, Rotor, Servo, add_actuators

SERVO_RADPS = 120.0
"""Natural frequency of the tilt servo's inner loop; well above the lag that is stated."""
SERVO_ARMATURE_KGM2 = 1.0e-3
"""Reflected inertia of a geared servo."""


def tool_transform(platform: TiltRotorPlatform) -> tuple[Vector, Matrix]:
    """(p_BT, R_BT): z_T = (sin φ, 0, −cos φ) through O_b, y_T = y_B, x_T = y_T × z_T."""
    phi = np.radians(platform.tool.pitch_deg)
    z = np.array([np.sin(phi), 0.0, -np.cos(phi)])
    y = np.array([0.0, 1.0, 0.0])
    return platform.tool.length_m * z, np.column_stack([np.cross(y, z), y, z])


def spin_sign(group: TiltArm) -> float:
    """σ: +1 when the upper rotor turns counter-clockwise seen from above."""
    return 1.0 if group.upper_spin == "ccw" else -1.0


def group_kappa_m(platform: TiltRotorPlatform) -> Vector:
    """κ_i (n,): what the reaction moments of a group's rotors leave, per newton of its thrust."""
    unit = platform.unit
    half = 0.5 * (unit.moment_constant_upper_m - unit.moment_constant_lower_m)
    return np.array([-spin_sign(group) * half for group in platform.groups])


def build_spec(platform: TiltRotorPlatform) -> mujoco.MjSpec:
    """The vehicle alone, hovering nowhere: see the contract in ``vehicles.kinds``."""
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1.0 / platform.rates.physics_hz
    spec.option.gravity = np.array([0.0, 0.0, -GRAVITY_MPS2])
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    core = spec.worldbody.add_body(name="core", explicitinertial=True)
    core.add_freejoint(name="root")
    core.mass = platform.core.mass_kg
    core.inertia = np.array(platform.core.inertia_kgm2)
    core.ipos = np.array(platform.core.com_m)
    _add_shell(core, platform)
    _add_gear(core, platform)
    _add_tool(core, platform)
    for index, group in enumerate(platform.groups):
        _add_group(core, platform, index, group)
    add_actuators(spec, actuators_of(platform))
    return spec


def _massless(parent: mujoco.MjsBody, name: str) -> mujoco.MjsBody:
    body = parent.add_body(name=name, explicitinertial=True)
    body.mass = 1e-9
    body.inertia = np.full(3, 1e-12)
    body.ipos = np.zeros(3)
    return body


def _add_shell(core: mujoco.MjsBody, platform: TiltRotorPlatform) -> None:
    """What must never touch: the core and a sphere around each group's rotors."""
    shell = _massless(core, "shell")
    half_height = 0.5 * platform.core.height_m
    shell.add_geom(
        name="hull",
        type=mujoco.mjtGeom.mjGEOM_CYLINDER,
        size=[platform.core.radius_m, half_height, 0.0],
        contype=0,
        conaffinity=1,
    )
    for index, group in enumerate(platform.groups):
        psi = np.radians(group.azimuth_deg)
        distance = platform.unit.distance_m
        shell.add_geom(
            name=f"guard_{index}",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[platform.rotor.radius_m, 0.0, 0.0],
            pos=[distance * np.cos(psi), distance * np.sin(psi), 0.0],
            contype=0,
            conaffinity=1,
            rgba=[0.35, 0.55, 0.75, 0.35],
        )


def _add_gear(core: mujoco.MjsBody, platform: TiltRotorPlatform) -> None:
    """Four feet under the core."""
    gear = _massless(core, "gear")
    foot = 0.01
    for index, psi in enumerate(np.radians([45.0, 135.0, 225.0, 315.0])):
        x, y = platform.core.radius_m * np.cos(psi), platform.core.radius_m * np.sin(psi)
        gear.add_geom(
            name=f"foot_{index}",
            type=mujoco.mjtGeom.mjGEOM_SPHERE,
            size=[foot, 0.0, 0.0],
            pos=[x, y, foot - platform.core.gear_height_m],
            contype=0,
            conaffinity=1,
        )


def _add_tool(core: mujoco.MjsBody, platform: TiltRotorPlatform) -> None:
    """A thin rod from O_b to the tip; only the tip can touch."""
    tool = platform.tool
    _, R_BT = tool_transform(platform)
    body = core.add_body(name="tool", explicitinertial=True, quat=matrix_to_quaternion(R_BT))
    body.mass = tool.mass_kg
    body.ipos = np.array([0.0, 0.0, 0.5 * tool.length_m])
    across = tool.mass_kg * tool.length_m**2 / 12.0
    body.inertia = np.array([across, across, 1e-2 * across])
    body.add_geom(
        name="tip",
        type=mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[tool.tip_radius_m, 0.0, 0.0],
        pos=[0.0, 0.0, tool.length_m - tool.tip_radius_m],
        contype=0,
        conaffinity=1,
    )
    body.add_geom(
        name="arm",
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0.0, 0.0, 0.1, 0.0, 0.0, tool.length_m - 2.0 * tool.tip_radius_m],
        size=[0.008, 0.0, 0.0],
        contype=0,
        conaffinity=0,
    )
    body.add_site(name=TOOL, pos=[0.0, 0.0, tool.length_m])


def _add_group(
    core: mujoco.MjsBody, platform: TiltRotorPlatform, index: int, group: TiltArm
) -> None:
    unit, rotor = platform.unit, platform.rotor
    psi = np.radians(group.azimuth_deg)
    body = core.add_body(
        name=f"group_{index}",
        pos=[unit.distance_m * np.cos(psi), unit.distance_m * np.sin(psi), 0.0],
        quat=[np.cos(0.5 * psi), 0.0, 0.0, np.sin(0.5 * psi)],
        explicitinertial=True,
    )
    body.mass = unit.mass_kg + 2.0 * rotor.mass_kg
    body.inertia = np.array(_group_inertia(platform))
    body.ipos = np.zeros(3)  # MuJoCo would take the body's position
    limited = unit.range_deg is not None
    reach = np.radians(unit.range_deg or 0.0)
    body.add_joint(
        name=f"tilt_{index}",
        type=mujoco.mjtJoint.mjJNT_HINGE,
        axis=[1.0, 0.0, 0.0],
        armature=SERVO_ARMATURE_KGM2,
        limited=limited,
        range=[-reach, reach],
    )
    for name, height in (("upper", 0.5), ("lower", -0.5)):
        body.add_site(name=f"rotor_{index}_{name}", pos=[0.0, 0.0, height * unit.coaxial_offset_m])


def _group_inertia(platform: TiltRotorPlatform) -> tuple[float, float, float]:
    """A compact tilting unit with two thin rotor discs; (along arm, across, along thrust)."""
    unit, rotor = platform.unit, platform.rotor
    disc = 2.0 * rotor.mass_kg * rotor.radius_m**2
    offset = 2.0 * rotor.mass_kg * (0.5 * unit.coaxial_offset_m) ** 2
    motor = unit.mass_kg * 0.02**2
    return (0.25 * disc + offset + motor, 0.25 * disc + offset + motor, 0.5 * disc + motor)


def actuators_of(platform: TiltRotorPlatform) -> tuple[Actuator, ...]:
    """Upper and lower rotor of each group, then the tilts' servos."""
    unit, rotor = platform.unit, platform.rotor
    constants = {"upper": unit.moment_constant_upper_m, "lower": -unit.moment_constant_lower_m}
    rotors = [
        Rotor(
            name=f"rotor_{index}_{name}",
            radius_m=rotor.radius_m,
            max_thrust_n=unit.max_thrust_n,
            moment_m=-spin_sign(group) * moment,
            time_up_s=rotor.time_up_s,
            time_down_s=rotor.time_down_s,
        )
        for index, group in enumerate(platform.groups)
        for name, moment in constants.items()
    ]
    inertia = _group_inertia(platform)[0] + SERVO_ARMATURE_KGM2
    servos = [
        Servo(
            name=f"tilt_{index}",
            joint=f"tilt_{index}",
            lag_s=unit.servo_lag_s,
            rate_radps=unit.servo_rate_radps,
            torque_nm=unit.servo_torque_nm,
            stiffness_nmprad=inertia * SERVO_RADPS**2,
            damping_nmsprad=2.0 * inertia * SERVO_RADPS,
        )
        for index in range(len(platform.groups))
    ]
    return (*rotors, *servos)
