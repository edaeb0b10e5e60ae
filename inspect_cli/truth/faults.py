"""Sensor faults of a mission: a sensor is silent, returns NaN, or sees only parts of an image."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TypeAlias

import numpy as np

from inspect_cli.records import DepthImage, Measurement
from inspect_cli.schema.truth import SensorFault
from inspect_cli.spatial.arrays import Points
from inspect_cli.truth.snapshot import Truth

PATCH_PIXELS = (3, 10)
"""A patch without a return is from 3 up to 9 pixels wide and as much high."""

Sample: TypeAlias = Callable[[Truth], Measurement | None]
"""Takes a measurement of the truth now; None where the sensor returns nothing yet."""


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

    def applied_to(self, sensor: str, sample: Sample, rng: np.random.Generator) -> Sample:
        """``sample`` with the faults of the sensor of that name; itself if it never fails.

        ``rng`` places the holes in the images of a depth camera.
        """
        if all(model.sensor != sensor for model in self._models):
            return sample

        def sample_or_fail(truth: Truth) -> Measurement | None:
            fault = self.active(sensor, truth.state.t_s)
            if fault is not None and fault.fault == "off":
                return None
            measurement = sample(truth)
            if fault is None or measurement is None:
                return measurement
            if fault.share is not None and isinstance(measurement, DepthImage):
                punch_holes(measurement.image, fault.share, rng)
            else:
                spoil(measurement)
            return measurement

        return sample_or_fail


def spoil(measurement: Measurement) -> None:
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
