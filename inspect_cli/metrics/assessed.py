"""The points of a flight or of a survey, assessed surface by surface.

The potentials of points are evaluated already. How sure a reading is follows from how it was
taken: the platform's probe with its rule for a valid reading, and the resistance, which tells how
firm and how wet the contact was.
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING

import numpy as np

from inspect_cli.assessment.electrodes import basis_of
from inspect_cli.metrics.planned_cells import PlannedCells, widths_of
from inspect_cli.schema.assessment import Basis
from inspect_cli.schema.mission import Mission
from inspect_cli.schema.result import PointResult
from inspect_cli.schema.vehicle import HalfCellModel
from inspect_cli.spatial.arrays import Vector

if TYPE_CHECKING:
    from inspect_cli.assessment.assess import Assessed


def assess_points(
    points: Sequence[PointResult],
    mission: Mission,
    probe: HalfCellModel | None,
    cells: PlannedCells,
) -> tuple[Assessed, ...]:
    """The findings of each surface that has points, in the order in which it first appears.

    ``probe`` took the readings; without one there are none to assess. Points that lie on no known
    surface belong to none. What a point stands for is the plan's cell.
    """
    surfaces = dict.fromkeys(p.surface for p in points if p.surface and p.uv_m is not None)
    if not surfaces or probe is None:
        return ()
    from inspect_cli.assessment.assess import assess
    from inspect_cli.assessment.readings import readings_of

    assessed = []
    for surface in surfaces:
        own = _on(surface, points)
        readings = readings_of(own, measurement_sd_v(own, probe))
        basis = basis_on(mission, surface, probe.electrode)
        assessed.append(assess(surface, readings, basis=basis, cell_m=widths_of(own, cells)))
    return tuple(assessed)


def with_uncertainty(
    points: Sequence[PointResult], assessed: Iterable[Assessed]
) -> tuple[PointResult, ...]:
    """The points, with the standard uncertainty of each valid potential that was assessed.

    A flight's points have labels of their own.
    """
    found: dict[int, float] = {}
    for one in assessed:
        each_mv = 1e3 * one.budget.alone_v[one.merged.member]
        by_label = dict(zip(one.merged.given.tolist(), each_mv.tolist(), strict=True))
        own = (p for p in _on(one.summary.surface, points) if p.valid and p.label in by_label)
        found |= {p.index: by_label[p.label] for p in own}
    return tuple(p.model_copy(update={"potential_sd_mv": found.get(p.index)}) for p in points)


def basis_on(mission: Mission, surface: str | None, electrode: str) -> Basis:
    """What the potentials on a surface rest on: the probe's electrode, the stated temperature."""
    stated = {known.name: known.temperature_c for known in mission.structure}
    return basis_of(electrode, stated.get(surface or ""))


def measurement_sd_v(points: Sequence[PointResult], probe: HalfCellModel) -> Vector:
    """Standard uncertainty (n,), V, of the readings themselves; NaN without a valid one."""
    from inspect_cli.assessment.uncertainty import reading_sd_v

    return reading_sd_v(
        _numbers(1e-3 * p.read_mv if p.read_mv is not None else None for p in points),
        _numbers(p.resistance_ohm for p in points),
        noise_v=probe.potential_noise_v,
        stable_v=probe.stable_v,
        stable_s=probe.stable_s,
        wetting_s=probe.wetting_s,
    )


def _on(surface: str, points: Iterable[PointResult]) -> list[PointResult]:
    return [p for p in points if p.surface == surface and p.uv_m is not None]


def _numbers(values: Iterable[float | None]) -> Vector:
    return np.array([np.nan if value is None else value for value in values], np.float64)
