"""The survey of a whole vault: how long its plan takes, and how short its way is.

The way is held against the best that a routing solver finds in half a minute on the same points.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import perf_counter

from inspect_cli.commands.plan import surveyor_of, vehicle_of
from inspect_cli.schema.loading import load_mission
from tests.bench.rows import Row
from tests.planning.solver import solver_m, tips_of

SOLVER_S = 30


def measure(mission: Path) -> Iterator[Row]:
    """Seconds for the plan, kernels compiled, and our way over the solver's."""
    loaded = load_mission(mission)
    vehicle = vehicle_of(loaded)
    surveyor_of(loaded, vehicle).survey()  # compiles
    begun = perf_counter()
    survey = surveyor_of(loaded, vehicle).survey()
    yield Row("survey.plan_s", perf_counter() - begun, "s", 5.0)
    best_m = solver_m(*tips_of(vehicle.capabilities, survey), SOLVER_S)
    yield Row("survey.way_over_solver", survey.tour_m / best_m, "1", 1.10)
