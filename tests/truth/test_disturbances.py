"""Constant disturbances: frames, ramps; and sums of several."""

from __future__ import annotations

import numpy as np
from loads import UPRIGHT, disturbances, motion
from scipy.spatial.transform import Rotation

from inspect_cli.schema.disturbances import Cable, ConstantWrench, Pull, Rope, Wind

TURN = Rotation.from_euler("zyx", [40, -25, 70], degrees=True)
Q_WB = TURN.as_quat()[[3, 0, 1, 2]]
FORCE, TORQUE = (1.0, -2.0, 3.0), (0.4, 0.5, -0.6)


def test_in_the_world_the_force_stays_and_the_torque_is_turned_into_the_body() -> None:
    wrench = ConstantWrench(frame="world", force_n=FORCE, torque_nm=TORQUE, ramp_s=0.0)
    load = disturbances(wrench).act(1.0, motion(q_WB=Q_WB))
    np.testing.assert_allclose(load.force_W, FORCE)
    np.testing.assert_allclose(load.torque_B, TURN.inv().apply(TORQUE), atol=1e-12)


def test_in_the_body_the_force_turns_with_it_and_the_torque_stays() -> None:
    wrench = ConstantWrench(frame="body", force_n=FORCE, torque_nm=TORQUE, ramp_s=0.0)
    load = disturbances(wrench).act(1.0, motion(q_WB=Q_WB))
    np.testing.assert_allclose(load.force_W, TURN.apply(FORCE), atol=1e-12)
    np.testing.assert_allclose(load.torque_B, TORQUE)


def test_it_rises_linearly_from_its_start_on() -> None:
    one = disturbances(ConstantWrench(force_n=(2.0, 0.0, 0.0), start_s=4.0, ramp_s=2.0))
    times = (0.0, 3.99, 4.0, 4.5, 5.0, 6.0, 9.0)
    shares = [one.act(t, motion()).force_W[0] / 2.0 for t in times]
    np.testing.assert_allclose(shares, [0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 1.0])


def test_without_a_ramp_it_is_there_at_once() -> None:
    wrench = ConstantWrench(force_n=(2.0, 0.0, 0.0), start_s=4.0, ramp_s=0.0)
    assert disturbances(wrench).act(4.0, motion()).force_W[0] == 2.0


def test_several_add_up_whatever_they_are() -> None:
    entries = [
        ConstantWrench(force_n=FORCE, ramp_s=0.0),
        ConstantWrench(force_n=FORCE, torque_nm=TORQUE, frame="body", ramp_s=0.0),
        Rope(kind="rope", direction=(0.0, 1.0, 0.0), pulls=(Pull(start_s=0.0, force_n=4.0),)),
        Wind(kind="wind", mean_mps=(3.0, 0.0, 0.0), drag_area_m2=(0.1, 0.1, 0.1)),
        Cable(kind="cable", length_m=5.0, mass_kgpm=0.03),
        Cable(kind="cable", length_m=5.0, mass_kgpm=0.03, attached="body"),
    ]
    together = disturbances(*entries)
    apart = [disturbances(entry) for entry in entries]
    for t_s in (0.0, 0.7, 1.5):
        here = motion(q_WB=Q_WB)
        total, parts = together.act(t_s, here), [one.act(t_s, here) for one in apart]
        for name in ("force_W", "torque_B", "force_tip_W"):
            expected = sum(getattr(part, name) for part in parts)
            np.testing.assert_allclose(getattr(total, name), expected, atol=1e-12)
        for name, view in total.record.views.items():
            np.testing.assert_allclose(view, sum(p.record.views[name] for p in parts), atol=1e-12)
    assert together.any


def test_without_any_there_is_nothing() -> None:
    nothing = disturbances()
    assert not nothing.any
    load = nothing.act(1.0, motion(q_WB=UPRIGHT))
    for acting in (load.force_W, load.torque_B, load.force_tip_W):
        np.testing.assert_array_equal(acting, 0.0)
