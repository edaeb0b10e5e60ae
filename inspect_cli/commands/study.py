"""``inspect study``: one mission flown with varied numbers, and what that does to its metrics.

<out>/study-<name>/study.json  study.html
<out>/study-<name>/<variant>/      an ordinary run of each variant
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import Protocol

import numpy as np

from inspect_cli.commands.fly import FlyOutcome, fly_loaded
from inspect_cli.commands.plan import plan_loaded, vehicle_of
from inspect_cli.commands.runs import log_of, write_model
from inspect_cli.commands.study_force import FORCE
from inspect_cli.commands.sweeps import Study, Variant, numbers_of, variants
from inspect_cli.errors import EXIT_CHECK_FAILED, EXIT_GOOD, InputError
from inspect_cli.files import write_whole
from inspect_cli.log.reader import read_log
from inspect_cli.metrics.evaluate import measure
from inspect_cli.metrics.flight import Flight
from inspect_cli.regression.flights import FlightEnd, FlightTask, fly_all
from inspect_cli.regression.run import Progress
from inspect_cli.reporting.html import html
from inspect_cli.reporting.language import LanguageCode
from inspect_cli.reporting.language import language as language_of
from inspect_cli.reporting.study import study_document
from inspect_cli.schema.coverage import CoveragePlan
from inspect_cli.schema.explain import suggest
from inspect_cli.schema.loading import Loaded, load_mission
from inspect_cli.schema.plan import Plan
from inspect_cli.schema.result import Metric
from inspect_cli.schema.study import StudyResult, StudyVariant

STUDIES: dict[str, Study] = {"force": FORCE}
"""What ``inspect study`` knows, by name."""


class FlyLoaded(Protocol):
    """Flies a mission that is read and planned; a function that other processes can import."""

    def __call__(
        self, loaded: Loaded, plan: Plan | CoveragePlan, *, seed: int, out: Path
    ) -> FlyOutcome:
        """Fly ``loaded`` with ``seed`` and write its files into the folder ``out``."""
        ...


@dataclass(frozen=True)
class StudyOutcome:
    """What came out, and where it was written."""

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
    progress: Progress | None = None,
    fly: FlyLoaded = fly_loaded,
) -> StudyOutcome:
    """Fly the variants of a mission and write ``study.json`` and ``study.html``.

    Args:
        name: one of ``STUDIES``.
        mission: the mission's file.
        asked: numbers with commas between them by option, instead of the study's own.
        out: folder for the study's, instead of the mission's in ``reports/``.
        seed: of every variant; by default the mission's first.
        jobs: flights at a time.
        language: of the page.
        progress: is told of each flight as it ends.
        fly: flies one variant.

    Raises:
        InputError: no such study, or a variant is refused; nothing was flown or written.
    """
    if jobs < 1:
        raise InputError(f"--jobs must be at least 1, not {jobs}")
    if name not in STUDIES:
        raise InputError(f"no study is named '{name}'", hint=suggest(name, list(STUDIES)))
    chosen, loaded = STUDIES[name], load_mission(mission)
    chosen.refuse(loaded)
    values = {option: numbers_of(option, text) for option, text in (asked or {}).items()}
    varied = variants(name, chosen, loaded, values)
    seed = loaded.mission.seeds[0] if seed is None else seed
    folder = (out or loaded.root / "reports" / loaded.mission.name) / f"study-{name}"
    ends = _flown(varied, folder, seed, jobs, fly, progress)
    result = StudyResult(
        study=name,
        title=chosen.title,
        mission=loaded.mission.name,
        platform=loaded.platform.name,
        seed=seed,
        expect_status=loaded.mission.expect_status,
        quantities=tuple(factor.quantity(loaded) for factor in chosen.factors),
        columns=chosen.columns,
        variants=tuple(_told(chosen, *pair) for pair in zip(varied, ends, strict=True)),
    )
    write_model(folder / "study.json", result)
    page = folder / "study.html"
    document = study_document(result, chosen.explained, chosen.figure(result))
    write_whole(page, html(document, language_of(language)))
    return StudyOutcome(result, folder, page)


@dataclass(frozen=True)
class _Flyer:
    """Flies variants by the folder that they are flown into, in other processes too."""

    fly: FlyLoaded
    planned: Mapping[Path, tuple[Loaded, Plan | CoveragePlan]]

    def __call__(
        self, mission: Path, *, seed: int | None, platform: Path | None, out: Path | None
    ) -> FlyOutcome:
        if out is None or seed is None:
            raise ValueError("a variant has a folder and a seed")
        loaded, plan = self.planned[out]
        return self.fly(loaded, plan, seed=seed, out=out)


def _flown(
    varied: Sequence[Variant],
    folder: Path,
    seed: int,
    jobs: int,
    fly: FlyLoaded,
    progress: Progress | None,
) -> list[FlightEnd]:
    """Plan every variant, then fly them, so that a refusal comes before the first flight."""
    planned = {folder / v.name: (v.loaded, _planned(v)) for v in varied}
    tasks = [FlightTask(v.loaded.mission_file, seed, folder / v.name, v.name) for v in varied]
    done = 0

    def on_end(end: FlightEnd) -> None:
        nonlocal done
        done += 1
        if progress is not None:
            progress(done, len(tasks), end)

    return fly_all(tasks, jobs=jobs, fly=_Flyer(fly, planned), on_end=on_end)


def _planned(variant: Variant) -> Plan | CoveragePlan:
    return plan_loaded(variant.loaded, vehicle_of(variant.loaded))


def _told(study: Study, variant: Variant, end: FlightEnd) -> StudyVariant:
    """What the study shows of a variant's flight."""
    result = end.result
    missing = Metric(value=None, unit="1", why=end.error or "no such metric")
    known = {} if result is None else result.metrics | _own(study, end)
    return StudyVariant(
        name=variant.name,
        folder=variant.name,
        values=variant.values,
        status="not flown" if result is None else result.status,
        status_reason=end.error if result is None else result.status_reason,
        failed_checks=tuple(
            check.metric for check in (result.checks if result else ()) if check.verdict == "fail"
        ),
        metrics={c.metric: known.get(c.metric, missing) for c in study.columns},
    )


def _own(study: Study, end: FlightEnd) -> dict[str, Metric]:
    """The study's own numbers of a flight, from its log."""
    if end.folder is None or not study.own:
        return {}
    flight = Flight(read_log(log_of(end.folder)))
    # The states of a diverged flight overflow; what is not finite is caught number by number.
    with np.errstate(all="ignore"):
        return {name: measure(spec, flight) for name, spec in study.own.items()}
