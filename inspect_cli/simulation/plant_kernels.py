"""Kernels of the plant: commands into MuJoCo's controls, and MuJoCo's numbers into records."""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.simulation.addresses import Addresses
from inspect_cli.spatial.arrays import Indices, Matrix, Structured, Vector
from inspect_cli.spatial.rotations import cross, matrix_to_quaternion, rotate_back


@kernel
def set_controls(
    where: Addresses,
    thrust: Vector,
    angle: Vector,
    activation: Vector,
    time_up: Vector,
    time_down: Vector,
    max_turn: Vector,
    ctrl: Vector,
    dynprm: Matrix,
) -> None:
    """Write thrusts and rate-limited servo angles into ``ctrl``, and each rotor's lag.

    With the command held, a first-order lag never crosses its target, so choosing the time
    constant by the sign of (command − activation) once per command is exact.
    """
    for i in range(thrust.shape[0]):
        rotor = where.rotors[i]
        ctrl[rotor] = thrust[i]
        rises = thrust[i] > activation[where.rotor_activations[i]]
        dynprm[rotor, 0] = time_up[i] if rises else time_down[i]
    for j in range(angle.shape[0]):
        servo = where.servos[j]
        turn = angle[j] - ctrl[servo]
        ctrl[servo] += min(max(turn, -max_turn[j]), max_turn[j])


@kernel
def move_drives(
    where: Addresses,
    speed: Vector,
    max_speed: Vector,
    reach: Vector,
    period_s: float,
    qpos: Vector,
    ctrl: Vector,
) -> None:
    """Move the drives' angles in ``ctrl`` on by one period at the commanded speeds, rad/s.

    An angle leads its joint by ``reach`` at the most.
    """
    for j in range(speed.shape[0]):
        drive, angle = where.drives[j], qpos[where.drive_angles[j]]
        asked = min(max(speed[j], -max_speed[j]), max_speed[j])
        lead = ctrl[drive] + asked * period_s - angle
        ctrl[drive] = angle + min(max(lead, -reach[j]), reach[j])


@kernel
def read_state(
    where: Addresses,
    qpos: Vector,
    qvel: Vector,
    qacc: Vector,
    constraint: Vector,
    applied: Vector,
    sensors: Vector,
    tip_W: Vector,
    tip_axes: Vector,
    activation: Vector,
    state: Structured,
) -> None:
    """Write everything but the time into a State (1,).

    MuJoCo's free joint keeps linear velocity in W and angular velocity in B, and its generalized
    forces likewise: force in W, torque about O_b in B. Forces and accelerations are those of the
    step that ended here. ``sensors`` hold the forces that contacts and protected bodies exert, in
    W.
    """
    row = state[0]
    q = qpos[3:7]
    sign = -1.0 if q[0] < 0.0 else 1.0
    for k in range(4):
        row["q_WB"][k] = sign * q[k]
    force_W, exerted = np.empty(3), np.empty(3)
    for k in range(3):
        row["p_WB"][k] = qpos[k]
        row["v_WB_W"][k] = qvel[k]
        row["w_WB_B"][k] = qvel[3 + k]
        row["a_WB_W"][k] = qacc[k]
        row["alpha_WB_B"][k] = qacc[3 + k]
        row["p_WT"][k] = tip_W[k]
        exerted[k] = sensors[where.tool_forces[0] + k]
        for i in range(1, where.tool_forces.shape[0]):
            exerted[k] += sensors[where.tool_forces[i] + k]
        row["f_tool_W"][k] = -exerted[k]
        row["wrench_ext_B"][3 + k] = constraint[3 + k] + applied[3 + k]
        force_W[k] = constraint[k] + applied[k]
    force_B = rotate_back(q, force_W)
    q_WT = matrix_to_quaternion(tip_axes.reshape(3, 3))
    for k in range(3):
        row["wrench_ext_B"][k] = force_B[k]
    for k in range(4):
        row["q_WT"][k] = q_WT[k]
    # z_T is the third column of R_WT; what presses along it is pushed back against it.
    row["f_normal"] = tip_axes[2] * exerted[0] + tip_axes[5] * exerted[1] + tip_axes[8] * exerted[2]
    row["f_body"] = 0.0
    for i in range(where.protected_forces.shape[0]):
        first = where.protected_forces[i]
        x, y, z = sensors[first], sensors[first + 1], sensors[first + 2]
        row["f_body"] += np.sqrt(x**2 + y**2 + z**2)
    for j in range(where.angles.shape[0]):
        row["joint_angle"][j] = qpos[where.angles[j]]
        row["joint_rate"][j] = qvel[where.rates[j]]
    for i in range(where.rotors.shape[0]):
        row["rotor_thrust"][i] = activation[where.rotor_activations[i]]


@kernel
def read_wrench(places: Indices, sensors: Vector, origin_W: Vector, wrench: Structured) -> None:
    """Write force and torque into a ContactWrench (1,), the sum over the geoms of a contact.

    ``sensors`` hold force, torque and the position it refers to of what each geom exerts.
    """
    row = wrench[0]
    for k in range(3):
        row["f_W"][k] = 0.0
        row["t_W"][k] = 0.0
    for first in places:
        force = sensors[first : first + 3]
        arm = sensors[first + 6 : first + 9] - origin_W
        turned = cross(arm, force)
        for k in range(3):
            row["f_W"][k] -= force[k]
            row["t_W"][k] -= sensors[first + 3 + k] + turned[k]
