"""The plant: the one place that calls ``mj_step``.

Between two ticks the commands are held, as a flight controller holds them. The plant turns a
Command into MuJoCo's controls (rate limit of the joints, rising or falling lag of the rotors,
thrust factors of near surfaces), applies the disturbances, keeps the plates of hollow and irregular
surfaces below the tip, steps, and reads the true State.
"""

from __future__ import annotations

import mujoco
import numpy as np

from inspect_cli.compiled import bound, kernel
from inspect_cli.interfaces import Posture
from inspect_cli.records import Command, Lengths, State
from inspect_cli.simulation.plates import Plates
from inspect_cli.simulation.stepping import advance, refresh
from inspect_cli.simulation.world import WALL_SENSOR
from inspect_cli.spatial.arrays import Matrix, Structured, Vector
from inspect_cli.spatial.rotations import cross, matrix_to_quaternion, rotate_back
from inspect_cli.truth.disturbances import Disturbances, Motion
from inspect_cli.truth.proximity import Proximity
from inspect_cli.truth.solids import Solids
from inspect_cli.vehicles.kinds import Vehicle


@kernel
def set_controls(
    thrust: Vector,
    angle: Vector,
    activation: Vector,
    time_up: Vector,
    time_down: Vector,
    max_turn: Vector,
    ctrl: Vector,
    dynprm: Matrix,
) -> None:
    """Write thrusts and rate-limited joint angles into ``ctrl``, and each rotor's lag.

    With the command held, a first-order lag never crosses its target, so choosing the time
    constant by the sign of (command − activation) once per command is exact.
    """
    n = thrust.shape[0]
    for i in range(n):
        ctrl[i] = thrust[i]
        dynprm[i, 0] = time_up[i] if thrust[i] > activation[i] else time_down[i]
    for j in range(angle.shape[0]):
        turn = angle[j] - ctrl[n + j]
        ctrl[n + j] += min(max(turn, -max_turn[j]), max_turn[j])


@kernel
def read_state(
    qpos: Vector,
    qvel: Vector,
    qacc: Vector,
    constraint: Vector,
    applied: Vector,
    contact: Vector,
    tip_W: Vector,
    tip_axes: Vector,
    activation: Vector,
    state: Structured,
) -> None:
    """Write everything but the time into a State (1,).

    MuJoCo's free joint keeps linear velocity in W and angular velocity in B, and its generalized
    forces likewise: force in W, torque about O_b in B. Forces and accelerations are those of the
    step that ended here. ``contact`` (6,) holds the forces that tool and shell exert, in W.
    """
    row = state[0]
    q = qpos[3:7]
    sign = -1.0 if q[0] < 0.0 else 1.0
    for k in range(4):
        row["q_WB"][k] = sign * q[k]
    force_W = np.empty(3)
    for k in range(3):
        row["p_WB"][k] = qpos[k]
        row["v_WB_W"][k] = qvel[k]
        row["w_WB_B"][k] = qvel[3 + k]
        row["a_WB_W"][k] = qacc[k]
        row["alpha_WB_B"][k] = qacc[3 + k]
        row["p_WT"][k] = tip_W[k]
        row["f_tool_W"][k] = -contact[k]
        row["wrench_ext_B"][3 + k] = constraint[3 + k] + applied[3 + k]
        force_W[k] = constraint[k] + applied[k]
    force_B = rotate_back(q, force_W)
    q_WT = matrix_to_quaternion(tip_axes.reshape(3, 3))
    for k in range(3):
        row["wrench_ext_B"][k] = force_B[k]
    for k in range(4):
        row["q_WT"][k] = q_WT[k]
    # z_T is the third column of R_WT; what presses along it is pushed back against it.
    row["f_normal"] = tip_axes[2] * contact[0] + tip_axes[5] * contact[1] + tip_axes[8] * contact[2]
    row["f_body"] = np.sqrt(contact[3] ** 2 + contact[4] ** 2 + contact[5] ** 2)
    n_joints = row["joint_angle"].shape[0]
    for j in range(n_joints):
        row["joint_angle"][j] = qpos[7 + j]
        row["joint_rate"][j] = qvel[6 + j]
    for i in range(row["rotor_thrust"].shape[0]):
        row["rotor_thrust"][i] = activation[i]


