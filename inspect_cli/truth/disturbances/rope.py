"""A cord tied to the tool's tip, pulled by a hand.

The cord of length L and stiffness k is elastic and can only pull. When a pull starts, with the
tip at p₀, the hand stands at p₀ + L d where the cord is straight and without tension; d is the
stated direction. It then moves along d by F(t)/k,

    h(t) = p₀ + d (L + F(t)/k),        T = k max(0, |h − p_WT| − L),

and the tip feels T along h − p_WT: were it held at p₀, T would be the profile F(t). A vehicle
that yields sees less, one that swings sees the cord turn with it. F rises and falls with the
quintic 10 s³ − 15 s⁴ + 6 s⁵, whose first and second derivatives end at zero. After the fall the
hand lets go, of whatever tension a tip that has moved away has left. The cord has no mass and no
damping. A tip that the vehicle holds with K yields until T = F/(1 + k/K).
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.schema.disturbances import Pull, Rope
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import rotate
from inspect_cli.truth.disturbances.load import Circumstances, Load, Motion


@kernel
def profile(t_s: float, rise_s: float, hold_s: float, fall_s: float) -> float:
    """F(t) as a share of its greatest value, ``t_s`` from the pull's start on."""
    if t_s < rise_s:
        s = t_s / rise_s
    else:
        s = (rise_s + hold_s + fall_s - t_s) / fall_s
    s = min(max(s, 0.0), 1.0)
    return float(s * s * s * (10.0 + s * (6.0 * s - 15.0)))


@kernel
def tension(hand_W: Vector, tip_W: Vector, length_m: float, stiffness_npm: float) -> Vector:
    """The cord's force (3,) on the tip, N in W; zero while it is slack."""
    x, y, z = hand_W[0] - tip_W[0], hand_W[1] - tip_W[1], hand_W[2] - tip_W[2]
    distance = np.sqrt(x * x + y * y + z * z)
    if distance <= length_m:
        return np.zeros(3)
    scale = stiffness_npm * (distance - length_m) / distance
    return np.array([scale * x, scale * y, scale * z])


class RopeLoad:
    """The pulls at one rope; ``numbers`` are theirs among all pulls of the flight, from 1."""

    def __init__(self, model: Rope, numbers: tuple[int, ...]) -> None:
        self._model = model
        self._pulls = tuple(zip(numbers, model.pulls, strict=True))
        self._begun = 0
        self._tip_W: Vector = np.zeros(3)
        self._direction_W: Vector = np.zeros(3)

    def act(self, t_s: float, motion: Motion, load: Load) -> None:
        """Add the tension of the pull of this moment."""
        for number, pull in self._pulls:
            if pull.start_s <= t_s < pull.end_s:
                if self._begun != number:
                    self._begin(number, motion)
                self._pull(t_s - pull.start_s, pull, motion, load)

    def _begin(self, number: int, motion: Motion) -> None:
        """The hand takes the cord up."""
        self._begun = number
        self._tip_W = motion.p_WT.copy()
        direction = np.array(self._model.direction)
        in_body = self._model.frame == "body"
        self._direction_W = rotate(motion.q_WB, direction) if in_body else direction

    def _pull(self, elapsed_s: float, pull: Pull, motion: Motion, load: Load) -> None:
        length_m, stiffness_npm = self._model.length_m, self._model.stiffness_npm
        force = pull.force_n * profile(elapsed_s, pull.rise_s, pull.hold_s, pull.fall_s)
        hand_W = self._tip_W + (length_m + force / stiffness_npm) * self._direction_W
        force_W = tension(hand_W, motion.p_WT, length_m, stiffness_npm)
        load.force_tip_W += force_W
        load.record.f_rope_W += force_W
        load.record.pull = self._begun


def rope_load(entry: Rope, around: Circumstances) -> RopeLoad:
    """The load of one entry; pulls are counted in order of time over all ropes of the mission."""
    ropes = [other for other in around.entries if isinstance(other, Rope)]
    starts = sorted(pull.start_s for rope in ropes for pull in rope.pulls)
    return RopeLoad(entry, tuple(1 + starts.index(pull.start_s) for pull in entry.pulls))
