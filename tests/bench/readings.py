"""A hundred thousand readings of a person's survey: time of the report, and size of its page.

The file is made here: a deck of 62 m by 100 m at 25 cm with two active regions and noise, once as
a grid and once as a list with coordinates beside the grid's.
"""

from __future__ import annotations

import sys
from collections.abc import Iterator
from pathlib import Path
from tempfile import TemporaryDirectory

import numpy as np

from tests.bench.rows import Row, ratio
from tests.bench.yardsticks import WORKLOAD, child_s, reference_workload_s

ROWS, COLUMNS, PITCH_M = 250, 400, 0.25
REGIONS = ((30.0, 20.0, 300.0, 60.0), (70.0, 45.0, 250.0, 40.0))
"""(u, v, depth in mV, squared width in m²)."""
ROUNDS = 3
LIMITS = {"grid": 24.0, "list": 28.0}
"""1.3 × 18.6 and 21.9, measured on an idle machine before the reports had rooms."""


def measure() -> Iterator[Row]:
    """The time of ``inspect report --readings``, everything included, and its page's megabytes.

    The median of few rounds, because one takes some ten seconds.
    """
    with TemporaryDirectory() as temporary:
        folder = Path(temporary)
        for layout, file in _files(folder).items():
            out = folder / layout
            command = [sys.executable, "-m", "inspect_cli", "report", "--readings", str(file)]
            command += ["--out", str(out)]
            name = f"readings.{layout}_over_workload"
            yield ratio(
                name,
                LIMITS[layout],
                WORKLOAD,
                lambda k, command=command: child_s(command),
                lambda k: reference_workload_s(),
                ROUNDS,
            )
            size_mb = 1e-6 * (out / "report.html").stat().st_size
            yield Row(f"readings.{layout}_page_mb", size_mb, "MB", 15.0)


def _files(folder: Path) -> dict[str, Path]:
    rng = np.random.default_rng(1)
    v, u = np.mgrid[0:ROWS, 0:COLUMNS] * PITCH_M
    mv = rng.normal(-150.0, 15.0, u.shape)
    for at_u, at_v, depth, width in REGIONS:
        mv -= depth * np.exp(-((u - at_u) ** 2 + (v - at_v) ** 2) / width)
    files = {"grid": folder / "grid.csv", "list": folder / "list.csv"}
    np.savetxt(files["grid"], np.round(mv), fmt="%d", delimiter=",")
    beside = rng.normal(0.0, 0.02, (2, *u.shape))
    columns = (u + beside[0], v + beside[1], np.round(mv), 8.0 + np.abs(mv) / 50.0)
    table = np.column_stack([column.ravel() for column in columns])
    header = "x_m,y_m,potential_mv,resistivity_kohm_cm"
    np.savetxt(files["list"], table, "%.3f", ",", header=header, comments="")
    return files
