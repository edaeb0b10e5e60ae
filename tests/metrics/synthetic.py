"""A nine-point flight whose every metric is known in closed form, made without a simulator.

The tracking error is a constant vector of length 3-4-12-13 mm, attitudes are off by constant
angles, forces are constant while the tool touches. Arrays can be changed before ``log()``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from modes import TABLE_JSON, Mode

from inspect_cli.log.reader import RunLog
from inspect_cli.records import (
    Command,
    Estimate,
    Reading,
    Record,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Status
from inspect_cli.schema.vehicle import TiltRotorPlatform
from inspect_cli.spatial.arrays import Structured, Vector

LENGTHS = {"n_rotors": 12, "n_joints": 6, "n_servos": 6}
WALL_X_M = 2.0
HEIGHT_M = 1.5
POINTS = 9
TOOL_M = 0.55
CELL_CONSTANT_M = 0.08
ACTIVE = (1, 2)

TRACKING_ERROR_M = np.array([0.003, -0.004, 0.012])
YAW_ERROR_RAD = 0.02
ESTIMATE_ERROR_M = np.array([0.001, 0.002, -0.002])
ESTIMATE_ROLL_ERROR_RAD = 0.005
WRENCH_ERROR = np.array([0.3, 0.4, 0.0, 0.0, 0.03, 0.04])
NORMAL_ERROR_DEG = 2.0
FORCE_N = 1.8
LAW = {"kind": "depth", "depth_m": 0.1, "profile": "contact_ndt", "expected_force_n": FORCE_N}
READING_ERROR_V = 0.002
RESISTANCE_FACTOR = 1.01

FREE_PRESS_S = 0.5
PRESS_S = 5.0
RELEASE_S = 0.1


def planned_point(k: int) -> Vector:
    """The k-th contact point, 5 cm apart along the wall."""
    return np.array([WALL_X_M, (4 - k) * 0.05, HEIGHT_M])


def specimen(k: int) -> tuple[float, float]:
    """(potential V, resistivity Ω·m) under the k-th point."""
    return (-0.42, 70.0) if k in ACTIVE else (-0.12, 200.0)


@dataclass
class SyntheticFlight:
    """The parts of a log, open to tampering."""

    channels: dict[str, Structured]
    mission: Mission
    plan: Plan
    platform: TiltRotorPlatform
    status: Status = "completed"
    seed: int = 1
    attachments: dict[str, bytes] = field(default_factory=dict)

    def rows(self, record: type[Record]) -> Structured:
        return self.channels[record.topic]

    def pressing(self, k: int) -> Vector:
        """Indices of the rows in which point k is truly touched while pressing."""
        reference = self.rows(Reference)
        press = (reference["mode"] == Mode.PRESS) & (reference["target"] == k)
        return np.flatnonzero(press & (self.rows(State)["f_normal"] > 0.1))

    def log(self) -> RunLog:
        run = {"seed": self.seed, "versions": {}}
        attachments = {
            "mission.json": self.mission.model_dump_json(by_alias=True).encode(),
            "platform.json": self.platform.model_dump_json(by_alias=True).encode(),
            "plan.json": self.plan.model_dump_json(by_alias=True).encode(),
            "modes.json": TABLE_JSON,
            "run.json": json.dumps(run).encode(),
        }
        return RunLog(
            path=Path("flight.mcap"),
            status=self.status,
            status_reason="",
            channels=self.channels,
            attachments=attachments | self.attachments,
            events=(),
            points=(),
        )


def nine_points(acceptance: tuple[dict[str, Any], ...] = ()) -> SyntheticFlight:
    """Nine points on a wall at x = 2 m, seen and touched along +x; all readings valid."""
    times, mode, target, tip = _schedule()
    channels = _truth(times, mode, target, tip) | _beliefs(times, mode, target, tip)
    channels[Reading.topic] = _readings(times, mode, target)
    return SyntheticFlight(channels, _mission(acceptance), _plan(), _platform())


def _schedule() -> tuple[Vector, Vector, Vector, Vector]:
    """(t, mode, target, reference p_WT) at 100 Hz."""
    home = np.array([TOOL_M, 0.0, 0.2])
    above = np.array([TOOL_M, 0.0, HEIGHT_M])
    phases: list[tuple[Mode, int, float, Vector]] = [
        (Mode.IDLE, -1, 1.0, home),
        (Mode.TAKEOFF, -1, 4.0, above),
    ]
    for k in range(POINTS):
        point = planned_point(k)
        standoff = point - [0.25, 0.0, 0.0]
        phases += [
            (Mode.TRANSIT, k, 2.0, standoff),
            (Mode.APPROACH, k, 2.0, point),
            (Mode.PRESS, k, PRESS_S, point + np.array([0.1, 0.0, 0.0])),
            (Mode.RETREAT, k, 1.5, standoff),
        ]
    phases += [
        (Mode.TRANSIT, -1, 2.0, above),
        (Mode.LAND, -1, 4.0, home),
        (Mode.LANDED, -1, 1.0, home),
    ]
    mode, target, tip = [], [], []
    here = home
    for phase, index, duration, there in phases:
        n = round(duration * 100)
        share = np.arange(1, n + 1)[:, None] / n
        mode += [float(phase)] * n
        target += [float(index)] * n
        tip.append(here + share * (there - here))
        here = there
    times = np.arange(len(mode)) / 100.0
    return times, np.array(mode), np.array(target), np.concatenate(tip)


def _phase_clock(times: Vector, mode: Vector) -> Vector:
    """Time since the mode last changed."""
    starts = np.r_[True, np.diff(mode) != 0]
    return times - np.maximum.accumulate(np.where(starts, times, -1.0))


def _truth(times: Vector, mode: Vector, target: Vector, tip: Vector) -> dict[str, Structured]:
    since = _phase_clock(times, mode)
    pressing = (mode == Mode.PRESS) & (since >= FREE_PRESS_S - 1e-9)
    releasing = (mode == Mode.RETREAT) & (since < RELEASE_S - 1e-9)
    touching = pressing | releasing
    state = np.zeros(len(times), State.dtype(LENGTHS))
    state["t_s"] = times
    state["p_WT"] = tip + TRACKING_ERROR_M
    state["p_WT"][touching, 0] = WALL_X_M
    state["p_WB"] = state["p_WT"] - [TOOL_M, 0.0, 0.0]
    state["q_WB"] = [np.cos(YAW_ERROR_RAD / 2), 0.0, 0.0, np.sin(YAW_ERROR_RAD / 2)]
    # The arm is turned by 90° about y_B: Hamilton product of the two, written out.
    c, s = np.cos(YAW_ERROR_RAD / 2) / np.sqrt(2.0), np.sin(YAW_ERROR_RAD / 2) / np.sqrt(2.0)
    state["q_WT"] = [c, -s, c, s]
    state["f_normal"] = np.where(pressing, FORCE_N, np.where(releasing, 0.5, 0.0))
    state["wrench_ext_B"][:, 0] = -state["f_normal"]
    state["rotor_thrust"] = 4.0
    contact = np.zeros(len(times), TrueContact.dtype())
    contact["t_s"] = times
    contact["n_W"] = [-1.0, 0.0, 0.0]
    contact["distance"] = WALL_X_M - state["p_WT"][:, 0]
    contact["uv"] = state["p_WT"][:, 1:]
    for k in range(-1, POINTS):
        here = target == k
        contact["potential"][here], contact["resistivity"][here] = specimen(k)
    return {State.topic: state, TrueContact.topic: contact}


def _beliefs(times: Vector, mode: Vector, target: Vector, tip: Vector) -> dict[str, Structured]:
    truth = _truth(times, mode, target, tip)[State.topic]
    reference = np.zeros(len(times), Reference.dtype())
    reference["t_s"], reference["mode"], reference["target"] = times, mode, target
    reference["p_WT"] = tip
    reference["p_WB"] = tip - [TOOL_M, 0.0, 0.0]
    reference["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    estimate = np.zeros(len(times), Estimate.dtype())
    estimate["t_s"] = times
    estimate["p_WB"] = truth["p_WB"] + ESTIMATE_ERROR_M
    # The true yaw followed by a roll: Hamilton product of the two, written out.
    yaw, roll = YAW_ERROR_RAD / 2, ESTIMATE_ROLL_ERROR_RAD / 2
    estimate["q_WB"] = [
        np.cos(yaw) * np.cos(roll),
        np.cos(yaw) * np.sin(roll),
        np.sin(yaw) * np.sin(roll),
        np.sin(yaw) * np.cos(roll),
    ]
    estimate["wrench_B"] = truth["wrench_ext_B"] + WRENCH_ERROR
    command = np.zeros(len(times), Command.dtype(LENGTHS))
    command["t_s"] = times
    surface = np.zeros(len(times[::10]), SurfaceEstimate.dtype())
    surface["t_s"] = times[::10] + 0.003  # the camera has ticks of its own
    tilt = np.radians(NORMAL_ERROR_DEG)
    surface["n_W"] = [-np.cos(tilt), np.sin(tilt), 0.0]
    surface["valid"] = 1.0
    return {
        Reference.topic: reference,
        Estimate.topic: estimate,
        Command.topic: command,
        SurfaceEstimate.topic: surface,
    }


def _readings(times: Vector, mode: Vector, target: Vector) -> Structured:
    readings = np.zeros(POINTS, Reading.dtype())
    for k, row in enumerate(readings):
        potential, resistivity = specimen(k)
        row["t_s"] = times[(mode == Mode.PRESS) & (target == k)][-1]
        row["target"] = k
        row["potential"] = potential + READING_ERROR_V * (-1) ** k
        row["resistance"] = RESISTANCE_FACTOR * resistivity / CELL_CONSTANT_M
        row["force_mean"] = FORCE_N
        row["contact_s"] = PRESS_S - FREE_PRESS_S
        row["p_WT"] = planned_point(k) + np.array([0.0, 0.002, 0.0])
        row["valid"] = 1.0
    return readings


def _mission(acceptance: tuple[dict[str, Any], ...]) -> Mission:
    wall = {"center_m": [WALL_X_M, 0, HEIGHT_M], "normal": [-1, 0, 0], "size_m": [2, 2]}
    grid = {"on": "wall", "rows": 1, "columns": POINTS, "pitch_m": 0.05}
    data = {
        "name": "nine-points",
        "platform": "hexarotor",
        "seeds": [1, 2],
        "structure": [{"name": "wall", "surface": {"shape": {"kind": "plane", **wall}}}],
        "tasks": [{"contact_grid": grid}],
        "acceptance": list(acceptance),
    }
    return Mission.model_validate_json(json.dumps(data))


def _posture(tip: Vector) -> dict[str, Any]:
    return {"p_WB": list(tip - [TOOL_M, 0, 0]), "q_WB": [1, 0, 0, 0]}


def _plan() -> Plan:
    """Enough of a plan to be read; the legs are not looked at by metrics."""
    targets = []
    for k in range(POINTS):
        point = planned_point(k)
        target = {
            "index": k,
            "label": f"wall {k + 1}",
            "kind": "contact",
            "impedance": "contact_ndt",
            "surface": "wall",
            "uv_m": [point[1], 0.0],
            "p_WC": list(point),
            "n_W": [-1, 0, 0],
            "q_WT": [np.sqrt(0.5), 0, np.sqrt(0.5), 0],
            "sensor": "half_cell",
            "cell_m": [0.05, 0.05],
            "law": LAW,
            "dwell_s": 3.0,
            "standoff_m": 0.25,
            "standoff": _posture(point - [0.25, 0, 0]),
            "contact": _posture(point),
            "margins": {"thrust": {"value": 5.0, "unit": "N"}},
            "clearance_m": 0.1,
        }
        targets.append(target)
    start = {"p_WB": [0, 0, 0.2], "q_WB": [1, 0, 0, 0]}
    data = {
        "mission": "nine-points",
        "platform": "hexarotor",
        "impedance": "contact_ndt",
        "surfaces": [],
        "start": start,
        "targets": targets,
        "legs": [],
        "duration_s": 110.0,
        "energy_wh": 12.5,
        "path_m": 9.0,
        "cable_m": 2.5,
    }
    return Plan.model_validate_json(json.dumps(data))


def _platform() -> TiltRotorPlatform:
    three = [1.0, 1.0, 1.0]
    half_cell = {
        "kind": "half_cell",
        "rate_hz": 50,
        "potential_noise_v": 0.001,
        "resistance_noise": 0.01,
        "force_noise_n": 0.05,
        "cell_constant_m": CELL_CONSTANT_M,
        "wetting_s": 0.4,
        "dry_offset_v": 0.05,
        "cable_m": 12,
    }
    imu: dict[str, Any] = dict.fromkeys(
        ("accel_noise", "gyro_noise", "accel_bias_walk", "gyro_bias_walk"), 0.0
    )
    imu |= {
        "kind": "imu",
        "rate_hz": 250,
        "accel_bias_initial_mps2": 0.0,
        "gyro_bias_initial_radps": 0.0,
    }
    tof = {
        "kind": "depth_camera",
        "rate_hz": 10,
        "mount": {"frame": "body", "position_m": [0.16, 0, 0.06], "axes": "tool"},
        "columns": 64,
        "rows": 48,
        "field_of_view_deg": [62, 45],
        "range_m": [0.1, 3],
        "noise_m": 0.002,
        "noise_floor_m": 0.004,
        "neighbourhood_m": 0.1,
    }
    control = dict.fromkeys(
        (
            "stiffness_npm",
            "damping_nspm",
            "stiffness_nmprad",
            "damping_nmsprad",
            "observer_gain",
            "observer_gain_torque",
        ),
        three,
    )
    profile = {"frame": "tool", "mass": [5, 5, 0.25], "inertia": [5, 5, 5]}
    data = {
        "name": "hexarotor",
        "kind": "tilt_rotor",
        "limits": {"speed_mps": 1, "acceleration_mps2": 1, "angular_rate_radps": 0.7},
        "battery": {"energy_wh": 117, "avionics_w": 25, "figure_of_merit": 0.55},
        "sensors": {
            "imu": imu,
            "pose": {
                "kind": "pose_tracker",
                "rate_hz": 100,
                "position_noise_m": 0.001,
                "attitude_noise_rad": 0.002,
            },
            "tof": tof,
            "probe": half_cell,
        },
        "control": control | {"profiles": {"contact_ndt": profile}},
        "core": {
            "mass_kg": 2.76,
            "inertia_kgm2": [0.009, 0.013, 0.016],
            "com_m": [0, 0, 0],
            "radius_m": 0.15,
            "height_m": 0.12,
            "gear_height_m": 0.2,
        },
        "rotor": {
            "radius_m": 0.1143,
            "mass_kg": 0.0065,
            "thrust_constant_ns2": 7.2e-6,
            "time_up_s": 0.0125,
            "time_down_s": 0.025,
            "drive_efficiency": 0.65,
        },
        "unit": {
            "distance_m": 0.3,
            "mass_kg": 0.277,
            "coaxial_offset_m": 0.06,
            "max_thrust_n": 20,
            "moment_constant_upper_m": 0.015,
            "moment_constant_lower_m": 0.005,
            "servo_lag_s": 0.02,
            "servo_rate_radps": 8,
            "servo_torque_nm": 2,
        },
        "groups": [{"azimuth_deg": 60.0 * k, "upper_spin": "ccw"} for k in range(6)],
        "tool": {
            "pitch_deg": 90,
            "length_m": TOOL_M,
            "mass_kg": 0.25,
            "tip_radius_m": 0.02,
            "tip_stiffness_npm": 3000,
            "tip_damping_ratio": 0.8,
        },
    }
    return TiltRotorPlatform.model_validate_json(json.dumps(data))
