"""Time as a count of physics steps, and what is due when.

Every rate divides the physics rate, so each component is due at multiples of a whole number of
steps, the pattern repeats after their least common multiple, and t = k·dt is never accumulated.
The loop visits only the ticks at which something is due and lets the physics run in between.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from math import lcm


@dataclass(frozen=True)
class Tick:
    """A moment at which something is due."""

    step: int
    """Physics steps since the start."""
    t_s: float
    due: frozenset[str]
    steps_to_next: int


class Clock:
    """The schedule of components at given rates."""

    def __init__(self, physics_hz: int, rates_hz: Mapping[str, int]) -> None:
        for name, hz in rates_hz.items():
            if hz < 1 or physics_hz % hz:
                raise ValueError(f"rate {name} {hz} Hz does not divide {physics_hz} Hz")
        self.physics_hz = physics_hz
        periods = {name: physics_hz // hz for name, hz in rates_hz.items()}
        cycle = lcm(*periods.values())
        dues = [
            (step, frozenset(name for name, period in periods.items() if step % period == 0))
            for step in range(cycle)
        ]
        pattern = [(step, due) for step, due in dues if due]
        following = [step for step, _ in pattern[1:]] + [cycle]
        self._cycle = cycle
        self._pattern = [
            (step, due, nxt - step) for (step, due), nxt in zip(pattern, following, strict=True)
        ]

    def ticks(self, limit_s: float) -> Iterator[Tick]:
        """The ticks from 0 up to ``limit_s``."""
        limit = round(limit_s * self.physics_hz)
        start = 0
        while True:
            for offset, due, steps in self._pattern:
                step = start + offset
                if step > limit:
                    return
                yield Tick(step, step / self.physics_hz, due, steps)
            start += self._cycle
