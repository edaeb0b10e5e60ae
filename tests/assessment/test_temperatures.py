"""Readings at temperatures of their own."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.electrodes import basis_of
from inspect_cli.assessment.temperatures import standardised
from inspect_cli.assessment.uncertainty import temperature_sd_v


def test_each_reading_is_corrected_by_its_own_temperature_and_as_sure_as_that() -> None:
    celsius = [5.0, 20.0, np.nan, 27.0]
    potential, basis, deviation = standardised(np.full(4, -0.3), "CSE", celsius)
    # 0.9 mV/°C (5 − 22.2) = −15.48 mV; within 22.2 ± 5.5 °C, and where it is not known, nothing.
    np.testing.assert_allclose(potential, [-0.31548, -0.3, -0.3, -0.3], atol=1e-12)
    # u = 0.9 mV/°C a/√3 with a = 1, 2.2, 5.5 and 4.8 °C.
    expected = 0.9e-3 * np.array([1.0, 2.2, 5.5, 4.8]) / np.sqrt(3.0)
    np.testing.assert_allclose(deviation, expected, rtol=1e-9)
    assert basis.own_temperatures_c == (5.0, 27.0)
    assert basis.own_corrections_mv == (-15.48, 0.0)
    assert basis.without_temperature == 1
    assert temperature_sd_v(basis) == 0.0


def test_opposite_corrections_do_not_cancel_in_what_is_said() -> None:
    _, basis, deviation = standardised([-0.3, -0.3], "CSE", [5.0, 39.4])
    assert basis.own_corrections_mv == (-15.48, 15.48)
    assert (deviation > 0.0).all()


@pytest.mark.parametrize("celsius", [np.nan, 12.0, 22.2])
def test_one_temperature_for_all_stands_in_the_basis(celsius: float) -> None:
    _, basis, deviation = standardised([-0.3, -0.2], "CSE", [celsius, celsius])
    assert basis == basis_of("CSE", None if np.isnan(celsius) else celsius)
    assert (deviation == 0.0).all()


def test_another_electrode_is_converted_and_not_corrected() -> None:
    potential, basis, _ = standardised([-0.3, -0.3], "SCE", [5.0, 39.4])
    np.testing.assert_allclose(potential, [-0.375, -0.375], atol=1e-12)
    assert basis.own_corrections_mv == (0.0, 0.0)


def test_no_readings_at_all() -> None:
    potential, basis, deviation = standardised([], "CSE", [])
    assert len(potential) == len(deviation) == 0
    assert basis.temperature_c is None
