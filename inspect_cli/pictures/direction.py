"""The script of a flight's pictures: what is shown, when, and from where."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import mujoco
import numpy as np

from inspect_cli.interfaces import TOOL
from inspect_cli.log.layout import Bytes
from inspect_cli.log.reader import RunLog
from inspect_cli.pictures.moments import still_moment
from inspect_cli.pictures.script import FILM_PX, FPS, SCENE_PX, LegendEntry, Script, Shot
from inspect_cli.scene.marks import Mark, MarkStyle, marks_of
from inspect_cli.scene.motion import Motion, motion_of
from inspect_cli.scene.scene_model import FIELD_OF_VIEW_DEG, SEGMENTS, build_scene
from inspect_cli.scene.views import View, best_view, boxed, facing, framed, in_frame, near
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.schema.result import Result
from inspect_cli.spatial.arrays import Mask, Points, Vector
from inspect_cli.spatial.patches import patch_nodes
from inspect_cli.vehicles import build_vehicle
from inspect_cli.vehicles.actuators import rotor_radii_m
from inspect_cli.vehicles.kinds import Vehicle

FILM_S = 10.0
"""Length of a film, s; a flight that is shorter is shown in real time."""
LEAST_FRAMES = 2
AROUND_M = 0.35
"""Parts of the structure within this distance of the work or the path are in the frame."""
WORK_M = 0.12
PATH_SAMPLES, WATCHED_SAMPLES = 60, 30
TOGETHER_M = 2.5
"""The still shows the points to touch that are no farther than this from the vehicle."""
CLOSE_M = 1.5
"""Distance from the close camera to the point that it looks at, in spans of the vehicle."""


@dataclass(frozen=True, eq=False)
class Direction:
    """A script, and the facts that its captions state."""

    script: Script
    motion: Motion
    still_s: float
    touching: bool
    speed: float
    """Seconds of the flight in a second of film."""


def direct(log: RunLog, result: Result, styles: Mapping[str, MarkStyle]) -> Direction | None:
    """The script of a flight; None where the log holds no motion that can be drawn."""
    plan, vehicle = log.plan(), build_vehicle(log.platform())
    nominal = vehicle.nominal_spec().compile()
    motion = motion_of(log, nominal, vehicle)
    if motion is None:
        return None
    marks = marks_of(log, plan, result, motion, styles)
    span_m = _span(nominal, vehicle)
    still_s, touching = still_moment(log, motion)
    film_s, speed = _film_times(motion)
    shown = _shown(plan, motion, span_m)
    view = best_view(
        plan,
        shown,
        _watched(plan, motion),
        _beside(plan, motion, still_s),
        _FOV,
        FILM_PX[0] / FILM_PX[1],
    )
    center, extent = shown.mean(axis=0), float(np.ptp(shown, axis=0).max())
    model = build_scene(
        vehicle, plan.surfaces, marks, _sun(plan, view), _overhead(plan), center, extent
    )
    legend = _legend(marks, styles)
    still = _still(plan, motion, marks, still_s, view, span_m)
    film = _film(plan, motion, marks, film_s, view, span_m, speed)
    names = [model.geom(f"mark:{k}").id for k in range(len(marks))]
    script = Script(_saved(model), np.array(names, dtype=np.int32), still, film, legend)
    return Direction(script, motion, still_s, touching, speed)


_FOV = float(np.radians(FIELD_OF_VIEW_DEG))


def _saved(model: mujoco.MjModel) -> Bytes:
    buffer = np.zeros(mujoco.mj_sizeModel(model), dtype=np.uint8)
    mujoco.mj_saveModel(model, None, buffer)
    return buffer


def _span(model: mujoco.MjModel, vehicle: Vehicle) -> float:
    """Half the visible width of the vehicle, m."""
    radius_m = rotor_radii_m(vehicle.actuators).max()
    data = mujoco.MjData(model)
    mujoco.mj_kinematics(model, data)
    reach = np.linalg.norm(data.site_xpos - data.xpos[model.body(vehicle.bodies.base).id], axis=1)
    tip = model.site(TOOL).id
    others = np.delete(reach, tip)
    return float(max(others.max(initial=0.1) + radius_m, reach[tip]))


def _film_times(motion: Motion) -> tuple[Vector, float]:
    """(times of the frames; how much faster than the flight they pass)."""
    lasts = float(motion.t_s[-1] - motion.t_s[0])
    speed = max(1.0, lasts / FILM_S)
    frames = max(LEAST_FRAMES, round(lasts / speed * FPS))
    return np.linspace(motion.t_s[0], motion.t_s[-1], frames), speed


def _work(plan: Plan) -> Points:
    return np.array([target.p_WC for target in plan.targets])


def _path(motion: Motion, samples: int) -> Points:
    rows = np.linspace(0, len(motion.t_s) - 1, samples).astype(int)
    return np.ascontiguousarray(motion.qpos[rows, :3])


def _shown(plan: Plan, motion: Motion, span_m: float) -> Points:
    """Points (n, 3) that the film's frame must hold: the work, the path, and what is near to
    them."""
    path = _path(motion, PATH_SAMPLES)
    work = _work(plan)
    path = near(path, [*work, np.array(plan.start.p_WB)], 3.0 * span_m)  # unless it flew off
    around = np.concatenate([work, path])
    fringes = [near(_fine_nodes(plan, k), around, AROUND_M) for k in range(len(plan.surfaces))]
    return np.concatenate([boxed(work, WORK_M), boxed(path, 0.8 * span_m), *fringes])


def _fine_nodes(plan: Plan, index: int) -> Points:
    patch = primitive_of(plan.surfaces[index].shape)
    return patch_nodes(patch, (SEGMENTS // 2, SEGMENTS // 2)).reshape(-1, 3)


def _watched(plan: Plan, motion: Motion) -> Points:
    """Points (n, 3) that should be visible: the targets, 5 cm before their surfaces, and the
    path."""
    before = [np.array(t.p_WC) + 0.05 * np.array(t.n_W) for t in plan.targets]
    return np.concatenate([np.array(before), _path(motion, WATCHED_SAMPLES)])


def _beside(plan: Plan, motion: Motion, t_s: float) -> Vector:
    """Vector (3,), m, from the tool at time ``t_s`` to the mean of the targets."""
    tip_W = motion.p_WT[motion.at(np.array([t_s]))[0]]
    away: Vector = _work(plan).mean(axis=0) - tip_W
    return away


def _sun(plan: Plan, view: View) -> Vector:
    """Unit vector (3,) towards the sun: above, and on the side that the surfaces and the camera
    share."""
    to_eye = view.eye_W - view.at_W
    to_eye = to_eye / np.linalg.norm(to_eye)
    sun: Vector = facing(plan) + 0.35 * to_eye
    sun[2] = max(0.0, sun[2]) + 0.9
    return sun / np.linalg.norm(sun)


def _overhead(plan: Plan) -> float:
    return max(0.0, -float(facing(plan)[2]))


def _still(
    plan: Plan, motion: Motion, marks: Sequence[Mark], t_s: float, view: View, span_m: float
) -> Shot:
    """The vehicle and the work around it, seen from where the film looks."""
    times = np.array([t_s])
    row = int(motion.at(times)[0])
    tip, body = motion.p_WT[row], motion.qpos[row, :3]
    work = _work(plan)
    together = work[np.linalg.norm(work - tip, axis=1) < TOGETHER_M]
    shown = np.concatenate([boxed(together, WORK_M), boxed(body[None], 0.75 * span_m)])
    direction = view.eye_W - view.at_W
    direction /= np.linalg.norm(direction)
    closer = framed(shown, direction, _FOV, SCENE_PX[0] / SCENE_PX[1])
    return Shot(motion.qpos[[row]], _visible(marks, times), closer, True, ("",), None, None)


def _film(
    plan: Plan,
    motion: Motion,
    marks: Sequence[Mark],
    times: Vector,
    view: View,
    span_m: float,
    speed: float,
) -> Shot:
    rows = motion.at(times)
    eyes, at = _close_camera(plan, motion.qpos[rows, :3], motion.p_WT[rows], view, span_m)
    right = _right_is_emptier(view, motion.qpos[rows, :3])
    lines = tuple(_clock(t - motion.t_s[0], speed) for t in times)
    return Shot(motion.qpos[rows], _visible(marks, times), view, right, lines, eyes, at)


def _right_is_emptier(view: View, body_W: Points) -> bool:
    """Whether the vehicle comes less into the upper right corner than into the upper left."""
    places = in_frame(view, body_W, _FOV, FILM_PX[0] / FILM_PX[1])
    upper = places[places[:, 1] > -0.1, 0]
    return int(np.sum(upper > 0.2)) <= int(np.sum(upper < -0.2))


def _close_camera(
    plan: Plan, body_W: Points, tip_W: Points, view: View, span_m: float
) -> tuple[Points, Points]:
    """(eyes, looked at), each (n, 3): beside the tool, on the side of the other camera."""
    at = 0.35 * body_W + 0.65 * tip_W
    n_W = facing(plan)
    to_eye = view.eye_W - view.at_W
    beside = to_eye - (to_eye @ n_W) * n_W
    beside /= max(float(np.linalg.norm(beside)), 1e-6)
    direction = beside + 0.25 * n_W + np.array([0.0, 0.0, 0.25])
    direction /= np.linalg.norm(direction)
    eyes = at + CLOSE_M * 2.0 * span_m * direction
    eyes[:, 2] = np.maximum(eyes[:, 2], 0.1)
    return eyes, at


def _clock(t_s: float, speed: float) -> str:
    minutes, seconds = divmod(int(t_s), 60)
    pace = (
        ""
        if speed < 1.05
        else f"  ·  {speed:.0f}x speed"
        if speed >= 9.5
        else f"  ·  {speed:.1f}x speed"
    )
    return f"{minutes}:{seconds:02d} min{pace}"


def _visible(marks: Sequence[Mark], times: Vector) -> Mask:
    begins = np.array([mark.from_s for mark in marks])
    ends = np.array([mark.until_s for mark in marks])
    return (begins <= times[:, None]) & (times[:, None] < ends)


def _legend(marks: Sequence[Mark], styles: Mapping[str, MarkStyle]) -> tuple[LegendEntry, ...]:
    """The classes that occur, in the order of the styles."""
    met = {mark.meaning for mark in marks}
    return tuple(
        LegendEntry(style.label, style.colour, style.symbol)
        for name, style in styles.items()
        if name in met
    )
