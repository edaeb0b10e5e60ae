"""The plant: the one place that calls ``mj_step``.

Between two ticks the commands are held, as a flight controller holds them. The plant turns a
Command into MuJoCo's controls (rate limit of the servos, rising or falling lag of the rotors,
thrust factors of near surfaces), applies the disturbances, keeps the plates of hollow and irregular
surfaces below the vehicle's contacts, steps, and reads the true State.
"""

from __future__ import annotations

from collections.abc import Sequence

import mujoco
import numpy as np

from inspect_cli.compiled import bound
from inspect_cli.compiled.joined import joined
from inspect_cli.errors import InputError
from inspect_cli.interfaces import TOOL, Posture
from inspect_cli.records import Command, Lengths, State
from inspect_cli.simulation.addresses import addresses_of, contact_addresses
from inspect_cli.simulation.plant_kernels import move_drives, read_state, read_wrench, set_controls
from inspect_cli.simulation.plates import Plates
from inspect_cli.simulation.stepping import advance, refresh
from inspect_cli.simulation.world import WALL_SENSOR
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import cross
from inspect_cli.truth.disturbances import Disturbances, Motion
from inspect_cli.truth.proximity import Proximity
from inspect_cli.truth.solids import Solids
from inspect_cli.vehicles.actuators import Drive, Rotor, Servo, of_kind
from inspect_cli.vehicles.contacts import wrench_record
from inspect_cli.vehicles.kinds import Vehicle


def _ignore(warning: str) -> None:
    """MuJoCo counts its warnings in the data as well."""


def _servo_of(joint: str, servos: Sequence[Servo], model: mujoco.MjModel) -> int | None:
    """The actuator that holds a joint; None of a passive one."""
    for servo in servos:
        if servo.joint == joint:
            return int(model.actuator(servo.name).id)
    return None


