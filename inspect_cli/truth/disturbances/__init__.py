"""Forces and torques that act on the vehicle without its knowledge, one model a file."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.schema.disturbances import ConstantWrench, Disturbance, Rope, Wind
from inspect_cli.truth.disturbances.cable import CableLoad
from inspect_cli.truth.disturbances.constant import ConstantLoad
from inspect_cli.truth.disturbances.load import Load, Model, Motion
from inspect_cli.truth.disturbances.rope import RopeLoad
from inspect_cli.truth.disturbances.wind import WindLoad

__all__ = ["Disturbances", "Load", "Motion"]


class Disturbances:
    """The sum of a mission's disturbances.

    ``rng`` makes the gusts; ``control_hz`` is how often ``act`` is called.
    """

    def __init__(
        self, entries: Sequence[Disturbance], rng: np.random.Generator, control_hz: int
    ) -> None:
        numbers = _pull_numbers(entries)
        self._models = [_model(entry, numbers, rng, control_hz) for entry in entries]
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


def _pull_numbers(entries: Sequence[Disturbance]) -> dict[float, int]:
    """The number of every pull of the flight by its start, in order of time from 1 on."""
    ropes = [entry for entry in entries if isinstance(entry, Rope)]
    starts = sorted(pull.start_s for rope in ropes for pull in rope.pulls)
    return {start_s: number for number, start_s in enumerate(starts, start=1)}


def _model(
    entry: Disturbance, numbers: dict[float, int], rng: np.random.Generator, control_hz: int
) -> Model:
    if isinstance(entry, ConstantWrench):
        return ConstantLoad(entry)
    if isinstance(entry, Rope):
        return RopeLoad(entry, tuple(numbers[pull.start_s] for pull in entry.pulls))
    if isinstance(entry, Wind):
        return WindLoad(entry, 1.0 / control_hz, rng)
    return CableLoad(entry)
