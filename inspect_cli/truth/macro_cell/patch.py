"""The metric of a surface's coordinates (u, v) and of the depth d below it.

The coordinates are orthogonal. A step (du, dv, dd) is h_u du, h_v dv and dd long, where with the
curvature κ = 1/R of a surface that is touched from outside, κ = −1/R from inside:

    plane      h_u = 1                        h_v = 1
    cylinder   h_u = 1 − κ d                  h_v = 1
    sphere     h_u = (1 − κ d) cos(v / R)     h_v = 1 − κ d

which follows from the parametrisations in ``spatial.primitives`` with R replaced by R ∓ d. A mesh
is taken as flat in its (u, v): its relief is shallow against its extent.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Final, Literal

import numpy as np

from inspect_cli.schema.geometry import CylinderShape, PlaneShape, SphereShape, TrueShape
from inspect_cli.spatial.arrays import Vector

LEAST_COSINE: Final = 0.05
"""Nearer to a sphere's pole the meridians are taken as parallel: there they would meet."""


@dataclass(frozen=True)
class Patch:
    """What the concrete under a surface inherits of its shape."""

    size_m: tuple[float, float]
    """Extent along u and v."""
    kind: Literal["plane", "cylinder", "sphere"] = "plane"
    curvature: float = 0.0
    """κ, 1/m."""

    def scales(self, v: Vector, d: Vector) -> tuple[Vector, Vector]:
        """(h_u, h_v) at the heights ``v`` and depths ``d``, m, that broadcast together."""
        one = np.ones(np.broadcast_shapes(v.shape, d.shape))
        if self.kind == "plane":
            return one, one
        shrunk = one * (1.0 - self.curvature * d)
        if self.kind == "cylinder":
            return shrunk, one
        cosine = np.maximum(np.cos(v * abs(self.curvature)), LEAST_COSINE)
        return shrunk * cosine, shrunk


def patch_of(shape: TrueShape, extent_m: tuple[float, float]) -> Patch:
    """The patch of a surface; ``extent_m`` is that of a mesh, which does not state its own."""
    if isinstance(shape, PlaneShape):
        return Patch(shape.size_m)
    if isinstance(shape, CylinderShape | SphereShape):
        side = 1.0 if shape.side == "outside" else -1.0
        return Patch(shape.size_m, shape.kind, side / shape.radius_m)
    return Patch(extent_m)
