"""Inertia of a whole vehicle at rest, read off its nominal MuJoCo model."""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.control.impedance import RigidBody


def nominal_body(spec: mujoco.MjSpec) -> RigidBody:
    """Mass, inertia about O_b and centre of mass with every joint at zero.

    The free joint's block of MuJoCo's joint-space inertia is [[m 1, −m [c]×], [m [c]×, I_O]]
    with the body's axes aligned with the world's.
    """
    model = spec.compile()
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    full = np.zeros((model.nv, model.nv))
    mujoco.mj_fullM(model, data, full)
    mass = float(full[0, 0])
    coupling = full[3:6, 0:3] / mass
    com = np.array([coupling[2, 1], coupling[0, 2], coupling[1, 0]])
    return RigidBody(mass, np.ascontiguousarray(full[3:6, 3:6]), com)
