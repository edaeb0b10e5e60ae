"""Forces and torques that act on the vehicle without its knowledge: one file and one row per kind.

A package outside this one adds a kind as an entry point of the group ``inspect_cli.loads``, under
the name that its model has in ``inspect_cli.disturbances``.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import Any

import numpy as np

from inspect_cli.errors import EnvironmentFault
from inspect_cli.plugins import registered
from inspect_cli.schema.disturbances import DisturbanceModel
from inspect_cli.truth.disturbances.cable import cable_load
from inspect_cli.truth.disturbances.constant import constant_load
from inspect_cli.truth.disturbances.load import Circumstances, Load, Model, Motion
from inspect_cli.truth.disturbances.rope import rope_load
from inspect_cli.truth.disturbances.wind import wind_load

__all__ = ["LOADS", "Disturbances", "Load", "Motion"]

LOADS: dict[str, Callable[[Any, Circumstances], Model]] = registered(
    "inspect_cli.loads",
    {"constant": constant_load, "rope": rope_load, "wind": wind_load, "cable": cable_load},
    Callable,
)


class Disturbances:
    """The sum of a mission's disturbances.

    ``rng`` makes what is left to chance, such as gusts; ``control_hz`` is how often ``act`` is
    called.
    """

    def __init__(
        self, entries: Sequence[DisturbanceModel], rng: np.random.Generator, control_hz: int
    ) -> None:
        around = Circumstances(tuple(entries), rng, 1.0 / control_hz)
        self._models = [_load(entry, around) for entry in entries]
        self.load = Load()

    @property
    def any(self) -> bool:
        """Whether there is anything to apply."""
        return bool(self._models)

    def act(self, t_s: float, motion: Motion) -> Load:
        """What acts on the vehicle from now on."""
        self.load.clear()
        for model in self._models:
            model.act(t_s, motion, self.load)
        return self.load


def _load(entry: DisturbanceModel, around: Circumstances) -> Model:
    if entry.kind not in LOADS:
        raise EnvironmentFault(
            f"nothing simulates a disturbance of kind {entry.kind}",
            hint=f"kinds that are simulated: {', '.join(LOADS)}",
        )
    return LOADS[entry.kind](entry, around)
