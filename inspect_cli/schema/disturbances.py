"""``truth: disturbances:`` of a mission: what pushes and pulls the vehicle without its knowledge.

An entry without ``kind`` is a ``constant`` one. What each does: ``inspect_cli.truth.disturbances``.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from itertools import pairwise
from typing import Annotated, Any, Literal

from pydantic import Discriminator, Field, Tag, model_validator

from inspect_cli.schema.base import Direction, NonNegative, Positive, PositiveTriple, Strict, Triple

LEAST_CARRYING_WIND_MPS = 0.5


class ConstantWrench(Strict):
    """A force and a torque that act on the body from ``start_s`` on."""

    kind: Literal["constant"] = "constant"
    frame: Literal["world", "body"] = "world"
    force_n: Triple = (0.0, 0.0, 0.0)
    torque_nm: Triple = (0.0, 0.0, 0.0)
    start_s: NonNegative = 0.0
    ramp_s: NonNegative = 1.0
    """The wrench rises linearly over this time."""


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


class Rope(Strict):
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


class Gust(Strict):
    """Dryden turbulence at low altitude (MIL-F-8785C), carried along by the mean wind."""

    w20_mps: Positive
    """The standard's measure of turbulence: the wind's speed 20 ft (6 m) over the ground."""
    altitude_m: Annotated[float, Field(ge=3.048, le=304.8)] = 3.048
    """The height that sets scale and strength; the standard gives none below 10 ft."""


class Wind(Strict):
    """A mean wind with gusts that drags at the body."""

    kind: Literal["wind"]
    mean_mps: Triple
    gust: Gust | None = None
    start_s: NonNegative = 0.0
    ramp_s: NonNegative = 1.0
    """Mean and gusts rise linearly over this time."""
    drag_area_m2: PositiveTriple
    """C_d A of the vehicle along x, y and z of B."""

    @model_validator(mode="after")
    def _carries_its_gusts(self) -> Wind:
        speed = math.hypot(*self.mean_mps[:2])
        if self.gust is not None and speed < LEAST_CARRYING_WIND_MPS:
            raise ValueError(
                f"gusts are carried past the vehicle by a horizontal mean wind of at least "
                f"{LEAST_CARRYING_WIND_MPS:g} m/s; mean_mps has {speed:g} m/s"
            )
        return self


class Cable(Strict):
    """The instrument's cable from a clamp on the ground to the vehicle."""

    kind: Literal["cable"]
    length_m: Positive
    mass_kgpm: Positive
    clamp_m: tuple[float, float] | None = None
    """(x, y) on the ground; without it, under the place where the vehicle starts."""
    attached: Literal["tool", "body"] = "tool"
    """To the tool's tip, or to O_b."""
    stiffness_npm: Annotated[float, Field(gt=0, le=500)] = 500.0
    """How fast the pull grows when the cable is stretched out; softer than a real one."""


def _kind(entry: Any) -> Any:
    """An entry that does not say its kind is a constant one."""
    if isinstance(entry, dict):
        return entry.get("kind", "constant")
    return getattr(entry, "kind", "constant")


Disturbance = Annotated[
    Annotated[ConstantWrench, Tag("constant")]
    | Annotated[Rope, Tag("rope")]
    | Annotated[Wind, Tag("wind")]
    | Annotated[Cable, Tag("cable")],
    Discriminator(
        _kind,
        custom_error_type="union_tag_invalid",
        # pydantic would name the function in place of the key.
        custom_error_context={"discriminator": "'kind'", "tag": "", "expected_tags": ""},
    ),
]


def refuse_overlaps(pulls: Sequence[Pull]) -> None:
    """Raise ValueError where a pull begins before the one before it has ended."""
    for before, after in pairwise(pulls):
        if after.start_s < before.end_s:
            raise ValueError(
                f"the pull at {after.start_s:g} s begins before the one at {before.start_s:g} s "
                f"has ended at {before.end_s:g} s"
            )


def refuse_impossible(disturbances: Sequence[Disturbance]) -> None:
    """Raise ValueError for what cannot be at the same time: two winds, two pulling hands."""
    if sum(isinstance(entry, Wind) for entry in disturbances) > 1:
        raise ValueError("there is one air: give one wind")
    ropes = [entry for entry in disturbances if isinstance(entry, Rope)]
    pulls = [pull for rope in ropes for pull in rope.pulls]
    refuse_overlaps(sorted(pulls, key=lambda pull: pull.start_s))
