"""Fresh processes of the command line: the help, a plan, and the first flight.

Each is timed in turns with a fresh interpreter that does the least that ours must do.
"""

from __future__ import annotations

import os
import subprocess
import sys
from collections.abc import Iterator, Mapping
from pathlib import Path
from tempfile import TemporaryDirectory

from tests.bench.rows import Row, Times, ratio
from tests.bench.yardsticks import COMPILATION, child_s

HELP_RUNS = 7
PLAN_RUNS = 3
HELP_IMPORTS = "import typer, rich.console, rich.table"
PLAN_IMPORTS = (
    f"{HELP_IMPORTS}, pydantic, yaml, numpy, numba, mujoco, scipy.ndimage, scipy.optimize, "
    "scipy.spatial; from inspect_cli.scans.files import open3d; open3d()"
)
"""What a plan needs of other people's packages; a scan is read by Open3D, which needs libusb."""

COMPILE_LIMIT = 3.4
"""Half of the 6.9 that the first compilation took, on an idle machine, before this was a ratio."""


def measure(mission: Path) -> Iterator[Row]:
    """The first answer, a cold plan, and what compilation adds to the first flight."""
    yield ratio(
        "cli.help_over_imports",
        2.0,
        "an interpreter that imports typer and rich",
        lambda k: _inspect_s("--help"),
        lambda k: _run_s("-c", HELP_IMPORTS),
        HELP_RUNS,
    )
    with TemporaryDirectory() as folder:
        yield ratio(
            "plan.cold_over_imports",
            1.75,
            "an interpreter that imports what a plan needs",
            lambda k: _inspect_s("plan", str(mission), "--out", folder),
            lambda k: _run_s("-c", PLAN_IMPORTS),
            PLAN_RUNS,
        )
    yield _compilation(mission)


def _compilation(mission: Path) -> Row:
    """By how much the first of two flights, plan included, with a cache of their own is slower."""
    yardstick_s = _kernel_s()
    with TemporaryDirectory() as cache, TemporaryDirectory() as out:
        first_s, second_s = (
            _inspect_s("fly", str(mission), "--out", out, environment={"NUMBA_CACHE_DIR": cache})
            for _ in range(2)
        )
    yardstick_s = 0.5 * (yardstick_s + _kernel_s())
    added_s = first_s - second_s
    times = Times(added_s, yardstick_s, "CPU s", COMPILATION)
    return Row(
        "compile.first_run_over_kernel", added_s / yardstick_s, "1", COMPILE_LIMIT, times=times
    )


def _kernel_s() -> float:
    command = [sys.executable, "-m", "tests.bench.yardsticks"]
    return float(subprocess.run(command, check=True, capture_output=True, text=True).stdout)


def _inspect_s(*arguments: str, environment: Mapping[str, str] | None = None) -> float:
    return _run_s("-m", "inspect_cli", *arguments, environment=environment)


def _run_s(*arguments: str, environment: Mapping[str, str] | None = None) -> float:
    return child_s([sys.executable, *arguments], os.environ | (environment or {}))
