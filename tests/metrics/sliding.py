"""Strokes and a followed surface on a wall, every number known; made without a simulator.

The wall is the plane x = 2 m, seen and touched along +x: a level tool's z_T is x_W. Rows come at
100 Hz. Each target is approached, pressed from 0.5 s into the press, slid along by ``WAY_M`` along
−y_W and left; it lets go 0.1 s into the retreat.
"""

from __future__ import annotations

from typing import Any

import numpy as np
from modes import Mode
from scipy.spatial.transform import Rotation
from synthetic import LENGTHS, WALL_X_M, SyntheticFlight, nine_points

from inspect_cli.records import Reference, State, TrueContact
from inspect_cli.schema.plan import Following, Stroke
from inspect_cli.spatial.arrays import Vector

HZ = 100
REST_S, MOVE_S = 1.0, 4.0
SPEED_MPS = 0.1
WAY_M = SPEED_MPS * MOVE_S
FORCE_N = 2.0
LEVEL = Rotation.from_euler("y", 90.0, degrees=True)
START = np.array([WALL_X_M, 0.2, 1.5])
PHASES: tuple[tuple[Mode, float], ...] = (
    (Mode.TRANSIT, 1.0),
    (Mode.APPROACH, 1.0),
    (Mode.PRESS, 2.0),
    (Mode.SLIDE, REST_S + MOVE_S + REST_S),
    (Mode.RETREAT, 1.0),
)


def strokes(trials: int = 2, parts: int = 1) -> SyntheticFlight:
    """A drawing of some parts, each the same line, drawn several times."""
    targets = []
    for trial in range(trials):
        for part in range(parts):
            stroke = Stroke(
                pieces_m=(((0.0, 0.0), (WAY_M, 0.0)),),
                speed_mps=SPEED_MPS,
                trial=trial,
                part=part,
            )
            targets.append({"kind": "stroke", "stroke": stroke, "surface": "wall"})
    return _flight(targets)


def following() -> SyntheticFlight:
    """One surface that is followed."""
    way = Following(direction="x", distance_m=WAY_M, speed_mps=SPEED_MPS)
    return _flight([{"kind": "following", "following": way, "surface": None, "uv_m": None}])


def rows_of(flight: SyntheticFlight, target: int, mode: Mode) -> Vector:
    """Indices of the rows of a target in a mode."""
    reference = flight.rows(Reference)
    return np.flatnonzero((reference["target"] == target) & (reference["mode"] == mode))


def touched(flight: SyntheticFlight, target: int) -> Vector:
    """Indices of the rows from first touch to release of a target."""
    reference, force = flight.rows(Reference), flight.rows(State)["f_normal"]
    rows = np.flatnonzero((reference["target"] == target) & (force > 0.1))
    return np.arange(rows[0], rows[-1] + 1)


def moving(flight: SyntheticFlight, target: int) -> Vector:
    """Indices of the rows of a target in which its reference is on its way, ends included."""
    rows = rows_of(flight, target, Mode.SLIDE)
    return rows[round(REST_S * HZ) : round((REST_S + MOVE_S) * HZ) + 1]


def _flight(targets: list[dict[str, Any]]) -> SyntheticFlight:
    made = nine_points()
    model = made.plan.targets[0]
    plan = tuple(
        model.model_copy(update={"index": k, "label": str(k + 1), "sensor": None} | changes)
        for k, changes in enumerate(targets)
    )
    made.plan = made.plan.model_copy(update={"targets": plan})
    made.channels = _channels(len(targets))
    return made


def _channels(count: int) -> dict[str, Any]:
    mode = np.concatenate([np.full(round(s * HZ), float(m)) for m, s in PHASES] * count)
    each = len(mode) // count
    target = np.repeat(np.arange(count, dtype=float), each)
    clock = np.tile(np.concatenate([np.arange(round(s * HZ)) / HZ for _, s in PHASES]), count)
    n = len(mode)
    reference = np.zeros(n, Reference.dtype())
    state = np.zeros(n, State.dtype(LENGTHS))
    contact = np.zeros(n, TrueContact.dtype())
    for rows in (reference, state, contact):
        rows["t_s"] = np.arange(n) / HZ
    share = np.where(mode == Mode.SLIDE, np.clip((clock - REST_S) / MOVE_S, 0.0, 1.0), 0.0)
    share = np.where(mode == Mode.RETREAT, 1.0, share)
    on_wall = START - share[:, None] * [0.0, WAY_M, 0.0]
    reference["mode"], reference["target"] = mode, target
    reference["p_WT"] = on_wall + np.array([0.1, 0.0, 0.0])
    reference["q_WB"] = state["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    state["p_WT"] = on_wall
    state["q_WT"] = LEVEL.as_quat(scalar_first=True)
    pressing = ((mode == Mode.PRESS) & (clock >= 0.5 - 1e-9)) | (mode == Mode.SLIDE)
    pressing |= (mode == Mode.RETREAT) & (clock < 0.1 - 1e-9)
    state["f_normal"] = np.where(pressing, FORCE_N, 0.0)
    contact["n_W"] = [-1.0, 0.0, 0.0]
    return {State.topic: state, Reference.topic: reference, TrueContact.topic: contact}
