"""Plausible flights for the report to draw, made without a simulator.

A body moves on smooth segments between stand-offs and contacts in front of a wall at x = 2 m;
noise, lag and readings are added. The parts stay open, so that a test can take the truth away,
cut the flight short or spoil it before ``log()``.
"""

from __future__ import annotations

import json
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np
from modes import TABLE_JSON, Mode

from inspect_cli.log.foxglove import Cloud, Event
from inspect_cli.log.reader import RunLog
from inspect_cli.records import (
    Command,
    Estimate,
    InvalidReason,
    Probe,
    Reading,
    Record,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Status
from inspect_cli.schema.vehicle import PlatformBase
from inspect_cli.spatial.arrays import Structured, Vector

WALL_X_M = 2.0
MIDDLE_Z_M = 1.25
ARM_M = 0.55
STANDOFF_M = 0.25
PRESS_M = 0.10
FORCE_N = 1.8
LAW = {"kind": "depth", "depth_m": PRESS_M, "profile": "contact_ndt"} | {
    "expected_force_n": FORCE_N
}
HZ = 100
HOME = np.array([ARM_M, 0.0, 0.2])

Phase = tuple[Mode, int, float, Vector]


@dataclass
class Flight:
    """The parts of a log."""

    mission: Mission
    platform: PlatformBase
    plan: Plan
    channels: dict[str, Structured]
    status: Status = "completed"
    status_reason: str = ""
    run: dict[str, Any] = field(default_factory=dict)
    truth: str | None = "{}"
    events: tuple[Event, ...] = ()
    points: tuple[Cloud, ...] = ()

    def rows(self, record: type[Record]) -> Structured:
        return self.channels[record.topic]

    def without_truth(self) -> Flight:
        """The same flight as a real vehicle would have logged it."""
        for record in (State, TrueContact):
            del self.channels[record.topic]
        self.truth = None
        self.run = {}
        return self

    def cut_at(self, t_s: float) -> Flight:
        """The same flight, its log ending early."""
        self.channels = {k: rows[rows["t_s"] < t_s] for k, rows in self.channels.items()}
        self.status, self.status_reason = "interrupted", f"the log was cut at {t_s:g} s"
        return self

    def log(self) -> RunLog:
        attachments = {
            "mission.json": self.mission.model_dump_json(by_alias=True).encode(),
            "platform.json": self.platform.model_dump_json(by_alias=True).encode(),
            "plan.json": self.plan.model_dump_json(by_alias=True).encode(),
            "modes.json": TABLE_JSON,
            "run.json": json.dumps(self.run).encode(),
        }
        if self.truth is not None:
            attachments["truth.json"] = self.truth.encode()
        return RunLog(
            path=Path("flight.mcap"),
            status=self.status,
            status_reason=self.status_reason,
            channels=self.channels,
            attachments=attachments,
            events=self.events,
            points=self.points,
        )


def survey(
    platform: Path,
    rows: int = 1,
    columns: int = 9,
    *,
    n_rotors: int = 12,
    n_joints: int = 6,
    acceptance: tuple[dict[str, Any], ...] = (),
    words: dict[str, str] | None = None,
) -> Flight:
    """A completed survey of a grid of points at 5 cm with an active spot on its left.

    ``words`` replaces texts that a user writes: title, description, surface, label, event.
    """
    words = {"surface": "wall"} | (words or {})
    places = [
        ((j - (columns - 1) / 2) * 0.05, ((rows - 1) / 2 - i) * 0.05)
        for i in range(rows)
        for j in range(columns)
    ]
    phases = _phases(places)
    lengths = {"n_rotors": n_rotors, "n_joints": n_joints, "n_servos": n_joints}
    channels = _channels(phases, places, lengths)
    end_s = float(channels[Reference.topic]["t_s"][-1])
    rng = np.random.default_rng(3)
    cloud = np.column_stack(
        [np.full(400, WALL_X_M), rng.uniform(-0.4, 0.4, 400), rng.uniform(0.9, 1.6, 400)]
    )
    return Flight(
        mission=_mission(rows, columns, acceptance, words),
        platform=load_platform(platform),
        plan=_plan(places, phases, end_s, words),
        channels=channels,
        run={"seed": 1, "versions": {"inspect-cli": "0.1.0", "mujoco": "4.0.0"}},
        events=(
            Event(0.0, "info", "take-off"),
            Event(12.5, "warning", words.get("event", "surface estimate lost for 0.2 s")),
        ),
        points=(Cloud(5.0, cloud),),
    )


def specimen(u: float, v: float) -> tuple[float, float]:
    """(potential V, resistivity Ω·m): sound concrete with one active spot."""
    spot = np.exp(-0.5 * ((u + 0.125) ** 2 + v**2) / 0.04**2)
    return -0.12 - 0.35 * spot, 220.0 * 0.25**spot


def world(u: float, v: float) -> Vector:
    """The wall faces −x, so u runs along −y."""
    return np.array([WALL_X_M, -u, MIDDLE_Z_M + v])


def _phases(places: list[tuple[float, float]]) -> list[Phase]:
    above = np.array([ARM_M, 0.0, MIDDLE_Z_M])
    out, inwards = np.array([STANDOFF_M, 0.0, 0.0]), np.array([PRESS_M, 0.0, 0.0])
    phases: list[Phase] = [(Mode.IDLE, -1, 1.0, HOME), (Mode.TAKEOFF, -1, 4.0, above)]
    for k, (u, v) in enumerate(places):
        point = world(u, v)
        phases += [
            (Mode.TRANSIT, k, 2.0, point - out),
            (Mode.APPROACH, k, 2.0, point),
            (Mode.PRESS, k, 4.5, point + inwards),
            (Mode.RETREAT, k, 1.5, point - out),
        ]
    phases += [(Mode.TRANSIT, -1, 3.0, above), (Mode.LAND, -1, 4.0, HOME)]
    return [*phases, (Mode.LANDED, -1, 1.0, HOME)]


def _reference(phases: list[Phase]) -> Structured:
    parts, here = [], HOME
    for mode, target, duration, there in phases:
        n = round(duration * HZ)
        part = np.zeros(n, Reference.dtype())
        s = np.clip(np.arange(1, n + 1) / (n if mode != Mode.PRESS else min(n, HZ)), 0.0, 1.0)
        smooth = (10 * s**3 - 15 * s**4 + 6 * s**5)[:, None]
        part["p_WT"] = here + smooth * (there - here)
        part["mode"], part["target"] = float(mode), float(target)
        parts.append(part)
        here = there
    reference = np.concatenate(parts)
    reference["t_s"] = np.arange(len(reference)) / HZ
    reference["p_WB"] = reference["p_WT"] - [ARM_M, 0.0, 0.0]
    reference["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    return reference


def _wobble(rng: np.random.Generator, n: int, columns: int, size: float) -> Vector:
    """Smooth noise: white noise through a 0.3 s moving average, scaled to ``size`` RMS."""
    white = rng.standard_normal((n + 30, columns))
    sums = np.cumsum(white, axis=0)
    smooth = (sums[30:] - sums[:-30]) / np.sqrt(30.0)
    return size * smooth


def _small_rotation(theta: Vector) -> Vector:
    q = np.column_stack([np.ones(len(theta)), 0.5 * theta])
    return q / np.linalg.norm(q, axis=1)[:, None]


def _channels(
    phases: list[Phase], places: list[tuple[float, float]], lengths: dict[str, int]
) -> dict[str, Structured]:
    rng = np.random.default_rng(1)
    reference = _reference(phases)
    state, contact = _truth(reference, places, lengths, rng)
    n, t_s = len(reference), reference["t_s"]
    estimate = np.zeros(n, Estimate.dtype())
    estimate["t_s"] = t_s
    estimate["p_WB"] = state["p_WB"] + _wobble(rng, n, 3, 0.0008)
    estimate["q_WB"] = _small_rotation(2 * state["q_WB"][:, 1:] + _wobble(rng, n, 3, 0.002))
    lag = np.exp(-np.arange(300) / HZ)
    for k in range(6):
        true = state["wrench_ext_B"][:, k]
        felt = np.convolve(true, lag / lag.sum())[:n]
        estimate["wrench_B"][:, k] = felt + _wobble(rng, n, 1, 0.05)[:, 0]
    command = np.zeros(n, Command.dtype(lengths))
    command["t_s"] = t_s
    command["rotor_thrust"] = state["rotor_thrust"] + 0.05
    command["joint_angle"] = state["joint_angle"]
    command["saturated"][500:520] = 1.0
    surface = np.zeros(len(t_s[::10]), SurfaceEstimate.dtype())
    surface["t_s"] = t_s[::10]
    surface["distance"] = contact["distance"][::10] + 0.003 * rng.standard_normal(len(surface))
    tilt = 0.01 * rng.standard_normal((len(surface), 2))
    surface["n_W"] = np.column_stack([-np.ones(len(surface)), tilt])
    surface["n_W"] /= np.linalg.norm(surface["n_W"], axis=1)[:, None]
    surface["valid"] = (surface["distance"] < 1.2).astype(float)
    probe = np.zeros(len(t_s[::2]), Probe.dtype())
    probe["t_s"] = t_s[::2]
    probe["force"] = state["f_normal"][::2] + 0.05 * rng.standard_normal(len(probe))
    channels = {
        State.topic: state,
        TrueContact.topic: contact,
        Estimate.topic: estimate,
        Reference.topic: reference,
        Command.topic: command,
        SurfaceEstimate.topic: surface,
        Probe.topic: probe,
    }
    return channels | {Reading.topic: _readings(reference, places, rng)}


def _truth(
    reference: Structured,
    places: list[tuple[float, float]],
    lengths: dict[str, int],
    rng: np.random.Generator,
) -> tuple[Structured, Structured]:
    n, t_s = len(reference), reference["t_s"]
    state = np.zeros(n, State.dtype(lengths))
    state["t_s"] = t_s
    tip = reference["p_WT"] + _wobble(rng, n, 3, 0.004)
    depth = np.maximum(reference["p_WT"][:, 0] - WALL_X_M, 0.0)
    touching = (reference["mode"] == Mode.PRESS) & (depth > 0.002)
    tip[:, 0] = np.where(touching, WALL_X_M + 1e-4, np.minimum(tip[:, 0], WALL_X_M - 1e-3))
    state["p_WT"] = tip
    state["p_WB"] = tip - [ARM_M, 0.0, 0.0]
    state["q_WB"] = _small_rotation(_wobble(rng, n, 3, 0.006))
    w, x, y, z = np.sqrt(0.5) * state["q_WB"].T  # turned by 90° about y_B
    state["q_WT"] = np.column_stack([w - y, x - z, w + y, x + z])
    state["f_normal"] = np.where(touching, FORCE_N * depth / PRESS_M, 0.0)
    state["wrench_ext_B"][:, 0] = -state["f_normal"]
    state["wrench_ext_B"][:, 1:3] = _wobble(rng, n, 2, 0.1)
    airborne = (reference["mode"] > Mode.IDLE) & (reference["mode"] < Mode.LANDED)
    hover = 4.75 * 9.81 / lengths["n_rotors"]
    noise = _wobble(rng, n, lengths["n_rotors"], 0.15)
    state["rotor_thrust"] = np.where(airborne[:, None], hover + noise, 0.0)
    state["joint_angle"] = _wobble(rng, n, lengths["n_joints"], 0.05)
    contact = np.zeros(n, TrueContact.dtype())
    contact["t_s"] = t_s
    contact["distance"] = WALL_X_M - tip[:, 0]
    contact["n_W"] = [-1.0, 0.0, 0.0]
    contact["uv"] = np.column_stack([-tip[:, 1], tip[:, 2] - MIDDLE_Z_M])
    contact["potential"], contact["resistivity"] = specimen(
        contact["uv"][:, 0], contact["uv"][:, 1]
    )
    return state, contact


def _readings(
    reference: Structured, places: list[tuple[float, float]], rng: np.random.Generator
) -> Structured:
    readings = np.zeros(len(places), Reading.dtype())
    for k, (row, place) in enumerate(zip(readings, places, strict=True)):
        potential, resistivity = specimen(*place)
        at_target = (reference["target"] == k) & (reference["mode"] == Mode.RETREAT)
        row["t_s"] = reference["t_s"][at_target][0]
        row["target"] = k
        row["potential"] = potential + 0.002 * rng.standard_normal()
        row["resistance"] = resistivity / 0.08
        row["force_mean"] = FORCE_N + 0.03 * rng.standard_normal()
        row["contact_s"] = 4.2
        row["p_WT"] = world(*place) + 0.004 * rng.standard_normal(3) * [0.0, 1.0, 1.0]
        row["valid"] = 1.0
    return readings


def spoil(flight: Flight, index: int, reason: InvalidReason) -> None:
    """Make a reading invalid."""
    row = flight.rows(Reading)[index : index + 1]
    row["valid"], row["reason"] = 0.0, float(reason)
    row["potential"] = row["resistance"] = np.nan


def _mission(
    rows: int, columns: int, acceptance: tuple[dict[str, Any], ...], words: dict[str, str]
) -> Mission:
    shape = {
        "kind": "plane",
        "center_m": [WALL_X_M, 0, MIDDLE_Z_M],
        "normal": [-1, 0, 0],
        "size_m": [3.0, 2.5],
    }
    data = {
        "name": "example-survey",
        "title": words.get("title", "Half-cell readings at 5 cm on a reinforced concrete wall"),
        "description": words.get("description", "Contacts on a grid, set-point behind the wall."),
        "platform": "tilt_rotor_hexarotor",
        "structure": [{"name": words["surface"], "surface": {"shape": shape}}],
        "tasks": [
            {
                "contact_grid": {
                    "on": words["surface"],
                    "rows": rows,
                    "columns": columns,
                    "pitch_m": 0.05,
                }
            }
        ],
        "acceptance": list(acceptance),
    }
    return Mission.model_validate_json(json.dumps(data))


def _plan(
    places: list[tuple[float, float]], phases: list[Phase], end_s: float, words: dict[str, str]
) -> Plan:
    targets = [
        {
            "index": k,
            "label": words.get("label", str(k + 1)),
            "kind": "contact",
            "impedance": "contact_ndt",
            "surface": words["surface"],
            "uv_m": [u, v],
            "p_WC": world(u, v).tolist(),
            "n_W": [-1, 0, 0],
            "q_WT": [0.7071067811865476, 0, 0.7071067811865476, 0],
            "sensor": "half_cell",
            "cell_m": [0.05, 0.05],
            "law": LAW,
            "dwell_s": 3.0,
            "standoff_m": STANDOFF_M,
            "standoff": _posture(world(u, v) - [STANDOFF_M, 0, 0]),
            "contact": _posture(world(u, v)),
            "margins": {"thrust": {"value": 5.0, "unit": "N"}},
            "clearance_m": 0.12,
        }
        for k, (u, v) in enumerate(places)
    ]
    kinds = {mode: mode.name.lower() for mode in Mode}
    legs = [
        {
            "kind": kinds[mode],
            "target": None if target < 0 else target,
            "postures": [_posture(there)],
            "speed_mps": 0.3,
            "duration_s": duration,
        }
        for mode, target, duration, there in phases
        if kinds[mode] in ("takeoff", "transit", "approach", "press", "retreat", "land")
    ]
    fit = {
        "method": "plane, seeded consensus and least squares",
        "points": 18234,
        "inliers": 17890,
        "inlier_share": 0.981,
        "rms_m": 0.0021,
        "parameter_sd": {"offset_m": 0.00002, "tilt_rad": 0.00003},
    }
    shape = {
        "kind": "plane",
        "center_m": [WALL_X_M, 0, MIDDLE_Z_M],
        "normal": [-1, 0, 0],
        "size_m": [3.0, 2.5],
    }
    surface = {"name": words["surface"], "shape": shape, "source": "scans/wall.ply", "fit": fit}
    data = {
        "mission": "example-survey",
        "platform": "tilt_rotor_hexarotor",
        "impedance": "contact_ndt",
        "surfaces": [surface],
        "start": _posture(HOME),
        "targets": targets,
        "legs": legs,
        "duration_s": end_s,
        "energy_wh": 18.4,
        "path_m": 9.2,
        "cable_m": 2.6,
    }
    return Plan.model_validate_json(json.dumps(data))


def _posture(tip: Vector) -> dict[str, Any]:
    return {"p_WB": (tip - [ARM_M, 0, 0]).tolist(), "q_WB": [1, 0, 0, 0]}
