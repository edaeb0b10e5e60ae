"""The visual model of a vehicle: its nominal model with visible booms and rotors.

Only the contract of all vehicles is used (``vehicles.kinds``), so that a new kind needs no line
here: a rotor's disc is normal to its site's z; a boom joins its carrier to the base.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.scene.materials import BLADE, BOOM, FRONT, HULL, INVISIBLE, ROTOR
from inspect_cli.scene.materials import TOOL as TOOL_COLOUR
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.vehicles.actuators import Rotor, of_kind, rotor_radii_m
from inspect_cli.vehicles.kinds import Bodies, Vehicle

BOOM_M, HUB_M, RING_M, STRUT_M = 0.009, 0.014, 0.004, 0.005
RING, RING_SIDES, RING_SEGMENTS = "rotor_ring", 6, 40
BLADE_CHORD, BLADE_HALF_M = 0.13, 0.002
AHEAD = 0.8
"""Cosine of the angle between a boom and the tool above which the boom is on the tool's side."""


def visual_model(vehicle: Vehicle) -> mujoco.MjSpec:
    """The vehicle's specification with visible parts; nothing of it can touch anything."""
    spec = vehicle.nominal_spec()
    _paint(spec, vehicle)
    _add_struts(spec, vehicle.bodies)
    bodies, rotors = vehicle.bodies, of_kind(vehicle.actuators, Rotor)
    p_BR = {rotor.name: _in_base(spec, bodies, rotor.name) for rotor in rotors}
    radius_m = float(rotor_radii_m(vehicle.actuators).max())
    _add_ring_mesh(spec, radius_m)
    tip_B = _in_base(spec, bodies, TOOL)
    _add_hull(spec, bodies, p_BR)
    for index, (name, place) in enumerate(p_BR.items()):
        site = spec.site(name)
        ahead = _level_cosine(place, tip_B) > AHEAD
        _add_rotor(site, radius_m, index)
        _add_boom(spec, bodies, site.parent, place, index, ahead)
    return spec


def _paint(spec: mujoco.MjSpec, vehicle: Vehicle) -> None:
    bodies, tool = vehicle.bodies, spec.site(TOOL).parent
    coloured = [(spec.body(name), INVISIBLE) for name in bodies.protected]
    coloured += [(spec.body(name), BOOM) for name in bodies.gear]
    coloured += [(spec.body(bodies.base), HULL), (tool, TOOL_COLOUR)]
    for body, colour in coloured:
        for geom in body.geoms:
            geom.rgba = colour
    hull = _hull(spec, bodies)
    if hull is not None:
        hull.rgba = HULL
    for contact in vehicle.contacts:
        for name in contact.geoms:
            spec.geom(name).rgba = FRONT


def _hull(spec: mujoco.MjSpec, bodies: Bodies) -> mujoco.MjsGeom | None:
    """The geom ``hull`` of a protected body, if there is one."""
    geoms = [geom for name in bodies.protected for geom in spec.body(name).geoms]
    return next((geom for geom in geoms if geom.name == "hull"), None)


def _add_struts(spec: mujoco.MjSpec, bodies: Bodies) -> None:
    """From the base's axis out to each foot."""
    for name in bodies.gear:
        _add_struts_to(spec.body(name))


def _add_struts_to(gear: mujoco.MjsBody) -> None:
    for geom in list(gear.geoms):
        top = [0.55 * geom.pos[0], 0.55 * geom.pos[1], 0.0]
        gear.add_geom(
            type=mujoco.mjtGeom.mjGEOM_CAPSULE,
            fromto=[*top, *geom.pos],
            size=[STRUT_M, 0.0, 0.0],
            rgba=BOOM,
            contype=0,
            conaffinity=0,
            mass=0.0,
        )


