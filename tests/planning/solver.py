"""A well-kept routing solver beside the project's own search: OR-tools with guided local search."""

from __future__ import annotations

import numpy as np
from ortools.constraint_solver import pywrapcp, routing_enums_pb2

MICRO = 1e6
"""The solver counts in whole numbers."""


def length_m(points_W, start_W, order) -> float:
    """Of the open path from the start through the points."""
    path = np.vstack([start_W, points_W[list(order)]])
    return float(np.linalg.norm(np.diff(path, axis=0), axis=1).sum())


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
