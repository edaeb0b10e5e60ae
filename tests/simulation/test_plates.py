"""Plates under a sliding, a stuck and a slipping tip, and at the end of a surface."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import mujoco
import numpy as np
import pytest
from scipy.integrate import solve_ivp
from worlds import UPRIGHT, hold_attitude, placed, plant_of, structure_of, vehicle_at, weightless

from inspect_cli.schema.geometry import CylinderShape, Displacement, MeshShape, Shape, SphereShape
from inspect_cli.simulation.plates import BEHIND_M, PARKED_M, REACH_M, Plates
from inspect_cli.simulation.surface_geoms import MOST_FACETS, SHELL_SAGITTA_M
from inspect_cli.spatial.primitives import PRIMITIVE
from inspect_cli.spatial.rotations import rotate
from inspect_cli.truth import geometry
from inspect_cli.truth.geometry import StructureTruth, SurfaceTruth
from inspect_cli.truth.heights import mesh_relief
from inspect_cli.truth.relief import relief_covers
from inspect_cli.truth.solids import foot_on, normal_on, point_on
from inspect_cli.vehicles.kinds import Vehicle

Array = np.ndarray
DT, TICK = 1e-3, 4
K, MASS = 3000.0, 4.75
R = 1.5
TUNNEL = CylinderShape(
    center_m=(0.0, 0.0, 2.0),
    axis=(0.0, 0.0, 1.0),
    radius_m=R,
    facing=(1.0, 0.0, 0.0),
    size_m=(4.0, 1.0),
    side="inside",
)
BOWL = SphereShape(
    center_m=(0.0, 0.0, 2.0),
    radius_m=1.2,
    facing=(1.0, 0.0, 0.0),
    size_m=(1.5, 1.5),
    side="inside",
)


@pytest.fixture(scope="module")
def vehicle() -> Vehicle:
    return vehicle_at(90.0)


@pytest.fixture(scope="module")
def vault(root: Path) -> SurfaceTruth:
    shape = MeshShape(file="missions/scans/vault.ply", normal=(0.0, 0.0, -1.0))
    relief = mesh_relief(shape, Displacement(), root)
    return SurfaceTruth("vault", shape, 0.5, None, relief)


def vault_of(surface: SurfaceTruth, friction: float) -> StructureTruth:
    return geometry.structure_of(
        [SurfaceTruth(surface.name, surface.shape, friction, None, surface.relief)]
    )


class Slider:
    """The weightless vehicle as a force-controlled slider: pushed at O_b, its attitude held."""

    def __init__(self, vehicle: Vehicle, structure: StructureTruth, every: int = TICK) -> None:
        self.model = weightless(vehicle, structure)
        self.data = mujoco.MjData(self.model)
        self.solids = structure.solids
        self._plates = Plates(self.model, self.data, structure.solids, vehicle.contacts)
        self._every, self._steps = every, 0
        self._ball = self.model.geom("tip").id
        self.attitude = UPRIGHT

    def place(self, u: float, v: float, depth_m: float) -> None:
        """The tip at (u, v), pressed in, and the tool along −n."""
        n = normal_on(self.solids, 0, u, v)
        quat = np.zeros(4)
        mujoco.mju_quatZ2Vec(quat, -n)
        # The tool lies along x_B.
        turn = np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])
        self.attitude = np.zeros(4)
        mujoco.mju_mulQuat(self.attitude, quat, turn)
        mujoco.mj_resetData(self.model, self.data)
        self.data.qpos[3:7] = self.attitude
        mujoco.mj_kinematics(self.model, self.data)
        at_origin = self.data.geom_xpos[self._ball].copy()
        radius = self.model.geom("tip").size[0]
        self.data.qpos[:3] = point_on(self.solids, 0, u, v) + (radius - depth_m) * n - at_origin
        mujoco.mj_kinematics(self.model, self.data)
        self._plates.reset()
        self._steps = 0

    def step(self, force_W: Array) -> None:
        """One step of physics under a force at O_b."""
        if self._steps % self._every == 0:
            mujoco.mj_kinematics(self.model, self.data)
            self._plates.place()
        self._steps += 1
        self.data.qfrc_applied[:3] = force_W
        hold_attitude(self.data, self.attitude)
        mujoco.mj_step(self.model, self.data)
        mujoco.mj_kinematics(self.model, self.data)

    @property
    def ball_W(self) -> Array:
        """The middle of the tip."""
        return self.data.geom_xpos[self._ball].copy()

    def foot(self) -> tuple[float, float, float, bool]:
        return foot_on(self.solids, 0, self.ball_W)

    def normal(self) -> Array:
        u, v, *_ = self.foot()
        return normal_on(self.solids, 0, u, v)

    def force_W(self) -> Array:
        """What acts on the tip."""
        return -np.array(self.data.sensordata[:3])


def slid(
    slider: Slider, along: Callable[[Array], Array], push_n: float, friction: float, speed: float
) -> tuple[Array, Array, Array]:
    """Normal forces, tangential forces and speeds (2000,) of the last two of three seconds.

    The slider is pressed with ``push_n`` and drawn by the friction plus a damper that keeps speed.
    """
    slider.data.qvel[:3] = speed * along(slider.normal())
    normal_n, tangential_n, speeds = [], [], []
    for _ in range(3000):
        n = slider.normal()
        t = along(n)
        v = slider.data.qvel[:3]
        pull = friction * push_n + 100.0 * (speed - v @ t)
        slider.step(-push_n * n + pull * t)
        force, n = slider.force_W(), slider.normal()
        normal_n.append(force @ n)
        tangential_n.append(np.linalg.norm(force - (force @ n) * n))
        speeds.append(slider.data.qvel[:3] @ along(n))
    return np.array(normal_n[1000:]), np.array(tangential_n[1000:]), np.array(speeds[1000:])


def test_sliding_in_a_tunnel_the_force_hardly_varies(vehicle: Vehicle) -> None:
    """At 0.17 m/s the contact adds 5 N + m v²/R; the damper's error of 0.5 % may show, no more."""
    slider = Slider(vehicle, structure_of([TUNNEL], 0.3))
    slider.place(-0.4, 0.0, 5.0 / K)

    def around(n: Array) -> Array:
        return np.cross([0.0, 0.0, 1.0], -n)

    forces, drags, speeds = slid(slider, around, 5.0, 0.3, 0.17)
    assert np.mean(speeds) == pytest.approx(0.17, rel=0.02)
    assert np.mean(forces) == pytest.approx(5.0 + MASS * 0.17**2 / R, rel=0.02)
    assert np.std(forces) / np.mean(forces) < 0.01
    np.testing.assert_allclose(drags, 0.3 * forces, rtol=0.01)


