"""Everything that is evaluated of one surface's readings, per point and as a summary."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import NDArray

from inspect_cli.assessment import classes, findings
from inspect_cli.assessment.areas import Cells, cells_of
from inspect_cli.assessment.classes import Codes
from inspect_cli.assessment.conditions import compatible
from inspect_cli.assessment.electrodes import CSE, basis_of
from inspect_cli.assessment.gradient import Minima, Steps, minima_of, steps_of
from inspect_cli.assessment.mixture import Mixture, fitted
from inspect_cli.assessment.readings import Merged, Readings, merged
from inspect_cli.assessment.spacing import Spacing, neighbours, spacing_of, spacing_of_cells
from inspect_cli.assessment.uncertainty import Budget, budget_of, class_probabilities, doubtful
from inspect_cli.schema.assessment import Basis, SurfaceAssessment
from inspect_cli.spatial.arrays import Points, Vector

if TYPE_CHECKING:
    from shapely.geometry.base import BaseGeometry


@dataclass(frozen=True)
class AtPoints:
    """The findings at m points, in the order in which each place was first read."""

    merged: Merged
    """The points, and which of the given readings are at which."""
    astm: Codes
    """(m,) numbers of ``classes.ASTM_CLASSES``; −1 without a valid reading."""
    rate: Codes
    """(m,) of ``CORROSION_RATES``; −1 without a resistivity."""
    risk: Codes
    """(m,) of ``CORROSION_RISKS``; likewise."""
    verdict: Codes
    """(m,) of ``VERDICTS``; −1 without a valid reading."""
    typical: NDArray[np.bool_]
    """(m, 6) of which of ``conditions.CONDITIONS`` the potential is typical."""
    spacing: Spacing | None
    cells: Cells | None
    """What each point stands for; None where no spacing is known."""
    minima: Minima
    steps: Steps
    mixture: Mixture | str
    """In words why there is none."""
    budget: Budget
    probabilities: Points
    """(m, 3) of the ASTM classes."""
    doubtful: NDArray[np.bool_]
    """(m,) whose class is less than 95 % certain."""

    @property
    def readings(self) -> Readings:
        """The points as readings (m)."""
        return self.merged.readings

    @property
    def area_m2(self) -> Vector | None:
        """(m,) What each point stands for."""
        return None if self.cells is None else self.cells.area_m2


@dataclass(frozen=True)
class Assessed(AtPoints):
    """A surface's findings at its points, and in short."""

    summary: SurfaceAssessment


def assess(
    surface: str,
    readings: Readings,
    *,
    basis: Basis | None = None,
    cell_m: Points | None = None,
    region: BaseGeometry | None = None,
    electrodes: int = 1,
) -> Assessed:
    """Evaluate the readings of one surface; any number of them, valid or not, wherever they lie.

    What cannot be told is None in the summary, with the reason in the ``why`` beside it.

    Args:
        surface: its name.
        readings: potentials against CSE at 22.2 °C (``electrodes.to_standard``).
        basis: how they were made that; by default they were read so at a temperature not known.
        cell_m: widths (n, 2), m, along u and v of the rectangle that each reading stands for, where
            a plan states them, NaN where it does not know; else they are told from the places.
            Repeated readings of a place stand for what the first does.
        region: the surveyed part of the surface, a shapely polygon in (u, v); else see ``areas``.
        electrodes: how many took the readings; any number above 1 means two.
    """
    basis = basis or basis_of(CSE)
    places = merged(readings)
    points = places.readings
    uv, potential, rho = points.uv_m, points.potential_v, points.resistivity_ohm_m
    stated_m = None
    if cell_m is not None and len(points):
        stated_m = cell_m[np.unique(places.member, return_index=True)[1]]
    spacing = spacing_of(uv) if stated_m is None else spacing_of_cells(stated_m)
    pairs = np.zeros((0, 2), np.intp)
    if spacing is not None:
        valid = np.flatnonzero(points.valid)
        pairs = valid[neighbours(uv[valid], spacing)]
    budget = budget_of(places, basis, electrodes=electrodes)
    probabilities = class_probabilities(potential, budget.total_v)
    at = AtPoints(
        merged=places,
        astm=classes.astm_codes(potential),
        rate=classes.rate_codes(rho),
        risk=classes.risk_codes(rho),
        verdict=classes.verdict_codes(potential, rho),
        typical=compatible(potential),
        spacing=spacing,
        cells=cells_of(uv, spacing, region, stated_m),
        minima=minima_of(uv, potential, pairs),
        steps=steps_of(uv, potential, pairs, spacing),
        mixture=fitted(potential),
        budget=budget,
        probabilities=probabilities,
        doubtful=doubtful(potential, probabilities),
    )
    merged_readings = len(readings) - len(points)
    basis = basis.model_copy(update={"merged_readings": merged_readings})
    return Assessed(**vars(at), summary=_summary(surface, basis, len(readings), at))


def _summary(surface: str, basis: Basis, given: int, at: AtPoints) -> SurfaceAssessment:
    points, area_m2, valid = at.readings, at.area_m2, at.readings.valid
    any_valid = bool(np.any(valid))
    return SurfaceAssessment(
        surface=surface,
        basis=basis,
        readings=given,
        points=len(points),
        valid=int(np.count_nonzero(valid)),
        invalid=int(np.count_nonzero(~valid)),
        spacing_m=None if at.spacing is None else (at.spacing.u_m, at.spacing.v_m),
        area_m2=None if area_m2 is None else float(np.sum(area_m2)),
        invalid_area_m2=None if area_m2 is None else float(np.sum(area_m2[~valid])),
        area_why="" if at.cells else _why_no_area(len(points)),
        astm=findings.class_shares(classes.ASTM_CLASSES, at.astm, area_m2),
        potential=findings.potential_statistics(points.potential_v),
        potential_why="" if any_valid else findings.NO_READING,
        conditions=findings.condition_counts(at.typical),
        no_condition=int(np.count_nonzero(valid & ~np.any(at.typical, axis=1))),
        gradient=findings.gradient_findings(points, at.minima, at.spacing),
        mixture=findings.mixture_findings(at.mixture),
        resistivity_known=int(np.count_nonzero(classes.is_resistivity(points.resistivity_ohm_m))),
        rates=findings.class_shares(classes.CORROSION_RATES, at.rate, area_m2),
        risks=findings.class_shares(classes.CORROSION_RISKS, at.risk, area_m2),
        verdicts=findings.class_shares(classes.VERDICTS, at.verdict, area_m2),
        astm_by_rate=findings.crossed(at.astm, at.rate, classes.CORROSION_RATES),
        astm_by_risk=findings.crossed(at.astm, at.risk, classes.CORROSION_RISKS),
        refinement=findings.refinement_findings(points, at.steps),
        repeatability=findings.repeatability_findings(at.merged),
        uncertainty=findings.uncertainty_findings(at.budget, at.doubtful, valid),
    )


def _why_no_area(points: int) -> str:
    return "nothing was read" if points == 0 else "a single place has no spacing; state the pitch"
