"""The structure, the flight around it and what chapters mark on it, in three dimensions."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.log.reader import RunLog
from inspect_cli.records import Estimate, State
from inspect_cli.reporting.figures.figure import Figure, Json, numbers, words
from inspect_cli.reporting.figures.palette import (
    ESTIMATE,
    MUTED,
    REFERENCE,
    TIP,
    TRUTH,
    LineStyle,
)
from inspect_cli.reporting.figures.rows import rows_of
from inspect_cli.reporting.figures.scene_marks import SceneMarks
from inspect_cli.reporting.words.text import Text, say, sentences, together
from inspect_cli.schema.plan import Plan, PlannedSurface
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.spatial.primitives import PLANE, point_at

FAR_M = 1000.0
"""A diverged flight ends far away; beyond this it would hide everything else."""
PATH_SAMPLES = 3000
CLOUD_POINTS = 3000
CURVED_NODES = 25


def scene_figure(log: RunLog, plan: Plan, marks: Sequence[SceneMarks]) -> Figure:
    """Surfaces, planned and flown path, and what chapters mark; equal scales."""
    traces = [_surface(surface) for surface in plan.surfaces]
    traces.append(_path(say("planned path"), _planned_path(plan), REFERENCE, "dash"))
    for record, position, style, name in (
        (State, "p_WT", TIP, say("tool's tip (truth)")),
        (State, "p_WB", TRUTH, say("flown path (truth)")),
        (Estimate, "p_WB", ESTIMATE, say("flown path (estimate)")),
    ):
        rows = rows_of(log, record)
        if rows is not None:
            shown = "legendonly" if style is TIP else True
            traces.append({**_path(name, rows[position], style, "solid"), "visible": shown})
    traces += [*(trace for one in marks for trace in one.traces), *_cloud(log)]
    layout: Json = {
        "margin": {"l": 0, "r": 0, "t": 30, "b": 70},
        **{name: part for one in marks for name, part in one.layout.items()},
        "scene": {
            "aspectmode": "data",
            "camera": {"eye": _eye(plan), "center": {"x": 0, "y": 0, "z": -0.2}},
            **{f"{axis}axis": {"title": {"text": f"{axis} (m)"}} for axis in "xyz"},
        },
    }
    return Figure(
        "scene",
        sentences(
            [
                say(
                    "Structure as the planner believed it, path of the body, and where the tool "
                    "was believed to touch; equal scales on all axes. Drag to turn."
                ),
                *(one.sentence for one in marks),
            ]
        ),
        say("Three-dimensional view of the structure, the path and the readings."),
        traces,
        layout,
        600,
    )


def patch_mesh(surface: PlannedSurface) -> Points:
    """Nodes (rows, columns, 3) of the surface's bounded patch in W, m."""
    primitive = primitive_of(surface.shape)
    n = 2 if primitive["kind"][0] == PLANE else CURVED_NODES
    half_u, half_v = primitive["half_size"][0]
    return np.array(
        [
            [point_at(primitive, 0, u, v) for u in np.linspace(-half_u, half_u, n)]
            for v in np.linspace(-half_v, half_v, n)
        ]
    )


def _surface(surface: PlannedSurface) -> Json:
    mesh = np.round(patch_mesh(surface), 4)
    name = words(surface.name)
    return {
        "type": "surface",
        "name": name,
        "x": mesh[:, :, 0].tolist(),
        "y": mesh[:, :, 1].tolist(),
        "z": mesh[:, :, 2].tolist(),
        "colorscale": [[0, "#c9d1d9"], [1, "#c9d1d9"]],
        "showscale": False,
        "opacity": 0.6,
        "lighting": {"ambient": 0.85, "diffuse": 0.25, "specular": 0.0},
        "hovertemplate": together(name, "<extra></extra>"),
        "showlegend": True,
    }


def _planned_path(plan: Plan) -> Points:
    postures = [plan.start, *(posture for leg in plan.legs for posture in leg.postures)]
    return np.array([posture.p_WB for posture in postures])


def _path(name: Text, p_W: Points, style: LineStyle, dash: str) -> Json:
    stride = -(-len(p_W) // PATH_SAMPLES)
    path = p_W[::stride]
    near = np.all(np.abs(np.nan_to_num(path, nan=np.inf)) < FAR_M, axis=1)
    x, y, z = (numbers(np.where(near, path[:, k], np.nan)) for k in range(3))
    return {
        "type": "scatter3d",
        "mode": "lines",
        "name": name,
        "x": x,
        "y": y,
        "z": z,
        "line": {"color": style.colour, "width": 3, "dash": dash},
        "hoverinfo": "name",
    }


def _cloud(log: RunLog) -> list[Json]:
    """A thinned sample of what the depth camera saw; hidden until asked for."""
    seen = [cloud.points_W for cloud in log.points if len(cloud.points_W)]
    if not seen:
        return []
    cloud = np.concatenate(seen)
    cloud = cloud[np.all(np.abs(np.nan_to_num(cloud, nan=np.inf)) < FAR_M, axis=1)]
    sample = cloud[:: max(1, -(-len(cloud) // CLOUD_POINTS))]
    x, y, z = (numbers(sample[:, k]) for k in range(3))
    return [
        {
            "type": "scatter3d",
            "mode": "markers",
            "name": say("depth camera"),
            "visible": "legendonly",
            "x": x,
            "y": y,
            "z": z,
            "marker": {"size": 1.5, "color": MUTED},
            "hoverinfo": "skip",
        }
    ]


def _eye(plan: Plan) -> Json:
    """Position of plotly's camera: on the free side of the surfaces, above and to their side."""
    normals = [target.n_W for target in plan.targets if target.surface is not None]
    n_W: Vector = np.mean(normals, axis=0) if normals else np.array([-1.0, 0.0, 0.0])
    level = np.array([n_W[0], n_W[1], 0.0])
    length = float(np.linalg.norm(level))
    level = level / length if length > 0.3 else np.array([-1.0, 0.0, 0.0])
    side = np.array([-level[1], level[0], 0.0])
    eye = 1.45 * level + 0.95 * side + np.array([0.0, 0.0, 0.55])
    return dict(zip("xyz", np.round(eye, 3).tolist(), strict=True))
