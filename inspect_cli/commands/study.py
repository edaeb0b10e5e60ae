"""``inspect study``: one mission with varied numbers, and their effect on its metrics.

<out>/study-<name>/study.json  study.html
<out>/study-<name>/<variant>/      an ordinary run of each variant that is flown

Every variant is planned before anything else. A study without a sampler then flies them; one with
a sampler computes its numbers from the plans, and flies only when it is asked to.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from pathlib import Path

import numpy as np

from inspect_cli.commands.delivery import report_folder
from inspect_cli.commands.fly import fly_loaded
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.commands.runs import log_of, write_model
from inspect_cli.commands.study_force import FORCE
from inspect_cli.commands.study_pitch import PITCH
from inspect_cli.commands.sweeps import Sampled, Study, Variant, numbers_of, variants
from inspect_cli.errors import EXIT_CHECK_FAILED, EXIT_GOOD, InfeasibleError, InputError
from inspect_cli.files import write_whole
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import measure
from inspect_cli.metrics.flight import FlightData
from inspect_cli.plugins import registered
from inspect_cli.regression.executors import OpenExecutor, local_executors
from inspect_cli.regression.flights import FlightEnd, FlightTask, Fly, fly_all
from inspect_cli.regression.run import Progress, counted
from inspect_cli.reporting.screen.html import html
from inspect_cli.reporting.studies.document import study_document
from inspect_cli.reporting.words.language import language as language_of
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.explain import suggest
from inspect_cli.schema.loading import load_mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import StudyColumn, StudyResult, StudyVariant
from inspect_cli.schema.survey import LanguageCode

STUDIES: dict[str, Study] = registered(
    "inspect_cli.studies", {"force": FORCE, "pitch": PITCH}, Study
)
"""Every study by its name: one row each, and those of installed packages. The command line takes
its options from here."""


@dataclass(frozen=True)
class StudyOutcome:
    """A study's result and its files."""

    result: StudyResult
    folder: Path
    page: Path

    @property
    def exit_code(self) -> int:
        """Zero when every flight ended as expected and every number is there."""
        return EXIT_CHECK_FAILED if self.result.shortfalls else EXIT_GOOD


def study(
    name: str,
    mission: Path,
    *,
    asked: Mapping[str, str] | None = None,
    out: Path | None = None,
    seed: int | None = None,
    jobs: int = 1,
    language: LanguageCode = "en",
    fly_sampled: bool = False,
    progress: Progress | None = None,
    fly: Fly = fly_loaded,
    open_executor: OpenExecutor | None = None,
) -> StudyOutcome:
    """Fly or sample the variants of a mission; write ``study.json`` and ``study.html``.

    Args:
        name: one of ``STUDIES``.
        mission: the mission's file.
        asked: numbers with commas between them by option, instead of the study's own.
        out: folder for the study's, instead of the mission's in ``reports/``.
        seed: of every variant; by default the mission's first.
        jobs: flights at a time on this machine; does nothing with an ``open_executor``.
        language: of the page.
        fly_sampled: fly each variant of a study that samples, too.
        progress: called with each flight as it ends.
        fly: flies one variant.
        open_executor: opens what runs the flights, for example a cluster's client; by default
            processes of this machine.

    Raises:
        InputError: no such study, or a variant is refused; nothing was flown or written.
    """
    if jobs < 1:
        raise InputError(f"--jobs must be at least 1, not {jobs}")
    chosen, loaded = _chosen(name, fly_sampled=fly_sampled), load_mission(mission)
    chosen.refuse(loaded)
    values = {option: numbers_of(option, text) for option, text in (asked or {}).items()}
    varied = variants(name, chosen, loaded, values)
    seed = loaded.mission.seeds[0] if seed is None else seed
    folder = (out or loaded.root / "reports" / loaded.mission.name) / f"study-{name}"
    plans = [_planned(variant) for variant in varied]
    report_folder(folder)
    sampler = chosen.sampler(loaded, seed) if chosen.sampler else None
    sampled = [sampler(*pair) if sampler else None for pair in zip(varied, plans, strict=True)]
    ends: list[FlightEnd | None] = [None] * len(varied)
    columns = chosen.columns
    if sampler is None or fly_sampled:
        tasks = [
            FlightTask(variant.loaded, seed, plan, folder / variant.name, variant.name)
            for variant, plan in zip(varied, plans, strict=True)
        ]
        ends = [
            *fly_all(
                tasks,
                fly=fly,
                open_executor=open_executor or local_executors(jobs),
                on_end=counted(len(tasks), progress),
            )
        ]
        columns += chosen.flown_columns
    result = StudyResult(
        study=name,
        title=chosen.title,
        mission=loaded.mission.name,
        platform=loaded.platform.name,
        seed=seed,
        expect_status=loaded.mission.expect_status,
        quantities=tuple(factor.quantity(loaded) for factor in chosen.factors),
        columns=columns,
        variants=tuple(
            _row(chosen, columns, *each) for each in zip(varied, ends, sampled, strict=True)
        ),
        trials=sampler.trials if sampler else 0,
        common=dict(sampler.common) if sampler else {},
    )
    return _written(chosen, result, folder, language)


