"""What the same metric of several flights comes to together, by a rule for each metric.

Counts, times and energies add up; of peaks and bounds the worst counts; means and shares are
weighted with what they were taken over; root mean squares are joined as √(Σ w x² / Σ w) with the
flights' durations as weights.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import Literal

import numpy as np


@dataclass(frozen=True)
class Joined:
    """A rule; ``weight`` names the metric that each flight's value is weighted with."""

    rule: Literal["sum", "greatest", "least", "mean", "rms", "anew", "none"]
    weight: str = ""

    def of(self, values: Sequence[float], weights: Sequence[float]) -> float:
        """The joined value of one or more flights; ``weights`` (n,) count for means alone."""
        if self.rule == "sum":
            return float(np.sum(values))
        if self.rule == "greatest":
            return float(np.max(values))
        if self.rule == "least":
            return float(np.min(values))
        if self.rule == "rms":
            return float(np.sqrt(np.average(np.square(values), weights=weights)))
        return float(np.average(values, weights=weights))


SUM = Joined("sum")
GREATEST = Joined("greatest")
LEAST = Joined("least")
MEAN_OVER_TIME = Joined("mean", "flight.duration_s")
MEAN_OVER_POINTS = Joined("mean", "contact.points_total")
MEAN_OVER_ENERGY = Joined("mean", "flight.energy_wh_flown")
"""Σ E x / Σ E: of ratios planned / flown this is the ratio of the sums."""
RMS_OVER_TIME = Joined("rms", "flight.duration_s")
ANEW = Joined("anew")
"""Is found again over all points: areas and sites of several flights overlap, and neighbours were
read in different ones."""
NOT_JOINED = Joined("none")
"""Says something of a single flight only."""
