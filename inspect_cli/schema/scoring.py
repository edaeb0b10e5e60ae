"""The verdicts of a simulated campaign against what is truly so, in areas and in points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Literal

from pydantic import Field

from inspect_cli.schema.base import Name, NonNegative, Strict

Rule = Literal["combined", "astm"]
"""Which verdict is held against the truth: the combined one, which the client gets, or the class of
the potential alone by ASTM C876, active below −350 mV."""

UNREAD = "unread"
"""Stands for a verdict where a point has no valid reading."""
VERDICTS: dict[Rule, tuple[str, ...]] = {
    "combined": ("none", "possible", "active", UNREAD),
    "astm": ("passive", "uncertain", "active", UNREAD),
}

Whole = Annotated[int, Field(ge=0)]


class ConfusionRow(Strict):
    """What is truly so where one verdict was given."""

    verdict: str
    active_m2: NonNegative
    """Area over steel that truly corrodes."""
    sound_m2: NonNegative
    """Area over steel that does not."""
    active_points: Whole
    sound_points: Whole


class Confusion(Strict):
    """Verdicts against the truth: a row for each verdict, in the order of ``VERDICTS``."""

    rule: Rule
    rows: tuple[ConfusionRow, ...]

    @property
    def active_m2(self) -> float:
        """Area over steel that truly corrodes."""
        return sum(row.active_m2 for row in self.rows)

    @property
    def missed_m2(self) -> float:
        """Truly active area that was not judged active, unread area included."""
        return sum(row.active_m2 for row in self.rows if row.verdict != "active")

    @property
    def false_m2(self) -> float:
        """Area judged active over steel that does not corrode."""
        return sum(row.sound_m2 for row in self.rows if row.verdict == "active")

    @property
    def region_m2(self) -> float:
        """The whole measured region."""
        return sum(row.active_m2 + row.sound_m2 for row in self.rows)


class SurfaceScoring(Strict):
    """One surface's verdicts against its specimen."""

    surface: Name
    combined: Confusion
    astm: Confusion
    sites_total: Whole
    """Connected regions of truly active area that reach into the measured region."""
    sites_found: Whole
    """Those with at least one point within that the combined rule judged active."""
    too_resistive_m2: NonNegative
    """Truly active area in the measured region over which the concrete is truly too resistive for
    the combined rule to say active, whatever the potential."""


class Scoring(Strict):
    """All surfaces with a specimen."""

    surfaces: Annotated[tuple[SurfaceScoring, ...], Field(min_length=1)]

    def confusion(self, rule: Rule = "combined") -> Confusion:
        """The confusion matrix of all surfaces together, for a table: one row a verdict."""
        each = [getattr(surface, rule) for surface in self.surfaces]
        rows = zip(*(confusion.rows for confusion in each), strict=True)
        return Confusion(rule=rule, rows=tuple(_together(row) for row in rows))

    @property
    def too_resistive_m2(self) -> float:
        """Of all surfaces."""
        return sum(surface.too_resistive_m2 for surface in self.surfaces)

    @property
    def sites_total(self) -> int:
        """Of all surfaces."""
        return sum(surface.sites_total for surface in self.surfaces)

    @property
    def sites_found(self) -> int:
        """Of all surfaces."""
        return sum(surface.sites_found for surface in self.surfaces)


def _together(rows: Sequence[ConfusionRow]) -> ConfusionRow:
    return ConfusionRow(
        verdict=rows[0].verdict,
        active_m2=sum(row.active_m2 for row in rows),
        sound_m2=sum(row.sound_m2 for row in rows),
        active_points=sum(row.active_points for row in rows),
        sound_points=sum(row.sound_points for row in rows),
    )
