"""The nominal MuJoCo model of a canted octorotor; see the contract in ``vehicles.kinds``."""

from __future__ import annotations

import mujoco
import numpy as np

from canted_octorotor.file_model import CantedOctorotorPlatform, rotor_geometry, tool_in_body
from inspect_cli.spatial.rotations import matrix_to_quaternion

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
    _add_rotors(spec, core, platform)
    _add_wrist(spec, core, platform)
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


def _add_rotors(spec, core, platform):
    rotors = platform.rotors
    geometry = zip(*rotor_geometry(rotors), strict=True)
    for index, (position, direction, spin) in enumerate(geometry):
        across = np.cross(direction, position / np.linalg.norm(position))
        R = np.column_stack([np.cross(across, direction), across, direction])
        name = f"rotor_{index}"
        core.add_site(name=name, pos=position, quat=matrix_to_quaternion(R))
        spec.add_actuator(
            name=name,
            trntype=mujoco.mjtTrn.mjTRN_SITE,
            target=name,
            gear=[0.0, 0.0, 1.0, 0.0, 0.0, -spin * rotors.moment_constant_m],
            dyntype=mujoco.mjtDyn.mjDYN_FILTEREXACT,
            dynprm=[rotors.time_up_s] + [0.0] * 9,
            gaintype=mujoco.mjtGain.mjGAIN_FIXED,
            gainprm=[1.0] + [0.0] * 9,
            ctrllimited=True,
            ctrlrange=[0.0, rotors.max_thrust_n],
        )


def _add_wrist(spec, core, platform):
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
    tool.add_site(name="tool_tip", pos=[0.0, 0.0, wrist.length_m])
    inertia = 4.0 * across + SERVO_ARMATURE_KGM2
    stiffness, damping = inertia * SERVO_RADPS**2, 2.0 * inertia * SERVO_RADPS
    spec.add_actuator(
        name="wrist",
        trntype=mujoco.mjtTrn.mjTRN_JOINT,
        target="wrist",
        dyntype=mujoco.mjtDyn.mjDYN_FILTEREXACT,
        dynprm=[wrist.servo_lag_s] + [0.0] * 9,
        gaintype=mujoco.mjtGain.mjGAIN_FIXED,
        gainprm=[stiffness] + [0.0] * 9,
        biastype=mujoco.mjtBias.mjBIAS_AFFINE,
        biasprm=[0.0, -stiffness, -damping] + [0.0] * 7,
        forcelimited=True,
        forcerange=[-wrist.servo_torque_nm, wrist.servo_torque_nm],
    )
