"""``inspect report`` of a run that consists of several sorties."""

from __future__ import annotations

import json
from dataclasses import replace
from pathlib import Path

from pydantic import ValidationError

from inspect_cli.commands.delivery import (
    Wanted,
    deliver,
    export,
    handed_readings,
    report_folder,
    require_exportable,
)
from inspect_cli.commands.pictures import pictured
from inspect_cli.commands.runs import (
    LOG_NAME,
    METRICS_NAME,
    SORTIES,
    log_of,
    write_model,
    write_readings,
)
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.errors import InputError, LogError
from inspect_cli.log.reader import RunLog, read_log
from inspect_cli.metrics.assessed import assessor
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.metrics.survey import joined_evaluation, scorer
from inspect_cli.pictures.render import Pictures
from inspect_cli.reporting.documents.flight import report_document, survey_document
from inspect_cli.schema.coverage import CoveragePlan, Sortie
from inspect_cli.schema.result import Result

FLY_AGAIN = "fly the survey again, or report its sorties one by one"


def survey_of(run: Path) -> CoveragePlan | None:
    """The survey that a run folder holds; None when it holds a single flight.

    Raises:
        InputError: its plan says that it is a survey and cannot be read.
    """
    file = run / "plan.json"
    if not file.is_file():
        return None
    content = file.read_bytes()
    try:
        if json.loads(content).get("kind") != "coverage":
            return None
        return CoveragePlan.model_validate_json(content)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        where = ".".join(map(str, first["loc"]))
        what = f"{file}: not the plan of a survey: {where}: {first['msg']}"
        raise InputError(what, hint=FLY_AGAIN) from error
    except (ValueError, AttributeError) as error:
        if any(run.glob(SORTIES)):
            raise InputError(
                f"{file}: the plan of the survey is damaged", hint=FLY_AGAIN
            ) from error
        return None  # the log carries the plan of a single flight


def report_survey(
    run: Path, survey: CoveragePlan, folder: Path, wanted: Wanted
) -> tuple[Result, Path, Pictures | None]:
    """Score and report every sortie that was flown, and the survey they make together.

    Its pictures, where wanted, are those of the first sortie.

    Raises:
        LogError: the log of a sortie is damaged; the others can be reported one by one.
        InputError: there is no sortie, or one is missing before another.
    """
    require_exportable(len(survey.joined().targets), wanted)
    first: RunLog | None = None
    results: list[Result] = []
    for sortie, file in _flown(run, survey):
        log = _log_that_was_begun(file)
        if log is None:
            break
        evaluation = evaluate_with_arrays(log)
        result = evaluation.result
        own = report_folder(folder / sortie.folder)
        write_model(own / METRICS_NAME, result)
        write_readings(own, result)
        document = report_document(log, result, log.plan(), with_maps(evaluation.assessed))
        deliver(own, document, replace(wanted, pdf=False))
        results.append(result)
        first = first or log
    if first is None:
        raise InputError(f"{run} holds no flown sortie", hint="fly it first: inspect fly MISSION")
    flown = sum(len(sortie.plan.targets) for sortie in survey.sorties[: len(results)])
    plan = survey.joined()
    unvisited = plan.targets[flown:]
    mission = first.mission()
    score_all = scorer(first.true_rasters(), plan.targets)
    assess_all = assessor(mission, first.platform(), plan.targets)
    survey_evaluation = joined_evaluation(
        results, unvisited, mission.acceptance, _seed(run), score_all, assess_all
    )
    joined = survey_evaluation.result
    write_model(folder / METRICS_NAME, joined)
    write_readings(folder, joined)
    which = f"sortie 1 of {len(results)}"
    export(folder, handed_readings(first, joined), wanted)
    taken = pictured(
        first, results[0], folder, wanted.language, wanted=wanted.pictures, flight=which
    )
    surfaces = with_maps(survey_evaluation.assessed)
    document = survey_document(first, joined, results, survey, plan, surfaces, taken)
    return joined, deliver(folder, document, wanted), taken


def _flown(run: Path, survey: CoveragePlan) -> list[tuple[Sortie, Path]]:
    """The sorties that have a log, with it."""
    flown: list[tuple[Sortie, Path]] = []
    missing = ""
    for sortie in survey.sorties:
        try:
            file = log_of(run / sortie.folder)
        except InputError:
            missing = missing or sortie.folder
            continue
        if not file.is_file():
            missing = missing or sortie.folder
            continue
        if missing:
            what = f"{run}: {missing} has no {LOG_NAME}, yet {sortie.folder} was flown after it"
            raise InputError(what, hint=f"bring it back, or report {run / sortie.folder} alone")
        flown.append((sortie, file))
    return flown


def _log_that_was_begun(file: Path) -> RunLog | None:
    """The log; None for one that was killed before anything of it had reached the disk."""
    try:
        return read_log(file)
    except LogError:
        if file.name != LOG_NAME:
            return None
        raise


def _seed(run: Path) -> int | None:
    """The run's own seed, from which those of its sorties were drawn."""
    try:
        saved = Result.model_validate_json((run / METRICS_NAME).read_bytes())
    except (OSError, ValidationError):
        return None
    return saved.seed