def _chosen(name: str, *, fly_sampled: bool) -> Study:
    if name not in STUDIES:
        raise InputError(f"no study is named '{name}'", hint=suggest(name, list(STUDIES)))
    if fly_sampled and STUDIES[name].sampler is None:
        raise InputError(f"the study '{name}' flies in any case", hint="leave out --fly")
    return STUDIES[name]


def _written(
    chosen: Study, result: StudyResult, folder: Path, language: LanguageCode
) -> StudyOutcome:
    """Add thresholds and findings to the result and write the study's files."""
    result = chosen.concluded(result) if chosen.concluded else result
    write_model(folder / "study.json", result)
    page = folder / "study.html"
    figures = [figure(result) for figure in chosen.figures]
    document = study_document(result, chosen.explained, figures)
    write_whole(page, html(document, language_of(language)))
    return StudyOutcome(result, folder, page)


def _planned(variant: Variant) -> Plan | CoveragePlan:
    try:
        return plan_loaded(variant.loaded, vehicle_of(variant.loaded))
    except InfeasibleError as error:
        problems = [replace(p, what=f"{variant.name}: {p.what}") for p in error.problems]
        raise InfeasibleError(problems) from error


def _row(
    study: Study,
    columns: Sequence[StudyColumn],
    variant: Variant,
    end: FlightEnd | None,
    sampled: Sampled | None,
) -> StudyVariant:
    """The row of a variant: numbers of its samples, of its flight, or of both."""
    result = end.result if end else None
    missing = Metric(value=None, unit="1", why=(end.error if end else "") or "no such metric")
    known = dict(sampled.metrics) if sampled else {}
    if end and result is not None:
        known |= result.metrics | _own(study, end)
    return StudyVariant(
        name=variant.name,
        folder=variant.name if end else None,
        values=variant.values,
        status=result.status if result else "not flown" if end else "sampled",
        status_reason=result.status_reason if result else end.error if end else "",
        failed_checks=tuple(
            check.metric for check in (result.checks if result else ()) if check.verdict == "fail"
        ),
        metrics={c.metric: known.get(c.metric, missing) for c in columns},
        standard_errors=dict(sampled.standard_errors) if sampled else {},
    )


def _own(study: Study, end: FlightEnd) -> dict[str, Metric]:
    """The numbers of a flight that the study itself defines, from its log."""
    if end.folder is None or not study.own:
        return {}
    flight = FlightData(read_log(log_of(end.folder)))
    # The states of a diverged flight overflow; what is not finite is caught number by number.
    with np.errstate(all="ignore"):
        return {name: measure(spec, flight) for name, spec in study.own.items()}
