"""The true MuJoCo model: the nominal vehicle plus the Truth.

Surfaces become geoms whose front is the true surface: a box behind a plane, a sphere or a
cylinder seen from outside, tangent boxes around a cylinder or sphere seen from inside. The tool's
tip meets each through an explicit contact pair, so that stiffness, damping and friction are those
that are stated.

With a constant impedance d MuJoCo's normal force f obeys δ̈ + b δ̇ + k δ = R f, R = Â (1 − d)/d, δ
the depth and Â the inverse inertia that the compiler gives the tip. A body of mass m pressed by F
then moves like (m + 1/R) δ̈ + (b/R) δ̇ + (k/R) δ = F: a spring and a damper, and a mass 1/R that
is nowhere. A small d makes that mass a few per cent of the vehicle's; k/R = K and b/R = 2 ζ √(K m)
are set by ``solref``, whose negative numbers MuJoCo divides by d. Friction sticks by the same law
without δ: the tip creeps by R/(impratio b) metres per second and newton, a tenth of a millimetre.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.schema.truth import TruePlatform
from inspect_cli.spatial.arrays import Structured, Vector
from inspect_cli.spatial.primitives import CYLINDER, PLANE, normal_at, point_at
from inspect_cli.spatial.rotations import matrix_to_quaternion
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.vehicles.kinds import Tip, Vehicle

CONTACT_IMPEDANCE = 0.05
FRICTION_STIFFENING = 1000.0
"""MuJoCo's ``impratio``: how much less friction yields than the normal direction."""
FRICTION_DAMPING_PS = 100.0
"""b of the friction, 1/s; well below the physics rate, so that a stuck tip does not chatter."""
WALL_THICKNESS_M = 0.2
FACET_SAGITTA_M = 0.0005
"""How far a tangent box may stand off a concave surface."""
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
    pairs = _add_surfaces(spec, structure)
    for name, friction in pairs:
        spec.add_pair(
            name=f"tip:{name}",
            geomname1="tip",
            geomname2=name,
            condim=3,
            friction=[friction, friction, 0.0, 0.0, 0.0],
        )
    _add_contact_sensor(spec, "tool")
    _add_contact_sensor(spec, "shell")
    _add_wall_sensors(spec, structure)
    model = spec.compile()
    _set_tip_contact(model, vehicle.tip, len(pairs))
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


def _add_surfaces(spec: mujoco.MjSpec, structure: StructureTruth) -> list[tuple[str, float]]:
    """Add every surface's geoms; return (geom's name, friction) of each."""
    pairs = []
    for index, surface in enumerate(structure.surfaces):
        prims = structure.primitives[index : index + 1]
        if prims["kind"][0] == PLANE or prims["side"][0] < 0:
            names = _add_facets(spec, surface.name, prims)
        else:
            names = [_add_round(spec, surface.name, prims)]
        pairs += [(name, surface.friction) for name in names]
    return pairs


def _add_round(spec: mujoco.MjSpec, name: str, prims: Structured) -> str:
    row = prims[0]
    is_cylinder = row["kind"] == CYLINDER
    # MuJoCo's cylinder lies along its z; the surface frame's axis is its y.
    turn = np.array([[1.0, 0.0, 0.0], [0.0, 0.0, 1.0], [0.0, -1.0, 0.0]])
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_CYLINDER if is_cylinder else mujoco.mjtGeom.mjGEOM_SPHERE,
        size=[row["radius"], row["half_size"][1] if is_cylinder else 0.0, 0.0],
        pos=row["p_WS"],
        quat=matrix_to_quaternion(np.ascontiguousarray(row["R_WS"] @ turn)),
        contype=1,
        conaffinity=0,
    )
    return name


def _add_facets(spec: mujoco.MjSpec, name: str, prims: Structured) -> list[str]:
    """Boxes whose fronts are tangent to the surface; a plane is one of them."""
    half = prims["half_size"][0]
    counts = (1, 1)
    if prims["kind"][0] != PLANE:
        radius = prims["radius"][0]
        is_cylinder = prims["kind"][0] == CYLINDER
        # A facet's corner stands off by w²/8r, and on a sphere by as much again.
        width = np.sqrt((8.0 if is_cylinder else 4.0) * radius * FACET_SAGITTA_M)
        along = 1 if is_cylinder else int(np.ceil(2.0 * half[1] / width))
        counts = (int(np.ceil(2.0 * half[0] / width)), along)
    size = half / np.array(counts)
    names = []
    for i in range(counts[0]):
        for j in range(counts[1]):
            u = -half[0] + (2 * i + 1) * size[0]
            v = -half[1] + (2 * j + 1) * size[1]
            names.append(_add_box(spec, f"{name}:{i}:{j}", prims, u, v, size))
    return names


def _add_box(
    spec: mujoco.MjSpec, name: str, prims: Structured, u: float, v: float, half: Vector
) -> str:
    n = normal_at(prims, 0, u, v)
    front = point_at(prims, 0, u, v)
    ahead = point_at(prims, 0, u + 1e-4, v) - front
    x = ahead - n * (n @ ahead)
    x /= np.linalg.norm(x)
    R = np.column_stack([x, np.cross(n, x), n])
    spec.worldbody.add_geom(
        name=name,
        type=mujoco.mjtGeom.mjGEOM_BOX,
        size=[half[0], half[1], 0.5 * WALL_THICKNESS_M],
        pos=front - 0.5 * WALL_THICKNESS_M * n,
        quat=matrix_to_quaternion(np.ascontiguousarray(R)),
        contype=1,
        conaffinity=0,
        rgba=[0.75, 0.74, 0.72, 1.0],
    )
    return name


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


def _add_wall_sensors(spec: mujoco.MjSpec, structure: StructureTruth) -> None:
    """What the tip does to each geom of a surface with a force sensor.

    Net force, torque and position in W; the torque is about the position. MuJoCo evaluates them
    in every step, so that a world without such a surface has none.
    """
    measured = {s.name for s in structure.surfaces if s.force_sensor is not None}
    kinds = ("FORCE", "TORQUE", "POS")
    asked = sum(1 << int(getattr(mujoco.mjtConDataField, f"mjCONDATA_{kind}")) for kind in kinds)
    for geom in list(spec.worldbody.geoms):
        if geom.name.partition(":")[0] in measured:
            spec.add_sensor(
                name=f"{WALL_SENSOR}{geom.name}",
                type=mujoco.mjtSensor.mjSENS_CONTACT,
                objtype=mujoco.mjtObj.mjOBJ_GEOM,
                objname="tip",
                reftype=mujoco.mjtObj.mjOBJ_GEOM,
                refname=geom.name,
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
