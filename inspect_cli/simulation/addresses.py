"""Where the numbers of a vehicle stand in MuJoCo's arrays, looked up by name.

Whatever a vehicle states that its model or its records do not have is refused here, before
anything is written past the end of an array.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import mujoco
import numpy as np

from inspect_cli.errors import InputError, Problem
from inspect_cli.interfaces import TOOL
from inspect_cli.records import Lengths
from inspect_cli.simulation.world import CONTACT_SENSOR, PROTECTED_SENSOR
from inspect_cli.spatial.arrays import Indices
from inspect_cli.vehicles.actuators import Actuator, Drive, Rotor, Servo, of_kind
from inspect_cli.vehicles.contacts import Contact
from inspect_cli.vehicles.kinds import Vehicle


class Addresses(NamedTuple):
    """Indices into MuJoCo's arrays, in the order of the records' arrays."""

    rotors: Indices
    """Actuators (n_rotors,); also their places in ``ctrl``."""
    rotor_activations: Indices
    servos: Indices
    """Actuators (n_servos,)."""
    drives: Indices
    """Actuators (n_drives,)."""
    drive_angles: Indices
    """Places (n_drives,) of their joints in ``qpos``."""
    angles: Indices
    """Places (n_joints,) of the joints in ``qpos``."""
    rates: Indices
    """Places (n_joints,) of the joints in ``qvel``."""
    tool_forces: Indices
    """Places in ``sensordata`` of the force that each geom of the tool's contact exerts, W."""
    protected_forces: Indices
    """Likewise of each protected body."""


def addresses_of(model: mujoco.MjModel, vehicle: Vehicle, lengths: Lengths) -> Addresses:
    """Look up what the vehicle states.

    Raises:
        InputError: a name that the model does not have, a name stated twice, an actuator on
            another joint than stated, or records whose arrays have another length.
    """
    problems = _misfits(model, vehicle, lengths)
    if problems:
        raise InputError(problems)
    rotors = _ids(model, of_kind(vehicle.actuators, Rotor))
    servos = _ids(model, of_kind(vehicle.actuators, Servo))
    drives = _ids(model, of_kind(vehicle.actuators, Drive))
    joints = np.array([model.joint(name).id for name in vehicle.joints], np.int32)
    return Addresses(
        rotors,
        model.actuator_actadr[rotors],
        servos,
        drives,
        model.jnt_qposadr[model.actuator_trnid[drives, 0]],
        model.jnt_qposadr[joints],
        model.jnt_dofadr[joints],
        contact_addresses(model, tool_contact(vehicle)),
        _sensors(model, [PROTECTED_SENSOR + body for body in vehicle.bodies.protected]),
    )


def _ids(model: mujoco.MjModel, actuators: Sequence[Actuator]) -> Indices:
    return np.array([model.actuator(actuator.name).id for actuator in actuators], np.int32)


def tool_contact(vehicle: Vehicle) -> Contact:
    """The contact whose frame is the tool's."""
    return next(contact for contact in vehicle.contacts if contact.frame == TOOL)


def contact_addresses(model: mujoco.MjModel, contact: Contact) -> Indices:
    """Places (n_geoms,) in ``sensordata`` of a contact's wrenches; see ``world.WRENCH``."""
    return _sensors(model, [CONTACT_SENSOR + geom for geom in contact.geoms])


def _sensors(model: mujoco.MjModel, names: Sequence[str]) -> Indices:
    return np.array([model.sensor(name).adr[0] for name in names], dtype=np.int32)


def _misfits(model: mujoco.MjModel, vehicle: Vehicle, lengths: Lengths) -> list[Problem]:
    names = {
        "body": (
            mujoco.mjtObj.mjOBJ_BODY,
            [vehicle.bodies.base, *vehicle.bodies.gear, *vehicle.bodies.protected],
        ),
        "site": (mujoco.mjtObj.mjOBJ_SITE, [*vehicle.frames]),
        "joint": (mujoco.mjtObj.mjOBJ_JOINT, [*vehicle.joints]),
        "actuator": (mujoco.mjtObj.mjOBJ_ACTUATOR, [a.name for a in vehicle.actuators]),
    }
    problems = []
    for what, (kind, stated) in names.items():
        problems += _missing(model, what, kind, stated)
        problems += [
            Problem(f"the vehicle states the {what} '{name}' {stated.count(name)} times")
            for name in sorted({n for n in stated if stated.count(n) > 1})
        ]
    problems += _wrong_references(vehicle)
    problems += _wrong_lengths(vehicle, lengths)
    return problems or _wrong_model(model, vehicle)


