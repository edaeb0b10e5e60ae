"""A vehicle whose bodies have other names, with two contacts, can be drawn all the same."""

from __future__ import annotations

from types import SimpleNamespace

import mujoco
import numpy as np
from crawler_models import crawler

from inspect_cli.records import Command, Estimate, Record, State
from inspect_cli.scene.materials import FRONT
from inspect_cli.scene.motion import motion_of
from inspect_cli.scene.visual_model import visual_model


def test_every_rotor_has_its_ring_and_every_contact_its_colour() -> None:
    vehicle = crawler()
    plain, model = vehicle.nominal_spec().compile(), visual_model(vehicle).compile()
    assert model.nq == plain.nq
    np.testing.assert_allclose(model.body_mass, plain.body_mass)
    rings = np.flatnonzero(model.geom_type == mujoco.mjtGeom.mjGEOM_MESH)
    assert len(rings) == 6
    for contact in vehicle.contacts:
        for geom in contact.geoms:
            np.testing.assert_allclose(model.geom(geom).rgba, FRONT, atol=1e-6)


def log_of(**rows: np.ndarray) -> SimpleNamespace:
    """A log that holds these records by name."""
    return SimpleNamespace(rows=lambda kind: rows.get(kind.__name__))


def rows_of(kind: type[Record], lengths: dict[str, int], **values: np.ndarray) -> np.ndarray:
    rows = np.zeros(5, kind.dtype(lengths))
    rows["t_s"], rows["q_WB"][:, 0] = np.arange(5), 1.0
    for name, value in values.items():
        rows[name] = value
    return rows


def test_joints_are_drawn_by_their_names_whatever_their_order() -> None:
    vehicle = crawler()
    vehicle.joints = ("wheel", "hinge")
    model, lengths = vehicle.nominal_spec().compile(), vehicle.capabilities.lengths
    state = rows_of(State, lengths, joint_angle=np.array([0.7, 0.2]))
    motion = motion_of(log_of(State=state), model, vehicle)
    np.testing.assert_array_equal(motion.qpos[:, model.joint("wheel").qposadr[0]], 0.7)
    np.testing.assert_array_equal(motion.qpos[:, model.joint("hinge").qposadr[0]], 0.2)


def test_without_the_truth_a_joint_that_nobody_commands_is_drawn_at_zero() -> None:
    vehicle = crawler()
    model, lengths = vehicle.nominal_spec().compile(), vehicle.capabilities.lengths
    estimate = rows_of(Estimate, lengths, p_WB=np.array([1.0, 2.0, 3.0]))
    command = np.zeros(5, Command.dtype(lengths))
    motion = motion_of(log_of(Estimate=estimate, Command=command), model, vehicle)
    assert motion.source == "estimate"
    np.testing.assert_array_equal(motion.qpos[:, :3], estimate["p_WB"])
    np.testing.assert_array_equal(motion.qpos[:, 7:], 0.0)
