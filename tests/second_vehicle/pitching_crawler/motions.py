"""How the set-point of a pitching crawler moves within a mode, by the time since it began."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field

import numpy as np

from inspect_cli.spatial.arrays import Vector

RAMP_S = 1.0
"""In which a force and the speed of a crawl rise and fall."""


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


def stay(t_s: float, point: SetPoint) -> None:
    """Rest where it is."""
    point.v_WB_W = np.zeros(3)


def line(start: Vector, end: Vector, duration_s: float) -> Motion:
    """From rest to rest, a polynomial of fifth degree."""

    def move(t_s: float, point: SetPoint) -> None:
        s = min(t_s / duration_s, 1.0)
        point.p_WB = start + (end - start) * s**3 * (10.0 - 15.0 * s + 6.0 * s**2)
        point.v_WB_W = (end - start) * 30.0 * s**2 * (1.0 - s) ** 2 / duration_s

    return move


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
