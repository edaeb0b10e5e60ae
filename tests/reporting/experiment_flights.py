"""Flights of experiments for the report to draw: the survey's flight with other targets.

A wall at x = 2 m as in ``example_flights``; what slides goes along it from 1 s after the press to
1 s before the end of the slide.
"""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path
from typing import Any

import numpy as np
from example_flights import ARM_M, FORCE_N, HZ, MIDDLE_Z_M, PRESS_M, WALL_X_M, Flight, survey
from modes import Mode

from inspect_cli.records import (
    WALL_SAMPLES,
    Estimate,
    Odometry,
    Probe,
    Reading,
    Reference,
    State,
    SurfaceEstimate,
    TrueContact,
    TrueDisturbance,
    WallForce,
)
from inspect_cli.schema.plan import Following, Stroke
from inspect_cli.spatial.arrays import Points, Vector

SLIDE_S = 8.0
CORNERS = np.array([[-0.2, -0.1], [0.2, -0.1], [0.2, 0.1], [-0.2, 0.1], [-0.2, -0.1]])
APART_M = 0.004
PULL_N = 6.0
TURNED = np.array([np.sqrt(0.5), 0.0, np.sqrt(0.5), 0.0])
"""q_WT of a level tool that points along +x."""


def drawing(platform: Path, trials: int = 2) -> Flight:
    """A rectangle drawn several times, each trial ``APART_M`` above the one before."""
    pieces = tuple((tuple(a), tuple(b)) for a, b in pairwise(CORNERS))
    targets = [
        {
            "kind": "stroke",
            "stroke": Stroke(pieces_m=pieces, speed_mps=0.1, trial=trial),
            "uv_m": tuple(CORNERS[0]),
        }
        for trial in range(trials)
    ]
    flight = _sliding(platform, "push_and_slide", targets, _along(CORNERS))
    state, reference = flight.rows(State), flight.rows(Reference)
    for trial in range(trials):
        rows = (reference["target"] == trial) & (reference["mode"] == Mode.SLIDE)
        state["p_WT"][rows, 2] += trial * APART_M
    return flight


def servoing(platform: Path) -> Flight:
    """0.4 m along a surface that no plan describes."""
    way = Following(direction="y", distance_m=0.4, speed_mps=0.1)
    target = {"kind": "following", "following": way, "surface": None, "uv_m": None}
    flight = _sliding(platform, "depth_servoing", [target], _along(CORNERS[:2]))
    flight.plan = flight.plan.model_copy(update={"surfaces": ()})
    return flight


def hold(platform: Path, pulls: int = 2) -> Flight:
    """A hover of 30 s in which somebody pulls at a cord along x; the body yields by 5 cm/N."""
    flight = survey(platform, 1, 1)
    target = {"kind": "pose", "surface": None, "uv_m": None, "sensor": None, "dwell_s": 30.0}
    _set_targets(flight, "rope_pull_1", [target])
    n = 30 * HZ
    spans = ((Mode.TAKEOFF, 3 * HZ), (Mode.HOLD, n), (Mode.LAND, 3 * HZ))
    mode = np.concatenate([np.full(count, float(m)) for m, count in spans])
    t_s = np.arange(len(mode)) / HZ
    felt = np.zeros(len(t_s), TrueDisturbance.dtype())
    felt["t_s"] = t_s
    for k in range(pulls):
        rows = (t_s >= 6.0 + 9.0 * k) & (t_s < 10.0 + 9.0 * k)
        felt["pull"][rows] = k + 1
        felt["f_rope_W"][rows, 0] = PULL_N * np.hanning(np.count_nonzero(rows))
    for record in (Probe, Reading, SurfaceEstimate):
        del flight.channels[record.topic]
    _cut_to(flight, len(t_s))
    reference, state = flight.rows(Reference), flight.rows(State)
    reference["mode"], reference["target"] = mode, np.where(mode == Mode.HOLD, 0.0, -1.0)
    reference["p_WB"] = [0.0, 0.0, 1.0]
    reference["p_WT"] = [ARM_M, 0.0, 1.0]
    state["p_WB"] = reference["p_WB"] + 0.05 * felt["f_rope_W"]
    state["p_WT"] = reference["p_WT"] + 0.05 * felt["f_rope_W"]
    state["f_normal"] = 0.0
    if pulls:
        flight.channels[TrueDisturbance.topic] = felt
    return flight


