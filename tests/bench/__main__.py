"""Measure everything, show it, write ``reports/bench.json``; exit code 1 if a limit is broken."""

from __future__ import annotations

import sys
from pathlib import Path

from rich.console import Console
from rich.table import Table

from inspect_cli.files import write_whole
from inspect_cli.schema.loading import load_mission
from tests.bench import camera, fits, flights, processes, readings, surveys
from tests.bench.rows import Row, as_json

ROOT = Path(__file__).resolve().parents[2]
MISSION = ROOT / "missions" / "nine_point_half_cell.yaml"
VAULTS = ROOT / "missions" / "paper_a" / "servoing"
WIDTH = 140
"""Columns of the table where it goes into a file."""
SURVEY = ROOT / "missions" / "paper_a" / "vault_coverage.yaml"


def main() -> int:
    """Measure, write the file, print the table and why rows fall short."""
    console = Console(width=None if sys.stdout.isatty() else WIDTH)
    rows: list[Row] = []
    for measured in (
        fits.measure(),
        camera.measure(ROOT),
        flights.measure(load_mission(MISSION), "flight", 1.5),
        flights.measure(load_mission(VAULTS / "cylinder.yaml"), "vault", 1.6),
        flights.measure(load_mission(VAULTS / "uneven.yaml"), "uneven_vault", 2.0),
        processes.measure(MISSION),
        readings.measure(),
        surveys.measure(SURVEY),
    ):
        rows.extend(measured)
    write_whole(ROOT / "reports" / "bench.json", as_json(rows))
    console.print(_table(rows))
    for row in rows:
        if row.profile:
            console.print(f"\n[bold]{row.name}[/]: {row.profile}")
    return 0 if all(row.ok for row in rows) else 1


def _table(rows: list[Row]) -> Table:
    heads = ("what", "measured", "limit", "", "times", "yardstick")
    table = Table(*heads, title="reports/bench.json")
    for row in rows:
        sign = "≤" if row.bound == "max" else "≥"
        unit = "" if row.unit == "1" else f" {row.unit}"
        verdict = "[green]ok" if row.ok else "[bold red]broken"
        limit, times = f"{sign} {row.limit:g}{unit}", row.times
        shown = f"{times.ours:.3g} over {times.yardstick:.3g} {times.unit}" if times else ""
        what = times.what if times else ""
        table.add_row(row.name, f"{row.value:.3g}{unit}", limit, verdict, shown, what)
    for index in (1, 2, 4):
        table.columns[index].justify = "right"
    for column in table.columns[:5]:
        column.no_wrap = True
    return table


if __name__ == "__main__":
    sys.exit(main())