def _add_ring_mesh(spec: mujoco.MjSpec, radius_m: float) -> None:
    """A thin torus about z along the path of the blade tips, which hides little."""
    around = np.linspace(0.0, 2.0 * np.pi, RING_SEGMENTS, endpoint=False)
    across = np.linspace(0.0, 2.0 * np.pi, RING_SIDES, endpoint=False)
    phi, psi = np.meshgrid(around, across, indexing="ij")
    out = radius_m + RING_M * np.cos(psi)
    nodes = np.stack([out * np.cos(phi), out * np.sin(phi), RING_M * np.sin(psi)], axis=-1)
    number = np.arange(phi.size).reshape(phi.shape)
    ahead, up = np.roll(number, -1, axis=0), np.roll(number, -1, axis=1)
    both = np.roll(ahead, -1, axis=1)
    faces = np.stack([number, ahead, both, number, both, up], axis=-1)
    spec.add_mesh(
        name=RING,
        uservert=nodes.ravel(),
        userface=faces.ravel().astype(np.int32),
        inertia=mujoco.mjtMeshInertia.mjMESH_INERTIA_SHELL,
    )


def _add_hull(spec: mujoco.MjSpec, bodies: Bodies, p_BR: dict[str, Vector]) -> None:
    """A visible body for a vehicle that has no geom ``hull``."""
    if _hull(spec, bodies) is not None:
        return
    reach = max((float(np.linalg.norm(p[:2])) for p in p_BR.values()), default=0.3)
    spec.body(bodies.base).add_geom(
        type=mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        size=[0.4 * reach, 0.4 * reach, 0.15 * reach],
        rgba=HULL,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )


def _in_base(spec: mujoco.MjSpec, bodies: Bodies, site: str) -> Vector:
    """A site's place (3,) in B with every joint at zero."""
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    base = model.body(bodies.base).id
    R_WB: Matrix = data.xmat[base].reshape(3, 3)
    place: Vector = R_WB.T @ (data.site_xpos[model.site(site).id] - data.xpos[base])
    return place


def _level_cosine(a: Vector, b: Vector) -> float:
    lengths = np.linalg.norm(a[:2]) * np.linalg.norm(b[:2])
    return float(a[:2] @ b[:2] / lengths) if lengths > 1e-6 else 0.0


def _add_rotor(site: mujoco.MjsSite, radius_m: float, index: int) -> None:
    body = site.parent
    ring = _add(body, mujoco.mjtGeom.mjGEOM_MESH, [0.0, 0.0, 0.0], site, ROTOR)
    ring.meshname = RING
    _add(body, mujoco.mjtGeom.mjGEOM_CYLINDER, [HUB_M, 1.5 * HUB_M, 0.0], site, BOOM)
    half = [0.97 * radius_m, 0.5 * BLADE_CHORD * radius_m, BLADE_HALF_M]
    blade = _add(body, mujoco.mjtGeom.mjGEOM_BOX, half, site, BLADE)
    angle = 0.4 + 2.4 * index  # neighbours stand differently
    turn = np.zeros(4)
    spin = np.array([np.cos(0.5 * angle), 0.0, 0.0, np.sin(0.5 * angle)])
    mujoco.mju_mulQuat(turn, np.array(site.quat, dtype=float), spin)
    blade.quat = turn


def _add(
    body: mujoco.MjsBody,
    kind: mujoco.mjtGeom,
    size: list[float],
    site: mujoco.MjsSite,
    rgba: tuple[float, float, float, float],
) -> mujoco.MjsGeom:
    return body.add_geom(
        type=kind,
        size=size,
        pos=site.pos,
        quat=site.quat,
        rgba=rgba,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )


def _add_boom(
    spec: mujoco.MjSpec,
    bodies: Bodies,
    carrier: mujoco.MjsBody,
    p_BR: Vector,
    index: int,
    ahead: bool,
) -> None:
    """From the base to below the rotor; of several rotors on one carrier each draws its own."""
    end = p_BR if carrier.name == bodies.base else np.array(carrier.pos)
    spec.body(bodies.base).add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0.0, 0.0, 0.0, *end],
        size=[BOOM_M + 1e-5 * index, 0.0, 0.0],  # no two surfaces in one place
        rgba=FRONT if ahead else BOOM,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )
