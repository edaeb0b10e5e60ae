"""Bounded primitives and displacements, as they are written in missions, truths and plans."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Direction, Positive, Strict, Triple

Side = Literal["outside", "inside"]


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


Shape = Annotated[PlaneShape | SphereShape | CylinderShape, Field(discriminator="kind")]


class Displacement(Strict):
    """A rigid motion: turn about ``about_m``, then shift."""

    rotate_deg: Triple = (0.0, 0.0, 0.0)
    """Roll, pitch, yaw about the world's axes: R = R_z R_y R_x."""
    about_m: Triple = (0.0, 0.0, 0.0)
    translate_m: Triple = (0.0, 0.0, 0.0)
