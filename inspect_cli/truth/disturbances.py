"""Forces and torques that act on the vehicle without its knowledge."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.schema.truth import Disturbance
from inspect_cli.spatial.arrays import Vector
from inspect_cli.spatial.rotations import rotate, rotate_back


class Disturbances:
    """The sum of a mission's disturbances on the body."""

    def __init__(self, models: Sequence[Disturbance]) -> None:
        self._models = tuple(models)

    @property
    def any(self) -> bool:
        """Whether there is anything to apply."""
        return bool(self._models)

    def generalized_force(self, t_s: float, q_WB: Vector) -> Vector:
        """(force in W, torque about O_b in B), six numbers, as a free joint takes them."""
        total = np.zeros(6)
        for model in self._models:
            share = _ramp(t_s - model.start_s, model.ramp_s)
            force, torque = np.array(model.force_n), np.array(model.torque_nm)
            if model.frame == "world":
                torque = rotate_back(q_WB, torque)
            else:
                force = rotate(q_WB, force)
            total[:3] += share * force
            total[3:] += share * torque
        return total


def _ramp(elapsed_s: float, ramp_s: float) -> float:
    if elapsed_s < 0.0:
        return 0.0
    return 1.0 if elapsed_s >= ramp_s else elapsed_s / ramp_s
