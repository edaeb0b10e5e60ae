"""The true MuJoCo model: the nominal vehicle plus the Truth.

Surfaces become geoms as ``simulation.surface_geoms`` says. Each geom of each of the vehicle's
contacts meets each surface through an explicit contact pair, so that stiffness, damping and
friction are those that are stated. In what follows d is MuJoCo's constant impedance and Â the
inverse inertia that the compiler gives the contact's body.

Point contact: MuJoCo's normal force f obeys δ̈ + b δ̇ + k δ = R f, R = Â (1 − d)/d, δ the depth. A
body of mass m pressed by F then moves like (m + 1/R) δ̈ + (b/R) δ̇ + (k/R) δ = F: a spring and a
damper, and a virtual mass 1/R. A small d makes that mass a few per cent of the vehicle's;
k/R = K and b/R = 2 ζ √(K m) are set by ``solref``, whose negative numbers MuJoCo divides by d.
Friction sticks by the same law without δ: the tip creeps by R/(impratio b) metres per second and
newton, a tenth of a millimetre.

Wheel and patch: d near one makes R small, so that they neither sink nor creep noticeably; b =
2/(d T) and k = 1/(d T)² follow from the settling time T, critically damped. A patch has torsional
friction at each of its points beside the Coulomb friction.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import mujoco
import numpy as np

from inspect_cli.errors import InputError
from inspect_cli.interfaces import TOOL
from inspect_cli.schema.truth import TruePlatform
from inspect_cli.simulation.surface_geoms import add_surfaces
from inspect_cli.spatial.arrays import Vector
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.vehicles.contacts import Contact, PatchContact, PointContact
from inspect_cli.vehicles.kinds import Vehicle

CONTACT_IMPEDANCE = 0.05
"""d of a point contact."""
STIFF_IMPEDANCE = 0.99
"""d of a wheel and of a patch."""
FRICTION_STIFFENING = 1000.0
"""MuJoCo's ``impratio``: how much less friction yields than the normal direction."""
FRICTION_DAMPING_PS = 100.0
"""b of the friction, 1/s; well below the physics rate, so that a stuck tip does not chatter."""
GROUND_FRICTION = 0.8
CONTACT_SENSOR = "contact:"
"""Prefix of the sensors' names that measure all that touches one geom of a contact."""
PROTECTED_SENSOR = "protected:"
"""Prefix of the sensors' names that measure all that touches a protected body."""
WALL_SENSOR = "wall_sensor:"
"""Prefix of the sensors' names that measure the contact of one geom with one surface."""
NET_FORCE = 3
"""MuJoCo's reduction of all contacts to their net force at its centre."""
WRENCH = ("FORCE", "TORQUE", "POS")
"""The fields of a contact sensor: 9 numbers in W, the torque about the position."""


def build_world(
    vehicle: Vehicle, platform: TruePlatform, structure: StructureTruth
) -> mujoco.MjModel:
    """Compile the true world."""
    spec = vehicle.nominal_spec()
    spec.option.impratio = FRICTION_STIFFENING
    _change_masses(spec, platform, vehicle.bodies.base)
    _add_ground(spec)
    touching = _touching(spec, vehicle.contacts)
    met = add_surfaces(spec, structure, touching, vehicle.bodies)
    for contact in vehicle.contacts:
        for geom in contact.geoms:
            for name, surface in zip(met[geom], structure.surfaces, strict=True):
                _add_pair(spec, contact, geom, name, surface.friction)
    _add_contact_sensors(spec, vehicle)
    for geom in touching:
        _add_wall_sensors(spec, structure, geom, met[geom])
    model = spec.compile()
    for contact in vehicle.contacts:
        _set_law(model, vehicle.bodies.base, contact, met)
    return model


def _touching(spec: mujoco.MjSpec, contacts: Sequence[Contact]) -> list[str]:
    """The geoms of all contacts.

    Raises:
        InputError: a geom that the model does not have, or one that stands in two contacts.
    """
    stated = [(contact.name, geom) for contact in contacts for geom in contact.geoms]
    known = [geom.name for geom in spec.geoms if geom.name]
    for name, geom in stated:
        if geom not in known:
            raise InputError(
                f"contact '{name}' names the geom '{geom}', which the model does not have",
                hint=f"the model's are: {', '.join(known)}",
            )
        users = [other for other, its in stated if its == geom]
        if len(users) > 1:
            raise InputError(f"geom '{geom}' stands in the contacts {', '.join(users)}")
    return [geom for _, geom in stated]


def _change_masses(spec: mujoco.MjSpec, platform: TruePlatform, base: str) -> None:
    for body in spec.bodies[1:]:  # the first is the world
        body.mass *= platform.mass_factor
        body.inertia = np.array(body.inertia) * platform.mass_factor
    core = spec.body(base)
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


