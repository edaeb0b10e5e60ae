"""Fits against known parameters, against other solvers and against finite differences."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.optimize import least_squares

from inspect_cli.errors import GeometryError
from inspect_cli.spatial.arrays import Points, Structured, Vector
from inspect_cli.spatial.primitives import CYLINDER, PLANE, SPHERE, cylinder, plane
from inspect_cli.structure.fit import CODES, Fit, Kind
from inspect_cli.structure.fitting import fit_primitive
from inspect_cli.structure.least_squares import (
    PARAMETERS,
    frame_of,
    minimised,
    normal_equations,
    residuals,
    stepped,
)
from inspect_cli.structure.synthetic import bench_surface, noisy_cloud

KINDS: tuple[Kind, ...] = ("plane", "sphere", "cylinder")
NOISE_M = 0.003


def true_model(surface: Structured, kind: Kind) -> Vector:
    direction = surface["R_WS"][0][:, 1 if kind == "cylinder" else 2]
    return np.concatenate([surface["p_WS"][0], direction, surface["radius"]])


def errors_in_sd(fit: Fit, surface: Structured) -> Vector:
    """The true parameters' distance from the fitted ones, in standard deviations."""
    p, d, r = np.split(true_model(surface, fit.kind), [3, 6])
    d = d * np.sign(d @ fit.direction)
    E = fit.frame
    if fit.kind == "plane":
        delta = [(p - fit.point_m) @ fit.direction, *(d @ E[:, :2])]
    elif fit.kind == "sphere":
        delta = [*(p - fit.point_m), r[0] - fit.radius_m]
    else:
        # Where the true axis passes the height of the fitted point.
        foot = p + ((fit.point_m - p) @ fit.direction) / (d @ fit.direction) * d
        delta = [*((foot - fit.point_m) @ E[:, :2]), *(d @ E[:, :2]), r[0] - fit.radius_m]
    return np.abs(delta) / np.array(list(fit.parameter_sd.values()))


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("seed", range(5))
def test_known_surface_among_outliers(kind: Kind, seed: int) -> None:
    surface = bench_surface(kind)
    cloud = noisy_cloud(surface, 20_000, NOISE_M, 0.3, np.random.default_rng(seed))
    fit = fit_primitive(cloud, kind, 0.02, np.random.default_rng(100 + seed))
    assert abs(fit.radius_m - surface["radius"][0]) < 0.5e-3
    assert fit.rms_m == pytest.approx(NOISE_M, rel=0.05)
    # 30 % outliers of which the band of ±20 mm holds a few.
    assert 0.69 < np.mean(fit.inliers) < 0.75
    assert np.all(errors_in_sd(fit, surface) < 4.5)


@pytest.mark.parametrize("kind", KINDS)
def test_standard_deviations_are_those_over_many_clouds(kind: Kind) -> None:
    surface = bench_surface(kind)
    squares = []
    for seed in range(40):
        cloud = noisy_cloud(surface, 1500, NOISE_M, 0.0, np.random.default_rng(seed))
        fit = fit_primitive(cloud, kind, 0.02, np.random.default_rng(seed))
        squares.append(errors_in_sd(fit, surface) ** 2)
    # χ² / 40 has a standard deviation of √(2/40) = 0.22; four of it either way.
    mean_square = np.mean(squares, axis=0)
    assert np.all(mean_square > 0.35)
    assert np.all(mean_square < 1.9)


