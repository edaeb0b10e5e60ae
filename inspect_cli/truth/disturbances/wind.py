"""A mean wind with Dryden gusts that drags at the body.

    f_B = ½ ρ |v| (C_d A) v per axis of B,        v = R_WBᵀ (v_wind − v_WB)

acts at O_b. Gusts have their axes along the horizontal mean wind, to its left and upwards, and
are carried past at the mean wind's horizontal speed: the vehicle's own speed, which is small
beside it, does not change their spectrum. Left out are what the wind does to the rotors (inflow,
blade flapping, thrust), the torque of a drag that does not act at O_b, and the shelter of walls.
"""

from __future__ import annotations

import numpy as np

from inspect_cli.compiled import kernel
from inspect_cli.schema.disturbances import Wind
from inspect_cli.spatial.arrays import Matrix, Vector
from inspect_cli.spatial.constants import AIR_DENSITY_KGPM3
from inspect_cli.spatial.rotations import rotate, rotate_back
from inspect_cli.truth.disturbances.dryden import Turbulence, scales
from inspect_cli.truth.disturbances.load import Circumstances, Load, Motion, ramp


@kernel
def drag(wind_W: Vector, v_WB_W: Vector, q_WB: Vector, area_m2: Vector) -> Vector:
    """The drag (3,) N in W; ``area_m2`` (3,) is C_d A along the axes of B."""
    v = rotate_back(q_WB, wind_W - v_WB_W)
    speed = np.sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2])
    return rotate(q_WB, 0.5 * AIR_DENSITY_KGPM3 * speed * area_m2 * v)


class WindLoad:
    """The wind of a flight; ``step_s`` is the time between two questions."""

    def __init__(self, model: Wind, step_s: float, rng: np.random.Generator) -> None:
        self._model = model
        self._mean_W, self._area_m2 = np.array(model.mean_mps), np.array(model.drag_area_m2)
        self._turbulence: Turbulence | None = None
        self._R_WU: Matrix = np.eye(3)
        if model.gust is not None:
            speed = float(np.hypot(*model.mean_mps[:2]))
            strengths = scales(model.gust.w20_mps, model.gust.altitude_m)
            self._turbulence = Turbulence(strengths, speed, step_s, rng)
            c, s = self._mean_W[:2] / speed
            self._R_WU = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])

    def act(self, t_s: float, motion: Motion, load: Load) -> None:
        """Add the drag."""
        share = ramp(t_s - self._model.start_s, self._model.ramp_s)
        wind_W = share * self._mean_W
        if self._turbulence is not None:
            wind_W = wind_W + share * (self._R_WU @ self._turbulence.step())
        if share > 0.0:
            load.force_W += drag(wind_W, motion.v_WB_W, motion.q_WB, self._area_m2)
            load.record.wind_W = wind_W


def wind_load(entry: Wind, around: Circumstances) -> WindLoad:
    """The load of one entry."""
    return WindLoad(entry, around.step_s, around.rng)
