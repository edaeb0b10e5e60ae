"""The visual model of a vehicle: its nominal model with visible booms and rotors.

Only the contract of all vehicles is used (``vehicles.kinds``), so that a new kind needs no line
here: an actuator on a site is a rotor, whose disc is normal to the site's z; a boom joins its
carrier to the core.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.scene.materials import BLADE, BOOM, FRONT, HULL, INVISIBLE, ROTOR, TOOL
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.vehicles.kinds import Vehicle

BOOM_M, HUB_M, RING_M, STRUT_M = 0.009, 0.014, 0.004, 0.005
RING, RING_SIDES, RING_SEGMENTS = "rotor_ring", 6, 40
BLADE_CHORD, BLADE_HALF_M = 0.13, 0.002
AHEAD = 0.8
"""Cosine of the angle between a boom and the tool above which the boom is on the tool's side."""


def visual_model(vehicle: Vehicle) -> mujoco.MjSpec:
    """The vehicle's specification with visible parts; nothing of it can touch anything."""
    spec = vehicle.nominal_spec()
    _paint(spec)
    _add_struts(spec)
    p_BR = _rotor_places(spec)
    _add_ring_mesh(spec, vehicle.actuators.rotor_radius_m)
    tip_B = _in_core(spec, "tool_tip")
    _add_hull(spec, p_BR)
    for index, (name, place) in enumerate(p_BR.items()):
        site = spec.site(name)
        ahead = _level_cosine(place, tip_B) > AHEAD
        _add_rotor(site, vehicle.actuators.rotor_radius_m, index)
        _add_boom(spec, site.parent, place, index, ahead)
    return spec


def _paint(spec: mujoco.MjSpec) -> None:
    for body, colour in (("core", HULL), ("tool", TOOL), ("gear", BOOM), ("shell", INVISIBLE)):
        for geom in spec.body(body).geoms:
            geom.rgba = colour
    hull = next((geom for geom in spec.body("shell").geoms if geom.name == "hull"), None)
    if hull is not None:
        hull.rgba = HULL
    spec.geom("tip").rgba = FRONT


def _add_struts(spec: mujoco.MjSpec) -> None:
    """From the core's axis out to each foot."""
    gear = spec.body("gear")
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


def _add_hull(spec: mujoco.MjSpec, p_BR: dict[str, Vector]) -> None:
    """A body for a vehicle whose shell has no geom ``hull`` that could be shown."""
    if any(geom.name == "hull" for geom in spec.body("shell").geoms):
        return
    reach = max((float(np.linalg.norm(p[:2])) for p in p_BR.values()), default=0.3)
    spec.body("core").add_geom(
        type=mujoco.mjtGeom.mjGEOM_ELLIPSOID,
        size=[0.4 * reach, 0.4 * reach, 0.15 * reach],
        rgba=HULL,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )


def _rotor_places(spec: mujoco.MjSpec) -> dict[str, Vector]:
    """By the rotor's site: its place (3,) in B with every joint at zero."""
    on_sites = [a for a in spec.actuators if a.trntype == mujoco.mjtTrn.mjTRN_SITE]
    return {a.target: _in_core(spec, a.target) for a in on_sites}


def _in_core(spec: mujoco.MjSpec, site: str) -> Vector:
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    core = model.body("core").id
    R_WB: Matrix = data.xmat[core].reshape(3, 3)
    place: Vector = R_WB.T @ (data.site_xpos[model.site(site).id] - data.xpos[core])
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
    spec: mujoco.MjSpec, carrier: mujoco.MjsBody, p_BR: Vector, index: int, ahead: bool
) -> None:
    """From the core to below the rotor; of several rotors on one carrier each draws its own."""
    end = p_BR if carrier.name == "core" else np.array(carrier.pos)
    spec.body("core").add_geom(
        type=mujoco.mjtGeom.mjGEOM_CAPSULE,
        fromto=[0.0, 0.0, 0.0, *end],
        size=[BOOM_M + 1e-5 * index, 0.0, 0.0],  # no two surfaces in one place
        rgba=FRONT if ahead else BOOM,
        contype=0,
        conaffinity=0,
        mass=0.0,
    )
