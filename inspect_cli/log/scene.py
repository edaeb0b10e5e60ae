"""The plan as a picture: surfaces, path and targets in foxglove.SceneUpdate."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from foxglove_schemas_protobuf.Color_pb2 import Color
from foxglove_schemas_protobuf.LinePrimitive_pb2 import LinePrimitive
from foxglove_schemas_protobuf.Point3_pb2 import Point3
from foxglove_schemas_protobuf.Pose_pb2 import Pose
from foxglove_schemas_protobuf.Quaternion_pb2 import Quaternion
from foxglove_schemas_protobuf.SceneEntity_pb2 import SceneEntity
from foxglove_schemas_protobuf.SceneUpdate_pb2 import SceneUpdate
from foxglove_schemas_protobuf.Vector3_pb2 import Vector3

from inspect_cli.log.foxglove import WORLD_FRAME, timestamp_of
from inspect_cli.schema.plan import Plan, PlannedSurface, Target
from inspect_cli.schema.primitives import primitive_of
from inspect_cli.spatial.arrays import Points
from inspect_cli.spatial.patches import grid_triangles, patch_nodes
from inspect_cli.spatial.primitives import PLANE

CONCRETE = Color(r=0.72, g=0.72, b=0.70, a=0.6)
PATH = Color(r=0.10, g=0.45, b=0.85, a=1.0)
TARGET = Color(r=0.90, g=0.45, b=0.10, a=1.0)
SEGMENTS = 24
"""Facets of a curved patch along each of its coordinates."""
TARGET_M = 0.02
TEXT_M = 0.05


def plan_scene(time_ns: int, plan: Plan) -> SceneUpdate:
    """What is believed and intended: one entity per surface and target, one for the path."""
    entities = [_surface(time_ns, surface) for surface in plan.surfaces]
    entities += [_target(time_ns, target) for target in plan.targets]
    entities.append(_path(time_ns, plan))
    return SceneUpdate(entities=entities)


def _entity(time_ns: int, name: str) -> SceneEntity:
    return SceneEntity(timestamp=timestamp_of(time_ns), frame_id=WORLD_FRAME, id=name)


def _surface(time_ns: int, surface: PlannedSurface) -> SceneEntity:
    """A patch as triangles between the nodes of a regular (u, v) grid."""
    patch = primitive_of(surface.shape)
    segments = (1, 1) if patch["kind"][0] == PLANE else (SEGMENTS, SEGMENTS)
    entity = _entity(time_ns, f"surface/{surface.name}")
    entity.triangles.add(
        pose=_pose((0.0, 0.0, 0.0)),
        points=_points(patch_nodes(patch, segments).reshape(-1, 3)),
        color=CONCRETE,
        indices=grid_triangles(segments).ravel().tolist(),
    )
    return entity


def _target(time_ns: int, target: Target) -> SceneEntity:
    entity = _entity(time_ns, f"target/{target.index}")
    pose = _pose(target.p_WC)
    entity.spheres.add(pose=pose, size=Vector3(x=TARGET_M, y=TARGET_M, z=TARGET_M), color=TARGET)
    entity.texts.add(
        pose=pose, billboard=True, font_size=TEXT_M, scale_invariant=False, color=TARGET,
        text=target.label,
    )  # fmt: skip
    outward = np.array([target.p_WC, np.add(target.p_WC, np.multiply(0.1, target.n_W))])
    _line(entity, outward, TARGET)
    return entity


def _path(time_ns: int, plan: Plan) -> SceneEntity:
    entity = _entity(time_ns, "path")
    postures = [plan.start, *(posture for leg in plan.legs for posture in leg.postures)]
    _line(entity, np.array([posture.p_WB for posture in postures]), PATH)
    return entity


def _line(entity: SceneEntity, points: Points, color: Color) -> None:
    entity.lines.add(
        type=LinePrimitive.LINE_STRIP,
        pose=_pose((0.0, 0.0, 0.0)),
        thickness=2.0,
        scale_invariant=True,
        points=_points(points),
        color=color,
    )


def _points(points: Points) -> list[Point3]:
    return [Point3(x=x, y=y, z=z) for x, y, z in points.tolist()]


def _pose(position: Sequence[float]) -> Pose:
    x, y, z = position
    return Pose(position=Vector3(x=x, y=y, z=z), orientation=Quaternion(w=1.0))
