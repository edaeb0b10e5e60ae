"""Sensor faults of a mission: when a sensor is silent or talks nonsense."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.records import Record
from inspect_cli.schema.truth import SensorFault


class Faults:
    """Which sensors fail when."""

    def __init__(self, models: Sequence[SensorFault]) -> None:
        self._models = tuple(models)

    def active(self, sensor: str, t_s: float) -> SensorFault | None:
        """The fault of a sensor at a time, if there is one."""
        for model in self._models:
            ended = model.end_s is not None and t_s >= model.end_s
            if model.sensor == sensor and t_s >= model.start_s and not ended:
                return model
        return None


def spoil(measurement: Record) -> None:
    """Overwrite everything but the time with NaN."""
    for name, view in measurement.views.items():
        if name != "t_s":
            view[...] = np.nan
