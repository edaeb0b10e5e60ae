"""The verdicts of a campaign against what is truly so, from the rasters of a simulated flight.

The client is handed the combined verdict, so that is what counts: a place is missed where the
steel truly corrodes and the verdict is not ``active``, false where it does not and the verdict is.
``possible`` and a point without a valid reading do not find anything. The class of the potential
alone (ASTM C876, active below −350 mV) is held against the truth beside it.

The measured region are the cells of the planned points, read or not; where the specimen knows
nothing there is no truth to be held against. A site is a connected region of truly active area,
diagonals included, that reaches into the measured region. It is found when a planned point within
it was judged active. A reading beside a site finds area of it, not the site.

The combined rule asks for a resistivity of at most 100 Ω·m. Steel that corrodes in concrete of
more is missed by the rule itself: readings there are *possible* at the most, but for the error of
the resistance. How much area that is says ``too_resistive_m2``.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray
from scipy.ndimage import label

from inspect_cli.assessment.classes import sustains_corrosion
from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.flight import NotMeasured
from inspect_cli.metrics.planned_cells import PlannedCells, widths_of
from inspect_cli.metrics.sample_areas import Cells, cells_around, weighed
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.scoring import (
    UNREAD,
    VERDICTS,
    Confusion,
    ConfusionRow,
    Rule,
    Scoring,
    SurfaceScoring,
)
from inspect_cli.spatial.arrays import Points, Vector

NO_TRUTH = "the log does not hold what is truly so beneath a surface"


@dataclass(frozen=True, eq=False)
class Judged:
    """What was said of the points of one surface."""

    uv_m: Points
    """(n, 2), where they were planned."""
    combined: tuple[str, ...]
    """By the combined rule; ``UNREAD`` without a valid reading."""
    astm: tuple[str, ...]

    @classmethod
    def of(cls, points: Sequence[PointResult]) -> Judged:
        """The points that lie on the surface's coordinates."""
        placed = [(point, point.uv_m) for point in points if point.uv_m is not None]
        return cls(
            np.array([uv for _, uv in placed], np.float64).reshape(-1, 2),
            tuple(point.corrosion or UNREAD for point, _ in placed),
            tuple(point.astm_class or UNREAD for point, _ in placed),
        )


def score(
    points: Sequence[PointResult], rasters: Sequence[TrueRaster], cells: PlannedCells
) -> Scoring:
    """The scoring of points, each by the surface that it lies on and the cell it stands for.

    Raises:
        NotMeasured: no raster lies beneath any of them, or it knows nothing there; or the plan
            does not know what a point stands for, as of one that stands alone.
    """
    scored = []
    for raster in rasters:
        own = [point for point in points if point.surface == raster.surface and point.uv_m]
        if not own:
            continue
        cell_m = widths_of(own, cells)
        if not np.all(np.isfinite(cell_m)):
            raise NotMeasured(
                f"a single point on '{raster.surface}' does not say what area it stands for"
            )
        judged = Judged.of(own)
        scored.append(score_surface(judged, cells_around(judged.uv_m, cell_m, raster), raster))
    known = tuple(one for one in scored if one.combined.region_m2 > 0.0)
    if not known:
        raise NotMeasured(f"{NO_TRUTH} where points were planned")
    return Scoring(surfaces=known)


def score_surface(judged: Judged, cells: Cells, raster: TrueRaster) -> SurfaceScoring:
    """What was said of a surface's points, each standing for its cells, against the raster."""
    known = np.isfinite(raster.potential_v)
    sites = _sites(raster)
    rows, columns, on = raster.cells(cells.uv_m)
    on &= known[rows, columns]
    owner, cell_sites = cells.owner[on], sites[rows[on], columns[on]]
    ohm_m = raster.resistivity_ohm_m[rows[on], columns[on]]
    too_resistive = (cell_sites > 0) & ~sustains_corrosion(ohm_m)
    each_m2 = cells.area_m2[on]
    too_resistive_m2 = float(weighed(too_resistive.astype(np.intp), each_m2, 2)[1])
    rows, columns, on = raster.cells(judged.uv_m)
    on &= known[rows, columns]
    point_sites = np.where(on, sites[rows, columns], -1)
    each: dict[Rule, tuple[str, ...]] = {"combined": judged.combined, "astm": judged.astm}
    made = {
        rule: _confusion(rule, each[rule], owner, cell_sites > 0, each_m2, point_sites)
        for rule in each
    }
    reached = set(np.unique(cell_sites[cell_sites > 0]).tolist())
    said_active = np.array([said == "active" for said in judged.combined], np.bool_)
    found = set(point_sites[said_active].tolist()) & reached
    return SurfaceScoring(
        surface=raster.surface,
        combined=made["combined"],
        astm=made["astm"],
        sites_total=len(reached),
        sites_found=len(found),
        too_resistive_m2=too_resistive_m2,
    )


def _confusion(
    rule: Rule,
    said: tuple[str, ...],
    owner: NDArray[np.intp],
    active: NDArray[np.bool_],
    each_m2: Vector,
    point_sites: NDArray[np.intp],
) -> Confusion:
    """Areas from samples of the region, counts from the points where the truth is known."""
    names = VERDICTS[rule]
    codes = np.array([names.index(one) for one in (*said, UNREAD)])  # the last for no owner
    areas = weighed(2 * codes[owner] + active, each_m2, 2 * len(names))
    at = point_sites >= 0
    truth = (point_sites[at] > 0).astype(np.intp)
    counts = np.bincount(2 * codes[:-1][at] + truth, minlength=2 * len(names))
    rows = tuple(
        ConfusionRow(
            verdict=name,
            active_m2=float(areas[2 * k + 1]),
            sound_m2=float(areas[2 * k]),
            active_points=int(counts[2 * k + 1]),
            sound_points=int(counts[2 * k]),
        )
        for k, name in enumerate(names)
    )
    return Confusion(rule=rule, rows=rows)


def _sites(raster: TrueRaster) -> NDArray[np.intp]:
    """The number of the site that each cell belongs to, from 1; 0 where it is not active."""
    sites = np.asarray(label(raster.active, np.ones((3, 3)))[0], np.intp)
    if not raster.turn_m:
        return sites
    for first, last in zip(sites[:, 0], sites[:, -1], strict=True):
        if first > 0 and last > 0 and first != last:
            sites[sites == last] = first  # one site across the seam of a closed surface
    return sites