def test_sliding_along_the_tunnel_it_is_a_plane(vehicle: Vehicle) -> None:
    slider = Slider(vehicle, structure_of([TUNNEL], 0.3))
    slider.place(0.0, -0.3, 5.0 / K)
    forces, drags, _ = slid(slider, lambda n: np.array([0.0, 0.0, 1.0]), 5.0, 0.3, 0.17)
    np.testing.assert_allclose(forces, 5.0, rtol=0.005)
    np.testing.assert_allclose(drags, 1.5, rtol=0.01)


def test_sliding_under_the_uneven_vault_the_force_stays_smooth(
    vehicle: Vehicle, vault: SurfaceTruth
) -> None:
    """Over waves of κ ≤ 4 /m it gains m v² κ = 0.5 N and the slider's lag; nothing jumps."""
    slider = Slider(vehicle, vault_of(vault, 0.3))
    slider.place(0.0, -0.4, 5.0 / K)

    def along(n: Array) -> Array:
        t = np.array([0.0, -1.0, 0.0])
        t = t - (t @ n) * n
        return t / np.linalg.norm(t)

    forces, drags, _ = slid(slider, along, 5.0, 0.3, 0.17)
    assert np.std(forces) / np.mean(forces) < 0.05
    assert np.abs(np.diff(forces)).max() < 0.1
    np.testing.assert_allclose(drags, 0.3 * forces, rtol=0.02)


@pytest.mark.parametrize("where", ["tunnel", "vault"])
def test_a_stuck_tip_stays_stuck_and_a_slipping_one_slips(
    vehicle: Vehicle, vault: SurfaceTruth, where: str
) -> None:
    friction, push_n = 0.5, 10.0
    structure = structure_of([TUNNEL], friction) if where == "tunnel" else vault_of(vault, friction)
    slider = Slider(vehicle, structure)
    for share in (0.9, 1.2):
        slider.place(0.1, 0.1, push_n / K)
        n = slider.normal()
        t = np.cross(n, [0.2, 1.0, 0.3])
        t /= np.linalg.norm(t)
        places = []
        for step in range(2000):
            pull = share * friction * push_n * min(step * DT, 1.0)
            slider.step(-push_n * n + pull * t)
            places.append(slider.ball_W)
        moved = np.linalg.norm(places[-1] - places[-1000])
        if share < 1.0:
            # The same tenth of a millimetre per newton and second as on a plane.
            assert moved < 1.2e-4 * share * friction * push_n
            force = slider.force_W()
            assert force @ t == pytest.approx(-share * friction * push_n, rel=0.02)
        else:
            # The excess of 1 N on 4.75 kg for a second, after it grew for a sixth of one.
            speed = 0.5 * 1.0 / MASS / 6.0
            assert moved == pytest.approx(speed + 0.5 / MASS, rel=0.15)


