"""Task ``servo``: find, touch and follow a surface that nobody has described."""

from __future__ import annotations

from typing import Literal

from inspect_cli.schema.base import NonNegative, Positive, Strict
from inspect_cli.schema.tasks.base import CONTACT_MODES, Place, Pressing, TaskKind


class ServoStart(Strict):
    """Where the vehicle is brought by hand: level, the tool about towards the surface."""

    position_m: Place
    """Of O_b in W, as the vehicle believes to be there."""
    heading_deg: float = 0.0


class Servo(Pressing):
    """Depth servoing: find, touch and follow a surface that nobody has described.

    From the start pose the tool goes to what the depth camera sees along its axis, presses,
    slides ``slide_m`` along the surface in a direction of its own frame, and backs off.
    """

    start: ServoStart
    direction: Literal["x", "-x", "y", "-y"] = "-x"
    """Of the tool's frame T, along the surface."""
    slide_m: NonNegative = 0.5
    speed_mps: Positive = 0.17
    settle_s: NonNegative = 2.0
    """Time in contact before and after the slide."""


KIND = TaskKind(Servo, modes=CONTACT_MODES | {"slide"})
