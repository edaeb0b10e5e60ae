"""What a user waits for: fresh processes of the command line."""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from statistics import median
from tempfile import TemporaryDirectory
from time import perf_counter

from tests.bench.rows import Row

HELP_RUNS = 7
PLAN_RUNS = 3


def measure(mission: Path) -> Iterator[Row]:
    """The first answer, a cold plan, and what compilation adds to the first flight."""
    yield Row("cli.help_s", _median_s(HELP_RUNS, "--help"), "s", 0.40)
    with TemporaryDirectory() as folder:
        planned = _median_s(PLAN_RUNS, "plan", str(mission), "--out", folder)
    yield Row("plan.cold_s", planned, "s", 2.5)
    yield Row("compile.first_run_s", _compilation_s(mission), "s", 15.0)


def _median_s(runs: int, *arguments: str) -> float:
    """The median of fresh processes, after one that fills the caches."""
    return median([_run_s(arguments) for _ in range(1 + runs)][1:])


def _compilation_s(mission: Path) -> float:
    """By how much the first of two flights, plan included, with a cache of their own is slower."""
    with TemporaryDirectory() as cache, TemporaryDirectory() as out:
        first_s, second_s = (
            _run_s(("fly", str(mission), "--out", out), {"NUMBA_CACHE_DIR": cache})
            for _ in range(2)
        )
    return first_s - second_s


def _run_s(arguments: tuple[str, ...], environment: Mapping[str, str] | None = None) -> float:
    command = [sys.executable, "-m", "inspect_cli", *arguments]
    begun = perf_counter()
    done = subprocess.run(
        command, env=os.environ | (environment or {}), capture_output=True, text=True
    )
    took = perf_counter() - begun
    if done.returncode:
        sys.exit(f"{' '.join(command)} ended with {done.returncode}:\n{done.stderr}")
    return took