def test_how_often_the_plate_is_placed_makes_no_difference(vehicle: Vehicle) -> None:
    ends = []
    for every in (1, TICK):
        slider = Slider(vehicle, structure_of([TUNNEL], 0.3), every)
        slider.place(-0.2, 0.0, 5.0 / K)
        forces, *_ = slid(slider, lambda n: np.cross([0.0, 0.0, 1.0], -n), 5.0, 0.3, 0.2)
        ends.append((slider.ball_W, np.mean(forces)))
    # s²/2R = 0.2 μm of place; the damper's 0.1 mm/s, half of it on average, of force.
    np.testing.assert_allclose(ends[0][0], ends[1][0], atol=1e-3)
    assert ends[0][1] == pytest.approx(ends[1][1], abs=0.02)


def test_a_bowl_is_touched_with_the_peak_of_one_spring(vehicle: Vehicle) -> None:
    """At 0.1 m/s: one spring and damper, whatever the place."""
    slider = Slider(vehicle, structure_of([BOWL], 0.5))
    damping = 2.0 * 0.8 * np.sqrt(K * MASS)

    def push(y: Array) -> float:
        return max(0.0, K * y[0] + damping * y[1]) if y[0] > 0.0 else 0.0

    solution = solve_ivp(
        lambda t, y: np.array([y[1], -push(y) / MASS]), (0.0, 0.3), [-0.005, 0.1], max_step=1e-4
    )
    expected = max(push(y) for y in solution.y.T)
    for u, v in np.random.default_rng(4).uniform(-0.6, 0.6, (6, 2)):
        slider.place(u, v, -0.005)
        n = slider.normal()
        slider.data.qvel[:3] = -0.1 * n
        forces = []
        for _ in range(300):
            slider.step(np.zeros(3))
            forces.append(slider.force_W() @ n)
        assert max(forces) == pytest.approx(expected, rel=0.06)


def test_a_tip_that_slides_off_the_edge_is_free_and_meets_nothing_from_behind(
    vehicle: Vehicle,
) -> None:
    slider = Slider(vehicle, structure_of([TUNNEL], 0.1))
    slider.place(0.0, 0.48, 5.0 / K)
    n, up = slider.normal(), np.array([0.0, 0.0, 1.0])
    slider.data.qvel[:3] = 0.2 * up
    touched = []
    for _ in range(400):
        slider.step(-5.0 * n)
        touched.append((slider.foot()[1], np.linalg.norm(slider.force_W())))
    v, force = np.array(touched).T
    assert (force[(v > 0.481) & (v < 0.499)] > 4.0).all()
    assert v[-1] > 0.52
    assert (force[v > 0.501] == 0.0).all()
    assert slider.foot()[2] < 0.0  # it fell through
    slider.data.qvel[:3] = -0.5 * up
    for _ in range(300):
        slider.step(np.zeros(3))
        assert np.linalg.norm(slider.force_W()) == 0.0
    assert slider.foot()[3]  # behind the patch


@pytest.mark.parametrize(
    ("w", "engaged"),
    [(0.0, True), (0.5 * REACH_M, True), (1.01 * REACH_M, False), (-0.001, False)],
)
def test_a_plate_is_tangent_below_a_near_tip_and_parked_otherwise(
    vehicle: Vehicle, w: float, engaged: bool
) -> None:
    slider = Slider(vehicle, structure_of([TUNNEL]))
    radius = slider.model.geom("tip").size[0]
    slider.place(0.3, 0.2, radius - w)
    slider.step(np.zeros(3))
    front, axes = slider.data.mocap_pos[0], np.zeros(9)
    if not engaged:
        assert front[2] == PARKED_M
        return
    mujoco.mju_quat2Mat(axes, slider.data.mocap_quat[0])
    n = slider.normal()
    assert abs(axes.reshape(3, 3)[:, 2] @ n) == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(front + 0.1 * n, point_on(slider.solids, 0, 0.3, 0.2), atol=1e-9)


def test_what_is_engaged_may_sink_in_as_far_as_stated(vehicle: Vehicle) -> None:
    slider = Slider(vehicle, structure_of([TUNNEL]))
    slider.place(0.0, 0.0, 0.0)
    slider.step(np.zeros(3))
    for depth, engaged in ((0.9, True), (1.1, False)):
        n, (*_, w, _) = slider.normal(), slider.foot()
        slider.data.qpos[:3] -= (w + depth * BEHIND_M) * n
        slider.data.qvel[:] = 0.0
        for _ in range(TICK):  # so that a placing is among them
            slider.data.qpos[:3] -= (slider.foot()[2] + depth * BEHIND_M) * n
            slider.step(np.zeros(3))
        assert (slider.data.mocap_pos[0][2] != PARKED_M) == engaged