@pytest.mark.parametrize("kind", KINDS)
def test_the_minimum_is_that_of_another_solver(kind: Kind) -> None:
    cloud = noisy_cloud(bench_surface(kind), 1500, NOISE_M, 0.2, np.random.default_rng(8))
    fit = fit_primitive(cloud, kind, 0.02, np.random.default_rng(1))
    used = cloud[fit.used]

    def distances(x: Vector) -> Vector:
        if kind == "plane":
            return used @ x[:3] / np.linalg.norm(x[:3]) - x[3]
        if kind == "sphere":
            return np.linalg.norm(used - x[:3], axis=1) - x[3]
        return (
            np.linalg.norm(np.cross(used - x[:3], x[3:6] / np.linalg.norm(x[3:6])), axis=1) - x[6]
        )

    if kind == "plane":
        start = [*fit.direction, fit.direction @ fit.point_m]
    elif kind == "sphere":
        start = [*fit.point_m, fit.radius_m]
    else:
        start = [*fit.point_m, *fit.direction, fit.radius_m]
    wrong = np.array(start) + 0.01 * np.arange(len(start))
    solution = least_squares(distances, wrong, xtol=1e-14, ftol=1e-14, gtol=1e-14)
    own = distances(np.array(start))
    assert np.sum(own**2) == pytest.approx(2.0 * solution.cost, rel=1e-6)
    # Both at the minimum: the distances agree far below a standard deviation.
    np.testing.assert_allclose(own, distances(solution.x), atol=1e-6)


def test_plane_is_the_smallest_principal_direction() -> None:
    cloud = noisy_cloud(bench_surface("plane"), 3000, NOISE_M, 0.0, np.random.default_rng(2))
    fit = fit_primitive(cloud, "plane", 0.02, np.random.default_rng(0))
    used = cloud[fit.used]
    normal = np.linalg.svd(used - used.mean(axis=0), full_matrices=False)[2][2]
    assert abs(normal @ fit.direction) == pytest.approx(1.0, abs=1e-10)
    np.testing.assert_allclose(fit.point_m, used.mean(axis=0), atol=1e-6)


@pytest.mark.parametrize("kind", KINDS)
def test_gradient_against_finite_differences(kind: Kind) -> None:
    code = CODES[kind]
    cloud = noisy_cloud(bench_surface(kind), 300, NOISE_M, 0.0, np.random.default_rng(2))
    model = true_model(bench_surface(kind), kind)
    model[:3] += [0.01, 0.02, -0.01]
    frame = frame_of(model[3:6])
    A, g, cost = normal_equations(code, model, frame, cloud, 1.0)
    assert cost == pytest.approx(np.sum(residuals(code, model, cloud) ** 2))
    h = 1e-6
    J = []
    for k in range(PARAMETERS[code]):
        step = np.zeros(5)
        step[k] = h
        ahead = residuals(code, stepped(code, model, frame, step), cloud)
        behind = residuals(code, stepped(code, model, frame, -step), cloud)
        J.append((ahead - behind) / (2.0 * h))
    jacobian = np.array(J).T
    size = PARAMETERS[code]
    np.testing.assert_allclose(A[:size, :size], jacobian.T @ jacobian, rtol=1e-5, atol=1e-4)
    r = residuals(code, model, cloud)
    np.testing.assert_allclose(g[:size], jacobian.T @ r, rtol=1e-5, atol=1e-6)


def test_frame_is_a_rotation_around_its_direction() -> None:
    for direction in (*np.eye(3), *-np.eye(3), *np.random.default_rng(0).normal(size=(20, 3))):
        unit = direction / np.linalg.norm(direction)
        frame = frame_of(unit)
        np.testing.assert_allclose(frame @ frame.T, np.eye(3), atol=1e-14)
        assert np.linalg.det(frame) == pytest.approx(1.0)
        np.testing.assert_array_equal(frame[:, 2], unit)


def test_residuals_by_hand() -> None:
    point = np.array([[3.0, 4.0, 7.0]])
    z_axis = np.array([0.0, 0.0, 0.0, 0.0, 0.0, 1.0, 2.0])
    assert residuals(PLANE, z_axis, point)[0] == pytest.approx(7.0)
    assert residuals(CYLINDER, z_axis, point)[0] == pytest.approx(3.0)
    assert residuals(SPHERE, z_axis, point)[0] == pytest.approx(np.sqrt(74.0) - 2.0)


