"""Small flights with known rows, for the log's tests."""

from __future__ import annotations

import json
import math
from pathlib import Path
from typing import Any

import numpy as np

from inspect_cli.interfaces import DepthLaw
from inspect_cli.log.writer import LogWriter
from inspect_cli.records import (
    Command,
    Estimate,
    Probe,
    Reading,
    Record,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
)
from inspect_cli.schema.geometry import CylinderShape, PlaneShape
from inspect_cli.schema.loading import load_platform
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import Leg, MarginModel, Plan, PlannedSurface, PostureModel, Target
from inspect_cli.schema.truth import TruthModel
from inspect_cli.vehicles.fully_actuated import BEHAVIOUR

LENGTHS = {"n_rotors": 12, "n_joints": 6, "n_servos": 6, "n_drives": 0, "n_arm": 0}
RECORDS: tuple[type[Record], ...] = (
    State,
    TrueContact,
    Estimate,
    Reference,
    Command,
    Probe,
    SurfaceEstimate,
    Reading,
)
HZ = {Probe: 50, SurfaceEstimate: 10, Reading: 1}
"""Rates; what is not named comes at 100 Hz."""
AWKWARD = np.array([0.0, -0.0, np.nan, np.inf, -np.inf, 5e-324, -1.7976931348623157e308, 0.1])
WALL = PlaneShape(center_m=(2.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size_m=(3.0, 2.0))
COLUMN = CylinderShape(
    center_m=(2.0, 3.0, 1.5),
    axis=(0.0, 0.0, 1.0),
    radius_m=0.5,
    facing=(-1.0, 0.0, 0.0),
    size_m=(1.0, 2.0),
)


def rows_of(record: type[Record], duration_s: float, seed: int = 0) -> Any:
    """Random rows (n,) with the awkward doubles strewn in; t_s = k / rate."""
    hz = HZ.get(record, 100)
    rng = np.random.default_rng([seed, RECORDS.index(record)])
    n = math.ceil(round(duration_s * 100) * hz / 100)
    rows = np.zeros(n, record.dtype(LENGTHS))
    numbers = rows.view("<f8").reshape(n, -1)
    numbers[:] = rng.normal(size=numbers.shape)
    awkward = rng.random(numbers.shape) < 0.1
    numbers[awkward] = rng.choice(AWKWARD, awkward.sum())
    rows["t_s"] = np.arange(n) / hz
    return rows


def flight(duration_s: float, seed: int = 0) -> dict[type[Record], Any]:
    """Rows of every record."""
    return {record: rows_of(record, duration_s, seed) for record in RECORDS}


def write(log: LogWriter, rows: dict[type[Record], Any]) -> None:
    """Log a flight tick by tick, as the flight loop does."""
    records = {record: record.create(LENGTHS) for record in rows}
    for k in range(rows[State].size):
        for record, array in rows.items():
            every = 100 // HZ.get(record, 100)
            if k % every == 0:
                records[record].array[0] = array[k // every]
                log.log(records[record])
        log.flush_due(k / 100)


def attach(log: LogWriter, contents: dict[str, bytes]) -> None:
    for name, data in contents.items():
        log.attach(name, "application/json", data)


def write_flight(path: Path, root: Path, duration_s: float = 1.3) -> dict[type[Record], Any]:
    """A finished log with everything in it; the rows that it holds."""
    rows = flight(duration_s)
    with LogWriter(path, RECORDS, LENGTHS) as log:
        attach(log, attachments(root))
        log.scene(0.0, plan())
        log.event(0.02, "info", "take-off")
        log.pose("/pose/estimate", 0.03, [1.0, 2.0, 3.0], [1.0, 0.0, 0.0, 0.0])
        log.point_cloud("/tof/points", 0.04, np.arange(12.0).reshape(4, 3))
        write(log, rows)
        log.event(duration_s, "warning", "wind — 3 N")
        log.close("completed", "all points visited")
    return rows


def mission() -> Mission:
    return Mission.model_validate(
        {
            "name": "wall",
            "platform": "tilt_rotor_hexarotor",
            "structure": ({"name": "wall", "surface": {"shape": WALL.model_dump()}},),
            "tasks": ({"contact_grid": {"on": "wall", "rows": 1, "columns": 1, "pitch_m": 0.05}},),
        }
    )


def plan() -> Plan:
    home = PostureModel(p_WB=(0.0, 0.0, 0.2), q_WB=(1.0, 0.0, 0.0, 0.0))
    there = PostureModel(p_WB=(1.4, 0.0, 1.5), q_WB=(1.0, 0.0, 0.0, 0.0))
    target = Target(
        index=0,
        label="wall 1",
        kind="contact",
        impedance="contact_ndt",
        surface="wall",
        uv_m=(0.0, 0.0),
        p_WC=(2.0, 0.0, 1.5),
        n_W=(-1.0, 0.0, 0.0),
        q_WT=(0.5, 0.5, 0.5, 0.5),
        sensor="half_cell",
        law=DepthLaw(0.1, "contact_ndt", 1.8),
        dwell_s=3.0,
        standoff_m=0.25,
        standoff=there,
        contact=there,
        margins={"thrust": MarginModel(value=3.0, unit="N")},
        clearance_m=0.2,
    )
    return Plan(
        mission="wall",
        platform="tilt_rotor_hexarotor",
        impedance="contact_ndt",
        surfaces=(
            PlannedSurface(name="wall", shape=WALL, source="given"),
            PlannedSurface(name="column", shape=COLUMN, source="given"),
        ),
        start=home,
        targets=(target,),
        legs=(Leg(kind="transit", target=0, postures=(there,), speed_mps=0.5, duration_s=5.0),),
        duration_s=5.0,
        energy_wh=1.0,
        path_m=2.0,
        cable_m=2.5,
    )


def attachments(root: Path) -> dict[str, bytes]:
    platform = load_platform(root / "platforms" / "tilt_rotor_hexarotor.yaml")
    models = {
        "mission.json": mission(),
        "platform.json": platform,
        "plan.json": plan(),
        "modes.json": BEHAVIOUR.table,
        "truth.json": TruthModel(),
    }
    contents = {k: m.model_dump_json(by_alias=True).encode() for k, m in models.items()}
    contents["run.json"] = json.dumps({"seed": 7, "versions": {"numpy": "1.2.3"}}).encode()
    return contents