def _missing(
    model: mujoco.MjModel, what: str, kind: mujoco.mjtObj, stated: Sequence[str]
) -> list[Problem]:
    lost = [name for name in stated if mujoco.mj_name2id(model, kind, name) < 0]
    if not lost:
        return []
    count = {"body": model.nbody, "site": model.nsite, "joint": model.njnt, "actuator": model.nu}
    known = ", ".join(mujoco.mj_id2name(model, kind, k) or "?" for k in range(count[what]))
    return [
        Problem(f"the vehicle states the {what} '{name}', which its model does not have",
                hint=f"the model's are: {known}")
        for name in lost
    ]  # fmt: skip


def _wrong_references(vehicle: Vehicle) -> list[Problem]:
    """Joints and frames that a part of the vehicle names and the vehicle does not state."""
    problems = []
    joints, frames = ", ".join(vehicle.joints), ", ".join(vehicle.frames)
    named = [(a.name, a.joint) for a in vehicle.actuators if not isinstance(a, Rotor)]
    named += [("a posture", joint) for joint in vehicle.posture_joints]
    problems += [
        Problem(f"{name} names the joint '{joint}'", hint=f"the vehicle's joints are: {joints}")
        for name, joint in named
        if joint not in vehicle.joints
    ]
    problems += [
        Problem(
            f"contact '{contact.name}' names the frame '{contact.frame}'",
            hint=f"the vehicle's frames are: {frames}",
        )
        for contact in vehicle.contacts
        if contact.frame not in vehicle.frames
    ]
    if TOOL not in [contact.frame for contact in vehicle.contacts]:
        problems.append(Problem(f"no contact of the vehicle has the frame '{TOOL}'"))
    return problems


def _wrong_lengths(vehicle: Vehicle, lengths: Lengths) -> list[Problem]:
    stated = {
        "n_rotors": [a.name for a in of_kind(vehicle.actuators, Rotor)],
        "n_servos": [a.name for a in of_kind(vehicle.actuators, Servo)],
        "n_drives": [a.name for a in of_kind(vehicle.actuators, Drive)],
        "n_joints": [*vehicle.joints],
        "n_arm": [*vehicle.posture_joints],
    }
    return [
        Problem(
            f"{name} of the records is {lengths.get(name, 0)}, but the vehicle states "
            f"{len(parts)}: {', '.join(parts) or 'none'}"
        )
        for name, parts in stated.items()
        if lengths.get(name, 0) != len(parts)
    ]


def _wrong_model(model: mujoco.MjModel, vehicle: Vehicle) -> list[Problem]:
    """What every name in the model still leaves open: the free joint and the transmissions."""
    base, problems = vehicle.bodies.base, []
    first = model.body(base).jntadr[0]
    if first != 0 or model.jnt_type[0] != mujoco.mjtJoint.mjJNT_FREE:
        problems.append(Problem(f"the model's first joint is not the free joint of '{base}'"))
    for actuator in vehicle.actuators:
        row = model.actuator(actuator.name)
        if isinstance(actuator, Rotor):
            target = "a site"
            acts = row.trntype[0] == mujoco.mjtTrn.mjTRN_SITE
        else:
            target = f"the joint '{actuator.joint}'"
            acts = (
                row.trntype[0] == mujoco.mjtTrn.mjTRN_JOINT
                and model.joint(int(row.trnid[0])).name == actuator.joint
            )
        if not acts:
            problems.append(Problem(f"actuator '{actuator.name}' does not act on {target}"))
        if model.actuator_actnum[row.id] != 1:
            problems.append(Problem(f"actuator '{actuator.name}' has no activation that lags"))
    free = set(range(model.nu)) - {model.actuator(a.name).id for a in vehicle.actuators}
    problems += [
        Problem(f"the vehicle does not state its model's actuator '{model.actuator(k).name}'")
        for k in sorted(free)
    ]
    return problems
