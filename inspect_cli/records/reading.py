"""What the readings of all instruments have in common."""

from __future__ import annotations

from collections.abc import Iterator
from enum import IntEnum

from inspect_cli.records.record import Field, Record, scalar, vector


class InvalidReason(IntEnum):
    """Why a reading does not count; 0 means that it does."""

    NONE = 0
    NOT_VISITED = 1
    NO_CONTACT = 2
    FORCE = 3
    UNSTABLE = 4
    OPEN_CIRCUIT = 5
    ABORTED = 6
    NO_SIGNAL = 7
    OFF_TARGET = 8


class PointReading(Record):
    """An instrument's verdict on one point, written once when the point is left.

    Each instrument has a subclass with a topic of its own, which declares the values that were
    read. In a row they stand behind the target.
    """

    target = scalar("1", "index of the target in the plan")
    force_mean = scalar("N", "mean load cell force over the accepted window")
    contact_s = scalar("s", "longest time with sufficient force")
    p_WT = vector(3, "m", "W", "where the tool's tip was believed to be")
    valid = scalar("1", "1 if the reading counts, else 0")
    reason = scalar("1", "an InvalidReason, by number")

    @classmethod
    def fields(cls) -> Iterator[Field]:
        """The time, the target, the instrument's values, how they were taken."""
        every = list(super().fields())
        shared = len(COMMON)
        yield from every[:2]
        yield from every[shared:]
        yield from every[2:shared]

    @classmethod
    def values(cls) -> tuple[str, ...]:
        """Names of what the instrument read."""
        return tuple(field.name for field in cls.fields() if field.name not in COMMON)

    @classmethod
    def units(cls) -> dict[str, str]:
        """Of what the instrument read, by name."""
        return {field.name: field.unit for field in cls.fields() if field.name not in COMMON}

    def void(self, reason: InvalidReason) -> None:
        """Let it not count: its values are NaN."""
        self.valid, self.reason = 0.0, float(reason)
        for name in self.values():
            self.views[name][...] = float("nan")


COMMON = tuple(
    name
    for base in (Record, PointReading)
    for name in vars(base)
    if isinstance(vars(base)[name], Field)
)
"""Names of the fields that every reading has."""