def force_evaluation(platform: Path) -> Flight:
    """Two points pressed without a reading, with a sensor of 800 Hz in the wall and odometry."""
    flight = survey(platform, 1, 2)
    plain = {"sensor": None}
    _set_targets(flight, "contact_ndt", [plain, plain])
    for record in (Probe, Reading):
        del flight.channels[record.topic]
    state = flight.rows(State)
    blocks = np.zeros(int(state["t_s"][-1] / 0.1) - 1, WallForce.dtype())
    blocks["t_s"] = 0.1 * np.arange(1, len(blocks) + 1)
    blocks["period"] = 1.0 / 800.0
    blocks["q_WS"] = [np.sqrt(0.5), 0.0, -np.sqrt(0.5), 0.0]  # z_S is the normal, −x_W
    times = blocks["t_s"][:, None] - np.arange(WALL_SAMPLES - 1, -1, -1) / 800.0
    pressed = np.interp(times.ravel(), state["t_s"], state["f_normal"]).reshape(times.shape)
    noise = np.random.default_rng(2).normal(0.0, 1.0, times.shape)
    blocks["f_S"][:, :, 2] = -pressed + noise
    flight.channels[WallForce.topic] = blocks
    poses = np.zeros(3, Odometry.dtype())
    poses["t_s"], poses["q_WB"] = [1.0, 2.0, 3.0], [1.0, 0.0, 0.0, 0.0]
    flight.channels[Odometry.topic] = poses
    return flight


def _along(corners: Points) -> Points:
    """(u, v) at each row of a slide: at rest for a second, along the line, at rest again."""
    steps = np.linalg.norm(np.diff(corners, axis=0), axis=1)
    arc = np.concatenate([[0.0], np.cumsum(steps)])
    share = np.clip((np.arange(round(SLIDE_S * HZ)) / HZ - 1.0) / (SLIDE_S - 2.0), 0.0, 1.0)
    return np.column_stack([np.interp(share * arc[-1], arc, corners[:, k]) for k in range(2)])


def _sliding(platform: Path, impedance: str, changes: list[dict[str, Any]], uv: Points) -> Flight:
    """Approach, press, slide and retreat for each target, in front of the wall."""
    flight = survey(platform, 1, len(changes))
    _set_targets(flight, impedance, [{"sensor": None} | change for change in changes])
    for record in (Probe, Reading):
        del flight.channels[record.topic]
    phases = ((Mode.APPROACH, 2.0), (Mode.PRESS, 2.0), (Mode.SLIDE, SLIDE_S), (Mode.RETREAT, 2.0))
    each = [np.full(round(s * HZ), float(m)) for m, s in phases]
    once = np.concatenate(each)
    before, slid, after = (len(each[0]) + len(each[1]), len(each[2]), len(each[3]))
    path = np.vstack([np.tile(uv[0], (before, 1)), uv, np.tile(uv[-1], (after, 1))])
    assert len(path) == before + slid + after
    depth = np.concatenate(
        [
            np.linspace(-0.25, 0.0, len(each[0])),
            np.linspace(0.0, PRESS_M, len(each[1])),
            np.full(slid, PRESS_M),
            np.linspace(PRESS_M, -0.25, after),
        ]
    )
    _cut_to(flight, len(changes) * len(once))
    mode, depth, path = (np.concatenate([x] * len(changes)) for x in (once, depth, path))
    _write(flight, mode, depth, path, len(once))
    return flight


def _write(flight: Flight, mode: Vector, depth: Vector, uv: Points, each: int) -> None:
    reference, state = flight.rows(Reference), flight.rows(State)
    contact = flight.rows(TrueContact)
    reference["mode"] = mode
    reference["target"] = np.arange(len(mode)) // each
    on_wall = np.column_stack([np.full(len(mode), WALL_X_M), -uv[:, 0], MIDDLE_Z_M + uv[:, 1]])
    reference["p_WT"] = on_wall + np.outer(depth, [1.0, 0.0, 0.0])
    state["p_WT"] = on_wall + np.outer(np.minimum(depth, 0.0), [1.0, 0.0, 0.0])
    state["q_WT"] = TURNED
    state["q_WB"] = reference["q_WB"] = [1.0, 0.0, 0.0, 0.0]
    for rows in (reference, state):
        rows["p_WB"] = rows["p_WT"] - [ARM_M, 0.0, 0.0]
    state["f_normal"] = FORCE_N * np.maximum(depth, 0.0) / PRESS_M
    contact["distance"] = np.maximum(-depth, 0.0)
    flight.rows(Estimate)["p_WB"] = state["p_WB"] + [0.0, 0.0, 0.001]
    seen = flight.rows(SurfaceEstimate)
    row = np.minimum(np.round(seen["t_s"] * HZ).astype(int), len(mode) - 1)
    seen["p_WC"] = on_wall[row]


def _set_targets(flight: Flight, impedance: str, changes: list[dict[str, Any]]) -> None:
    targets = tuple(
        target.model_copy(update={"impedance": impedance} | change)
        for target, change in zip(flight.plan.targets, changes, strict=True)
    )
    flight.plan = flight.plan.model_copy(update={"targets": targets, "impedance": impedance})


def _cut_to(flight: Flight, n: int) -> None:
    """Every channel as long as ``n`` rows at 100 Hz; shorter ones are continued by their last."""
    end_s = n / HZ
    for topic, rows in flight.channels.items():
        step = float(np.median(np.diff(rows["t_s"])))
        count = round(end_s / step)
        longer = rows[np.minimum(np.arange(count), len(rows) - 1)].copy()
        longer["t_s"] = step * np.arange(count)
        flight.channels[topic] = longer