def test_least_squares_does_not_leave_a_minimum() -> None:
    cloud = noisy_cloud(bench_surface("sphere"), 500, 0.0, 0.0, np.random.default_rng(0))
    exact = true_model(bench_surface("sphere"), "sphere")
    model, cost = minimised(SPHERE, exact, cloud, 0.1, iterations=5)
    np.testing.assert_allclose(model, exact, atol=1e-9)
    assert cost < 1e-20


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("noise_m", [0.0, NOISE_M])
def test_auto_finds_the_kind(kind: Kind, noise_m: float) -> None:
    cloud = noisy_cloud(bench_surface(kind), 5000, noise_m, 0.2, np.random.default_rng(3))
    assert fit_primitive(cloud, "auto", 0.02, np.random.default_rng(0)).kind == kind


def test_auto_takes_a_nearly_flat_cylinder_for_a_plane() -> None:
    for radius, kind in ((250.0, "plane"), (20.0, "cylinder")):
        # 2 m across: the sagitta is 2 mm, below the noise, or 25 mm.
        surface = cylinder([radius, 0, 1], [0, 0, 1], radius, [-1, 0, 0], [2.0, 2.0])
        cloud = noisy_cloud(surface, 5000, NOISE_M, 0.1, np.random.default_rng(3))
        assert fit_primitive(cloud, "auto", 0.05, np.random.default_rng(0)).kind == kind


def test_same_generator_same_fit_and_other_generator_same_surface() -> None:
    cloud = noisy_cloud(bench_surface("cylinder"), 8000, NOISE_M, 0.3, np.random.default_rng(3))
    first, again, other = (
        fit_primitive(cloud, "cylinder", 0.02, np.random.default_rng(s)) for s in (5, 5, 6)
    )
    np.testing.assert_array_equal(first.point_m, again.point_m)
    np.testing.assert_array_equal(first.covariance, again.covariance)
    assert abs(first.radius_m - other.radius_m) < 0.2 * first.parameter_sd["radius_m"]


def test_georeferenced_coordinates_lose_nothing() -> None:
    cloud = noisy_cloud(bench_surface("cylinder"), 4000, NOISE_M, 0.1, np.random.default_rng(3))
    far = np.array([451_234.0, 5_412_345.0, 403.0])
    near_fit = fit_primitive(cloud, "cylinder", 0.02, np.random.default_rng(5))
    far_fit = fit_primitive(cloud + far, "cylinder", 0.02, np.random.default_rng(5))
    assert far_fit.radius_m == pytest.approx(near_fit.radius_m, abs=1e-6)


def line(count: int) -> Points:
    return np.outer(np.linspace(0.0, 2.0, count), [1.0, 2.0, 0.5])


@pytest.mark.parametrize("kind", KINDS)
def test_points_that_span_no_surface_are_refused(kind: Kind) -> None:
    rng = np.random.default_rng(0)
    for cloud in (
        line(3)[:2],
        line(500),
        line(500) + rng.normal(0.0, 1e-3, (500, 3)),
        0 * line(99),
    ):
        with pytest.raises(GeometryError):
            fit_primitive(cloud, kind, 0.02, rng)


def test_points_without_a_surface_are_refused() -> None:
    rng = np.random.default_rng(0)
    with pytest.raises(GeometryError, match="no plane explains the points"):
        fit_primitive(rng.uniform(-5.0, 5.0, (3000, 3)), "plane", 0.01, rng)
    with pytest.raises(GeometryError):
        fit_primitive(line(500), "auto", 0.01, rng)


@pytest.mark.parametrize("kind", ["sphere", "cylinder"])
def test_flat_points_fix_no_radius(kind: Kind) -> None:
    flat = plane([0, 0, 0], [0, 0.1, 1], [1.0, 1.0])
    cloud = noisy_cloud(flat, 3000, 0.002, 0.0, np.random.default_rng(1))
    with pytest.raises(GeometryError):
        fit_primitive(cloud, kind, 0.02, np.random.default_rng(1))
