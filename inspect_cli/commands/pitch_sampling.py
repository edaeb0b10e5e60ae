"""What grids of one pitch find of a specimen, wherever they happen to lie: sampled, not flown.

The region is the same for every pitch: the squares around the points that the mission itself
plans. A grid of the pitch p lies on it with each of 20 offsets, stratified over the square p × p
and the same shares of it for every pitch. Every place of the region stands for its nearest
reading. A reading is taken where the tool truly is, its point plus a normal error along u and
along v; what it says there the instrument's own function knows (``Verdicts``).

Standard errors are s/√20 over the offsets, as if they were independent. Strata can only lower the
true ones, so the stated ones are rather too large. They are of where the grid happens to lie on
this one specimen and say nothing of other walls; all pitches share the specimen and the shares.

The deviations of the error are stated: with them the largest errors of the reference flights,
2 to 4 mm with an external tracker and 12 to 19 mm with odometry on board, are those of a dozen
points. An error larger than the task's ``off_target_m`` spoils the reading, as in a flight.
"""

from __future__ import annotations

from collections.abc import Iterator
from typing import Protocol

import numpy as np

from inspect_cli.commands.sweeps import Sampled, Variant
from inspect_cli.errors import InputError, Location, Problem
from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.sample_areas import Cells, cells_around, in_squares, nearest_to
from inspect_cli.metrics.truth_scoring import Judged, score_surface
from inspect_cli.planning.lattice import lattice
from inspect_cli.reporting.studies.pitch_figures import (
    ACTIVE,
    DETECTED,
    DURATION,
    ENERGY,
    FALSE,
    MISSED,
    POINTS,
    SITES,
    SORTIES,
    TOO_RESISTIVE,
)
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.positioning import Estimation
from inspect_cli.schema.result import Metric
from inspect_cli.schema.scoring import UNREAD, SurfaceScoring
from inspect_cli.schema.tasks.contact_grid import ContactGrid
from inspect_cli.schema.tasks.coverage import Coverage
from inspect_cli.simulation.randomness import component_rng
from inspect_cli.spatial.arrays import Points, Vector
from inspect_cli.truth.rasters import UnderSurface

POSITION_SD_M: dict[Estimation, float] = {"external": 0.002, "onboard": 0.008}
"""Of the true contact from its point, along u and along v each, by where poses come from."""
STRATA = (5, 4)
"""Of the offsets along u and v."""
FINER = 2.0
"""The raster's cells, as a multiple of those that a flight leaves in its log."""


GridWork = ContactGrid | Coverage
"""The tasks whose pitch can be varied."""


class Verdicts(Protocol):
    """What an instrument says of n places that it is steadily pressed onto."""

    def __call__(
        self,
        loaded: Loaded,
        work: GridWork,
        potential_v: Vector,
        resistivity_ohm_m: Vector,
        rng: np.random.Generator,
    ) -> Iterator[tuple[str, str]]:
        """Verdicts by its combined rule and by ASTM C876, or ``UNREAD``, one pair for each place.

        Potential (n,), V, and resistivity (n,), Ω·m, are the true ones there, NaN beside the
        specimen.
        """
        ...


