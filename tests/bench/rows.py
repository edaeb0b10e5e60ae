"""A row of the bench: one measured number and its limit.

Times are stated as ratios. Machines differ by a factor of two to four from day to day, so a time
is divided by that of a yardstick: work of the same kind by somebody else's code, timed in turns
with ours in the same run. Where all times of a run grow alike, the ratio stays. But for flights
the times are those of the processor, summed over threads, so that other work on the machine does
not count.

Limits are at most 1.3 × the ratio that was measured when they were set, but for those that say
otherwise. They were measured on a machine of two cores.
"""

from __future__ import annotations

import json
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from statistics import median
from typing import Literal

from tests.bench.profiles import PROFILES


@dataclass(frozen=True)
class Times:
    """The median times behind a ratio."""

    ours: float
    yardstick: float
    unit: str
    what: str
    """What the yardstick is."""

    def as_dict(self) -> dict[str, object]:
        """The times as they are written."""
        return {
            "ours": _rounded(self.ours),
            "yardstick": _rounded(self.yardstick),
            "unit": self.unit,
            "of": self.what,
        }


@dataclass(frozen=True)
class Row:
    """``bound`` says whether the limit is the largest or the smallest allowed value."""

    name: str
    value: float
    unit: str
    limit: float
    bound: Literal["max", "min"] = "max"
    times: Times | None = None
    """The absolute times, if the value is a ratio of two."""

    @property
    def ok(self) -> bool:
        """Whether the limit is kept; NaN keeps none."""
        return self.value <= self.limit if self.bound == "max" else self.value >= self.limit

    @property
    def profile(self) -> str:
        """Why a row that falls short does so; empty if it keeps its limit."""
        return "" if self.ok else PROFILES.get(self.name, "not profiled yet")

    def as_dict(self) -> dict[str, object]:
        """The row as it is written."""
        data: dict[str, object] = {
            "name": self.name,
            "value": _rounded(self.value),
            "unit": self.unit,
            "bound": self.bound,
            "limit": self.limit,
            "ok": self.ok,
        }
        if self.times is not None:
            data["times"] = self.times.as_dict()
        if not self.ok:
            data["profile"] = self.profile
        return data


def ratio(
    name: str,
    limit: float,
    what: str,
    ours: Callable[[int], float],
    yardstick: Callable[[int], float],
    rounds: int,
) -> Row:
    """Time ours and the yardstick in turns; the value is the median of the rounds' ratios.

    ``ours`` and ``yardstick`` take the number of the round, from 1, and return seconds. Round 0
    fills caches, compiles, and does not count.
    """
    ours(0)
    yardstick(0)
    pairs = [(ours(k), yardstick(k)) for k in range(1, 1 + rounds)]
    value = median(a / b for a, b in pairs)
    times = Times(median(a for a, _ in pairs), median(b for _, b in pairs), "CPU s", what)
    return Row(name, value, "1", limit, times=times)


def as_json(rows: Iterable[Row]) -> str:
    """One row per line."""
    lines = ",\n".join(json.dumps(row.as_dict(), ensure_ascii=False) for row in rows)
    return f"[\n{lines}\n]\n"


def _rounded(value: float) -> float:
    return float(f"{value:.4g}")