@pytest.mark.parametrize("shape", [TUNNEL, BOWL])
def test_facets_for_the_shell_are_few_and_stand_off_as_stated(
    vehicle: Vehicle, shape: Shape
) -> None:
    structure = structure_of([shape])
    model = weightless(vehicle, structure)
    facets = [g for g in range(model.ngeom) if model.geom(g).name.startswith("s0:")]
    assert 4 < len(facets) <= MOST_FACETS**2
    standing = stand_off(model, structure, 0.98)
    assert standing.min() > -1e-6
    assert standing.max() < SHELL_SAGITTA_M + 1e-4


def test_facets_of_the_vault_are_few_and_three_centimetres_true(
    vehicle: Vehicle, vault: SurfaceTruth
) -> None:
    structure = vault_of(vault, 0.5)
    model = weightless(vehicle, structure)
    facets = [g for g in range(model.ngeom) if model.geom(g).name.startswith("vault:")]
    assert 80 < len(facets) <= MOST_FACETS**2
    assert np.abs(stand_off(model, structure, 0.85)).max() < 0.03


def stand_off(model: mujoco.MjModel, structure: StructureTruth, share: float) -> Array:
    """How far (400,) the shell's facets lie behind the true surface, by MuJoCo's own rays."""
    data, solids = mujoco.MjData(model), structure.solids
    data.qpos[:3] = [50.0, 50.0, 50.0]
    mujoco.mj_forward(model, data)
    rows = solids.primitives if len(solids.primitives) else solids.reliefs
    assert rows.dtype == PRIMITIVE or relief_covers(solids.reliefs, solids.nodes, 0, 0.0, 0.0)
    half = share * rows["half_size"][0]
    hit, group, found = np.zeros(1, np.int32), np.ones(6, np.uint8), []
    for u, v in np.random.default_rng(8).uniform(-half, half, (400, 2)):
        n = normal_on(solids, 0, u, v)
        start = point_on(solids, 0, u, v) + 0.3 * n
        distance = mujoco.mj_ray(model, data, start, -n, group, 1, -1, hit)
        assert distance > 0.0
        found.append(distance - 0.3)
    return np.array(found)


@pytest.mark.parametrize("where", ["tunnel", "vault"])
def test_the_shell_meets_what_the_plates_leave_to_it(
    vehicle: Vehicle, vault: SurfaceTruth, where: str
) -> None:
    """Pushed backwards into the surface, the body is held; the tip has no part in it."""
    structure = structure_of([TUNNEL]) if where == "tunnel" else vault_of(vault, 0.5)
    plant = plant_of(vehicle, structure)
    plant.model.opt.gravity[:] = 0.0
    n = normal_on(structure.solids, 0, 0.05, 0.05)
    quat, turn = np.zeros(4), np.array([np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0])
    attitude = np.zeros(4)
    mujoco.mju_quatZ2Vec(quat, n)
    mujoco.mju_mulQuat(attitude, quat, turn)
    attitude *= np.sign(attitude[0])
    foot = point_on(structure.solids, 0, 0.05, 0.05)
    # The rearmost guards reach 0.26 m + 0.114 m behind O_b.
    placed(plant, (foot + 0.45 * n).tolist(), attitude)
    for _ in range(2000):
        plant.data.qfrc_applied[:3] = -5.0 * n
        hold_attitude(plant.data, attitude)
        plant.step(1)
    state = plant.observe(2.0)
    assert state.f_body == pytest.approx(5.0, rel=0.1)
    assert np.linalg.norm(state.f_tool_W) == 0.0


def test_the_plant_keeps_plates_below_the_tip_in_one_long_stretch(vehicle: Vehicle) -> None:
    plant = plant_of(vehicle, structure_of([TUNNEL], 0.0))
    plant.model.opt.gravity[:] = 0.0
    placed(plant, [R - 0.55, 0.0, 2.0])
    plant.data.qvel[1] = 0.1
    plant.data.qfrc_applied[0] = 5.0
    plant.step(800)
    state = plant.observe(0.8)
    angle = np.arctan2(state.p_WT[1], state.p_WT[0])
    assert angle > 0.01
    # Attitude is free here; what tells is that the force is square to the wall where the tip is.
    force = state.f_tool_W / np.linalg.norm(state.f_tool_W)
    ball = state.p_WT - 0.02 * rotate(state.q_WT, np.array([0.0, 0.0, 1.0]))
    radial = np.array([*ball[:2], 0.0]) / np.linalg.norm(ball[:2])
    assert force @ -radial > 1.0 - 1e-6
