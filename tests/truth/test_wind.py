"""The wind: drag in closed form, gusts against the analytic Dryden spectra."""

from __future__ import annotations

from itertools import pairwise

import numpy as np
import pytest
from loads import disturbances, motion
from scipy.integrate import quad
from scipy.linalg import expm
from scipy.signal import welch
from scipy.spatial.transform import Rotation

from inspect_cli.schema.disturbances import Gust, Wind
from inspect_cli.truth.disturbances import dryden

RHO = 1.225
AREA = (0.05, 0.08, 0.12)
FOOT = 0.3048
STEP_S = 0.02
SPEED = 3.0
Array = np.ndarray


def calm(**changes: object) -> Wind:
    numbers = {"mean_mps": (3.0, 0.0, 0.0), "drag_area_m2": AREA, "ramp_s": 0.0}
    return Wind(kind="wind", **(numbers | changes))


def test_along_an_axis_it_is_half_rho_v_squared_c_d_a() -> None:
    for axis in range(3):
        mean = 4.0 * np.eye(3)[axis]
        load = disturbances(calm(mean_mps=tuple(mean))).act(0.0, motion())
        np.testing.assert_allclose(load.force_W, 0.5 * RHO * 4.0 * AREA[axis] * mean)
        np.testing.assert_array_equal(load.record.wind_W, mean)
        assert not load.torque_B.any()
        assert not load.force_tip_W.any()


def test_it_drags_at_the_body_as_it_is_turned_and_as_it_moves() -> None:
    turn = Rotation.from_euler("zyx", [40, -25, 70], degrees=True)
    velocity = np.array([1.0, -2.0, 0.5])
    here = motion(q_WB=turn.as_quat()[[3, 0, 1, 2]], v_WB_W=velocity)
    load = disturbances(calm()).act(0.0, here)
    relative = np.array([3.0, 0.0, 0.0]) - velocity
    axes = turn.as_matrix()
    expected = sum(
        0.5 * RHO * np.linalg.norm(relative) * AREA[k] * (relative @ axes[:, k]) * axes[:, k]
        for k in range(3)
    )
    np.testing.assert_allclose(load.force_W, expected, atol=1e-12)
    assert load.force_W @ relative > 0.0  # drag takes energy out of the relative motion


def test_carried_along_with_the_wind_it_feels_none() -> None:
    load = disturbances(calm()).act(0.0, motion(v_WB_W=(3.0, 0.0, 0.0)))
    np.testing.assert_array_equal(load.force_W, 0.0)


def test_it_rises_over_its_ramp_and_is_no_still_air_before() -> None:
    wind = disturbances(calm(start_s=2.0, ramp_s=2.0))
    moving = motion(v_WB_W=(0.0, 1.0, 0.0))
    np.testing.assert_array_equal(wind.act(1.9, moving).force_W, 0.0)
    np.testing.assert_allclose(wind.act(3.0, moving).record.wind_W, [1.5, 0.0, 0.0])
    np.testing.assert_allclose(wind.act(9.0, moving).record.wind_W, [3.0, 0.0, 0.0])


@pytest.mark.parametrize(
    ("altitude_ft", "along_ft", "ratio"),
    # By hand from h/(0.177 + 0.000823 h)^1.2 and (0.177 + 0.000823 h)^−0.4; at 1000 ft the
    # standard's boundary: both are h and 1.
    [(10.0, 75.6, 1.963), (100.0, 505.2, 1.716), (1000.0, 1000.0, 1.0)],
)
def test_scales_and_strengths_at_some_heights(
    altitude_ft: float, along_ft: float, ratio: float
) -> None:
    found = dryden.scales(7.7, altitude_ft * FOOT)
    np.testing.assert_allclose(found.length_m / FOOT, [along_ft, along_ft, altitude_ft], rtol=1e-3)
    np.testing.assert_allclose(found.sigma_mps, [0.77 * ratio, 0.77 * ratio, 0.77], rtol=1e-3)


def spectrum(axis: int, omega: Array, sigma: float, length: float) -> Array:
    """One-sided in ω, (m/s)²/(rad/s), as the standard prints it with Ω = ω/V."""
    a = length * omega / SPEED
    if axis == 0:
        return sigma**2 * 2.0 * length / (np.pi * SPEED) / (1.0 + a**2)
    return sigma**2 * length / (np.pi * SPEED) * (1.0 + 3.0 * a**2) / (1.0 + a**2) ** 2


