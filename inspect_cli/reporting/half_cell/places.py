"""The places of one surface's assessment, one by one, as figures and tables name them."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment.assess import Assessed
from inspect_cli.assessment.classes import (
    ASTM_CLASSES,
    VERDICTS,
    is_resistivity,
    millivolts,
    name_of,
)
from inspect_cli.assessment.readings import SAME_PLACE_DECIMALS
from inspect_cli.assessment.surface_findings import SurfaceFindings
from inspect_cli.reporting.content.read_points import ReadPoint
from inspect_cli.reporting.half_cell.potential_scale import potential_range, reading_text
from inspect_cli.reporting.words.text import Text, count, separated
from inspect_cli.schema.assessment import AstmClass
from inspect_cli.schema.result import Corrosion

Indices = NDArray[np.intp]


@dataclass(frozen=True)
class Place:
    """One place and what was found there."""

    label: str
    uv_m: tuple[float, float]
    potential_mv: float | None
    resistivity_ohm_m: float | None
    astm_class: AstmClass | None
    verdict: Corrosion | None
    readings: int
    """Number of valid readings whose mean is the potential."""

    def text(self) -> Text:
        """The text that a figure shows under the pointer."""
        several = count(self.readings, "mean of {n} reading", "mean of {n} readings")
        said = reading_text(
            self.label, self.potential_mv, self.astm_class, self.resistivity_ohm_m, self.verdict
        )
        return separated([said, several if self.readings > 1 else ""], "<br>")


def places_of(assessed: Assessed, chosen: Indices) -> list[Place]:
    """The places at the chosen indices of the assessment."""
    points = assessed.readings
    mv = millivolts(points.potential_v[chosen])
    known = is_resistivity(points.resistivity_ohm_m[chosen])
    return [
        Place(
            label=str(points.labels[i]),
            uv_m=(float(points.uv_m[i, 0]), float(points.uv_m[i, 1])),
            potential_mv=float(mv[k]) if np.isfinite(mv[k]) else None,
            resistivity_ohm_m=float(points.resistivity_ohm_m[i]) if known[k] else None,
            astm_class=name_of(ASTM_CLASSES, assessed.astm[i]),
            verdict=name_of(VERDICTS, assessed.verdict[i]),
            readings=int(assessed.merged.counts[i]),
        )
        for k, i in enumerate(chosen)
    ]


def shared_range(evaluated: Sequence[SurfaceFindings]) -> tuple[float, float]:
    """Ends of one scale of potentials for all surfaces, mV."""
    valid = (e.assessed.readings.potential_v[e.assessed.readings.valid] for e in evaluated)
    return potential_range(
        float(end) for v in valid if len(v) for end in (millivolts(v).min(), millivolts(v).max())
    )


def points_on(
    evaluated: Sequence[SurfaceFindings], points: Iterable[ReadPoint]
) -> dict[str, list[ReadPoint]]:
    """The points of each surface; where only one was evaluated, those without a surface too."""
    found: dict[str, list[ReadPoint]] = {e.surface: [] for e in evaluated}
    alone = evaluated[0].surface if len(evaluated) == 1 else ""
    for p in points:
        own = p.surface or alone
        if own in found and p.point.uv_m is not None:
            found[own].append(p)
    return found


def index_of_places(assessed: Assessed) -> Mapping[tuple[float, float], int]:
    """Index of the assessment's point by ``place_key`` of a reading."""
    keys = np.round(assessed.readings.uv_m, SAME_PLACE_DECIMALS) + 0.0
    return {(u, v): i for i, (u, v) in enumerate(keys.tolist())}


def place_key(uv_m: tuple[float, float]) -> tuple[float, float]:
    """Readings with the same key were taken at the same place."""
    u, v = (np.round(np.asarray(uv_m), SAME_PLACE_DECIMALS) + 0.0).tolist()
    return u, v


def thinned_places(values: NDArray[np.float64], most: int) -> Indices:
    """At most ``most`` indices of values (n,), evenly spread and with both extremes.

    In the order of the values given.
    """
    n = len(values)
    if n <= most:
        return np.arange(n)
    spread = np.linspace(0, n - 1, most - 2).round().astype(np.intp)
    return np.unique([*spread, int(np.argmin(values)), int(np.argmax(values))])
