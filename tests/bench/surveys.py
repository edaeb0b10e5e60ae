"""The survey of a whole vault: the time of its plan, and the length of its path.

The path is compared with the best that a routing solver finds in half a minute on the same points.
"""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from time import process_time

from inspect_cli.commands.plan import surveyor_of, vehicle_of
from inspect_cli.schema.loading import load_mission
from tests.bench.rows import Row, ratio
from tests.bench.yardsticks import WORKLOAD, reference_workload_s
from tests.planning.solver import solver_m, tips_of

SOLVER_S = 30
ROUNDS = 3


def measure(mission: Path) -> Iterator[Row]:
    """The time of the plan, kernels compiled, and our path over the solver's."""
    loaded = load_mission(mission)
    vehicle = vehicle_of(loaded)

    def ours_s(k: int) -> float:
        begun = process_time()
        surveyor_of(loaded, vehicle).survey()
        return process_time() - begun

    name = "survey.plan_over_workload"
    yield ratio(name, 2.1, WORKLOAD, ours_s, lambda k: reference_workload_s(), ROUNDS)
    survey = surveyor_of(loaded, vehicle).survey()
    best_m = solver_m(*tips_of(vehicle.capabilities, survey), SOLVER_S)
    yield Row("survey.way_over_solver", survey.tour_m / best_m, "1", 1.10)