@pytest.fixture(scope="module")
def gusts() -> tuple[dryden.Scales, Array]:
    """Two hours of gusts, (n, 3)."""
    scales = dryden.scales(3.0, 10.0 * FOOT)
    turbulence = dryden.Turbulence(scales, SPEED, STEP_S, np.random.default_rng(5))
    return scales, np.array([turbulence.step() for _ in range(round(7200 / STEP_S))])


def test_the_variance_is_the_standards(gusts: tuple[dryden.Scales, Array]) -> None:
    """A mean square over T has a relative σ of √(2 τ/T) or less: τ = 7.7 s, 7.7 s, 1.0 s."""
    scales, samples = gusts
    error = np.mean(samples**2, axis=0) / scales.sigma_mps**2 - 1.0
    bound = 3.0 * np.sqrt(2.0 * scales.length_m / SPEED / 7200.0)
    assert (np.abs(error) < bound).all()
    for axis in range(3):
        arguments = (axis, scales.sigma_mps[axis], scales.length_m[axis])
        area, _ = quad(lambda w, a=arguments: spectrum(a[0], w, a[1], a[2]), 0.0, np.inf)
        assert area == pytest.approx(scales.sigma_mps[axis] ** 2, rel=1e-6)


def test_the_three_are_independent(gusts: tuple[dryden.Scales, Array]) -> None:
    correlation = np.corrcoef(gusts[1].T)
    assert np.abs(correlation - np.eye(3)).max() < 3.0 * np.sqrt(2.0 * 7.7 / 7200.0)


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_the_spectrum_is_drydens(gusts: tuple[dryden.Scales, Array], axis: int) -> None:
    """Welch's estimate in thirds of a decade, up to a tenth of the sampling rate.

    With n windows in a band its relative σ is about 1/√n; 3 σ and 3 % for the Hann window's leak.
    """
    scales, samples = gusts
    length = 2**14  # 5.5 minutes
    hz, density = welch(samples[:, axis], 1.0 / STEP_S, nperseg=length)
    windows = len(samples) / length
    analytic = (
        2.0
        * np.pi
        * spectrum(axis, 2.0 * np.pi * hz, scales.sigma_mps[axis], scales.length_m[axis])
    )
    edges = np.geomspace(0.01, 5.0, 9)
    for low, high in pairwise(edges):
        band = (hz >= low) & (hz < high)
        ratio = density[band].mean() / analytic[band].mean()
        assert abs(ratio - 1.0) < 3.0 / np.sqrt(windows * band.sum()) + 0.03, (low, high)


@pytest.mark.parametrize("delta", [1e-4, 0.013, 0.7, 3.0])
def test_a_step_is_exact(delta: float) -> None:
    """Transition and noise of one step against the matrix exponential (Van Loan, 1978)."""
    A, B = np.array([[-1.0, 0.0], [1.0, -1.0]]), np.array([[1.0], [0.0]])
    block = np.block([[-A, B @ B.T], [np.zeros((2, 2)), A.T]])
    exponential = expm(block * delta)
    transition = exponential[2:, 2:].T
    covariance = transition @ exponential[:2, 2:]
    deltas = np.full(3, delta)

    def stepped(z: Array, noise: Array) -> Array:
        states = np.tile(z, (3, 1))
        dryden.advance(states, deltas, np.tile(noise, (3, 1)))
        return states[1]

    nothing = np.zeros(2)
    found = np.column_stack([stepped(e, nothing) for e in np.eye(2)])
    root = np.column_stack([stepped(nothing, e) for e in np.eye(2)])
    np.testing.assert_allclose(found, transition, atol=1e-12)
    np.testing.assert_allclose(root @ root.T, covariance, atol=1e-14, rtol=1e-6)


def test_gusts_blow_along_the_mean_wind_and_repeat_with_the_seed() -> None:
    """A wind to −y: u is along −y and has the longer memory; the same seed gives the same air."""
    wind = calm(mean_mps=(0.0, -SPEED, 0.0), gust=Gust(w20_mps=3.0))
    air, again = disturbances(wind, seed=4), disturbances(wind, seed=4)
    felt = np.array([air.act(t / 250, motion()).record.wind_W.copy() for t in range(2000)])
    repeated = np.array([again.act(t / 250, motion()).record.wind_W.copy() for t in range(2000)])
    np.testing.assert_array_equal(felt, repeated)
    turbulence = dryden.Turbulence(
        dryden.scales(3.0, 10.0 * FOOT), SPEED, 1.0 / 250.0, np.random.default_rng(4)
    )
    u, v, w = np.array([turbulence.step() for _ in range(2000)]).T
    np.testing.assert_allclose(felt, np.column_stack([v, -SPEED - u, w]), atol=1e-12)
