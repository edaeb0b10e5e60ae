"""Small flights with known motion, written as logs."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
from modes import TABLE_JSON, Mode

from inspect_cli.interfaces import DepthLaw
from inspect_cli.log.reader import RunLog, read_log
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import Command, Estimate, Reading, Reference, State
from inspect_cli.schema.geometry import CylinderShape, PlaneShape, Shape, SphereShape
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Leg, MarginModel, Plan, PlannedSurface, PostureModel, Target
from inspect_cli.schema.result import PointResult, Result

LENGTHS = {"n_rotors": 12, "n_joints": 6, "n_servos": 6, "n_arm": 0}
TOOL_M = 0.6
"""The flights need not be exact: the tip is drawn where the model has it."""
UP = (1.0, 0.0, 0.0, 0.0)
DURATION_S, HZ = 2.0, 100
CLASSES = {0: "passive", 1: "uncertain", 2: "active"}
AT_S = (0.5, 1.0, 1.5)
"""When the readings come, the last of them invalid where there is a fourth."""

WALL = PlaneShape(center_m=(2.0, 0.0, 1.2), normal=(-1.0, 0.0, 0.0), size_m=(2.4, 2.4))
SOFFIT = PlaneShape(center_m=(1.0, 0.0, 2.4), normal=(0.0, 0.0, -1.0), size_m=(2.0, 2.0))
FLOOR = PlaneShape(center_m=(1.0, 0.0, 0.0), normal=(0.0, 0.0, 1.0), size_m=(2.0, 2.0))
COLUMN = CylinderShape(
    center_m=(2.0, 0.0, 1.2), axis=(0, 0, 1), radius_m=0.3, facing=(-1, 0, 0), size_m=(1.8, 2.4)
)
VAULT = CylinderShape(
    center_m=(1.0, 0.0, 0.5),
    axis=(1.0, 0.0, 0.0),
    radius_m=2.0,
    facing=(0.0, 0.0, 1.0),
    size_m=(4.0, 2.0),
    side="inside",
)
BALL = SphereShape(
    center_m=(2.5, 0.0, 1.2), radius_m=0.5, facing=(-1, 0, 0), size_m=(2 * np.pi * 0.5, np.pi * 0.5)
)
"""A whole sphere, with both its poles."""


def plan(shape: Shape = WALL, count: int = 3) -> Plan:
    """Contacts in a row at the middle of a surface."""
    home = PostureModel(p_WB=(0.0, 0.0, 0.2), q_WB=UP)
    facing = shape.normal if isinstance(shape, PlaneShape) else shape.facing
    side = 1.0 if isinstance(shape, PlaneShape) or shape.side == "outside" else -1.0
    n_W = side * np.array(facing, dtype=float)
    front = np.array(shape.center_m, dtype=float)
    if not isinstance(shape, PlaneShape):
        front = front + shape.radius_m * np.array(facing, dtype=float)
    targets = []
    for k in range(count):
        p_WC = front + np.array([0.0, 0.15 * (k - 1), 0.0])
        body = PostureModel(p_WB=tuple(p_WC + TOOL_M * n_W), q_WB=UP)
        targets.append(
            Target(
                index=k, label=str(k + 1), kind="contact", impedance="contact_ndt",
                surface="surface", uv_m=(0.15 * (k - 1), 0.0), p_WC=tuple(p_WC), n_W=tuple(n_W),
                q_WT=(0.5, 0.5, 0.5, 0.5), sensor="half_cell",
                law=DepthLaw(0.1, "contact_ndt", 1.8), dwell_s=0.2,
                standoff_m=0.2, standoff=body, contact=body,
                margins={"thrust": MarginModel(value=3.0, unit="N")}, clearance_m=0.2,
            )
        )  # fmt: skip
    leg = Leg(kind="transit", target=0, postures=(home,), speed_mps=0.5, duration_s=1.0)
    return Plan(
        mission="drawn", platform="tilt_rotor_hexarotor", impedance="contact_ndt",
        surfaces=(PlannedSurface(name="surface", shape=shape, source="given"),),
        start=home, targets=tuple(targets), legs=(leg,), duration_s=DURATION_S,
        energy_wh=1.0, path_m=2.0, cable_m=2.0,
    )  # fmt: skip


def result(count: int = 3, invalid: int = -1) -> Result:
    """One reading of each class, and point ``invalid`` without one."""
    points = [
        PointResult(
            index=k, label=str(k + 1), valid=k != invalid,
            reason="too short" if k == invalid else "", p_W=(2.0, 0.0, 1.2), uv_m=(0.0, 0.0),
            potential_mv=None if k == invalid else -200.0, resistance_ohm=None,
            resistivity_ohm_m=None, probe_force_n=None, contact_s=1.0,
            astm_class=None if k == invalid else CLASSES[k], corrosion=None,
        )
        for k in range(count)
    ]  # fmt: skip
    return Result(
        mission="drawn", platform="tilt_rotor_hexarotor", seed=1, status="completed",
        checks=(), metrics={}, points=tuple(points),
    )  # fmt: skip


def _mission(plan: Plan) -> Mission:
    shape = plan.surfaces[0].shape.model_dump()
    grid = {"on": "surface", "rows": 1, "columns": 3, "pitch_m": 0.15}
    return Mission.model_validate(
        {
            "name": "drawn",
            "platform": "tilt_rotor_hexarotor",
            "structure": ({"name": "surface", "surface": {"shape": shape}},),
            "tasks": ({"contact_grid": grid},),
        }
    )


def path(plan: Plan, t_s: float) -> np.ndarray:
    """p_WB: from the start to the first point in 0.4 s, then from point to point."""
    stops = [plan.start.p_WB, *(target.contact.p_WB for target in plan.targets)]
    times = [0.0, 0.4, *(0.4 + 0.5 * k for k in range(1, len(plan.targets)))]
    return np.array([np.interp(t_s, times, [stop[k] for stop in stops]) for k in range(3)])


def write_flight(
    file: Path,
    root: Path,
    plan: Plan,
    *,
    truth: bool = True,
    diverges_s: float = np.inf,
    finished: bool = True,
    mode: Mode = Mode.PRESS,
) -> RunLog:
    """Write a flight and read it back; with ``truth`` false it is like that of a real vehicle."""
    platform = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml")
    moving = State if truth else Estimate
    kinds = (moving, Reference, Command, Reading)
    with LogWriter(file, kinds, LENGTHS) as log:
        contents = {"mission.json": _mission(plan), "platform.json": platform, "plan.json": plan}
        for name, model in contents.items():
            content = model.model_dump_json(by_alias=True).encode()
            log.attach(name, "application/json", content)
        log.attach("modes.json", "application/json", TABLE_JSON)
        log.attach("run.json", "application/json", json.dumps({"seed": 1}).encode())
        row, reference, command, reading = (kind.create(LENGTHS) for kind in kinds)
        taken = 0
        for tick in range(round(DURATION_S * HZ)):
            t_s = tick / HZ
            for record in (row, reference, command):
                record.t_s = t_s
            row.p_WB = path(plan, t_s) if t_s < diverges_s else np.full(3, np.nan)
            row.q_WB = UP
            reference.mode = mode if t_s > 0.4 else Mode.TRANSIT
            reference.target = min(max(taken, 0), len(plan.targets) - 1)
            command.joint_angle = 0.1 * t_s
            for record in (row, reference, command):
                log.log(record)
            if taken < len(AT_S) and t_s >= AT_S[taken]:
                reading.t_s, reading.target, reading.valid = t_s, taken, 1.0
                reading.p_WT = plan.targets[taken].p_WC
                log.log(reading)
                taken += 1
            log.flush_due(t_s)
        if finished:
            log.close("completed", "")
    return read_log(file if file.is_file() else file.with_name(f"{file.name}.part"))