class Plant:
    """The true vehicle in the true world."""

    def __init__(
        self,
        model: mujoco.MjModel,
        vehicle: Vehicle,
        lengths: Lengths,
        solids: Solids,
        disturbances: Disturbances,
        proximity: Proximity,
        control_hz: int,
    ) -> None:
        # MuJoCo would write its warnings into a file in the current folder; see ``diverged``.
        mujoco.set_mju_user_warning(_ignore)
        self.model = model
        self.data = mujoco.MjData(model)
        self.state = State.create(lengths)
        self._where = addresses_of(model, vehicle, lengths)
        rotors = of_kind(vehicle.actuators, Rotor)
        servos = of_kind(vehicle.actuators, Servo)
        self._time_up = np.array([rotor.time_up_s for rotor in rotors])
        self._time_down = np.array([rotor.time_down_s for rotor in rotors])
        self._max_turn = np.array([servo.rate_radps for servo in servos]) / control_hz
        self._held = [(model.joint(joint), _servo_of(joint, servos, model))
                      for joint in vehicle.posture_joints]  # fmt: skip
        drives = of_kind(vehicle.actuators, Drive)
        self._drive_limits = (
            np.array([drive.max_speed_radps for drive in drives]),
            np.array([drive.reach_rad for drive in drives]),
            1.0 / control_hz,
        )
        self.contacts = {c.name: wrench_record(c.name).create() for c in vehicle.contacts}
        """Wrenches by the name of the contact; ``observe_contacts`` brings them up to date."""
        self._plates = Plates(model, self.data, solids, vehicle.contacts)
        self._physics_hz = vehicle.platform.rates.physics_hz
        self._steps_per_placing = max(round(1.0 / (control_hz * model.opt.timestep)), 1)
        self.disturbances = disturbances
        self._proximity = proximity
        self._hubs = model.actuator_trnid[self._where.rotors, 0].copy()
        places = self.data.site_xpos, self.data.site_xmat
        self._hub_places = (*places, self._hubs, self._where.rotors)
        self._gains = model.actuator_gainprm
        self._tip = model.site(TOOL).id
        # The arrays below are views into MuJoCo's memory; they are looked up once.
        data = self.data
        self._tip_W, self._tip_axes = data.site_xpos[self._tip], data.site_xmat[self._tip]
        self._applied, self._activation = data.qfrc_applied, data.act
        self._sensors = data.sensordata
        self._motion = Motion(data.qpos[:3], data.qpos[3:7], data.qvel[:3], self._tip_W)
        self._tool = int(model.site_bodyid[self._tip])
        walls = [s for s in map(model.sensor, range(model.nsensor)) if WALL_SENSOR in s.name]
        self._walls = [data.sensordata[s.adr[0] : s.adr[0] + s.dim[0]] for s in walls]
        self._ctrl, self._dynprm = data.ctrl, model.actuator_dynprm
        self._warnings = data.warning.number
        here = model._address, data._address
        self._steps = np.zeros(1, np.int32)
        steps = bound(advance, *here, self._steps)
        up_to_date = bound(refresh, *here)
        read = bound(
            read_state,
            self._where,
            data.qpos,
            data.qvel,
            data.qacc,
            data.qfrc_constraint,
            self._applied,
            self._sensors,
            self._tip_W,
            self._tip_axes,
            self._activation,
            self.state.array,
        )
        self._observe = joined(up_to_date, read)
        plates = (self._plates.place,) if self._plates.any else ()
        # The kinematics lag the step, and plates are placed by them.
        self._pass = joined(*plates, steps, up_to_date)
        self._pass_and_observe = joined(*plates, steps, up_to_date, read)
        self._read_wrenches = {
            contact.name: bound(
                read_wrench,
                contact_addresses(model, contact),
                self._sensors,
                data.site_xpos[model.site(contact.frame).id],
                self.contacts[contact.name].array,
            )
            for contact in vehicle.contacts
        }
        self._contact_times = [record.views["t_s"] for record in self.contacts.values()]
        self._taken: Command | None = None

    def place(self, posture: Posture) -> None:
        """Put the vehicle somewhere at rest; servos hold the joints where the posture has them."""
        mujoco.mj_resetData(self.model, self.data)
        self._plates.reset()
        self.data.qpos[:3] = posture.p_WB
        self.data.qpos[3:7] = posture.q_WB
        for (joint, servo), angle in zip(self._held, posture.joint_angle, strict=True):
            self.data.qpos[joint.qposadr[0]] = angle
            if servo is not None:
                self.data.ctrl[servo] = angle
                self.data.act[self.model.actuator_actadr[servo]] = angle
        mujoco.mj_forward(self.model, self.data)
        self._steps_taken = 0
        self.observe(0.0)

    def observe(self, t_s: float) -> State:
        """Read the true state of this moment, which is called ``t_s``."""
        self._observe()
        self.state.t_s = t_s
        return self.state

    def wall_wrench(self) -> Vector:
        """Force of the contacts on the surface with a force sensor, torque about O_W, (6,) in W."""
        wrench = np.zeros(6)
        for contact in self._walls:
            force = contact[:3]
            wrench[:3] += force
            wrench[3:] += contact[3:6] + cross(contact[6:9], force)
        return wrench

    def contact_wrench(self, name: str) -> Vector:
        """Force on a contact and torque about the origin of its frame, (6,) in W.

        Raises:
            InputError: the vehicle has no contact of that name.
        """
        if name not in self.contacts:
            known = ", ".join(self.contacts)
            raise InputError(f"the vehicle has no contact '{name}'", hint=f"it has: {known}")
        record = self.contacts[name]
        self._read_wrenches[name]()
        return np.concatenate([record.f_W, record.t_W])

    def observe_contacts(self, t_s: float) -> None:
        """Read the wrench on each contact; the kinematics are up to date."""
        for read, time in zip(self._read_wrenches.values(), self._contact_times, strict=True):
            read()
            time[0] = t_s

    def apply(self, command: Command) -> None:
        """Take a command."""
        if command is not self._taken:
            self._taken = command
            self._bind(command)
        self._write()

    def _bind(self, command: Command) -> None:
        """Look up once how this command is written into MuJoCo's controls."""
        views = command.views
        rotors_and_servos = bound(
            set_controls,
            self._where,
            views["rotor_thrust"],
            views["joint_angle"],
            self._activation,
            self._time_up,
            self._time_down,
            self._max_turn,
            self._ctrl,
            self._dynprm,
        )
        if self._where.drives.size:
            angles = (self.data.qpos, self._ctrl)
            speeds = (views["drive_speed"], *self._drive_limits, *angles)
            self._write = joined(rotors_and_servos, bound(move_drives, self._where, *speeds))
        else:
            self._write = joined(rotors_and_servos)

    def disturb(self, t_s: float) -> None:
        """Set the disturbances of this moment."""
        if not self.disturbances.any:
            return
        load = self.disturbances.act(t_s, self._motion)
        # What pulls at the tip also turns the joints between it and the body.
        self._applied[6:] = 0.0
        self._applied[:3], self._applied[3:6] = load.force_W, load.torque_B
        if load.force_tip_W.any():
            self._apply_at_tip(load.force_tip_W)

    def _apply_at_tip(self, force_W: Vector) -> None:
        """Add Jᵀ f of the tool's tip to the applied generalized forces."""
        mujoco.mj_comPos(self.model, self.data)  # the Jacobian's axes would lag a step
        no_torque = np.zeros(3)
        mujoco.mj_applyFT(
            self.model, self.data, force_W, no_torque, self._tip_W, self._tool, self._applied
        )

    def feel_surroundings(self) -> None:
        """Set the thrust factors of this moment."""
        if self._proximity.any:
            self._proximity.update(*self._hub_places, self._gains)

    def step(self, steps: int) -> None:
        """Let time pass and read the state; plates are placed at the control rate or more often.

        The kinematics are brought up to date, so that the tip does not lag a step.
        """
        rest = steps
        while self._plates.any and rest > self._steps_per_placing:
            self._steps[0] = self._steps_per_placing
            self._pass()
            rest -= self._steps_per_placing
        self._steps[0] = rest
        self._pass_and_observe()
        self._steps_taken += steps
        self.state.t_s = self._steps_taken / self._physics_hz

    @property
    def diverged(self) -> str:
        """Why the physics cannot be trusted any more; empty while it can."""
        if not any(self._warnings.tolist()):
            return ""
        numbers = np.flatnonzero(self._warnings)
        return ", ".join(mujoco.mjtWarning(int(number)).name for number in numbers)
