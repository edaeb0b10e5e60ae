"""``inspect report``: from a run or a log to metrics, readings, a page and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.commands.delivery import (
    PICTURES,
    REPORT_FILES,
    Wanted,
    deliver,
    export,
    handed_readings,
    report_folder,
    require_exportable,
    require_room,
)
from inspect_cli.commands.pictures import pictured
from inspect_cli.commands.runs import METRICS_NAME, log_of, write_model, write_readings
from inspect_cli.commands.surface_maps import with_maps
from inspect_cli.commands.survey_report import report_survey, survey_of
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import evaluate_with_arrays
from inspect_cli.pictures.render import Pictures
from inspect_cli.reporting.documents.flight import report_document
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.result import Result


@dataclass(frozen=True)
class ReportOutcome:
    """One reported run."""

    result: Result
    page: Path
    pictures: Pictures | None = None
    """What was rendered, or why not; None where no pictures were wanted."""


def report(
    runs: Sequence[Path], out: Path | None = None, wanted: Wanted | None = None
) -> tuple[ReportOutcome, ...]:
    """Report each run folder or log; with several, ``out`` takes a folder per mission and run.

    Of a survey of several sorties, pictures are those of its first.

    Raises:
        LogError: a file is no log of ours; then nothing is written for it.
        InputError: a folder cannot take a report; then nothing is written at all.
    """
    wanted = wanted or Wanted()
    asked = [(run, _folder(run, out, len(runs)), survey_of(run)) for run in runs]
    for _, folder, survey in asked:
        require_room(folder, (*REPORT_FILES, *PICTURES))
        for sortie in survey.sorties if survey else ():
            require_room(folder / sortie.folder)
    return tuple(_report_one(run, folder, survey, wanted) for run, folder, survey in asked)


def _report_one(
    run: Path, folder: Path, survey: CoveragePlan | None, wanted: Wanted
) -> ReportOutcome:
    if survey is not None:
        return ReportOutcome(*report_survey(run, survey, folder, wanted))
    log = read_log(log_of(run))
    evaluation = evaluate_with_arrays(log)
    result = evaluation.result
    require_exportable(len(result.points), wanted)
    write_model(report_folder(folder) / METRICS_NAME, result)
    write_readings(folder, result)
    export(folder, handed_readings(log, result), wanted)
    taken = pictured(log, result, folder, wanted.language, wanted=wanted.pictures)
    surfaces = with_maps(evaluation.assessed)
    document = report_document(log, result, log.plan(), surfaces, taken)
    page = deliver(folder, document, wanted)
    return ReportOutcome(result, page, taken)


def _folder(run: Path, out: Path | None, count: int) -> Path:
    own = run if run.is_dir() else run.parent
    if out is None or count == 1:
        return out or own
    return out / own.resolve().parent.name / own.resolve().name
