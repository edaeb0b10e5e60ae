"""Sensor faults: which sensor, from when to when, and what NaN spoils."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.records import Probe
from inspect_cli.schema.truth import SensorFault
from inspect_cli.truth.faults import Faults, spoil


@pytest.mark.parametrize(
    ("t_s", "active"), [(0.0, False), (4.999, False), (5.0, True), (6.999, True), (7.0, False)]
)
def test_a_fault_lasts_from_its_start_up_to_its_end(t_s: float, active: bool) -> None:
    faults = Faults([SensorFault(sensor="tof", start_s=5.0, end_s=7.0)])
    assert (faults.active("tof", t_s) is not None) == active
    assert faults.active("pose", t_s) is None


def test_without_an_end_it_lasts_for_ever() -> None:
    faults = Faults([SensorFault(sensor="tof", start_s=5.0)])
    assert faults.active("tof", 1e6) is not None


def test_the_first_of_two_faults_at_a_time_holds() -> None:
    faults = Faults(
        [
            SensorFault(sensor="probe", fault="nan", start_s=1.0, end_s=2.0),
            SensorFault(sensor="probe", fault="off"),
        ]
    )
    early, late = faults.active("probe", 1.5), faults.active("probe", 3.0)
    assert early is not None
    assert late is not None
    assert (early.fault, late.fault) == ("nan", "off")


def test_spoiling_leaves_the_time_alone() -> None:
    probe = Probe.create()
    probe.t_s, probe.force = 3.0, 1.8
    spoil(probe)
    assert probe.t_s == 3.0
    assert np.isnan([probe.potential, probe.resistance, probe.force]).all()
