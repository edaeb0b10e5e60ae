"""Missions and surfaces in a few words, for the planner's tests."""

from __future__ import annotations

import numpy as np

from inspect_cli.planning.planner import make_plan
from inspect_cli.schema.geometry import CylinderShape, PlaneShape, SphereShape
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.plan import PlannedSurface


def wall(center=(2.0, 0.0, 1.5), normal=(-1.0, 0.0, 0.0), size=(3.0, 2.0)):
    return PlaneShape(center_m=center, normal=normal, size_m=size)


def column(center=(2.0, 0.0, 1.5), radius=0.5, facing=(-1.0, 0.0, 0.0), size=(1.5, 2.0), **more):
    return CylinderShape(
        center_m=center,
        axis=more.pop("axis", (0.0, 0.0, 1.0)),
        radius_m=radius,
        facing=facing,
        size_m=size,
        **more,
    )


def ball(center=(2.5, 0.0, 1.5), radius=1.0, facing=(-1.0, 0.0, 0.0), size=(1.0, 1.0), **more):
    return SphereShape(center_m=center, radius_m=radius, facing=facing, size_m=size, **more)


def grid(on="wall", rows=1, columns=9, pitch_m=0.05, **more):
    return {
        "contact_grid": {"on": on, "rows": rows, "columns": columns, "pitch_m": pitch_m, **more}
    }


def points(*at_m, on="wall", **more):
    return {"contact_points": {"on": on, "at_m": at_m, **more}}


def mission(*tasks, surfaces, start=None, flight=None):
    shapes = {name: shape.model_dump() for name, shape in surfaces.items()}
    return Mission.model_validate(
        {
            "name": "test",
            "platform": "fake",
            "start": start or {},
            "flight": flight or {},
            "structure": tuple({"name": n, "surface": {"shape": s}} for n, s in shapes.items()),
            "tasks": tasks,
        }
    )


def plan(vehicle, *tasks, surfaces=None, cable_m=20.0, min_force_n=0.0, **more):
    surfaces = surfaces or {"wall": wall()}
    believed = tuple(PlannedSurface(name=n, shape=s, source="given") for n, s in surfaces.items())
    asked = mission(*tasks, surfaces=surfaces, **more)
    return make_plan(asked, "fake", vehicle, believed, cable_m, {"half_cell": min_force_n})


def array(*models):
    """Positions p_WB (n, 3) of posture models."""
    return np.array([model.p_WB for model in models])
