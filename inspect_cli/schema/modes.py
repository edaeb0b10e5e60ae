"""A vehicle's table of modes as a log carries it: what the numbers in ``/reference`` stand for.

Metrics, reports and pictures ask for a mode's phase, never for its number or name, so that they
hold for every vehicle. The table is the log's attachment ``modes.json``.
"""

from __future__ import annotations

from collections.abc import Container
from enum import StrEnum
from functools import cached_property
from typing import Annotated, Self

import numpy as np
from numpy.typing import ArrayLike
from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, Strict
from inspect_cli.spatial.arrays import Mask


class Phase(StrEnum):
    """What a mode means for the flight, whatever the vehicle."""

    GROUND = "ground"
    """On the ground."""
    NEAR_GROUND = "near_ground"
    """Taking off or landing: the ground may push."""
    FREE = "free"
    """In free air, away from any surface."""
    NEAR = "near"
    """On the way to a surface or away from it."""
    CONTACT = "contact"
    """A tool is asked to touch a surface."""
    PERCHED = "perched"
    """Held by a surface."""
    SAFE = "safe"
    """After a failsafe; the mission goes on from there or is over."""


IN_FLIGHT = frozenset({Phase.NEAR_GROUND, Phase.FREE, Phase.NEAR, Phase.CONTACT, Phase.PERCHED})
"""From take-off to landing, but for what follows a failsafe."""
OFF_GROUND = frozenset({Phase.FREE, Phase.NEAR, Phase.CONTACT, Phase.PERCHED})
"""The same without take-off and landing: the ground touches nothing."""
AT_SURFACE = frozenset({Phase.NEAR, Phase.CONTACT})
"""From the approach of a surface to the retreat from it."""


class ModeRow(Strict):
    """One mode."""

    name: Name
    number: Annotated[int, Field(ge=0)]
    """Its value in the field ``mode`` of ``/reference``."""
    phase: Phase
    slides: bool = False
    """Whether a tool moves along the surface while it touches."""


class ModeTable(Strict):
    """All modes of a vehicle."""

    modes: tuple[ModeRow, ...]

    @model_validator(mode="after")
    def _told_apart(self) -> Self:
        for key in ("name", "number"):
            values = [getattr(row, key) for row in self.modes]
            if len(set(values)) < len(values):
                raise ValueError(f"two modes have the same {key}")
        return self

    @cached_property
    def by_number(self) -> dict[int, ModeRow]:
        """The modes by their numbers."""
        return {row.number: row for row in self.modes}

    def within(
        self, numbers: ArrayLike, phases: Container[Phase], *, slides: bool | None = None
    ) -> Mask:
        """Where logged mode numbers (n,) belong to a mode of one of these phases.

        ``slides`` asks for modes that slide, or that do not; None for both.
        """
        meant = [
            row.number
            for row in self.modes
            if row.phase in phases and (slides is None or row.slides is slides)
        ]
        return np.isin(np.asarray(numbers), meant)
