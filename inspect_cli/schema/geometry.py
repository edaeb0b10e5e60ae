"""Bounded primitives and displacements, as they are written in missions, truths and plans."""

from __future__ import annotations

import math
from typing import Annotated, Literal

from pydantic import Field, model_validator

from inspect_cli.schema.base import Direction, Positive, Strict, Triple

Side = Literal["outside", "inside"]

ROUNDING = 1e-9
"""A patch that goes all the way around may have been written out with rounded numbers."""
LEAST_ANGLE_RAD = 1e-6
"""``facing`` nearer to a cylinder's axis than this tells no direction from it."""


def _require_arc(size_m: float, circle_share_m: float, what: str) -> None:
    if size_m > circle_share_m * (1.0 + ROUNDING):
        raise ValueError(f"size_m: {size_m:g} is longer than {what}, {circle_share_m:.6g}")


class PlaneShape(Strict):
    """A rectangle. ``normal`` points to the side from which it is touched."""

    kind: Literal["plane"] = "plane"
    center_m: Triple
    normal: Direction
    size_m: tuple[Positive, Positive]
    """Extent along the level direction u and along v = n × u."""


class SphereShape(Strict):
    """A patch of a sphere around the direction ``facing`` from its centre."""

    kind: Literal["sphere"] = "sphere"
    center_m: Triple
    radius_m: Positive
    facing: Direction
    """From the centre to the middle of the patch."""
    size_m: tuple[Positive, Positive]
    """Arc lengths of the patch along its equator u and meridian v."""
    side: Side = "outside"

    @model_validator(mode="after")
    def _once_around(self) -> SphereShape:
        _require_arc(self.size_m[0], 2.0 * math.pi * self.radius_m, "the equator 2πR")
        _require_arc(self.size_m[1], math.pi * self.radius_m, "a meridian πR")
        return self


class CylinderShape(Strict):
    """A patch of a cylinder around the direction ``facing`` from its axis."""

    kind: Literal["cylinder"] = "cylinder"
    center_m: Triple
    """The point of the axis at half the patch's length."""
    axis: Direction
    radius_m: Positive
    facing: Direction
    """From the axis to the middle of the patch; its part along the axis is ignored."""
    size_m: tuple[Positive, Positive]
    """Arc length u around the axis and length v along it."""
    side: Side = "outside"

    @model_validator(mode="after")
    def _once_around(self) -> CylinderShape:
        _require_arc(self.size_m[0], 2.0 * math.pi * self.radius_m, "the circumference 2πR")
        return self

    @model_validator(mode="after")
    def _facing_away_from_the_axis(self) -> CylinderShape:
        along = sum(a * f for a, f in zip(self.axis, self.facing, strict=True))
        across = [f - along * a for a, f in zip(self.axis, self.facing, strict=True)]
        if math.hypot(*across) < LEAST_ANGLE_RAD:
            raise ValueError("facing must not be parallel to axis: it says which side is touched")
        return self


Shape = Annotated[PlaneShape | SphereShape | CylinderShape, Field(discriminator="kind")]


class MeshShape(Strict):
    """An irregular surface: a mesh that is a graph of heights over a plane."""

    kind: Literal["mesh"] = "mesh"
    file: str
    """STL, OBJ or PLY, in the campaign folder, in the world's coordinates."""
    normal: Direction | None = None
    """The plane's normal, to the side from which the surface is touched. Without it the plane is
    the one that fits best, and the free side the one that the faces turn to."""
    pitch_m: Annotated[float, Field(ge=0.002, le=0.5)] = 0.02
    """Greatest spacing of the grid of heights that the mesh is resampled to."""


TrueShape = Annotated[
    PlaneShape | SphereShape | CylinderShape | MeshShape, Field(discriminator="kind")
]
"""What a surface may truly be; no planner believes in a mesh."""


class Displacement(Strict):
    """A rigid motion: turn about ``about_m``, then shift."""

    rotate_deg: Triple = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw about the world's axes: R = R_z R_y R_x."""
    about_m: Triple = (0.0, 0.0, 0.0)
    translate_m: Triple = (0.0, 0.0, 0.0)
