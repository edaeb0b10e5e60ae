"""``inspect report`` of a run that consists of several sorties."""

from __future__ import annotations

import json
from pathlib import Path

from pydantic import ValidationError

from inspect_cli.commands.runs import log_of, write_model
from inspect_cli.errors import InputError
from inspect_cli.log.reader import RunLog, read_log
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.metrics.survey import joined_result
from inspect_cli.reporting.report import write_report
from inspect_cli.reporting.survey import write_survey_report
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.result import Result


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
    except (ValueError, AttributeError) as error:
        if isinstance(error, ValidationError):
            raise InputError(f"{file}: not the plan of a survey: {error}") from error
        return None  # the log carries the plan of a single flight


def report_survey(run: Path, survey: CoveragePlan, folder: Path) -> tuple[Result, Path]:
    """Score and report every sortie that was flown, and the survey they make together."""
    first: RunLog | None = None
    results: list[Result] = []
    for sortie in survey.sorties:
        try:
            log = read_log(log_of(run / sortie.folder))
        except InputError:
            break
        result = evaluate(log)
        own = folder / sortie.folder
        own.mkdir(parents=True, exist_ok=True)
        write_model(own / "metrics.json", result)
        write_report(log, result, own)
        results.append(result)
        first = first or log
    if first is None:
        raise InputError(f"{run} holds no flown sortie", hint="fly it first: inspect fly MISSION")
    flown = sum(len(sortie.plan.targets) for sortie in survey.sorties[: len(results)])
    unvisited = survey.joined().targets[flown:]
    joined = joined_result(results, unvisited, first.mission().acceptance, _seed(run))
    write_model(folder / "metrics.json", joined)
    return joined, write_survey_report(first, joined, results, survey, folder)


def _seed(run: Path) -> int | None:
    """The run's own seed, from which those of its sorties were drawn."""
    try:
        saved = Result.model_validate_json((run / "metrics.json").read_bytes())
    except (OSError, ValidationError):
        return None
    return saved.seed
