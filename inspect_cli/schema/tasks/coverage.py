"""Task ``coverage``: touch points all over a surface, in as many sorties as it takes."""

from __future__ import annotations

from typing import Annotated

from pydantic import Field, model_validator

from inspect_cli.schema.base import Name, NonNegative, Positive, Strict
from inspect_cli.schema.start import Start
from inspect_cli.schema.tasks.base import CONTACT_MODES, MAX_POINTS, ContactOptions, TaskKind


class KeepOut(Strict):
    """A round part of a surface that is not touched."""

    at_m: tuple[float, float]
    """(u, v) of its middle."""
    radius_m: Positive
    """Along the surface."""


CLOSER_SPACING_MV = 150.0
"""Neighbouring readings that differ by more ask for a closer spacing (ASTM C876)."""


class Refinement(Strict):
    """The rule of ASTM C876 for a closer spacing: points between neighbours that differ much."""

    difference_mv: Positive = CLOSER_SPACING_MV
    """Neighbouring readings that differ by more get points between them."""
    pitch_m: Positive | None = None
    """At most this far apart; by default half the pitch of the coverage, one point between."""
    max_points: Annotated[int, Field(ge=1, le=MAX_POINTS)] = 20
    """In the whole survey; the greatest differences come first."""


class Coverage(ContactOptions):
    """A whole surface, filled with contact points and flown in as many sorties as it takes."""

    on: Name
    pitch_m: Positive
    """Between neighbouring points along the surface."""
    edge_m: NonNegative | None = None
    """No point is nearer to the surface's edge; by default half the pitch."""
    offset_m: tuple[float, float] = (0.0, 0.0)
    """(u, v) by which the points are shifted from where they lie evenly on the surface."""
    keep_out: tuple[KeepOut, ...] = ()
    reserve: Annotated[float, Field(ge=0, lt=1)] = 0.10
    """Share of the battery's energy that no sortie plans with."""
    starts: tuple[Start, ...] = ()
    """Where sorties may take off and land, each with the cable's clamp under it; by default the
    mission's start."""
    refine: Refinement | None = None
    """Without it, no points are added in flight."""

    @model_validator(mode="after")
    def _refined_is_closer(self) -> Coverage:
        closer_m = self.refine.pitch_m if self.refine else None
        if closer_m is not None and closer_m >= self.pitch_m:
            raise ValueError(
                f"refine.pitch_m {closer_m:g} must be below pitch_m {self.pitch_m:g}: "
                "no point would ever be added"
            )
        return self

    def check_instrument(self, instrument: str | None) -> None:
        """Refuse to refine what is not read."""
        if self.refine and instrument is None:
            raise ValueError("refine compares readings; sensor: none takes none")


KIND = TaskKind(
    Coverage,
    modes=CONTACT_MODES,
    surface_key="on",
    reads=True,
    alone="a coverage is split into sorties and must be the only task of its mission",
)
