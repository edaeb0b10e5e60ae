"""Ways from one standoff posture to the next that keep clear of the structure."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass, replace
from itertools import pairwise

import numpy as np

from inspect_cli.interfaces import Capabilities, Posture
from inspect_cli.planning.clearance import Scene, body_reach_m, gap_along
from inspect_cli.planning.timing import path_m, same
from inspect_cli.spatial.arrays import Vector

Way = tuple[Posture, ...]

BACK_OFF_M = (0.0, 0.25, 0.5, 1.0, 2.0)
"""How far a vehicle may back off along the surface's normal before it goes round something."""
DETOUR_MARGIN_M = 0.1
"""Room that a way round leaves beyond what the clearance asks for."""


@dataclass(frozen=True)
class Stop:
    """A posture between two transits, and the direction (3,) in W that leads away into the open.

    The direction is the surface's normal at a standoff, and zero in free air.
    """

    posture: Posture
    away_W: Vector

    def backed_off(self, distance_m: float) -> Posture:
        """The posture moved into the open."""
        return _moved(self.posture, self.posture.p_WB + distance_m * self.away_W)


def find_way(
    capabilities: Capabilities, scene: Scene, a: Stop, b: Stop, clearance_m: float
) -> Way | None:
    """The way-points after ``a`` up to and with ``b``, at rest in each; None if none is clear.

    Empty when the two postures are the same. The straight way if it is clear, else the
    shortest clear one of those that back off along the normals, rise over the top of the
    structure, or pass one or two corners of its outline on the ground plan.
    """
    if same(a.posture, b.posture):
        return ()

    def clear(way: Way) -> bool:
        stretches = pairwise((a.posture, *way))
        return all(gap_along(capabilities, scene, s).clears(clearance_m) for s in stretches)

    straight: Way = (b.posture,)
    if clear(straight):
        return straight
    room_m = body_reach_m(capabilities, b.posture) + clearance_m + DETOUR_MARGIN_M
    detours = [_without_pauses(a.posture, way) for way in _detours(scene, a, b, room_m)]
    detours.sort(key=lambda way: path_m((a.posture, *way)))
    return next((way for way in detours if clear(way)), None)


def _detours(scene: Scene, a: Stop, b: Stop, room_m: float) -> Iterator[Way]:
    """Candidates; the vehicle turns from a's attitude to b's as soon as it has backed off."""
    outline = _outline(scene, room_m)
    top_m = float(scene.high_W[2]) + room_m
    for back_m in BACK_OFF_M:
        leave, arrive = a.backed_off(back_m), b.backed_off(back_m)
        ending = (arrive, b.posture)
        yield (leave, *ending)
        if top_m > max(leave.p_WB[2], arrive.p_WB[2]):
            yield (leave, _at_height(leave, top_m), _at_height(arrive, top_m), *ending)
        height_m = max(float(leave.p_WB[2]), float(arrive.p_WB[2]))
        corners = [_moved(arrive, np.array([x, y, height_m])) for x, y in outline]
        for k in range(4):
            yield (leave, corners[k], *ending)
            yield (leave, corners[k], corners[(k + 1) % 4], *ending)
            yield (leave, corners[k], corners[(k - 1) % 4], *ending)


def _outline(scene: Scene, room_m: float) -> list[tuple[float, float]]:
    """The corners (x, y) m of the structure's box, widened by ``room_m``, in turning order."""
    x_low, y_low = (float(x) - room_m for x in scene.low_W[:2])
    x_high, y_high = (float(x) + room_m for x in scene.high_W[:2])
    return [(x_low, y_low), (x_high, y_low), (x_high, y_high), (x_low, y_high)]


def _moved(posture: Posture, p_WB: Vector) -> Posture:
    return replace(posture, p_WB=p_WB)


def _at_height(posture: Posture, height_m: float) -> Posture:
    return _moved(posture, np.array([posture.p_WB[0], posture.p_WB[1], height_m]))


def _without_pauses(start: Posture, way: Way) -> Way:
    """The way without way-points that repeat the posture before them."""
    kept: list[Posture] = []
    before = start
    for posture in way:
        if not same(before, posture):
            kept.append(posture)
            before = posture
    return tuple(kept)
