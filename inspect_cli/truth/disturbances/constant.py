"""A force and a torque that stay as they are, in W or in B."""

from __future__ import annotations

import numpy as np

from inspect_cli.schema.disturbances import ConstantWrench
from inspect_cli.spatial.rotations import rotate, rotate_back
from inspect_cli.truth.disturbances.load import Circumstances, Load, Motion, ramp


class ConstantLoad:
    """Acts on O_b from its start on, and rises linearly."""

    def __init__(self, model: ConstantWrench) -> None:
        self._model = model
        self._force, self._torque = np.array(model.force_n), np.array(model.torque_nm)

    def act(self, t_s: float, motion: Motion, load: Load) -> None:
        """Add the wrench."""
        share = ramp(t_s - self._model.start_s, self._model.ramp_s)
        force, torque = self._force, self._torque
        if self._model.frame == "world":
            torque = rotate_back(motion.q_WB, torque)
        else:
            force = rotate(motion.q_WB, force)
        load.force_W += share * force
        load.torque_B += share * torque


def constant_load(entry: ConstantWrench, _: Circumstances) -> ConstantLoad:
    """The load of one entry."""
    return ConstantLoad(entry)
