"""``inspect regress``: fly missions, compare them with their acceptance and with references."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from pathlib import Path

from inspect_cli.commands.fly import fly_loaded
from inspect_cli.errors import EXIT_CHECK_FAILED, EXIT_GOOD, InputError
from inspect_cli.files import write_whole
from inspect_cli.regression.executors import OpenExecutor, local_executors
from inspect_cli.regression.flights import Fly
from inspect_cli.regression.github import annotation_lines, step_summary
from inspect_cli.regression.junit import junit_xml
from inspect_cli.regression.outcome import RegressReport
from inspect_cli.regression.run import Progress, run
from inspect_cli.regression.selection import mission_files, select


@dataclass(frozen=True)
class RegressOutcome:
    """What came out, and what was written."""

    report: RegressReport
    updated: tuple[Path, ...]
    """The references that were rewritten."""
    annotations: tuple[str, ...]
    """Lines that GitHub Actions turns into annotations when they are printed; else none."""

    @property
    def exit_code(self) -> int:
        """Zero unless a flight failed."""
        return EXIT_CHECK_FAILED if self.report.failed else EXIT_GOOD


def regress(
    paths: Sequence[Path] = (),
    *,
    jobs: int = 1,
    update: bool = False,
    junit: Path | None = None,
    out: Path | None = None,
    progress: Progress | None = None,
    campaign: Path = Path(),
    fly: Fly = fly_loaded,
    open_executor: OpenExecutor | None = None,
    environment: Mapping[str, str] = os.environ,
) -> RegressOutcome:
    """Fly missions with all their seeds and compare what came out.

    Args:
        paths: mission files or folders; without any, the campaign's ``missions/``.
        jobs: flights at a time on this machine; does nothing with an ``open_executor``.
        update: rewrite the references of the flights that ended as their missions expect.
        junit: where to write JUnit XML.
        out: folder for the runs instead of the campaign's ``reports/``.
        progress: called with each flight as it ends.
        campaign: the campaign folder.
        fly: flies one mission.
        open_executor: opens what runs the flights, for example a cluster's client; by default
            processes of this machine.
        environment: variables in which GitHub Actions states its presence and the summary's file.

    Raises:
        InputError: there is no mission, or a mission file is refused; nothing was flown.
        EnvironmentFault: a reference or a report cannot be written.
    """
    if jobs < 1:
        raise InputError(f"--jobs must be at least 1, not {jobs}")
    selections = select(mission_files(paths, campaign))
    report, updated = run(
        selections,
        open_executor=open_executor or local_executors(jobs),
        fly=fly,
        update=update,
        out=out,
        progress=progress,
    )
    if junit is not None:
        write_whole(junit, junit_xml(report))
    on_github = environment.get("GITHUB_ACTIONS") == "true"
    summary = environment.get("GITHUB_STEP_SUMMARY")
    if on_github and summary:
        with Path(summary).open("a", encoding="utf-8") as file:
            file.write(step_summary(report))
    return RegressOutcome(report, updated, annotation_lines(report) if on_github else ())
