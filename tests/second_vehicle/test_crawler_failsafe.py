"""What a pitching crawler does when it is not where it shall be."""

from __future__ import annotations

from types import SimpleNamespace

import numpy as np
from crawler_models import crawler

from inspect_cli.autonomy.executive import Executive
from inspect_cli.autonomy.modes import Order
from inspect_cli.interfaces import Posture
from inspect_cli.schema.plan import PostureModel

START = PostureModel(p_WB=(0.0, 0.0, 1.0), q_WB=(1.0, 0.0, 0.0, 0.0), arm_angle_rad=(0.0,))


def test_a_lost_vehicle_gives_up():
    vehicle = crawler()
    plan = SimpleNamespace(start=START, legs=(), targets=())
    stack = vehicle.flight_stack(plan)
    stack.estimate.p_WB = START.p_WB
    executive = Executive(vehicle.behaviour, vehicle.behaviour.context(plan, stack, {}), 60.0)
    there = Posture(np.array([0.0, 0.0, 1.0]), np.array([1.0, 0.0, 0.0, 0.0]), np.zeros(1))
    executive.submit(Order("hovering", postures=(there,), speed_mps=0.5))
    executive.update(0.0)
    executive.update(0.4)
    assert executive.mode.name == "hovering"
    stack.estimate.p_WB = (0.0, 0.7, 1.0)
    executive.update(0.5)
    assert executive.mode.name == "hovering"  # it may be so for 0.2 s
    executive.update(0.8)
    assert executive.mode.name == "giving_up"
    assert (executive.status, executive.reason) == ("aborted", "far from where it shall be")
