"""A vehicle that the pictures know only by its contract is dressed all the same."""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.scene.visual_model import visual_model


def test_every_rotor_has_its_ring(vehicle) -> None:
    plain, model = vehicle.nominal_spec().compile(), visual_model(vehicle).compile()
    assert model.nq == plain.nq
    assert np.allclose(model.body_mass, plain.body_mass)
    rings = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)
    assert len(rings) == 8
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    sites = [model.site(model.actuator_trnid[k, 0]).id for k in range(8)]
    assert np.allclose(data.geom_xpos[rings], data.site_xpos[sites], atol=1e-6)
    assert np.any(model.geom_rgba[model.geom_bodyid == model.body("core").id, 3] == 1.0)
