"""Signs and sizes of conversions between electrodes and temperatures."""

from __future__ import annotations

import numpy as np
import pytest

from inspect_cli.assessment.electrodes import (
    ELECTRODES,
    as_evaluated,
    basis_of,
    conversion_v,
    electrode_name,
    electrode_shift_v,
    temperature_correction_v,
    to_cse,
    to_standard,
)
from inspect_cli.errors import InputError


@pytest.mark.parametrize(
    ("electrode", "shift_mv"),
    [
        ("CSE", 0.0),
        ("SCE", -75.0),
        ("Ag/AgCl sat. KCl", -119.0),
        ("Ag/AgCl 1 M KCl", -80.0),
        ("Ag/AgCl 0.1 M KCl", -26.5),
    ],
)
def test_conversion_to_cse(electrode: str, shift_mv: float) -> None:
    assert 1e3 * conversion_v(electrode) == pytest.approx(shift_mv, abs=1e-9)
    np.testing.assert_allclose(
        to_cse([-0.300, np.nan], electrode), [-0.300 + 1e-3 * shift_mv, np.nan], atol=1e-12
    )


@pytest.mark.parametrize("electrode", ELECTRODES)
def test_a_steel_has_one_potential_whatever_it_is_read_with(electrode: str) -> None:
    """The steel's potential on the hydrogen scale is the reading plus the electrode's own."""
    steel_she = -0.040
    reading = steel_she - ELECTRODES[electrode]
    assert float(to_cse(reading, electrode)) == pytest.approx(steel_she - 0.316, abs=1e-12)


@pytest.mark.parametrize("plain", ["Ag/AgCl", "ag/agcl", "Ag / AgCl", "Ag/AgCl 3 M KCl"])
def test_silver_chloride_must_say_its_filling(plain: str) -> None:
    with pytest.raises(InputError, match="how it is filled") as refusal:
        electrode_name(plain)
    for name in ELECTRODES:
        assert name in str(refusal.value)


def test_an_unknown_electrode_is_refused_with_the_choices() -> None:
    with pytest.raises(InputError, match="no reference electrode 'zinc'") as refusal:
        conversion_v("zinc")
    assert "CSE, SCE, Ag/AgCl sat. KCl" in str(refusal.value)


@pytest.mark.parametrize(
    ("given", "name"),
    [("cse", "CSE"), ("ag/agcl SAT. kcl", "Ag/AgCl sat. KCl"), ("Ag/AgCl 1M", "Ag/AgCl 1 M KCl")],
)
def test_case_and_spaces_do_not_matter(given: str, name: str) -> None:
    assert electrode_name(given) == name


@pytest.mark.parametrize(
    ("temperature_c", "correction_mv"),
    [
        (0.0, -19.98),
        (16.69, -4.959),
        (16.7, 0.0),
        (22.2, 0.0),
        (27.7, 0.0),
        (27.71, 4.959),
        (32.2, 9.0),
        (49.0, 24.12),
    ],
)
def test_temperature_correction(temperature_c: float, correction_mv: float) -> None:
    correction = temperature_correction_v(temperature_c)
    assert 1e3 * correction == pytest.approx(correction_mv, abs=1e-9)


def test_the_sign_is_that_of_the_electrodes_own_change() -> None:
    """A CSE's potential grows by 0.9 mV/°C: the same steel reads more negative when it is warm."""
    steel_she, temperature_c = -0.040, 40.0
    reading = steel_she - (0.316 + 0.9e-3 * (temperature_c - 22.2))
    corrected = reading + temperature_correction_v(temperature_c)
    assert corrected == pytest.approx(steel_she - 0.316, abs=1e-12)


@pytest.mark.parametrize("temperature_c", [-0.1, 49.1, float("nan")])
def test_temperatures_beyond_the_standards_range_are_refused(temperature_c: float) -> None:
    with pytest.raises(InputError, match="0 to 49"):
        temperature_correction_v(temperature_c)


def test_the_basis_says_what_was_done() -> None:
    warm = basis_of("CSE", 32.2)
    assert (warm.conversion_mv, warm.temperature_correction_mv, warm.temperature_why) == (
        0,
        9.0,
        "",
    )
    assert float(to_standard(-0.359, warm)) == pytest.approx(-0.350, abs=1e-12)
    mild = basis_of("sce", 20.0)
    assert (mild.electrode, mild.conversion_mv, mild.temperature_correction_mv) == ("SCE", -75.0, 0)
    assert "negligible" in mild.temperature_why
    assert "not known" in basis_of("CSE").temperature_why


def test_the_standards_coefficient_is_not_applied_to_other_electrodes() -> None:
    cold = basis_of("SCE", 5.0)
    assert cold.temperature_correction_mv == 0.0
    assert "coefficient of a CSE" in cold.temperature_why
    with pytest.raises(InputError):
        basis_of("SCE", 60.0)


@pytest.mark.parametrize("electrode", ELECTRODES)
@pytest.mark.parametrize("temperature_c", [2.0, 35.0])
def test_what_an_electrode_reads_comes_back(electrode: str, temperature_c: float) -> None:
    """Beyond the negligible band, any electrode's reading is evaluated as the same potential."""
    standard_v = -0.31
    cse_v = standard_v - 0.9e-3 * (temperature_c - 22.2)  # what a CSE at T reads
    read_v = cse_v + electrode_shift_v(electrode, temperature_c)
    basis = basis_of(electrode, temperature_c)
    assert to_standard(read_v, basis) == pytest.approx(standard_v, abs=1e-12)
    assert as_evaluated(cse_v, basis) == pytest.approx(standard_v, abs=1e-12)


@pytest.mark.parametrize("electrode", ELECTRODES)
def test_at_an_unknown_temperature_the_conversion_alone_is_undone(electrode: str) -> None:
    read_v = -0.31 + electrode_shift_v(electrode)
    assert to_cse(read_v, electrode) == pytest.approx(-0.31, abs=1e-12)
    assert as_evaluated(-0.31, basis_of(electrode)) == pytest.approx(-0.31, abs=1e-12)


def test_with_a_cse_nothing_moves_by_a_single_digit() -> None:
    given = np.random.default_rng(1).uniform(-0.6, 0.1, 1000)
    np.testing.assert_array_equal(as_evaluated(given, basis_of("CSE")), given)
    np.testing.assert_array_equal(to_standard(given, basis_of("CSE", 25.0)), given)
