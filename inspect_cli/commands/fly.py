"""``inspect fly``: from a mission or a plan to flight logs and metrics."""

from __future__ import annotations

import json
from dataclasses import dataclass
from pathlib import Path

from pydantic import ValidationError

from inspect_cli.commands.plan import inputs_sha256, plan_loaded, vehicle_of
from inspect_cli.commands.runs import prepared_run, run_folder
from inspect_cli.commands.single_flight import Progress, fly_into
from inspect_cli.commands.survey import fly_survey
from inspect_cli.commands.truth_under_surface import truth_under_surfaces
from inspect_cli.errors import InputError
from inspect_cli.schema.coverage import CoveragePlan, CoveragePlanFile
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan, PlanFile
from inspect_cli.schema.result import Result
from inspect_cli.simulation.loop import Ending

PLAN_FIRST = "make it anew with 'inspect plan MISSION'"


@dataclass(frozen=True)
class FlyOutcome:
    """A run's result and where its files are."""

    result: Result
    folder: Path
    ending: Ending


def fly(
    mission: Path,
    *,
    seed: int | None = None,
    platform: Path | None = None,
    out: Path | None = None,
    progress: Progress | None = None,
) -> FlyOutcome:
    """Fly a mission, or a saved plan, in simulation; a survey flies its sorties one by one.

    ``seed`` defaults to the mission's first. ``progress`` is called with the time of flight and
    the planned duration, s. Raises InputError before anything is written.
    """
    loaded, plan = _load(mission, platform)
    return fly_loaded(loaded, plan, seed=seed, out=out, progress=progress)


def fly_loaded(
    loaded: Loaded,
    plan: Plan | CoveragePlan | None = None,
    *,
    seed: int | None = None,
    out: Path | None = None,
    progress: Progress | None = None,
) -> FlyOutcome:
    """``fly`` for a mission that is already read, and planned too where a ``plan`` is given."""
    vehicle = vehicle_of(loaded)
    plan = plan or plan_loaded(loaded, vehicle)
    seed = loaded.mission.seeds[0] if seed is None else seed
    folder = out or run_folder(loaded.root, plan.mission, plan.platform, seed)
    believed = plan.sorties[0].plan.surfaces if isinstance(plan, CoveragePlan) else plan.surfaces
    structure = truth_under_surfaces(loaded, believed)
    with prepared_run(folder):
        if isinstance(plan, CoveragePlan):
            result, ending = fly_survey(folder, vehicle, plan, loaded, structure, seed, progress)
        else:
            result, ending = fly_into(folder, vehicle, plan, loaded, structure, seed, progress)
    return FlyOutcome(result, folder, ending)


def _load(path: Path, platform: Path | None) -> tuple[Loaded, Plan | CoveragePlan | None]:
    if path.suffix != ".json":
        return load_mission(path, platform), None
    try:
        content = path.read_bytes()
        saved = _plan_file(content)
    except OSError as error:
        raise InputError(f"{path}: {error.strerror}", hint=PLAN_FIRST) from error
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        raise InputError(f"{path}: not a plan: {where}: {first['msg']}", hint=PLAN_FIRST) from error
    loaded = load_mission(path.parent / saved.mission_file, platform)
    if inputs_sha256(loaded) != saved.inputs_sha256:
        raise InputError(
            f"{path}: the mission or the platform has changed since it was planned",
            hint=PLAN_FIRST,
        )
    return loaded, saved.plan()


def _plan_file(content: bytes) -> PlanFile | CoveragePlanFile:
    """The plan of one flight, or of a survey, which says so."""
    try:
        is_survey = json.loads(content).get("kind") == "coverage"
    except (ValueError, AttributeError):
        is_survey = False  # the model says what is wrong with it
    model = CoveragePlanFile if is_survey else PlanFile
    return model.model_validate_json(content)