class PitchSampler:
    """Grids of any pitch over the region of one mission."""

    def __init__(
        self,
        loaded: Loaded,
        work: GridWork,
        beneath: UnderSurface,
        planned: Points,
        seed: int,
        verdicts: Verdicts,
    ) -> None:
        self._loaded, self._work, self._beneath, self._seed = loaded, work, beneath, seed
        self._planned, self._verdicts = planned, verdicts
        self._raster: TrueRaster = beneath.raster(FINER)
        self._region: Cells = cells_around(planned, work.pitch_m, self._raster)
        unread = self._scored(np.empty((0, 2)), ())
        if unread.sites_total == 0:
            what = f"nothing is truly active beneath the points on '{work.on}'"
            hint = "there is nothing to detect: give the specimen an active site within the region"
            raise InputError(Problem(what, Location(str(loaded.mission_file)), hint))
        self.trials = STRATA[0] * STRATA[1]
        self.common = {
            ACTIVE: Metric(value=unread.combined.active_m2, unit="m²"),
            TOO_RESISTIVE: Metric(value=unread.too_resistive_m2, unit="m²"),
        }

    def __call__(self, variant: Variant, plan: Plan | CoveragePlan) -> Sampled:
        """What the plan costs, and the means over the offsets of what is found."""
        work = variant.loaded.mission.tasks[0].work
        assert isinstance(work, ContactGrid | Coverage)  # the study has looked
        scored = [
            self._at(work, offset, k) for k, offset in enumerate(self._offsets(work) * work.pitch_m)
        ]
        active_m2 = scored[0].combined.active_m2
        missed_m2 = np.array([one.combined.missed_m2 for one in scored])
        samples: dict[str, tuple[Vector, str]] = {
            MISSED: (missed_m2, "m²"),
            FALSE: (np.array([one.combined.false_m2 for one in scored]), "m²"),
            DETECTED: (1.0 - missed_m2 / active_m2, "1"),
            SITES: (np.array([one.sites_found / one.sites_total for one in scored]), "1"),
        }
        means = {n: Metric(value=float(x.mean()), unit=unit) for n, (x, unit) in samples.items()}
        errors = {n: float(x.std(ddof=1) / np.sqrt(len(x))) for n, (x, _) in samples.items()}
        return Sampled(_costs(plan) | means, errors)

    def _at(self, work: GridWork, offset: Vector, number: int) -> SurfaceScoring:
        """What a grid with one offset (2,) m comes to."""
        places = self._places(work, offset)
        rng = component_rng(self._seed, f"study.pitch.{work.pitch_m!r}.{number}")
        said = tuple(self._read(places, work, rng))
        return self._scored(places, said)

    def _scored(self, places: Points, said: tuple[tuple[str, str], ...]) -> SurfaceScoring:
        """``said`` are the verdicts of the places, by the combined rule and by ASTM C876."""
        combined, astm = tuple(one for one, _ in said), tuple(other for _, other in said)
        cells = nearest_to(self._region, places, self._raster)
        return score_surface(Judged(places, combined, astm), cells, self._raster)

    def _read(
        self, places: Points, work: GridWork, rng: np.random.Generator
    ) -> Iterator[tuple[str, str]]:
        """The verdicts at each of the places: see ``Verdicts``."""
        error = rng.normal(0.0, POSITION_SD_M[self._loaded.mission.estimation], places.shape)
        across = np.column_stack([self._raster.across(places[:, 1]), np.ones(len(places))])
        volts, ohm_m, _ = self._beneath.at(places + error / across)
        missed = np.hypot(*error.T) > work.off_target_m
        verdicts = self._verdicts(self._loaded, work, volts, ohm_m, rng)
        for verdict, off in zip(verdicts, missed, strict=True):
            yield (UNREAD, UNREAD) if off else verdict

    def _places(self, work: GridWork, offset: Vector) -> Points:
        """The points (n, 2) of a grid that lie in the region."""
        if isinstance(work, Coverage):
            shift = (float(offset[0]), float(offset[1]))
            found = np.array(lattice(self._beneath.prim, work.pitch_m, 0.0, shift))
        else:
            found = _grid(self._work, work, offset)
        if len(found) == 0:
            return np.empty((0, 2))
        squares = self._planned, self._work.pitch_m
        return found[in_squares(found, *squares, self._raster)]

    def _offsets(self, work: GridWork) -> Points:
        """(n, 2) in pitches, each within ±½; along a single line of points they lie on it."""
        rng = component_rng(self._seed, "study.pitch.offsets")
        columns, rows = STRATA
        if isinstance(work, ContactGrid) and 1 in (work.rows, work.columns):
            along = (np.arange(self.trials) + rng.uniform(size=self.trials)) / self.trials - 0.5
            still = np.zeros(self.trials)
            return np.column_stack([still, along] if work.columns == 1 else [along, still])
        strata = np.array([(i, j) for j in range(rows) for i in range(columns)])
        spread: Points = (strata + rng.uniform(size=strata.shape)) / STRATA - 0.5
        return spread


def _grid(base: GridWork, work: ContactGrid, offset: Vector) -> Points:
    """A grid's points, one more on every side than it takes to cover what the mission covers."""
    assert isinstance(base, ContactGrid)  # a variant is a task of the same kind
    lines = []
    for axis, count in enumerate((base.columns, base.rows)):
        reach = 0 if count == 1 else int(np.ceil(0.5 * count * base.pitch_m / work.pitch_m)) + 1
        steps = np.arange(-reach, reach + 1) * work.pitch_m
        lines.append(steps + base.offset_m[axis] + offset[axis])
    u, v = np.meshgrid(*lines)
    return np.column_stack([u.ravel(), v.ravel()])


def _costs(plan: Plan | CoveragePlan) -> dict[str, Metric]:
    if isinstance(plan, CoveragePlan):
        points, sorties = plan.points, len(plan.sorties)
    else:
        points, sorties = len(plan.targets), 1
    return {
        POINTS: Metric(value=float(points), unit="1"),
        SORTIES: Metric(value=float(sorties), unit="1"),
        DURATION: Metric(value=plan.duration_s, unit="s"),
        ENERGY: Metric(value=plan.energy_wh, unit="Wh"),
    }