def _ignore(warning: str) -> None:
    """MuJoCo counts its warnings in the data as well."""


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
        # MuJoCo would write its warnings into a file where the user stands; ``diverged`` tells.
        mujoco.set_mju_user_warning(_ignore)
        self.model = model
        self.data = mujoco.MjData(model)
        self.state = State.create(lengths)
        self._n_rotors = lengths["n_rotors"]
        self._n_arm = lengths.get("n_arm", 0)
        self._actuators = vehicle.actuators
        self._max_turn = vehicle.actuators.joint_rate_radps / control_hz
        self._plates = Plates(model, self.data, solids)
        self._steps_per_placing = max(round(1.0 / (control_hz * model.opt.timestep)), 1)
        self.disturbances = disturbances
        self._proximity = proximity
        self._hubs = model.actuator_trnid[: self._n_rotors, 0].copy()
        self._gains = model.actuator_gainprm
        self._tip = model.site("tool_tip").id
        # The arrays below are views into MuJoCo's memory; they are looked up once.
        data = self.data
        self._tip_W, self._tip_axes = data.site_xpos[self._tip], data.site_xmat[self._tip]
        self._applied, self._activation = data.qfrc_applied, data.act
        self._motion = Motion(data.qpos[:3], data.qpos[3:7], data.qvel[:3], self._tip_W)
        self._tool = model.body("tool").id
        walls = [s for s in map(model.sensor, range(model.nsensor)) if WALL_SENSOR in s.name]
        self._walls = [data.sensordata[s.adr[0] : s.adr[0] + s.dim[0]] for s in walls]
        self._ctrl, self._dynprm = data.ctrl, model.actuator_dynprm
        self._warnings = data.warning.number
        here = model._address, data._address
        self._advance = bound(advance, *here, then=(1,))
        self._refresh = bound(refresh, *here)
        self._read = bound(
            read_state,
            data.qpos,
            data.qvel,
            data.qacc,
            data.qfrc_constraint,
            self._applied,
            data.sensordata,
            self._tip_W,
            self._tip_axes,
            self._activation,
            self.state.array,
        )
        self._taken: Command | None = None

    def place(self, posture: Posture) -> None:
        """Put the vehicle somewhere at rest."""
        mujoco.mj_resetData(self.model, self.data)
        self._plates.reset()
        self.data.qpos[:3] = posture.p_WB
        self.data.qpos[3:7] = posture.q_WB
        # The arm's joints come last, and so do their servos: they hold what they stand at.
        for last in (self.data.qpos, self.data.ctrl, self.data.act):
            last[len(last) - self._n_arm :] = posture.arm_angle
        mujoco.mj_forward(self.model, self.data)
        self.observe(0.0)

    def observe(self, t_s: float) -> State:
        """The true state now; kinematics are refreshed so that the tip does not lag a step."""
        self._refresh()
        self._read()
        self.state.t_s = t_s
        return self.state

    def wall_wrench(self) -> Vector:
        """Force of the tip on the surface with a force sensor and torque about O_W, (6,) in W."""
        wrench = np.zeros(6)
        for contact in self._walls:
            force = contact[:3]
            wrench[:3] += force
            wrench[3:] += contact[3:6] + cross(contact[6:9], force)
        return wrench

    def apply(self, command: Command) -> None:
        """Take a command."""
        if command is not self._taken:
            self._taken = command
            self._set_controls = bound(
                set_controls,
                command.views["rotor_thrust"],
                command.views["joint_angle"],
                self._activation,
                self._actuators.time_up_s,
                self._actuators.time_down_s,
                self._max_turn,
                self._ctrl,
                self._dynprm,
            )
        self._set_controls()

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
            self._proximity.update(
                self.data.site_xpos, self.data.site_xmat, self._hubs, self._gains
            )

    def step(self, steps: int) -> None:
        """Let time pass; plates are placed at the control rate or more often."""
        if not self._plates.any:
            self._advance(steps)
            return
        done = 0
        while done < steps:
            if done:
                self._refresh()  # as ``observe`` left them at first
            self._plates.follow()
            stretch = min(self._steps_per_placing, steps - done)
            self._advance(stretch)
            done += stretch

    @property
    def diverged(self) -> str:
        """Why the physics cannot be trusted any more; empty while it can."""
        if not any(self._warnings.tolist()):
            return ""
        numbers = np.flatnonzero(self._warnings)
        return ", ".join(mujoco.mjtWarning(int(number)).name for number in numbers)
