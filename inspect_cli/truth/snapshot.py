"""What is so at one moment, as far as simulated sensors may read it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from inspect_cli.records import State, TrueContact
from inspect_cli.spatial.arrays import Vector


@dataclass(frozen=True)
class Truth:
    """The true state, and what is computed from it only when a sensor asks.

    One object serves a whole flight: ``state`` is overwritten in place at every tick.
    """

    state: State
    contact: Callable[[], TrueContact] = TrueContact.create
    """The nearest surface and the specimen under the tool's tip, now."""
    wall_wrench: Callable[[], Vector] = lambda: np.zeros(6)
    """Force of the tool on the surface with a force sensor and torque about O_W, (6,) N and N·m
    in W, now."""
    contact_wrench: Callable[[str], Vector] = lambda name: np.zeros(6)
    """Force of the surfaces on a contact of the vehicle, by its name, and torque about the origin
    of its frame, (6,) N and N·m in W, now."""
