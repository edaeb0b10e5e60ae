"""Flying the sorties of a survey one by one, refining it on the way, and joining the results.

<run>/plan.json       the survey, with the sorties that were added in flight
<run>/metrics.json    all sorties joined
<run>/sortie-<k>/     a run of its own for each sortie
"""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from pathlib import Path

from inspect_cli.commands.plan import surveyor_of
from inspect_cli.commands.runs import METRICS_NAME, write_json, write_model
from inspect_cli.commands.single_flight import FlightInterrupted, Progress, fly_into, timing
from inspect_cli.log.rasters import TrueRaster
from inspect_cli.metrics.readings import assessor, scorer
from inspect_cli.metrics.survey import joined_result
from inspect_cli.planning.coverage import Surveyor
from inspect_cli.planning.lattice import Place
from inspect_cli.planning.refinement import Measured, places_between
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.loading import Loaded
from inspect_cli.schema.result import Result
from inspect_cli.simulation.loop import Ending
from inspect_cli.simulation.randomness import sortie_seed
from inspect_cli.truth.geometry import StructureTruth
from inspect_cli.truth.rasters import true_rasters
from inspect_cli.vehicles.kinds import Vehicle


def fly_survey(
    folder: Path,
    vehicle: Vehicle,
    plan: CoveragePlan,
    loaded: Loaded,
    structure: StructureTruth,
    seed: int,
    progress: Progress | None,
) -> tuple[Result, Ending]:
    """Fly every sortie into its own folder; the first that is not completed is the last.

    What is written after each sortie is whole, so that a killed run keeps the finished ones.

    Raises:
        FlightInterrupted: the user stopped a sortie; the finished ones are kept and joined.
    """
    refinement = Refining(surveyor_of(loaded, vehicle), plan)
    results: list[Result] = []
    endings: list[Ending] = []
    survey = plan
    rasters = true_rasters(structure, plan.sorties[0].plan.surfaces)
    write_model(folder / "plan.json", survey)
    while len(results) < len(survey.sorties):
        sortie = survey.sorties[len(results)]
        told = _onward(progress, survey, endings)
        drawn = sortie_seed(seed, sortie.number)
        try:
            result, ending = fly_into(
                folder / sortie.folder, vehicle, sortie.plan, loaded, structure, drawn, told
            )
        except FlightInterrupted:
            raise FlightInterrupted(folder) from None
        results.append(result)
        endings.append(ending)
        if result.status == "completed":
            survey = refinement.after(survey, results)
        joined = join(survey, results, loaded, seed, rasters)
        write_model(folder / "plan.json", survey)
        write_model(folder / METRICS_NAME, joined)
        write_json(folder / "timing.json", timing(_together(joined, endings)))
        if result.status != "completed":
            break
    return joined, _together(joined, endings)


def join(
    survey: CoveragePlan,
    results: Sequence[Result],
    loaded: Loaded,
    seed: int,
    rasters: Sequence[TrueRaster] = (),
) -> Result:
    """The sorties' results as one, with the points of those that were not flown.

    ``rasters`` are what is truly so, for the points of all sorties to be held against.
    """
    mission = loaded.mission
    targets = survey.joined().targets
    score_all = scorer(rasters, targets)
    flown = sum(len(sortie.plan.targets) for sortie in survey.sorties[: len(results)])
    unvisited = targets[flown:]
    assess_all = assessor(mission, loaded.platform, targets)
    return joined_result(results, unvisited, mission.acceptance, seed, score_all, assess_all)


class Refining:
    """The refinement rule: after each sortie of the lattice, points between doubtful neighbours."""

    def __init__(self, surveyor: Surveyor, planned: CoveragePlan) -> None:
        self._surveyor = surveyor
        self._planned = planned
        self._places: dict[str, Place] = {}

    def after(self, survey: CoveragePlan, results: Sequence[Result]) -> CoveragePlan:
        """The survey with what the readings so far ask for in further sorties at its end."""
        rule = self._surveyor.coverage.refine
        lattice = len(self._planned.sorties)
        if rule is None or len(results) > lattice:
            return survey
        readings = _readings(results)
        wanted = places_between(self._surveyor.prim, self._surveyor.coverage, rule, readings)
        if wanted.keys() == self._places.keys():
            return survey
        self._places |= wanted
        asked = list(self._places.items())[: rule.max_points]
        batch = self._surveyor.batch(asked)
        return self._planned.with_sorties(batch.plans, batch.skipped)


def _readings(results: Iterable[Result]) -> dict[str, Measured]:
    """What was measured and is valid, by label."""
    return {
        point.label: Measured(point.uv_m, point.potential_mv)
        for result in results
        for point in result.points
        if point.potential_mv is not None and point.uv_m is not None
    }


def _onward(
    progress: Progress | None, survey: CoveragePlan, endings: Sequence[Ending]
) -> Progress | None:
    """Progress over the whole survey."""
    if progress is None:
        return None
    flown_s = sum(ending.flight_s for ending in endings)
    left_s = sum(sortie.plan.duration_s for sortie in survey.sorties[len(endings) :])

    def tell(t_s: float, _: float) -> None:
        progress(flown_s + t_s, flown_s + left_s)

    return tell


def _together(joined: Result, endings: Sequence[Ending]) -> Ending:
    return Ending(
        joined.status,
        joined.status_reason,
        flight_s=sum(ending.flight_s for ending in endings),
        wall_s=sum(ending.wall_s for ending in endings),
        log_wall_s=sum(ending.log_wall_s for ending in endings),
    )
