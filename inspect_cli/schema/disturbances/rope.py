"""``kind: rope``: a cord tied to the tool's tip, pulled by a hand."""

from __future__ import annotations

from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Literal, Self

from pydantic import Field, model_validator

from inspect_cli.schema.base import Direction, NonNegative, Positive, Strict
from inspect_cli.schema.disturbances.base import DisturbanceModel


class Pull(Strict):
    """One pull at a rope: the tension that it would have if the tip did not yield."""

    start_s: NonNegative
    rise_s: Positive = 1.0
    hold_s: NonNegative = 2.0
    fall_s: Positive = 1.0
    force_n: Positive

    @property
    def end_s(self) -> float:
        """When the hand is back where it began and lets go."""
        return self.start_s + self.rise_s + self.hold_s + self.fall_s


class Rope(DisturbanceModel):
    """A cord tied to the tool's tip, pulled by a hand."""

    kind: Literal["rope"]
    frame: Literal["world", "body"] = "world"
    """``body``: of the body's attitude when a pull begins."""
    direction: Direction
    stiffness_npm: Annotated[float, Field(gt=0, le=300)] = 10.0
    """Of cord and hand in series, k. A tip that is held with K yields until the tension is
    1/(1 + k/K) of the profile; a hand that follows the force is soft. Against a force that is
    held for a control tick a light tip begins to shake towards 1000 N/m."""
    length_m: Positive = 2.0
    pulls: Annotated[tuple[Pull, ...], Field(min_length=1)]

    @model_validator(mode="after")
    def _one_after_the_other(self) -> Rope:
        refuse_overlaps(self.pulls)
        return self

    @classmethod
    def refuse_together(cls, entries: Sequence[Self]) -> None:
        """Raise ValueError where two ropes are pulled at the same time."""
        pulls = [pull for rope in entries for pull in rope.pulls]
        refuse_overlaps(sorted(pulls, key=lambda pull: pull.start_s))


def refuse_overlaps(pulls: Sequence[Pull]) -> None:
    """Raise ValueError where a pull begins before the one before it has ended."""
    for before, after in pairwise(pulls):
        if after.start_s < before.end_s:
            raise ValueError(
                f"the pull at {after.start_s:g} s begins before the one at {before.start_s:g} s "
                f"has ended at {before.end_s:g} s"
            )
