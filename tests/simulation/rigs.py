"""Small bodies with one wheel or one foot plate on a slope, to be held against statics."""

from __future__ import annotations

from types import SimpleNamespace

import mujoco
import numpy as np
from worlds import hold_attitude, structure_of

from inspect_cli.interfaces import TOOL
from inspect_cli.schema.geometry import PlaneShape, Shape
from inspect_cli.schema.truth import TruePlatform
from inspect_cli.simulation.addresses import Addresses
from inspect_cli.simulation.plant_kernels import move_drives
from inspect_cli.simulation.plates import Plates
from inspect_cli.simulation.world import build_world
from inspect_cli.vehicles.actuators import Drive, add_actuators
from inspect_cli.vehicles.contacts import PatchContact, WheelContact
from inspect_cli.vehicles.kinds import Bodies

Array = np.ndarray
MASS, G = 2.0, 9.81
INERTIA, RADIUS = 0.2, 0.04
HALF, THICK, LEVER = 0.05, 0.005, 0.03
DRIVE = Drive("wheel", "wheel", 0.05, 30.0, 2.0, stiffness_nmprad=16.0, damping_nmsprad=0.27)
CONTROL_STEPS = 4
SPHERE, BOX = mujoco.mjtGeom.mjGEOM_SPHERE, mujoco.mjtGeom.mjGEOM_BOX


def _base() -> tuple[mujoco.MjSpec, mujoco.MjsBody]:
    spec = mujoco.MjSpec()
    spec.compiler.degree = False
    spec.option.timestep = 1e-3
    spec.option.gravity = np.array([0.0, 0.0, -G])
    spec.option.cone = mujoco.mjtCone.mjCONE_ELLIPTIC
    spec.option.integrator = mujoco.mjtIntegrator.mjINT_IMPLICITFAST
    core = spec.worldbody.add_body(name="core", explicitinertial=True)
    core.add_freejoint(name="root")
    core.mass, core.ipos = 0.9 * MASS, np.zeros(3)
    core.inertia = np.full(3, INERTIA)
    return spec, core


def wheel_spec() -> mujoco.MjSpec:
    """A base that a driven wheel about y_B carries; O_b is the hub."""
    spec, core = _base()
    wheel = core.add_body(name="wheel", explicitinertial=True)
    wheel.mass, wheel.ipos = 0.1 * MASS, np.zeros(3)
    wheel.inertia = np.full(3, 0.4 * 0.1 * MASS * RADIUS**2)
    wheel.add_joint(
        name="wheel", type=mujoco.mjtJoint.mjJNT_HINGE, axis=[0.0, 1.0, 0.0], armature=1e-3
    )
    wheel.add_geom(name="tyre", type=SPHERE, size=[RADIUS, 0, 0], contype=0, conaffinity=1)
    core.add_site(name=TOOL, pos=[0.0, 0.0, -RADIUS])
    add_actuators(spec, [DRIVE])
    return spec


def foot_spec(height: float) -> mujoco.MjSpec:
    """A square foot plate ``height`` below O_b, where all of the mass is."""
    spec, core = _base()
    core.mass = MASS
    core.add_geom(
        name="plate",
        type=BOX,
        size=[HALF, HALF, 0.5 * THICK],
        pos=[0.0, 0.0, 0.5 * THICK - height],
        contype=0,
        conaffinity=1,
        mass=0.0,
    )
    core.add_site(name=TOOL, pos=[0.0, 0.0, -height])
    return spec


class Rig:
    """A body on a plane that leans by ``slope`` towards +x, its z_B along the normal."""

    def __init__(
        self,
        spec: mujoco.MjSpec,
        slope: float,
        friction: float,
        height: float,
        hollow: Shape | None = None,
    ) -> None:
        is_foot = any(geom.name == "plate" for geom in spec.geoms)
        contact = (
            PatchContact("foot", ("plate",), TOOL, LEVER)
            if is_foot
            else WheelContact("wheel", ("tyre",), TOOL, "wheel", RADIUS)
        )
        self.normal = np.array([np.sin(slope), 0.0, np.cos(slope)])
        self.downhill = np.array([np.cos(slope), 0.0, -np.sin(slope)])
        middle = np.array([0.0, 0.0, 2.0])
        plane = PlaneShape(
            center_m=tuple(middle), normal=tuple(self.normal.tolist()), size_m=(4.0, 4.0)
        )
        vehicle = SimpleNamespace(
            nominal_spec=lambda: spec,
            bodies=Bodies(gear=(), protected=()),
            contacts=(contact,),
        )
        structure = structure_of([hollow or plane], friction)
        self.model = build_world(vehicle, TruePlatform(), structure)
        self.data = mujoco.MjData(self.model)
        self._plates = Plates(self.model, self.data, structure.solids, vehicle.contacts)
        self.plates = self.model.nmocap
        if hollow is not None:
            middle = np.array([0.0, 0.0, 0.5])  # its lowest line
        self.q_WB = np.array([np.cos(0.5 * slope), 0.0, np.sin(0.5 * slope), 0.0])
        self.data.qpos[:3] = middle + height * self.normal
        self.data.qpos[3:7] = self.q_WB
        self._middle = middle
        self.speed = np.zeros(self.model.nu)
        """Commanded of the drive, rad/s."""
        drives = np.arange(self.model.nu, dtype=np.int32)
        none = np.zeros(0, np.int32)
        angles = self.model.jnt_qposadr[self.model.actuator_trnid[:, 0]]
        self._where = Addresses(none, none, none, drives, angles, none, none, none, none)

    def run(self, duration_s: float, force_W: Array | None = None, held: bool = False) -> None:
        """Let time pass with a force at O_b; ``held`` keeps the attitude."""
        data, limits = self.data, np.array([[DRIVE.max_speed_radps], [DRIVE.reach_rad]])
        for step in range(round(duration_s / self.model.opt.timestep)):
            if step % CONTROL_STEPS == 0:
                move_drives(
                    self._where, self.speed, *limits, CONTROL_STEPS * 1e-3, data.qpos, data.ctrl
                )
                mujoco.mj_kinematics(self.model, self.data)
                self._plates.place()
            self.data.qfrc_applied[:6] = 0.0
            if held:
                hold_attitude(self.data, self.q_WB)
            if force_W is not None:
                self.data.qfrc_applied[:3] = force_W
            mujoco.mj_step(self.model, self.data)

    @property
    def travel(self) -> float:
        """How far O_b is downhill of where it began, m."""
        return float((self.data.qpos[:3] - self._middle) @ self.downhill)
