"""How the set-point of a pitching crawler moves within a mode, by the time since it began."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, field
from itertools import pairwise

import numpy as np

from inspect_cli.interfaces import Posture
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import quaternion_to_matrix
from pitching_crawler.task_models import RAMP_S

LEAST_LINE_S = 1.0


@dataclass
class SetPoint:
    """Where the body shall be, and how hard it shall push along ``into_W``."""

    p_WB: Vector
    v_WB_W: Vector = field(default_factory=lambda: np.zeros(3))
    heading: float = 0.0
    force_n: float = 0.0
    into_W: Vector = field(default_factory=lambda: np.zeros(3))
    roll_mps: float = 0.0
    """Speed of the wheel's hub that its rolling shall give."""


Motion = Callable[[float, SetPoint], None]


def heading_of(posture: Posture) -> float:
    """Direction of x_B on the ground plan, rad."""
    x_W = quaternion_to_matrix(posture.q_WB)[:, 0]
    return float(np.arctan2(x_W[1], x_W[0]))


def stay(t_s: float, point: SetPoint) -> None:
    """Rest where it is."""
    point.v_WB_W = np.zeros(3)


def route(
    start: SetPoint, postures: Sequence[Posture], speed_mps: float, turn_radps: float
) -> tuple[Motion, float]:
    """From rest to rest through way-points, polynomials of fifth degree; and how long it takes.

    Such a line peaks at 15/8 of its mean speed.
    """
    places = [start.p_WB.copy(), *(posture.p_WB for posture in postures)]
    headings = [start.heading, *map(heading_of, postures)]
    turns = [float(np.arctan2(np.sin(b - a), np.cos(b - a))) for a, b in pairwise(headings)]
    lengths = [float(np.linalg.norm(b - a)) for a, b in pairwise(places)]
    lasts = [
        max(1.875 * way_m / speed_mps, 1.875 * abs(turn) / turn_radps, LEAST_LINE_S)
        for way_m, turn in zip(lengths, turns, strict=True)
    ]
    begins = np.concatenate([[0.0], np.cumsum(lasts)])

    def move(t_s: float, point: SetPoint) -> None:
        k = int(np.clip(np.searchsorted(begins, t_s, side="right") - 1, 0, len(lasts) - 1))
        s = min((t_s - begins[k]) / lasts[k], 1.0)
        share, along = s**3 * (10.0 - 15.0 * s + 6.0 * s**2), places[k + 1] - places[k]
        point.p_WB = places[k] + share * along
        point.v_WB_W = along * 30.0 * s**2 * (1.0 - s) ** 2 / lasts[k]
        point.heading = headings[k] + share * turns[k]

    return move, float(begins[-1])


def creep(start: Vector, velocity: Vector) -> Motion:
    """On at a constant velocity."""

    def move(t_s: float, point: SetPoint) -> None:
        point.p_WB, point.v_WB_W = start + velocity * t_s, velocity

    return move


def press(start: Vector, end: Vector, into_W: Vector, force_n: float) -> Motion:
    """Into a trimmed posture while the force rises."""

    def move(t_s: float, point: SetPoint) -> None:
        share = min(t_s / RAMP_S, 1.0)
        point.p_WB, point.v_WB_W = start + share * (end - start), np.zeros(3)
        point.into_W, point.force_n = into_W, share * force_n

    return move


def crawl(start: Vector, along_W: Vector, length_m: float, speed_mps: float) -> Motion:
    """Along the surface as the wheel rolls; the speed rises, holds and falls."""
    held_s = length_m / speed_mps - RAMP_S

    def move(t_s: float, point: SetPoint) -> None:
        rise = min(t_s, RAMP_S)
        fall = min(max(t_s - RAMP_S - held_s, 0.0), RAMP_S)
        hold = min(max(t_s - RAMP_S, 0.0), held_s)
        way = 0.5 * rise**2 / RAMP_S + hold + fall - 0.5 * fall**2 / RAMP_S
        speed = speed_mps * max(rise - fall, 0.0) / RAMP_S
        point.p_WB = start + speed_mps * way * along_W
        point.v_WB_W, point.roll_mps = speed * along_W, speed

    return move


def crawl_s(length_m: float, speed_mps: float) -> float:
    """How long a crawl takes."""
    return length_m / speed_mps + RAMP_S
