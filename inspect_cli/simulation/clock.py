"""Time as a count of physics steps, and what is due when.

A component of rate f is due at the first step at or after each k/f, which is step ⌈k P / f⌉ at
the physics rate P: exactly at k/f where f divides P, up to one step late where it does not. Its
pattern repeats after P / gcd(P, f) steps, that of all after their least common multiple, and
t = k·dt is never accumulated. The loop visits only the ticks at which something is due and lets
the physics run in between.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from math import gcd, lcm
from typing import NamedTuple


class Tick(NamedTuple):
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
            if not 1 <= hz <= physics_hz:
                raise ValueError(f"rate {name} {hz} Hz is not between 1 and {physics_hz} Hz")
        self.physics_hz = physics_hz
        cycle = lcm(*(physics_hz // gcd(physics_hz, hz) for hz in rates_hz.values()))
        dues: dict[int, set[str]] = {}
        for name, hz in rates_hz.items():
            for k in range(cycle * hz // physics_hz):
                dues.setdefault(-(-k * physics_hz // hz), set()).add(name)
        pattern = [(step, frozenset(dues[step])) for step in sorted(dues)]
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
