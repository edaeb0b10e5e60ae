"""A vehicle whose bodies have other names, with two contacts, can be drawn all the same."""

from __future__ import annotations

import mujoco
import numpy as np
from pitching_crawler import PitchingCrawler

from inspect_cli.scene.materials import FRONT
from inspect_cli.scene.visual_model import visual_model


def test_every_rotor_has_its_ring_and_every_contact_its_colour() -> None:
    vehicle = PitchingCrawler()
    plain, model = vehicle.nominal_spec().compile(), visual_model(vehicle).compile()
    assert model.nq == plain.nq
    np.testing.assert_allclose(model.body_mass, plain.body_mass)
    rings = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)
    assert len(rings) == 6
    for contact in vehicle.contacts:
        for geom in contact.geoms:
            np.testing.assert_allclose(model.geom(geom).rgba, FRONT, atol=1e-6)
