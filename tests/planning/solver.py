"""A well-kept routing solver beside the project's own search: OR-tools with guided local search."""

from __future__ import annotations

import numpy as np
from ortools.constraint_solver import pywrapcp, routing_enums_pb2

MICRO = 1e6
"""The solver counts in whole numbers."""


def tips_of(capabilities, survey):
    """The tool's tips (n, 3) m at the standoffs in the order of the flights, and the first's (3,)
    over the start."""
    targets = [target for sortie in survey.sorties for target in sortie.plan.targets]
    tips = np.array([np.array(t.p_WC) + t.standoff_m * np.array(t.n_W) for t in targets])
    hover = survey.sorties[0].plan.legs[0].postures[-1]
    return tips, capabilities.frame_pose(hover.posture, "tool")[0]


def solver_m(points_W, start_W, limit_s: int) -> float:
    """The shortest open path, m, that the solver finds within the time."""
    nodes = np.vstack([start_W, points_W])
    n = len(nodes)
    # A node at no distance from any other lets the path end anywhere.
    distances = np.zeros((n + 1, n + 1), dtype=np.int64)
    apart_m = np.linalg.norm(nodes[:, None] - nodes[None], axis=2)
    distances[:n, :n] = np.rint(MICRO * apart_m)
    manager = pywrapcp.RoutingIndexManager(n + 1, 1, [0], [n])
    routing = pywrapcp.RoutingModel(manager)
    routing.SetArcCostEvaluatorOfAllVehicles(routing.RegisterTransitMatrix(distances.tolist()))
    parameters = pywrapcp.DefaultRoutingSearchParameters()
    first, better = (
        routing_enums_pb2.FirstSolutionStrategy,
        routing_enums_pb2.LocalSearchMetaheuristic,
    )
    parameters.first_solution_strategy = first.PATH_CHEAPEST_ARC
    parameters.local_search_metaheuristic = better.GUIDED_LOCAL_SEARCH
    parameters.time_limit.seconds = limit_s
    return routing.SolveWithParameters(parameters).ObjectiveValue() / MICRO
