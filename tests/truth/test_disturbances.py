"""Disturbances: frames, ramps and sums."""

from __future__ import annotations

import numpy as np
from scipy.spatial.transform import Rotation

from inspect_cli.schema.truth import ConstantWrench
from inspect_cli.truth.disturbances import Disturbances

TURN = Rotation.from_euler("zyx", [40, -25, 70], degrees=True)
Q_WB = TURN.as_quat()[[3, 0, 1, 2]]
FORCE, TORQUE = (1.0, -2.0, 3.0), (0.4, 0.5, -0.6)


def test_in_the_world_the_force_stays_and_the_torque_is_turned_into_the_body() -> None:
    wrench = ConstantWrench(frame="world", force_n=FORCE, torque_nm=TORQUE, ramp_s=0.0)
    force = Disturbances([wrench]).generalized_force(1.0, Q_WB)
    np.testing.assert_allclose(force[:3], FORCE)
    np.testing.assert_allclose(force[3:], TURN.inv().apply(TORQUE), atol=1e-12)


def test_in_the_body_the_force_turns_with_it_and_the_torque_stays() -> None:
    wrench = ConstantWrench(frame="body", force_n=FORCE, torque_nm=TORQUE, ramp_s=0.0)
    force = Disturbances([wrench]).generalized_force(1.0, Q_WB)
    np.testing.assert_allclose(force[:3], TURN.apply(FORCE), atol=1e-12)
    np.testing.assert_allclose(force[3:], TORQUE)


def test_it_rises_linearly_from_its_start_on() -> None:
    wrench = ConstantWrench(force_n=(2.0, 0.0, 0.0), start_s=4.0, ramp_s=2.0)
    one = Disturbances([wrench])
    shares = [one.generalized_force(t, Q_WB)[0] / 2.0 for t in (0.0, 3.99, 4.0, 4.5, 5.0, 6.0, 9.0)]
    np.testing.assert_allclose(shares, [0.0, 0.0, 0.0, 0.25, 0.5, 1.0, 1.0])


def test_without_a_ramp_it_is_there_at_once() -> None:
    wrench = ConstantWrench(force_n=(2.0, 0.0, 0.0), start_s=4.0, ramp_s=0.0)
    assert Disturbances([wrench]).generalized_force(4.0, Q_WB)[0] == 2.0


def test_several_add_up() -> None:
    wrenches = [
        ConstantWrench(force_n=FORCE, ramp_s=0.0),
        ConstantWrench(force_n=FORCE, frame="body", ramp_s=0.0),
    ]
    total = Disturbances(wrenches).generalized_force(1.0, Q_WB)
    alone = [Disturbances([w]).generalized_force(1.0, Q_WB) for w in wrenches]
    np.testing.assert_allclose(total, alone[0] + alone[1])
    assert Disturbances(wrenches).any
    assert not Disturbances([]).any
    np.testing.assert_array_equal(Disturbances([]).generalized_force(1.0, Q_WB), np.zeros(6))
