"""``inspect report``: from a run or a log to metrics, readings, a page and pictures."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.commands.pictures import pictured
from inspect_cli.commands.runs import log_of, write_model, write_readings
from inspect_cli.commands.survey_report import report_survey, survey_of
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import evaluate
from inspect_cli.pictures.take import Pictures
from inspect_cli.reporting.report import write_report
from inspect_cli.schema.result import Result
from inspect_cli.schema.survey import LanguageCode


@dataclass(frozen=True)
class ReportOutcome:
    """One reported run."""

    result: Result
    page: Path
    pictures: Pictures | None = None
    """What was rendered, or why not; None where no pictures were wanted."""


def report(
    runs: Sequence[Path],
    out: Path | None = None,
    language: LanguageCode = "en",
    *,
    pictures: bool = False,
) -> tuple[ReportOutcome, ...]:
    """Report each run folder or log; with several, ``out`` takes a folder per mission and run.

    With ``pictures`` a scene and a film are rendered, of a survey those of its first sortie.

    Raises LogError when a file is no log of ours; then nothing is written for it.
    """
    return tuple(_report_one(run, _folder(run, out, len(runs)), language, pictures) for run in runs)


def _report_one(run: Path, folder: Path, language: LanguageCode, pictures: bool) -> ReportOutcome:
    survey = survey_of(run)
    if survey is not None:
        return ReportOutcome(*report_survey(run, survey, folder, language, pictures=pictures))
    log = read_log(log_of(run))
    result = evaluate(log)
    folder.mkdir(parents=True, exist_ok=True)
    write_model(folder / "metrics.json", result)
    write_readings(folder, result)
    taken = pictured(log, result, folder, language, wanted=pictures)
    return ReportOutcome(result, write_report(log, result, folder, language), taken)


def _folder(run: Path, out: Path | None, count: int) -> Path:
    own = run if run.is_dir() else run.parent
    if out is None or count == 1:
        return out or own
    return out / own.resolve().parent.name / own.resolve().name
