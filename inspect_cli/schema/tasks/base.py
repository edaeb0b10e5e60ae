"""What all kinds of tasks are made of, and the row of a kind in the registry."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Positive, Strict

MAX_POINTS = 10_000
SHORTEST_M = 1e-4
"""Lines that are shorter are marks of the pen, not lines."""

Instrument = Literal["half_cell"]

Coordinate = Annotated[float, Field(ge=-1000.0, le=1000.0)]
Place = tuple[Coordinate, Coordinate, Coordinate]
"""Somewhere to fly to: farther off than any battery lasts is a slip of the unit."""

CONTACT_MODES = frozenset({"approach", "press", "retreat"})
"""Modes of a vehicle that a touch takes."""


class Work(Strict):
    """What a task asks for, the base of every kind's model."""

    def check_instrument(self, instrument: str | None) -> None:
        """Refuse, with ValueError, what cannot be done with the instrument that reads (or none)."""


@dataclass(frozen=True)
class TaskKind:
    """A kind of task: its row in the registry of tasks."""

    model: type[Work]
    """What stands in the mission under the kind's name."""
    modes: frozenset[str]
    """Modes that a vehicle must have to do it, beside those of going there."""
    surface_key: str | None = None
    """The key under which it names a surface of the structure."""
    file_keys: tuple[str, ...] = ()
    """Keys under which it names files."""
    reads: bool = False
    """Whether an instrument can read at its points, and does unless the task says otherwise."""
    alone: str = ""
    """Why it must be the only task of its mission; empty where it need not be."""


class Pressing(Work):
    """How the tool is brought to a surface and pressed on it."""

    press_m: Annotated[float, Field(gt=0, le=1.0)] = 0.10
    """Set-point behind the surface while pressing."""
    standoff_m: Annotated[float, Field(gt=0, le=1.5)] = 0.25
    """Distance of the tool's tip from the surface before approach and after retreat."""


class ContactOptions(Pressing):
    """How each point of a task is touched."""

    dwell_s: Annotated[float, Field(gt=0, le=3600)] = 3.0
    """Time with sufficient force before a reading may be accepted."""
    off_target_m: Positive = 0.03
    """A reading taken farther than this from its point, along the surface, does not count."""
