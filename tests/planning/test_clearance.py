"""Clearance and ways round, against brute force over dense points and fine steps."""

from __future__ import annotations

import numpy as np
import pytest
from builders import array, ball, column, grid, plan, points, wall
from rigid import ArmVehicle, RigidVehicle
from scipy.spatial import cKDTree
from scipy.spatial.transform import Rotation, Slerp

from inspect_cli.interfaces import Posture
from inspect_cli.planning.clearance import Scene, gap_along
from inspect_cli.schema.plan import PlannedSurface
from inspect_cli.spatial.rotations import quaternion_exp, quaternion_normalize

SPACING_M = 0.01


def scene_of(**shapes):
    return Scene.of([PlannedSurface(name=n, shape=s, source="given") for n, s in shapes.items()])


def cloud(shape):
    """Points spread over the patch, from the shape's definition: spacing ≤ SPACING_M."""
    half_u, half_v = np.array(shape.size_m) / 2.0
    u = np.linspace(-half_u, half_u, int(np.ceil(2.0 * half_u / SPACING_M)) + 1)
    v = np.linspace(-half_v, half_v, int(np.ceil(2.0 * half_v / SPACING_M)) + 1)
    u, v = (a.ravel() for a in np.meshgrid(u, v))
    z = np.array(getattr(shape, "normal", None) or shape.facing)
    x = np.array([-z[1], z[0], 0.0]) / np.hypot(z[0], z[1])
    y = np.cross(z, x)
    if shape.kind == "plane":
        local = np.column_stack([u, v, np.zeros_like(u)])
    elif shape.kind == "cylinder":  # upright
        r = shape.radius_m
        local = np.column_stack([r * np.sin(u / r), v, r * np.cos(u / r)])
    else:
        r = shape.radius_m
        local = r * np.column_stack(
            [np.cos(v / r) * np.sin(u / r), np.sin(v / r), np.cos(v / r) * np.cos(u / r)]
        )
    return np.array(shape.center_m) + local @ np.array([x, y, z])


def dense(shapes):
    """All clouds in one tree."""
    return cKDTree(np.concatenate([cloud(shape) for shape in shapes.values()]))


def dense_gap(vehicle, tree, a, b, steps=100):
    """Least distance of the spheres from the clouds over a fine straight path."""
    ends = Rotation.from_quat(np.array([a.q_WB, b.q_WB])[:, [1, 2, 3, 0]])
    slerp = Slerp([0.0, 1.0], ends)
    gap = np.inf
    for share in np.linspace(0.0, 1.0, steps + 1):
        q = slerp(share).as_quat()[[3, 0, 1, 2]]
        arm = a.joint_angle + share * (b.joint_angle - a.joint_angle)
        posture = Posture(a.p_WB + share * (b.p_WB - a.p_WB), quaternion_normalize(q), arm)
        spheres = vehicle.collision_spheres(posture)
        gap = min(gap, float((tree.query(spheres[:, :3])[0] - spheres[:, 3]).min()))
    return gap


@pytest.mark.parametrize("vehicle", [RigidVehicle(), ArmVehicle()], ids=["rigid", "arm"])
def test_gap_against_brute_force(vehicle):
    shapes = {"wall": wall(), "column": column(center=(0.0, 2.0, 1.5)), "ball": ball((0, -3, 1))}
    scene = scene_of(**shapes)
    tree = dense(shapes)
    rng = np.random.default_rng(5)
    for _ in range(12):
        a, b = (
            Posture(
                rng.uniform([-1.0, -1.5, 0.8], [1.4, 1.0, 2.2]),
                quaternion_exp(rng.normal(size=3)),
                rng.uniform(0.3, 2.5, 1) if isinstance(vehicle, ArmVehicle) else np.empty(0),
            )
            for _ in range(2)
        )
        found = gap_along(vehicle, scene, [a, b])
        fine = dense_gap(vehicle, tree, a, b)
        # Below: the fine path and the clouds miss the nearest point by half their spacing.
        # Above: half of a 5 cm step and half of a 5° step at the body's reach of 0.42 m.
        assert found.structure_m >= fine - 0.01
        assert found.structure_m <= fine + 0.025 + 0.42 * np.radians(2.5)


def test_patch_is_an_obstacle_from_both_sides():
    """Behind a wall that is touched from the front there is room again."""
    scene = scene_of(front=wall(), back=wall(center=(2.3, 0.0, 1.5), normal=(1.0, 0.0, 0.0)))
    far = Posture(np.array([4.0, 0.0, 1.5]), np.array([1.0, 0.0, 0.0, 0.0]))
    gap = gap_along(RigidVehicle(), scene, [far, far])
    assert gap.structure_m == pytest.approx(1.7 - 0.42, abs=1e-9)
    assert gap.surface == "back"


def test_path_does_not_slip_through_a_wall():
    a = Posture(np.array([0.0, 0.0, 1.5]), np.array([1.0, 0.0, 0.0, 0.0]))
    b = Posture(np.array([4.0, 0.0, 1.5]), np.array([1.0, 0.0, 0.0, 0.0]))
    gap = gap_along(RigidVehicle(), scene_of(wall=wall()), [a, b])
    assert gap.structure_m < -0.1


def transit_gaps(made, vehicle, shapes):
    """Dense gap of every transit of a plan."""
    tree, end, gaps = dense(shapes), made.start, []
    for leg in made.legs:
        for posture in leg.postures:
            if leg.kind == "transit":
                a, b = (
                    Posture(np.array(m.p_WB), np.array(m.q_WB), np.array(m.arm_angle_rad))
                    for m in (end, posture)
                )
                gaps.append(dense_gap(vehicle, tree, a, b))
            end = posture
    return gaps


LOW = {
    "front": wall(size=(2.0, 1.5)),
    "back": wall(center=(2.3, 0.0, 1.5), normal=(1.0, 0.0, 0.0), size=(2.0, 1.5)),
}
TALL = {
    "front": wall(center=(2.0, 0.0, 2.5), size=(2.0, 4.8)),
    "back": wall(center=(2.3, 0.0, 2.5), normal=(1.0, 0.0, 0.0), size=(2.0, 4.8)),
}


@pytest.mark.parametrize(
    ("shapes", "top_m", "over"), [(LOW, 2.25, True), (TALL, 4.9, False)], ids=["over", "round"]
)
def test_way_from_the_front_to_the_back_of_a_wall(shapes, top_m, over):
    vehicle = RigidVehicle()
    made = plan(vehicle, grid("front", columns=1), grid("back", columns=1), surfaces=shapes)
    assert min(transit_gaps(made, vehicle, shapes)) >= 0.05 - 0.01
    transit = next(leg for leg in made.legs if leg.kind == "transit" and leg.target == 1)
    assert len(transit.postures) > 1
    assert (array(*transit.postures)[:, 2].max() > top_m) == over
    assert any("point 2" in warning for warning in made.warnings)


def test_way_round_a_column():
    vehicle = RigidVehicle()
    shapes = {"column": column(size=(3.1, 4.8), center=(2.0, 0.0, 2.5))}
    sides = points((2.0, 0.5, 2.0), (2.0, -0.5, 2.0), on="column")
    made = plan(vehicle, sides, surfaces=shapes)
    assert min(transit_gaps(made, vehicle, shapes)) >= 0.05 - 0.01


def test_same_plan_twice():
    task = grid(rows=3, columns=3, order="shortest")
    assert plan(RigidVehicle(), task) == plan(RigidVehicle(), task)
