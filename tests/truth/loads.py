"""A vehicle that is where a test says, and what a disturbance does to it there."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.schema.disturbances import Disturbance
from inspect_cli.truth.disturbances import Disturbances, Motion

HZ = 250
UPRIGHT = (1.0, 0.0, 0.0, 0.0)


def motion(
    p_WB: Sequence[float] = (0.0, 0.0, 1.0),
    q_WB: Sequence[float] = UPRIGHT,
    v_WB_W: Sequence[float] = (0.0, 0.0, 0.0),
    p_WT: Sequence[float] = (0.55, 0.0, 1.0),
) -> Motion:
    """The vehicle's motion at a moment."""
    return Motion(*(np.array(x, dtype=float) for x in (p_WB, q_WB, v_WB_W, p_WT)))


def disturbances(*entries: Disturbance, seed: int = 0, hz: int = HZ) -> Disturbances:
    """The sum of some entries."""
    return Disturbances(entries, np.random.default_rng(seed), hz)
