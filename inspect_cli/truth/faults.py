"""Sensor faults of a mission: when a sensor is silent, talks nonsense or sees but in part."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from inspect_cli.records import Record
from inspect_cli.schema.truth import SensorFault
from inspect_cli.spatial.arrays import Points

PATCH_PIXELS = (3, 10)
"""A patch without a return is from 3 up to 9 pixels wide and as much high."""


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


def punch_holes(points: Points, share: float, rng: np.random.Generator) -> None:
    """Take a share of an image's pixels away, in random rectangles that may overlap.

    ``points`` (rows, columns, 3) become NaN there. The rounded share is met to the pixel: of the
    last rectangle only as many go as are still wanted. Pixels that returned nothing count as well,
    since a fault of the sensor does not know what it would have seen.
    """
    rows, columns = points.shape[:2]
    lost = np.zeros((rows, columns), np.bool_)
    wanted = round(share * lost.size)
    missing = wanted
    while missing > 0:
        high, wide = rng.integers(*PATCH_PIXELS, size=2)
        top, left = rng.integers(1 - high, rows), rng.integers(1 - wide, columns)
        patch = lost[max(top, 0) : top + high, max(left, 0) : left + wide]
        fresh = np.argwhere(~patch)[:missing]
        patch[fresh[:, 0], fresh[:, 1]] = True
        missing -= len(fresh)
    points[lost] = np.nan
