"""Axes of a plotly layout: where they stand, how far they go, what is on their ticks."""

from __future__ import annotations

import base64
import math
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

import numpy as np

from inspect_cli.reporting.figures.figure import Json
from inspect_cli.spatial.arrays import Vector

ROOM = 0.05
"""Margin beyond the outermost values, as a share of their range."""


def column(values: Any) -> list[Any]:
    """A column of a trace as a list; plotly's base64 form is decoded."""
    if values is None:
        return []
    if isinstance(values, Mapping):
        data = base64.b64decode(values["bdata"])
        decoded = np.frombuffer(data, dtype=np.dtype(str(values["dtype"])).newbyteorder("<"))
        shape = values.get("shape")
        if shape is not None:
            decoded = decoded.reshape([int(n) for n in str(shape).split(",")])
        return list(decoded.tolist())
    return list(values)


@dataclass
class Axis:
    """One axis of the layout with what its traces bring along."""

    name: str
    """As traces name it: "x", "x2", "y" …"""
    settings: Json
    categories: list[str] = field(default_factory=list)
    low: float = math.inf
    high: float = -math.inf
    markers: bool = False

    @property
    def horizontal(self) -> bool:
        """Whether it is an axis of x."""
        return self.name.startswith("x")

    @property
    def logarithmic(self) -> bool:
        """Whether it shows powers at equal distances."""
        return bool(self.settings.get("type") == "log")

    @property
    def anchor(self) -> str:
        """The axis across, beside which the ticks stand."""
        return str(self.settings.get("anchor", "y" if self.horizontal else "x"))

    def places(self, values: Any) -> Vector:
        """Where the values stand: numbers themselves, words by their number in ``categories``."""
        cells = column(values)
        if self.settings.get("type") != "category" and not any(isinstance(c, str) for c in cells):
            return np.array([math.nan if c is None else float(c) for c in cells])
        for cell in cells:
            if str(cell) not in self.categories:
                self.categories.append(str(cell))
        return np.array([float(self.categories.index(str(c))) for c in cells])

    def take(self, places: Vector, *, markers: bool) -> None:
        """Extend the range to the values of a trace."""
        shown = places[np.isfinite(places)]
        if self.logarithmic:
            shown = shown[shown > 0.0]
        self.markers = self.markers or markers
        if len(shown):
            self.low, self.high = min(self.low, shown.min()), max(self.high, shown.max())


def axes_of(layout: Json, traces: Sequence[Json]) -> dict[str, Axis]:
    """The axes that the traces use, by the names that traces give them."""
    names = {str(t.get(f"{kind}axis", kind)) for t in traces for kind in "xy"}
    found = {}
    for name in sorted(names):
        settings = layout.get(f"{name[0]}axis{name[1:]}", {})
        found[name] = Axis(name, settings, [str(c) for c in settings.get("categoryarray", ())])
    return found


def limits(axis: Axis, axes: Mapping[str, Axis]) -> tuple[float, float]:
    """Ends of the axis in its own values; axes that match have the same."""
    leader = axes.get(str(axis.settings.get("matches", "")), axis)
    given = leader.settings.get("range") or axis.settings.get("range")
    if given is not None:
        low, high = float(given[0]), float(given[1])
        return (10.0**low, 10.0**high) if axis.logarithmic else (low, high)
    low, high = _of_the_data(leader, axes)
    return (high, low) if leader.settings.get("autorange") == "reversed" else (low, high)


def _of_the_data(leader: Axis, axes: Mapping[str, Axis]) -> tuple[float, float]:
    followers = [a for a in axes.values() if a.settings.get("matches") == leader.name]
    members = [leader, *followers]
    if leader.categories:
        return -0.5, len(leader.categories) - 0.5
    low, high = min(a.low for a in members), max(a.high for a in members)
    if low > high:
        return (1.0, 10.0) if leader.logarithmic else (0.0, 1.0)
    if leader.logarithmic:
        low, high = math.log10(low), math.log10(high)
    to_zero = leader.settings.get("rangemode") == "tozero" and not leader.logarithmic
    if to_zero:
        low, high = min(low, 0.0), max(high, 0.0)
    if low == high:
        low, high = low - 0.5, high + 0.5
    padded = not leader.horizontal or any(a.markers for a in members)
    room = ROOM * (high - low) if padded else 0.0
    start = low if to_zero and low == 0.0 else low - room
    end = high if to_zero and high == 0.0 else high + room
    allowed = leader.settings.get("autorangeoptions", {})
    start = max(start, float(allowed.get("minallowed", -math.inf)))
    end = min(end, float(allowed.get("maxallowed", math.inf)))
    return (10.0**start, 10.0**end) if leader.logarithmic else (start, end)


def domain(axis: Axis, axes: Mapping[str, Axis]) -> tuple[float, float]:
    """The stretch of the figure that the axis takes, from 0 to 1."""
    below = axes.get(str(axis.settings.get("overlaying", "")), axis)
    start, end = below.settings.get("domain", (0.0, 1.0))
    return float(start), float(end)


def panels_of(traces: Sequence[Json]) -> list[tuple[str, str]]:
    """The pairs of axes that traces are drawn in, in their order."""
    pairs = ((str(t.get("xaxis", "x")), str(t.get("yaxis", "y"))) for t in traces)
    return list(dict.fromkeys(pairs))


def round_ticks(low: float, high: float, count: int) -> tuple[list[float], int]:
    """About ``count`` ticks at multiples of 1, 2 or 5 times a power of ten, and their decimals."""
    start, end = min(low, high), max(low, high)
    wanted = (end - start) / max(count, 1)
    power = math.floor(math.log10(wanted)) if wanted > 0.0 else 0
    step = next(m * 10.0**power for m in (1.0, 2.0, 5.0, 10.0) if m * 10.0**power >= 0.999 * wanted)
    decimals = max(0, -math.floor(math.log10(step) + 1e-9))
    first, last = math.ceil(start / step - 1e-6), math.floor(end / step + 1e-6)
    return [round(k * step, decimals + 2) + 0.0 for k in range(first, last + 1)], decimals


def decades(low: float, high: float) -> Iterator[float]:
    """1, 2 and 5 times the powers of ten between two values."""
    for power in range(math.floor(math.log10(low)), math.ceil(math.log10(high)) + 1):
        for m in (1.0, 2.0, 5.0):
            if low <= m * 10.0**power <= high:
                yield m * 10.0**power