def _pair_name(geom: str, surface: str) -> str:
    return f"{geom}:{surface}"


def _add_pair(
    spec: mujoco.MjSpec, contact: Contact, geom: str, surface: str, friction: float
) -> None:
    dimensions, torsion = 3, 0.0
    if isinstance(contact, PatchContact):
        dimensions, torsion = 4, friction * contact.torsion_lever_m
    spec.add_pair(
        name=_pair_name(geom, surface),
        geomname1=geom,
        geomname2=surface,
        condim=dimensions,
        friction=[friction, friction, torsion, 0.0, 0.0],
    )


def _add_contact_sensors(spec: mujoco.MjSpec, vehicle: Vehicle) -> None:
    """Net contact of each touching geom and of each protected body with everything.

    The contact of the frame ``tool`` comes first, then the protected bodies, which are all that a
    State needs.
    """
    contacts = sorted(vehicle.contacts, key=lambda contact: contact.frame != TOOL)
    tool, *others = contacts
    for geom in tool.geoms:
        _add_sensor(spec, f"{CONTACT_SENSOR}{geom}", mujoco.mjtObj.mjOBJ_GEOM, geom, WRENCH)
    for body in vehicle.bodies.protected:
        name = f"{PROTECTED_SENSOR}{body}"
        _add_sensor(spec, name, mujoco.mjtObj.mjOBJ_BODY, body, ("FORCE",))
    for contact in others:
        for geom in contact.geoms:
            _add_sensor(spec, f"{CONTACT_SENSOR}{geom}", mujoco.mjtObj.mjOBJ_GEOM, geom, WRENCH)


def _add_sensor(
    spec: mujoco.MjSpec,
    name: str,
    kind: mujoco.mjtObj,
    what: str,
    asked: Sequence[str],
    surface: str | None = None,
) -> None:
    """Measure the net contact of a geom or body, with one surface or with everything."""
    bits = sum(1 << int(getattr(mujoco.mjtConDataField, f"mjCONDATA_{one}")) for one in asked)
    reference = {} if surface is None else {
        "reftype": mujoco.mjtObj.mjOBJ_GEOM, "refname": surface
    }  # fmt: skip
    spec.add_sensor(
        name=name,
        type=mujoco.mjtSensor.mjSENS_CONTACT,
        objtype=kind,
        objname=what,
        intprm=[bits, NET_FORCE, 1],
        **reference,
    )


def _add_wall_sensors(
    spec: mujoco.MjSpec, structure: StructureTruth, geom: str, met: Sequence[str]
) -> None:
    """Measure force and torque of a geom on each surface with a force sensor.

    MuJoCo evaluates them in every step, so that a world without such a surface has none.
    """
    for name, surface in zip(met, structure.surfaces, strict=True):
        if surface.force_sensor is not None:
            sensor = f"{WALL_SENSOR}{_pair_name(geom, name)}"
            _add_sensor(spec, sensor, mujoco.mjtObj.mjOBJ_GEOM, geom, WRENCH, name)


def _set_law(
    model: mujoco.MjModel, base: str, contact: Contact, met: Mapping[str, Sequence[str]]
) -> None:
    """Spring, damper and friction of all pairs of a contact."""
    for geom in contact.geoms:
        for surface in met[geom]:
            pair = model.pair(_pair_name(geom, surface)).id
            if isinstance(contact, PointContact):
                _set_spring(model, base, contact, geom, pair)
            else:
                model.pair_solref[pair] = (contact.settling_s, 1.0)
                model.pair_solimp[pair] = _constant(STIFF_IMPEDANCE)


def _set_spring(
    model: mujoco.MjModel, base: str, contact: PointContact, geom: str, pair: int
) -> None:
    """The damping ratio is that of the whole vehicle."""
    body = model.geom_bodyid[model.geom(geom).id]
    mass = model.body_subtreemass[model.body(base).id]
    share = (1.0 - CONTACT_IMPEDANCE) * model.body_invweight0[body][0]
    damping = 2.0 * contact.damping_ratio * np.sqrt(contact.stiffness_npm * mass)
    model.pair_solref[pair] = (-contact.stiffness_npm * share, -damping * share)
    model.pair_solreffriction[pair] = (0.0, -FRICTION_DAMPING_PS * CONTACT_IMPEDANCE)
    model.pair_solimp[pair] = _constant(CONTACT_IMPEDANCE)


def _constant(impedance: float) -> Vector:
    """MuJoCo's ``solimp`` of an impedance that does not depend on the depth."""
    return np.array([impedance, impedance, 1e-3, 0.5, 2.0])
