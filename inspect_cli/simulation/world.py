"""The true MuJoCo model: the nominal vehicle plus the Truth.

Surfaces become geoms as ``simulation.surface_geoms`` says. The tool's tip meets each through an
explicit contact pair, so that stiffness, damping and friction are those that are stated.

With a constant impedance d MuJoCo's normal force f obeys δ̈ + b δ̇ + k δ = R f, R = Â (1 − d)/d, δ
the depth and Â the inverse inertia that the compiler gives the tip. A body of mass m pressed by F
then moves like (m + 1/R) δ̈ + (b/R) δ̇ + (k/R) δ = F: a spring and a damper, and a mass 1/R that
is nowhere. A small d makes that mass a few per cent of the vehicle's; k/R = K and b/R = 2 ζ √(K m)
are set by ``solref``, whose negative numbers MuJoCo divides by d. Friction sticks by the same law
without δ: the tip creeps by R/(impratio b) metres per second and newton, a tenth of a millimetre.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from inspect_cli.schema.truth import TruePlatform
from inspect_cli.simulation.surface_geoms import add_surfaces
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.vehicles.kinds import Tip, Vehicle

CONTACT_IMPEDANCE = 0.05
FRICTION_STIFFENING = 1000.0
"""MuJoCo's ``impratio``: how much less friction yields than the normal direction."""
FRICTION_DAMPING_PS = 100.0
"""b of the friction, 1/s; well below the physics rate, so that a stuck tip does not chatter."""
GROUND_FRICTION = 0.8
WALL_SENSOR = "wall_sensor:"
"""How the names begin of what measures the contact of the tip with one geom."""
NET_FORCE = 3
"""MuJoCo's reduction of all contacts to their net force at its centre."""


def build_world(
    vehicle: Vehicle, platform: TruePlatform, structure: StructureTruth
) -> mujoco.MjModel:
    """Compile the true world."""
    spec = vehicle.nominal_spec()
    spec.option.impratio = FRICTION_STIFFENING
    _change_masses(spec, platform)
    _add_ground(spec)
    met = add_surfaces(spec, structure)
    for name, surface in zip(met, structure.surfaces, strict=True):
        friction = surface.friction
        spec.add_pair(
            name=f"tip:{name}",
            geomname1="tip",
            geomname2=name,
            condim=3,
            friction=[friction, friction, 0.0, 0.0, 0.0],
        )
    _add_contact_sensor(spec, "tool")
    _add_contact_sensor(spec, "shell")
    _add_wall_sensors(spec, structure, met)
    model = spec.compile()
    _set_tip_contact(model, vehicle.tip, len(met))
    return model


def _change_masses(spec: mujoco.MjSpec, platform: TruePlatform) -> None:
    for body in spec.bodies[1:]:  # the first is the world
        body.mass *= platform.mass_factor
        body.inertia = np.array(body.inertia) * platform.mass_factor
    core = spec.body("core")
    core.ipos = np.array(core.ipos) + np.array(platform.com_offset_m)


def _add_ground(spec: mujoco.MjSpec) -> None:
    spec.worldbody.add_geom(
        name="ground",
        type=mujoco.mjtGeom.mjGEOM_PLANE,
        size=[100.0, 100.0, 0.1],
        contype=1,
        conaffinity=0,
        friction=[GROUND_FRICTION, 0.005, 0.0001],
    )


def _add_contact_sensor(spec: mujoco.MjSpec, body: str) -> None:
    """Net contact force of a body with everything, in W."""
    force = 1 << int(mujoco.mjtConDataField.mjCONDATA_FORCE)
    spec.add_sensor(
        name=f"contact_{body}",
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=mujoco.mjtObj.mjOBJ_BODY,
        objname=body,
        intprm=[force, NET_FORCE, 1],
    )


def _add_wall_sensors(spec: mujoco.MjSpec, structure: StructureTruth, met: Sequence[str]) -> None:
    """What the tip does to the geom that it meets of each surface with a force sensor.

    Net force, torque and position in W; the torque is about the position. MuJoCo evaluates them
    in every step, so that a world without such a surface has none.
    """
    kinds = ("FORCE", "TORQUE", "POS")
    asked = sum(1 << int(getattr(mujoco.mjtConDataField, f"mjCONDATA_{kind}")) for kind in kinds)
    for name, surface in zip(met, structure.surfaces, strict=True):
        if surface.force_sensor is not None:
            spec.add_sensor(
                name=f"{WALL_SENSOR}{name}",
                type=mujoco.mjtSensor.mjSENS_CONTACT,
                objtype=mujoco.mjtObj.mjOBJ_GEOM,
                objname="tip",
                reftype=mujoco.mjtObj.mjOBJ_GEOM,
                refname=name,
                intprm=[asked, NET_FORCE, 1],
            )


def _set_tip_contact(model: mujoco.MjModel, tip: Tip, n_pairs: int) -> None:
    """Spring, damper and friction of the tip; the damping ratio is that of the whole vehicle."""
    mass = model.body_subtreemass[model.body("core").id]
    share = (1.0 - CONTACT_IMPEDANCE) * model.body_invweight0[model.body("tool").id][0]
    damping = 2.0 * tip.damping_ratio * np.sqrt(tip.stiffness_npm * mass)
    for index in range(n_pairs):
        model.pair_solref[index] = (-tip.stiffness_npm * share, -damping * share)
        model.pair_solreffriction[index] = (0.0, -FRICTION_DAMPING_PS * CONTACT_IMPEDANCE)
        model.pair_solimp[index] = (CONTACT_IMPEDANCE, CONTACT_IMPEDANCE, 1e-3, 0.5, 2.0)
